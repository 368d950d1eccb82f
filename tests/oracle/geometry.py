"""Metrics of the two distance fields. e2r[i] = d(x_i^s, R) for the estimate S, r2e[j] = d(x_j^r, S) for the reference R, in meters.

e2r_at and r2e_at: the least thresholds at which they count as within (neighbors.thresholded).
"""
import numpy as np


def rms(x):
    """sqrt(mean x^2), null without values."""
    return float(np.sqrt(np.mean(x * x))) if len(x) else None


def mean(x):
    """Mean, null without values."""
    return float(np.mean(x)) if len(x) else None


def quantile(x, q):
    """Type-7 quantile (linear interpolation), null without values."""
    return float(np.quantile(x, q)) if len(x) else None


def chamfer(e2r, r2e, cap):
    """value = mean e2r + mean r2e; the variants by name."""
    variants = {
        "l1_sum": mean(e2r) + mean(r2e),
        "l1_mean": (mean(e2r) + mean(r2e)) / 2,
        "l2sq_sum": mean(e2r**2) + mean(r2e**2),
        "l2_rms_mean": (rms(e2r) + rms(r2e)) / 2,
        "truncated_l1_sum": mean(np.minimum(e2r, cap)) + mean(np.minimum(r2e, cap)),
    }
    return {"value": variants["l1_sum"], "variants": variants, "estimate_to_reference": mean(e2r), "reference_to_estimate": mean(r2e),
            "n_estimate": len(e2r), "n_reference": len(r2e)}


def accuracy(e2r, e2r_at, thresholds):
    """Per threshold t: RMSE, mean and median of the e2r within t."""
    records = []
    for t in thresholds:
        x = e2r[e2r_at <= t]
        records.append({"threshold_m": t, "value": rms(x), "mean": mean(x), "median": quantile(x, 0.5), "n": len(x)})
    return {"per_threshold": records}


def share_within(at, thresholds):
    """Per threshold t: #{d within t} / N. Fitness (precision) of e2r_at, completeness (recall) of r2e_at."""
    counts = [int(np.sum(at <= t)) for t in thresholds]
    return {"per_threshold": [{"threshold_m": t, "value": n / len(at), "n": n} for t, n in zip(thresholds, counts)]}


def f_score(e2r_at, r2e_at, thresholds):
    """F = 2PR/(P+R), 0 when both are 0."""
    records = []
    for t in thresholds:
        p, r = float(np.mean(e2r_at <= t)), float(np.mean(r2e_at <= t))
        records.append({"threshold_m": t, "value": 2 * p * r / (p + r) if p + r > 0 else 0.0, "precision": p, "recall": r})
    return {"per_threshold": records}


def overlap(e2r_at, distance):
    """#{e2r within distance} / N_s."""
    n = int(np.sum(e2r_at <= distance))
    return {"value": n / len(e2r_at), "n": n, "n_estimate": len(e2r_at)}


def hausdorff(e2r, r2e):
    """max(max e2r, max r2e), and the 95th and 99th percentiles of each direction."""
    directed = [{"max": float(d.max()), "p95": quantile(d, 0.95), "p99": quantile(d, 0.99)} for d in (e2r, r2e)]
    return {"value": max(directed[0]["max"], directed[1]["max"]), "estimate_to_reference": directed[0],
            "reference_to_estimate": directed[1]}


def rmse(e2r, e2r_at, distance):
    """sqrt(mean e2r^2) over all; inlier_rmse over the e2r within distance."""
    inliers = e2r[e2r_at <= distance]
    return {"value": rms(e2r), "inlier_rmse": rms(inliers), "n": len(e2r), "n_inliers": len(inliers)}

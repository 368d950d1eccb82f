"""Metrics of color, RGB in [0,1]; NaN is no color.

A Direction holds the nearest pairs of one direction: the least threshold at which the distance counts as within (neighbors.thresholded), own
color, nearest point's color. Pairs without both colors never count.
"""
from collections import namedtuple

import numpy as np

from ciede2000 import ciede2000, lab_from_srgb
from geometry import mean, quantile
from grids import Grid, band, phases, voxel_groups
from neighbors import pairs_within

Direction = namedtuple("Direction", "at own nearest")
RANGE_EDGES_M = [0.0, 0.05, 0.1, 0.2, 0.5, 1.0]
CURVE_TAUS = [k / 50 for k in range(1, 16)]
BT709 = np.array([[0.2126, 0.7152, 0.0722], [-0.1146, -0.3854, 0.5], [0.5, -0.4542, -0.0458]])


def is_colored(colors):
    """Which rows are colors."""
    return ~np.isnan(colors).any(axis=1)


def without_color(est_color, ref_color):
    """Counts of points without color, where there are any."""
    missing = [int(np.sum(~is_colored(c))) for c in (est_color, ref_color)]
    return dict(zip(("n_without_color_estimate", "n_without_color_reference"), missing)) if any(missing) else {}


def within(pairs, low, high):
    """The pairs with both colors and low < distance <= high."""
    keep = (pairs.at > low) & (pairs.at <= high) & is_colored(pairs.own) & is_colored(pairs.nearest)
    return Direction(*(x[keep] for x in pairs))


def color_error(pairs):
    """|c - c_nearest|, L2 norm of RGB."""
    return np.linalg.norm(pairs.own - pairs.nearest, axis=1)


def two_sided(e2r, r2e):
    """(e2r mean + r2e mean) / 2 of the color errors, with both means; null without a pair in a direction."""
    a, b = mean(color_error(e2r)), mean(color_error(r2e))
    value = (a + b) / 2 if a is not None and b is not None else None
    return {"value": value, "estimate_to_reference": a, "reference_to_estimate": b}


def color_distance(e2r, r2e, max_distance):
    """CD = 1/2 mean_i |c_i^s - c_pi(i)^r| + 1/2 mean_j |c_j^r - c_pi'(j)^s|, over the pairs within max_distance if given."""
    gate = np.inf if max_distance is None else max_distance
    kept = within(e2r, -1, gate), within(r2e, -1, gate)
    record = two_sided(*kept)
    record["value_8bit"] = None if record["value"] is None else 255 * record["value"]
    missing = without_color(e2r.own, r2e.own)
    record.update(n_estimate=len(kept[0].at), n_reference=len(kept[1].at), **missing)
    if max_distance is not None or missing:
        record.update(n_unmatched_estimate=len(e2r.at) - len(kept[0].at), n_unmatched_reference=len(r2e.at) - len(kept[1].at))
    return record


def median_color_distance(e2r, r2e):
    """(median of one direction + median of the other) / 2 of the color errors; null without a pair in a direction."""
    a, b = (quantile(color_error(within(pairs, -1, np.inf)), 0.5) for pairs in (e2r, r2e))
    value = (a + b) / 2 if a is not None and b is not None else None
    return {"value": value, "estimate_to_reference": a, "reference_to_estimate": b, **without_color(e2r.own, r2e.own)}


def color_fidelity(cd):
    """CF = -20 log10(CD); null for CD = 0 and for no CD."""
    return {"value": float(-20 * np.log10(cd)) if cd else None}


NOT_COVERED, NO_RIGHT_COLOR = np.inf, 1e9


def nearest_colors_within(ref, ref_color, est, est_color, radius):
    """For each reference point with a color the smallest |c^s - c^r| over the estimated points within radius, which are offsets here."""
    best = np.full(len(ref), NOT_COVERED)
    for first, i, j in pairs_within(ref, est, radius, rounded=True):
        difference = np.linalg.norm(est_color[j] - ref_color[first + i], axis=1)
        np.minimum.at(best, first + i, np.where(np.isnan(difference), NO_RIGHT_COLOR, difference))
    return best[is_colored(ref_color)]


def recalled(best, tau):
    """#{j : best_j <= 3 tau}; equality holds up to rounding (3 x 0.2 is not 0.6 in double)."""
    return int(np.sum(best <= 3 * tau + 1e-12))


def local_color_recall(best, tau, curve):
    """LCR = #{best <= 3 tau} / N_r, coverage = #{best finite} / N_r; the curve's area is trapezoidal, divided by the range of tau."""
    n, covered, hits = len(best), int(np.sum(best != NOT_COVERED)), recalled(best, tau)
    record = {"value": hits / n, "coverage": covered / n, "conditional": hits / covered if covered else None,
              "n_reference": n, "n_covered": covered, "n_recalled": hits}
    if curve:
        values = [recalled(best, t) / n for t in CURVE_TAUS]
        area = np.sum(np.diff(CURVE_TAUS) * (np.array(values[1:]) + values[:-1]) / 2) / (CURVE_TAUS[-1] - CURVE_TAUS[0])
        record["curve"] = {"tau": CURVE_TAUS, "value": values, "area": float(area)}
    return record


def voxel_color_variance(points, colors, grid, singletons, min_points):
    """tr cov(c), n-1, of the voxels: its mean over all occupied ones with those of one point as 0 (zero), and over those of at least
    max(min_points, 2) points (exclude)."""
    colored = is_colored(colors)
    _, group, count = voxel_groups(points[colored], grid)
    colors = colors[colored]
    centers = np.stack([np.bincount(group, colors[:, k]) for k in range(3)], axis=1) / count[:, None]
    scatter = np.bincount(group, np.sum((colors - centers[group]) ** 2, axis=1))
    trace = np.where(count > 1, scatter / np.maximum(count - 1, 1), 0.0)
    enough = count >= max(min_points, 2)
    both = {"zero": mean(trace), "exclude": mean(trace[enough])}
    value = both["exclude" if singletons == "exclude" else "zero"]
    record = {"value": value, "value_x100": None if value is None else 100 * value, **both, "median": quantile(trace[count > 1], 0.5),
              "n_voxels": int(enough.sum()) if singletons == "exclude" else len(count), "n_occupied": len(count),
              "n_singletons": int(np.sum(count == 1))}
    if not colored.all():
        record["n_without_color"] = int(np.sum(~colored))
    return record


def color_consistency(est, est_color, ref, ref_color, voxel_m, singletons, min_points, n_grids):
    """CCS of the estimate, and of the reference beside it; n_grids above 1: with the phases of the grid."""
    record = voxel_color_variance(est, est_color, Grid(voxel_m), singletons, min_points)
    record["reference"] = voxel_color_variance(ref, ref_color, Grid(voxel_m), singletons, min_points)
    if n_grids > 1:
        record["phases"] = band([voxel_color_variance(est, est_color, grid, singletons, min_points)["value"]
                                 for grid in phases(voxel_m, n_grids)])
    return record


def delta_e(e2r, r2e, radius):
    """CIEDE2000 over the pairs within radius: mean, median, 95th percentile; value = mean of both directions' means."""
    record = {"value": None, **without_color(e2r.own, r2e.own)}
    for name, pairs in (("estimate_to_reference", e2r), ("reference_to_estimate", r2e)):
        near = within(pairs, -1, radius)
        error = ciede2000(lab_from_srgb(near.own), lab_from_srgb(near.nearest))
        record[name] = {"mean": mean(error), "median": quantile(error, 0.5), "p95": quantile(error, 0.95), "n": len(error)}
    a, b = record["estimate_to_reference"]["mean"], record["reference_to_estimate"]["mean"]
    if a is not None and b is not None:
        record["value"] = (a + b) / 2
    return record


def color_distance_by_range(e2r, r2e):
    """CD of the pairs in each distance bin (lo, hi]; the first bin includes 0."""
    records = []
    for low, high in zip(RANGE_EDGES_M[:-1], RANGE_EDGES_M[1:]):
        a, b = within(e2r, low or -1, high), within(r2e, low or -1, high)
        records.append({"lo_m": low, "hi_m": high, **two_sided(a, b), "n_estimate": len(a.at), "n_reference": len(b.at)})
    return {"per_range": records, **without_color(e2r.own, r2e.own)}


def exposure_gains(e2r, radius):
    """Per channel the median of c_ref / c_est over estimate-to-reference pairs within radius, both values non-zero."""
    near = within(e2r, -1, radius)
    usable = (near.own > 0) & (near.nearest > 0)
    ratios = [near.nearest[usable[:, k], k] / near.own[usable[:, k], k] for k in range(3)]
    return [quantile(r, 0.5) for r in ratios], len(near.at)


def color_distance_exposure_free(e2r, r2e, radius, max_distance):
    """CD (over the pairs that CD takes) with the estimate's colors times the gains, unclipped."""
    gains, n_pairs = exposure_gains(e2r, radius)
    record = {"value": None, "estimate_to_reference": None, "reference_to_estimate": None}
    if None not in gains:
        gate = np.inf if max_distance is None else max_distance
        a, b = within(e2r, -1, gate), within(r2e, -1, gate)
        record = two_sided(a._replace(own=a.own * gains), b._replace(nearest=b.nearest * gains))
    return {**record, "gains": gains, "n_pairs": n_pairs, **without_color(e2r.own, r2e.own)}


def color_psnr(e2r, r2e):
    """10 log10(1 / mse) for Y, Cb, Cr (BT.709, pc_error's four-digit coefficients), mse the larger of both directions.

    mse below 1e-24 is rounding noise (of gray differences in Cb and Cr) and counts as 0; mse 0 gives null.
    """
    kept = [within(pairs, -1, np.inf) for pairs in (e2r, r2e)]
    mse = [np.mean(((pairs.own - pairs.nearest) @ BT709.T) ** 2, axis=0) for pairs in kept]
    mse = [np.where(m < 1e-24, 0.0, m) for m in mse]
    y, cb, cr = (float(-10 * np.log10(m)) if m > 0 else None for m in np.maximum(*mse))
    return {"value": y, "y": y, "cb": cb, "cr": cr,
            "mse": {"estimate_to_reference": mse[0].tolist(), "reference_to_estimate": mse[1].tolist()},
            **without_color(e2r.own, r2e.own)}

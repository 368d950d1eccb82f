"""Metrics of local Gaussians: average Wasserstein distance, spatial consistency, mean map entropy."""
import numpy as np
from scipy.spatial import cKDTree

from geometry import mean, quantile
from grids import band, phases, rows_by_voxel
from neighbors import float_steps, pairs_within


def gaussian(points):
    """Mean and a factor F with F^T F = covariance (n-1), by QR of the centered points: no digit is lost on flat sets."""
    center = points.mean(axis=0)
    return center, np.linalg.qr((points - center) / np.sqrt(len(points) - 1), mode="r")


def wasserstein(points1, points2):
    """W^2 = |m1-m2|^2 + tr(S1 + S2 - 2 (S1^1/2 S2 S1^1/2)^1/2); the last trace is the sum of singular values of F1 F2^T.

    W^2 below 1e-12 (tr S1 + tr S2) counts as 0.
    """
    (m1, f1), (m2, f2) = gaussian(points1), gaussian(points2)
    spread = np.sum(f1**2) + np.sum(f2**2)
    squared = np.sum((m1 - m2) ** 2) + spread - 2 * np.sum(np.linalg.svd(f1 @ f2.T, compute_uv=False))
    return 0.0 if squared < 1e-12 * spread else float(np.sqrt(max(squared, 0.0)))


def voxel_distances(est, ref, grid, min_points):
    """{voxel: W} over the voxels that hold at least max(min_points, 2) points of both maps."""
    a, b = (rows_by_voxel(p, p, grid, max(min_points, 2)) for p in (est, ref))
    return {key: wasserstein(a[key], b[key]) for key in sorted(a.keys() & b.keys())}


def average_wasserstein(distances):
    """AWD: the mean of W; its median and its quantiles at 0, 5 .. 100 %."""
    w = np.array(list(distances.values()))
    cumulative = [{"share": k / 20, "value_m": quantile(w, k / 20)} for k in range(21)] if len(w) else []
    return {"value": mean(w), "median": quantile(w, 0.5), "n_voxels": len(w), "cumulative": cumulative}


def spatial_consistency(distances, radius):
    """SCS: mean over voxels of std/mean (population) of W over the other voxels within the cube of +-radius; mean 0 is skipped."""
    keys, w = np.array(list(distances.keys())).reshape(-1, 3), np.array(list(distances.values()))
    ratios = []
    for k in range(len(w)):
        near = np.abs(keys - keys[k]).max(axis=1) <= radius
        near[k] = False
        if near.any() and w[near].mean() > 0:
            ratios.append(w[near].std() / w[near].mean())
    return {"value": mean(ratios), "n_voxels": len(ratios)}


def voxel_metrics(est, ref, voxel_m, min_points, radius, n_grids):
    """AWD and SCS at the world's origin and, unless n_grids is 1, over the phases of the grid."""
    distances = [voxel_distances(est, ref, grid, min_points) for grid in phases(voxel_m, n_grids)]
    awd, scs = [average_wasserstein(d) for d in distances], [spatial_consistency(d, radius) for d in distances]
    if n_grids > 1:
        for records in (awd, scs):
            records[0]["phases"] = band([record["value"] for record in records])
    return {"average_wasserstein": awd[0], "spatial_consistency": scs[0]}


def neighborhood_covariances(points, radius, min_neighbors):
    """Covariance (n-1) of each point's neighbors within radius, itself left out; NaN below min_neighbors."""
    result = np.full((len(points), 3, 3), np.nan)
    for first, i, j in pairs_within(points, points, radius):
        other = first + i != j
        i, j = i[other], j[other]
        size = min(len(points) - first, i.max() + 1 if len(i) else 0)
        count = np.bincount(i, minlength=size)
        delta = points[j] - points[first + i]
        center = np.stack([np.bincount(i, delta[:, k], size) for k in range(3)], axis=1) / np.maximum(count, 1)[:, None]
        delta -= center[i]
        moments = [np.bincount(i, delta[:, a] * delta[:, b], size) for a in range(3) for b in range(3)]
        full = count >= max(min_neighbors, 2)
        result[first + np.flatnonzero(full)] = np.stack(moments, axis=1).reshape(-1, 3, 3)[full] / (count[full] - 1)[:, None, None]
    return result


def map_entropy(offsets, radius, min_neighbors):
    """Mean over points of 1/2 ln((2 pi e)^3 det C). Left out and counted: points with too few neighbors, and those whose neighborhood is flat,
    its smallest eigenvalue below the square of single precision's step at the offsets within the radius."""
    cov = neighborhood_covariances(offsets, radius, min_neighbors)
    enough = np.isfinite(cov).all(axis=(1, 2))
    flat = np.linalg.eigvalsh(cov[enough])[:, 0] < float_steps(np.abs(offsets[enough]) + radius, 0) ** 2
    entropy = 0.5 * (3 * np.log(2 * np.pi * np.e) + np.log(np.linalg.det(cov[enough][~flat])))
    return {"value": mean(entropy), "n": len(entropy), "n_left_out": int(np.sum(~enough)), "n_flat": int(np.sum(flat))}


def mean_map_entropy(est, ref, radius, min_neighbors):
    """MME of the estimate, and of the reference beside it."""
    return {**map_entropy(est, radius, min_neighbors), "reference": map_entropy(ref, radius, min_neighbors)}


def spacing(points):
    """Distance from every place to the nearest other one; points of equal coordinates are one place."""
    places = np.unique(points, axis=0)
    distance = cKDTree(places).query(places, k=2)[0][:, 1] if len(places) > 1 else np.empty(0)
    median = float(np.median(distance)) if len(distance) else None
    return {"value": median, "mean": mean(distance), "n": len(places), "n_copies": len(points) - len(places)}


def point_spacing(est, ref):
    """Point spacing of the estimate, and of the reference beside it."""
    return {**spacing(est), "reference": spacing(ref)}

"""Voxel grids anchored at the world's origin, their phases, and the band of a metric over these.

Voxel of the grid of phase (k_x, k_y, k_z) of m: floor((floor(m x / v) + k) / m), which is the grid shifted by -k v / m.
"""
from collections import namedtuple
from itertools import product

import numpy as np

Grid = namedtuple("Grid", "voxel_m m k", defaults=(1, (0, 0, 0)))


def cells(points, grid):
    """The voxel of every point. Phase 0 is floor(x / v) itself: m x / v rounds elsewhere for m = 3."""
    if not any(grid.k):
        return np.floor(points / grid.voxel_m).astype(np.int64)
    return np.floor((np.floor(grid.m * points / grid.voxel_m) + np.array(grid.k)) / grid.m).astype(np.int64)


def voxel_groups(points, grid):
    """(voxels n x 3 sorted, the voxel of each point, points in each voxel)."""
    keys, group, count = np.unique(cells(points, grid), axis=0, return_inverse=True, return_counts=True)
    return keys, group.ravel(), count


def rows_by_voxel(points, values, grid, min_points):
    """{voxel: rows of values}, in the order of the points, for voxels of at least min_points."""
    keys, group, count = voxel_groups(points, grid)
    parts = np.split(values[np.argsort(group, kind="stable")], np.cumsum(count)[:-1])
    return {tuple(key): part for key, part in zip(keys.tolist(), parts) if len(part) >= min_points}


def phases(voxel_m, n_grids):
    """The 1, 8 or 27 grids: offsets 0 .. m-1 on x, y, z, x slowest."""
    m = {1: 1, 8: 2, 27: 3}[n_grids]
    return [Grid(voxel_m, m, k) for k in product(range(m), repeat=3)]


def band(values):
    """n of the values that are not null, their mean, population std, min, max; then all values."""
    known = np.array([v for v in values if v is not None])
    if not len(known):
        return {"n": 0, "values": values}
    return {"n": len(known), "mean": float(known.mean()), "std": float(known.std()), "min": float(known.min()), "max": float(known.max()),
            "values": values}

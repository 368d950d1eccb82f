"""Nearest neighbors with exact ties, pairs within a radius, and voxel groups: what every metric of the oracle reads."""
import numpy as np
from scipy.spatial import cKDTree

CHUNK = 20000


def squared_distance(a, b):
    """((dx^2 + dy^2) + dz^2), in double, in this order."""
    d = a - b
    return d[..., 0] * d[..., 0] + d[..., 1] * d[..., 1] + d[..., 2] * d[..., 2]


def lowest_of_nearest(point, targets, candidates):
    """Index of the nearest candidate; of equally near ones the lowest."""
    candidates = np.sort(np.asarray(candidates))
    return candidates[np.argmin(squared_distance(point, targets[candidates]))]


def nearest(points, targets):
    """For each point the index of its nearest target (ties: the lowest index) and the distance in meters."""
    tree = cKDTree(targets)
    if len(targets) == 1:
        index = np.zeros(len(points), int)
    else:
        distance, found = tree.query(points, k=2)
        index = found[:, 0].copy()
        for i in np.flatnonzero(distance[:, 1] <= distance[:, 0] * (1 + 1e-9)):
            candidates = tree.query_ball_point(points[i], distance[i, 0] * (1 + 1e-8))
            index[i] = lowest_of_nearest(points[i], targets, candidates)
    return index, np.sqrt(squared_distance(points, targets[index]))


def pairs_within(points, targets, radius):
    """Yield (first, i, j) for chunks of points: every pair |points[first + i] - targets[j]| <= radius, sorted by i."""
    tree = cKDTree(targets)
    for first in range(0, len(points), CHUNK):
        chunk = points[first:first + CHUNK]
        pairs = cKDTree(chunk).sparse_distance_matrix(tree, radius * (1 + 1e-9), output_type="ndarray")
        order = np.argsort(pairs["i"], kind="stable")
        i, j = pairs["i"][order], pairs["j"][order]
        inside = np.sqrt(squared_distance(chunk[i], targets[j])) <= radius
        yield first, i[inside], j[inside]


def voxel_groups(points, voxel):
    """Voxels floor(x / voxel): (keys m x 3 sorted, the voxel of each point, points in each voxel)."""
    cells = np.floor(points / voxel).astype(np.int64)
    return np.unique(cells, axis=0, return_inverse=True, return_counts=True)

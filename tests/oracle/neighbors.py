"""Nearest neighbors with exact ties and pairs within a radius: what the metrics of the oracle read."""
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


def common_origin(ref, est):
    """Where offsets are counted from: on each axis the multiple of a power of ten (at least 100 m and the extent) nearest to the box's center."""
    low, high = np.minimum(ref.min(axis=0), est.min(axis=0)), np.maximum(ref.max(axis=0), est.max(axis=0))
    unit = np.array([10.0 ** max(2, int(np.ceil(np.log10(max(e, 1e-300))))) for e in high - low])
    return np.floor((low + high) / 2 / unit + 0.5) * unit


def float_steps(a, b):
    """The step of single precision at the largest absolute coordinate of each pair of offsets."""
    return np.spacing(np.maximum(np.abs(a), np.abs(b)).max(axis=-1).astype(np.float32)).astype(np.float64)


def thresholded(distance, a, b):
    """The least threshold at which each distance counts as within: two float steps of the offsets below it."""
    return distance - 2 * float_steps(a, b)


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


def nearest_other(points):
    """For each point the index of its nearest other entry (ties: the lowest index) and the distance; a copy at the same place is another."""
    if len(points) < 2:
        return np.empty(0, int), np.empty(0)
    tree = cKDTree(points)
    distance = tree.query(points, k=min(3, len(points)))[0]
    index = np.empty(len(points), int)
    # The own entry is among those at distance 0; which of them the tree gives first is its own affair.
    reach = distance[:, 1] * (1 + 1e-8)
    single = distance[:, 2] > reach if len(points) > 2 else np.ones(len(points), bool)
    single &= distance[:, 1] > 0
    index[single] = tree.query(points[single], k=2)[1][:, 1]
    for i in np.flatnonzero(~single):
        candidates = np.array(tree.query_ball_point(points[i], reach[i]))
        index[i] = lowest_of_nearest(points[i], points, candidates[candidates != i])
    return index, np.sqrt(squared_distance(points, points[index]))


def pairs_within(points, targets, radius, rounded=False):
    """Yield (first, i, j) for chunks of points: every pair |points[first + i] - targets[j]| <= radius, sorted by i.

    rounded: up to two float steps of the offsets (which the points then are).
    """
    tree = cKDTree(targets)
    reach = radius + 4 * np.spacing(np.float32(np.abs(targets).max() + radius)) if rounded else radius
    for first in range(0, len(points), CHUNK):
        chunk = points[first:first + CHUNK]
        pairs = cKDTree(chunk).sparse_distance_matrix(tree, reach * (1 + 1e-9), output_type="ndarray")
        order = np.argsort(pairs["i"], kind="stable")
        i, j = pairs["i"][order], pairs["j"][order]
        distance = np.sqrt(squared_distance(chunk[i], targets[j]))
        inside = (thresholded(distance, chunk[i], targets[j]) if rounded else distance) <= radius
        yield first, i[inside], j[inside]

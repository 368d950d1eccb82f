"""Nearest points and means of neighborhoods in numpy, on cells."""
import numpy as np


def cell_keys(points, edge):
    """One number for each point's cell of this edge; neighboring cells differ by the sums of STEPS."""
    cells = np.floor(points / edge).astype(np.int64) + (1 << 19)
    return cells @ STEPS


STEPS = np.array([1 << 40, 1 << 20, 1])
AROUND = np.array([[x, y, z] for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)]) @ STEPS


def neighborhood_means(points, values, radius):
    """Mean of the values in the cube of three cells each way that is about 2 radius wide: what a blur of that radius leaves."""
    keys, cell, count = np.unique(cell_keys(points, 2 * radius / 3), return_inverse=True, return_counts=True)
    sums = np.stack([np.bincount(cell, values[:, k]) for k in range(values.shape[1])] + [count], axis=1)
    total = np.zeros_like(sums)
    for step in AROUND:
        at = np.minimum(np.searchsorted(keys, keys + step), len(keys) - 1)
        there = keys[at] == keys + step
        total[there] += sums[at[there]]
    return (total[:, :-1] / total[:, -1:])[cell]


def nearest(points, queries, within):
    """Index of the nearest of the points for each query, which must have one within that distance."""
    edge = max(within, np.ptp(points, axis=0).max() / 25)  # smaller cells would be too many
    keys = cell_keys(points, edge)
    order = np.argsort(keys, kind="stable")
    keys, query_keys = keys[order], cell_keys(queries, edge)
    query_order = np.argsort(query_keys, kind="stable")
    groups = np.split(query_order, np.flatnonzero(np.diff(query_keys[query_order])) + 1)
    found = np.empty(len(queries), np.int64)
    for group in groups:
        around = query_keys[group[0]] + AROUND
        first, last = np.searchsorted(keys, around), np.searchsorted(keys, around, side="right")
        near = np.concatenate([order[a:b] for a, b in zip(first, last)])
        for part in np.array_split(group, 1 + len(group) * len(near) // 10**7):
            found[part] = near[squared_distances(queries[part], points[near]).argmin(axis=1)]
    return found


def squared_distances(a, b):
    """Of each of a (n) to each of b (m): n x m, about b's middle, where they are exact enough."""
    middle = b.mean(axis=0)
    a, b = a - middle, b - middle
    return np.sum(a**2, axis=1)[:, None] - 2 * a @ b.T + np.sum(b**2, axis=1)

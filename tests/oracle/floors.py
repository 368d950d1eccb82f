"""Floors: what a perfect map could be expected to score against the reference.

Pair metrics: the reference against itself, each point's own entry left out; from all points, so exact for what a program takes from a sample
of them. AWD and CW: between random halves of the reference, as mean and spread over many of them.
"""
import numpy as np

import color
import geometry
from color import Direction
from color_wasserstein import colors_by_voxel, mean_distance
from grids import Grid
from neighbors import nearest_other, pairs_within, thresholded
from structure import voxel_distances

N_HALVES = 25
LEAST_VOXELS = 20


class SelfPairs:
    """Every reference point and its nearest other one."""

    def __init__(self, ref, ref_color, origin):
        index, self.distance = nearest_other(ref)
        self.at = thresholded(self.distance, ref[:len(index)] - origin, ref[index] - origin)
        self.colors = None if ref_color is None else Direction(self.at, ref_color[:len(index)], ref_color[index])


def chamfer(pairs):
    """Both directions are the one."""
    mean = geometry.mean(pairs.distance)
    return {"value": None if mean is None else 2 * mean, **({} if mean is None else {"n": len(pairs.distance)})}


def accuracy(pairs, thresholds):
    """Per threshold the RMSE of the distances within it."""
    return [{"value": record["value"]} for record in geometry.accuracy(pairs.distance, pairs.at, thresholds)["per_threshold"]]


def share_within(pairs, thresholds):
    """Per threshold the share of points: of fitness, completeness and F alike."""
    return [{"value": float(np.mean(pairs.at <= t)) if len(pairs.at) else None} for t in thresholds]


def color_distance(pairs, max_distance):
    """The mean color error of the pairs that CD would take."""
    error = color.color_error(color.within(pairs.colors, -1, np.inf if max_distance is None else max_distance))
    return {"value": geometry.mean(error), **({"n": len(error)} if len(error) else {})}


def delta_e(pairs, radius):
    """The mean CIEDE2000 of the pairs within the radius."""
    return {"value": color.delta_e(pairs.colors, pairs.colors, radius)["value"]}


def nearest_colors_of_others(offsets, colors, radius):
    """For each colored point the smallest color error among the other points within the radius."""
    best = np.full(len(offsets), color.NOT_COVERED)
    for first, i, j in pairs_within(offsets, offsets, radius, rounded=True):
        i, j = first + i[first + i != j], j[first + i != j]
        difference = np.linalg.norm(colors[j] - colors[i], axis=1)
        np.minimum.at(best, i, np.where(np.isnan(difference), color.NO_RIGHT_COLOR, difference))
    return best[color.is_colored(colors)]


def local_color_recall(offsets, colors, radius, tau):
    """LCR of the reference by its other points."""
    record = color.local_color_recall(nearest_colors_of_others(offsets, colors, radius), tau, False)
    return {"value": record["value"], "n": record["n_reference"]}


def random_halves(n, random):
    """Which of n points are in the first half: as many as in the second, or one more."""
    order = random.permutation(n)
    first = np.zeros(n, bool)
    first[order[:(n + 1) // 2]] = True
    return first


def over_halves(n_points, distance_of):
    """{value, spread, n} of distance_of(first half?) = (value, n_voxels) over many halves; null where all have fewer than LEAST_VOXELS."""
    random = np.random.default_rng(17)
    found = [distance_of(random_halves(n_points, random)) for _ in range(N_HALVES)]
    n_voxels = [n for _, n in found]
    if max(n_voxels) < LEAST_VOXELS:
        return {"value": None, "n_max": max(n_voxels)}
    values = np.array([v for v, n in found if n])
    return {"value": float(values.mean()), "se_value": float(values.std(ddof=1) / np.sqrt(len(values))), "se": float(values.std(ddof=1)),
            "n_min": min(n_voxels), "n_max": max(n_voxels)}


def average_wasserstein(ref, voxel_m, min_points):
    """AWD between two halves of the reference."""
    def distance_of(first):
        w = list(voxel_distances(ref[first], ref[~first], Grid(voxel_m), min_points).values())
        return geometry.mean(np.array(w)), len(w)

    return over_halves(len(ref), distance_of)


def color_wasserstein(ref, ref_color, voxel_m, min_points):
    """CW between two halves of the reference."""
    def distance_of(first):
        return mean_distance(*(colors_by_voxel(ref[half], ref_color[half], Grid(voxel_m), min_points) for half in (first, ~first)))[:2]

    return over_halves(len(ref), distance_of)

"""Distance and color error of one cloud against another, by definition, with numpy alone."""
from collections import namedtuple

import numpy as np

TIE_M = 2e-6  # points that are equally near but for the rounding of coordinates

# chamfer_m: sum of both mean distances; rmse_m: of the estimate's distances; color_low, color_high: the color distance CD, which
# has no one value where several points of different colors are equally near.
Scores = namedtuple("Scores", "chamfer_m rmse_m color_low color_high")


def distance_table(a, b):
    squares = np.zeros((len(a), len(b)))
    for axis in range(3):
        squares += np.square(a[:, axis, None] - b[None, :, axis])
    return np.sqrt(squares, out=squares)


def closest_pair_m(xyz):
    """Distance of the two points of a cloud that are nearest to each other."""
    table = distance_table(xyz, xyz)
    np.fill_diagonal(table, np.inf)
    return table.min()


def mean_color_errors(a, b):
    return np.linalg.norm(a - b, axis=1).mean()


def one_way(distances, own, other):
    """Nearest distances along rows, and the mean color error with the nearest point: lowest and highest over ties."""
    nearest = distances.min(axis=1)
    if own is None or other is None:
        return nearest, None, None
    low, high = 0.0, 0.0
    tied = distances <= nearest[:, None] + TIE_M
    for row in range(len(own)):
        errors = np.linalg.norm(other[tied[row]] - own[row], axis=1)
        low, high = low + errors.min(), high + errors.max()
    return nearest, low / len(own), high / len(own)


def score_all_pairs(ref_xyz, ref_rgb, est_xyz, est_rgb):
    distances = distance_table(est_xyz - ref_xyz[0], ref_xyz - ref_xyz[0])
    to_ref, low_a, high_a = one_way(distances, est_rgb, ref_rgb)
    to_est, low_b, high_b = one_way(distances.T, ref_rgb, est_rgb)
    chamfer, rmse = to_ref.mean() + to_est.mean(), np.sqrt(np.mean(np.square(to_ref)))
    if low_a is None:
        return Scores(chamfer, rmse, None, None)
    return Scores(chamfer, rmse, (low_a + low_b) / 2, (high_a + high_b) / 2)


def score(ref_xyz, ref_rgb, ref_closest_pair_m, est_xyz, est_rgb):
    """Scores of the estimate. Where no point moved by more than a third of the closest pair, each is nearest to itself."""
    if len(est_xyz) == len(ref_xyz):
        moved = np.linalg.norm(est_xyz - ref_xyz, axis=1)
        if moved.max() < ref_closest_pair_m / 3:
            cd = None if est_rgb is None else mean_color_errors(est_rgb, ref_rgb)
            return Scores(2 * moved.mean(), np.sqrt(np.mean(np.square(moved))), cd, cd)
    return score_all_pairs(ref_xyz, ref_rgb, est_xyz, est_rgb)

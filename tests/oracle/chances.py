"""Chance: the expected value of a color metric when every estimated point draws its color from all the estimate's colors, with replacement.

Exact over all pairs of different colors where these are few enough, else from many drawn pairs. A record holds `value`; `se_value`, its own
standard error, 0 where exact; and `se`, the standard error of a program that takes the sample that METRICS gives.
"""
import numpy as np
from scipy.spatial.distance import cdist

from ciede2000 import ciede2000, lab_from_srgb
from color import CURVE_TAUS, is_colored, within
from color_wasserstein import colors_by_voxel, mean_distance
from grids import Grid
from neighbors import pairs_within

N_POINTS, N_REFERENCE, N_DRAWS = 100000, 20000, 5  # the samples of METRICS
N_OWN_PAIRS, N_OWN_DRAWS, N_OWN_REFERENCE = 4000000, 40, 40000  # and of the oracle
ROWS_AT_ONCE = 4000000


def counted(colors):
    """The different colors of those that are one, and how often each occurs."""
    return np.unique(colors[is_colored(colors)], axis=0, return_counts=True)


def chunks(n_rows, n_columns):
    """Slices of rows whose table with the columns is not too large."""
    step = max(1, ROWS_AT_ONCE // n_columns)
    return [slice(first, first + step) for first in range(0, n_rows, step)]


def rgb_difference(a, b):
    """|a_i - b_j| for every pair."""
    return cdist(a, b)


def delta_e_difference(a, b):
    """CIEDE2000 for every pair."""
    return ciede2000(lab_from_srgb(a)[:, None], lab_from_srgb(b)[None])


def drawn_difference(drawn, there, difference, most_pairs):
    """(mean, variance, standard error of the mean) of the difference of a color drawn from `drawn` and one of `there`."""
    (a, n_a), (b, n_b) = counted(drawn), counted(there)
    if len(a) * len(b) <= most_pairs:
        first = second = 0.0
        for rows in chunks(len(b), len(a)):
            d = difference(b[rows], a)
            first += n_b[rows] @ (d @ n_a)
            second += n_b[rows] @ (d * d @ n_a)
        total = float(n_a.sum()) * float(n_b.sum())
        return first / total, max(0.0, second / total - (first / total) ** 2), 0.0
    random = np.random.default_rng(3)
    take = lambda colors, n: colors[random.choice(len(colors), N_OWN_PAIRS, p=n / n.sum())]
    a, b = take(a, n_a), take(b, n_b)
    d = np.concatenate([difference_of_rows(a[s], b[s], difference) for s in chunks(len(a), 40)])
    return d.mean(), d.var(), d.std() / np.sqrt(len(d))


def difference_of_rows(a, b, difference):
    """The difference of a_i and b_i."""
    return np.linalg.norm(a - b, axis=1) if difference is rgb_difference else ciede2000(lab_from_srgb(a), lab_from_srgb(b))


def of_both_directions(drawn, e2r, r2e, difference, most_pairs):
    """Half of the mean over the pairs of each direction; the reference color is the nearest one of e2r and the own one of r2e."""
    if not len(e2r.at) or not len(r2e.at):
        return {"value": None}
    parts = [drawn_difference(drawn, there, difference, most_pairs) for there in (e2r.nearest, r2e.own)]
    sample = [variance / min(N_POINTS, len(pairs.at)) for (_, variance, _), pairs in zip(parts, (e2r, r2e))]
    return {"value": float(parts[0][0] + parts[1][0]) / 2, "se_value": float(np.hypot(parts[0][2], parts[1][2])) / 2,
            "se": float(np.sqrt(sum(sample))) / 2}


def color_distance(est_color, e2r, r2e, max_distance):
    """CD over the pairs that CD takes."""
    gate = np.inf if max_distance is None else max_distance
    return of_both_directions(est_color, within(e2r, -1, gate), within(r2e, -1, gate), rgb_difference, 3e9)


def delta_e(est_color, e2r, r2e, radius):
    """Mean CIEDE2000 over the pairs within the radius."""
    return of_both_directions(est_color, within(e2r, -1, radius), within(r2e, -1, radius), delta_e_difference, 2e7)


def counts_within(offsets, targets, radius):
    """How many targets lie within the radius of each point."""
    count = np.zeros(len(offsets), int)
    for first, i, _ in pairs_within(offsets, targets, radius, rounded=True):
        count += np.bincount(first + i, minlength=len(offsets))
    return count


def shares_near(colors, drawn, taus):
    """q: for every color the share of the drawn colors within 3 tau, a column for each tau."""
    different, which = np.unique(colors, axis=0, return_inverse=True)
    values, n = counted(drawn)
    share = np.empty((len(different), len(taus)))
    for rows in chunks(len(different), len(values)):
        d = cdist(different[rows], values)
        for k, tau in enumerate(taus):
            share[rows, k] = (d <= 3 * tau + 1e-12) @ n / n.sum()
    return share[which.ravel()]


def local_color_recall(ref, ref_color, est, est_color, radius, taus):
    """A record for each tau: mean over the colored reference points of 1 - (1 - q)^n, n the colored estimated points within the radius, which
    are offsets here. The oracle takes all reference points, or many of them."""
    colored = np.flatnonzero(is_colored(ref_color))
    own = colored if len(colored) <= 1.5 * N_OWN_REFERENCE else np.sort(np.random.default_rng(4).choice(colored, N_OWN_REFERENCE, False))
    n = counts_within(ref[own], est[is_colored(est_color)], radius)
    p = 1 - (1 - shares_near(ref_color[own], est_color, taus)) ** n[:, None]
    error = lambda k, sample: float(p[:, k].std() * np.sqrt(max(0, 1 / sample - 1 / len(colored)))) if sample < len(colored) else 0.0
    return [{"value": float(p[:, k].mean()), "se_value": error(k, len(own)), "se": error(k, N_REFERENCE)} for k in range(len(taus))]


def recall_and_curve(ref, ref_color, est, est_color, radius, tau, curve):
    """Chance of LCR at tau; and with curve of each of its taus."""
    taus = [tau] + (CURVE_TAUS if curve else [])
    records = local_color_recall(ref, ref_color, est, est_color, radius, taus)
    return records[0], records[1:]


def color_wasserstein(est, est_color, ref, ref_color, voxel_m, min_points):
    """CW where the colors of the estimate are drawn: mean over many draws; a program takes the mean of N_DRAWS."""
    colored = is_colored(est_color)
    est, est_color, grid = est[colored], est_color[colored], Grid(voxel_m)
    of_reference, random = colors_by_voxel(ref, ref_color, grid, min_points), np.random.default_rng(5)
    drawn = lambda: colors_by_voxel(est, est_color[random.integers(0, len(est), len(est))], grid, min_points)
    if not mean_distance(drawn(), of_reference)[1]:
        return {"value": None}
    values = np.array([mean_distance(drawn(), of_reference)[0] for _ in range(N_OWN_DRAWS)])
    spread = float(values.std(ddof=1))
    return {"value": float(values.mean()), "se_value": spread / np.sqrt(N_OWN_DRAWS), "se": spread / np.sqrt(N_DRAWS)}


def color_consistency(est_color):
    """CCS: trace of the covariance (n-1) of the estimate's colors; null of fewer than two."""
    colors = est_color[is_colored(est_color)]
    return {"value": float(np.trace(np.atleast_2d(np.cov(colors.T)))) if len(colors) > 1 else None}

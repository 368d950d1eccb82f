#!/usr/bin/env python3
"""Hold the oracle, and every expected.json, to values derived by hand (data_samples/README.md gives the derivations).

Also checks CIEDE2000 against Sharma's 34 pairs and the nearest neighbors against brute force. Exit code 1 when anything is off.
"""
import json
import sys
from math import e, log, log10, pi, sqrt
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from ciede2000 import ciede2000  # noqa: E402
from neighbors import nearest, nearest_other, squared_distance  # noqa: E402
from oracle import evaluate  # noqa: E402

SAMPLES = HERE.parents[1] / "data_samples"
WIDE = sqrt(24 / 7) / 4  # sqrt(3) (1/2 - 1/4) sqrt(8/7): corners of two cubes about one center
BOTH = (0.75 + WIDE) / 2  # the mean of the two
GEOMETRY_OF_TWO_POINTS = {
    "chamfer.value": 1.625 + 8.25 / 3,
    "chamfer.variants.l1_mean": (1.625 + 8.25 / 3) / 2,
    "chamfer.variants.l2sq_sum": 9.0625 / 2 + 34.0625 / 3,
    "chamfer.variants.l2_rms_mean": (sqrt(9.0625 / 2) + sqrt(34.0625 / 3)) / 2,
    "chamfer.variants.truncated_l1_sum": 1.25 / 2 + 2.25 / 3,
    "accuracy.per_threshold.0.value": sqrt(9.0625 / 2),
    "accuracy.per_threshold.0.median": 1.625,
    "accuracy.per_threshold.1.value": 0.25,
    "accuracy.per_threshold.2.value": None,
    "fitness.per_threshold.0.value": 1,
    "fitness.per_threshold.1.value": 1 / 2,
    "completeness.per_threshold.0.value": 2 / 3,
    "completeness.per_threshold.1.value": 1 / 3,
    "f_score.per_threshold.0.value": 0.8,
    "f_score.per_threshold.1.value": 0.4,
    "f_score.per_threshold.2.value": 0,
    "overlap.value": 1 / 2,
    "hausdorff.value": 5,
    "hausdorff.estimate_to_reference.p95": 0.25 + 0.95 * 2.75,
    "rmse.value": sqrt(9.0625 / 2),
    "rmse.inlier_rmse": 0.25,
    "average_wasserstein.value": None,
}
HAND = {
    "identical": {
        "chamfer.value": 0, "hausdorff.value": 0, "rmse.value": 0, "overlap.value": 1, "accuracy.per_threshold.1.value": 0,
        "fitness.per_threshold.1.value": 1, "completeness.per_threshold.1.value": 1, "f_score.per_threshold.1.value": 1,
        "average_wasserstein.value": 0, "average_wasserstein.n_voxels": 2, "spatial_consistency.value": None,
        "color_distance.value": 0, "color_fidelity.value": None, "local_color_recall.value": 1, "delta_e.value": 0,
        "color_psnr.value": None, "color_distance_exposure_free.value": 0,
    },
    "color_shift": {
        "chamfer.value": 0, "color_distance.value": 0.2 * sqrt(3), "color_distance.value_8bit": 51 * sqrt(3),
        "color_fidelity.value": -20 * log10(0.2 * sqrt(3)), "local_color_recall.value": 0, "local_color_recall.coverage": 1,
        "local_color_recall.curve.value.4": 0, "local_color_recall.curve.value.5": 1, "local_color_recall.curve.area": 19 / 28,
        "color_consistency.value": 0, "color_consistency.n_voxels": 2, "color_psnr.y": 20 * log10(5), "color_psnr.cb": None,
        "color_distance_exposure_free.gains.0": 1 / 2, "color_distance_exposure_free.gains.1": 2 / 3,
        "color_distance_exposure_free.gains.2": 3 / 4, "color_distance_exposure_free.value": 0,
        "color_distance_by_range.per_range.0.value": 0.2 * sqrt(3), "color_distance_by_range.per_range.1.value": None,
    },
    "black_white_voxel": {
        "color_consistency.value": 1 / 2, "color_consistency.value_x100": 50, "color_consistency.n_voxels": 2,
        "color_consistency.zero": 1 / 2, "color_consistency.exclude": 1, "color_consistency.median": 1,
        "color_consistency.n_occupied": 2, "color_consistency.n_singletons": 1, "color_consistency.reference.value": 0.9,
        "color_distance.estimate_to_reference": 40 / 255, "color_distance.reference_to_estimate": sqrt(3) / 3,
    },
    "two_points": {
        **GEOMETRY_OF_TWO_POINTS,
        "color_distance.estimate_to_reference": 0.1, "color_distance.reference_to_estimate": (0.2 + sqrt(1.64)) / 3,
        "color_distance.value": 0.05 + (0.2 + sqrt(1.64)) / 6, "local_color_recall.value": 1 / 3,
        "local_color_recall.coverage": 1 / 3, "local_color_recall.conditional": 1, "delta_e.value": 0,
        "color_distance_by_range.per_range.3.value": 0, "color_distance_by_range.per_range.2.value": None,
    },
    "no_color": {**GEOMETRY_OF_TWO_POINTS, "color_distance": None, "color_psnr": None},
    "no_overlap": {
        "chamfer.value": 256, "chamfer.variants.truncated_l1_sum": 2, "overlap.value": 0, "fitness.per_threshold.0.value": 0,
        "f_score.per_threshold.0.value": 0, "accuracy.per_threshold.0.value": None, "rmse.inlier_rmse": None,
        "average_wasserstein.value": None, "color_distance.value": sqrt(2), "local_color_recall.value": 0,
        "local_color_recall.conditional": None, "delta_e.value": None, "color_distance_exposure_free.value": None,
    },
    "ties": {
        "chamfer.value": 1, "color_distance.estimate_to_reference": 0, "color_distance.reference_to_estimate": 2 * sqrt(2) / 3,
        "color_distance.value": sqrt(2) / 3, "local_color_recall.value": 2 / 3, "local_color_recall.coverage": 1,
        "fitness.per_threshold.0.value": 1, "fitness.per_threshold.1.value": 1 / 3, "accuracy.per_threshold.1.value": 0,
    },
    "ties_grid": {
        "chamfer.value": 2 * sqrt(3), "color_distance.estimate_to_reference": 52 / 255,
        "color_distance.reference_to_estimate": 104 / 255, "color_distance.value": 78 / 255, "local_color_recall.value": 10 / 27,
        "local_color_recall.coverage": 1, "fitness.per_threshold.0.value": 1, "fitness.per_threshold.1.value": 0,
        "chamfer.floor.value": 4, "color_distance.floor.value": (18 * 72 + 6 * 24 + 3 * 8) / 27 / 255,
        "accuracy.per_threshold.0.floor.value": 2, "accuracy.per_threshold.1.floor.value": None,
        "fitness.per_threshold.0.floor.value": 1, "f_score.per_threshold.1.floor.value": 0,
    },
    "one_point": {
        "chamfer.value": 1, "fitness.per_threshold.0.value": 1, "fitness.per_threshold.1.value": 0,
        "color_distance.value": sqrt(3), "color_fidelity.value": -10 * log10(3), "color_psnr.value": -20 * log10(0.5748),
        "local_color_recall.value": 0, "local_color_recall.coverage": 1, "color_consistency.value": 0,
        "color_consistency.exclude": None, "color_consistency.median": None, "color_consistency.n_singletons": 1,
        "color_distance_exposure_free.value": None, "average_wasserstein.value": None, "spatial_consistency.value": None,
        "mean_map_entropy.value": None, "mean_map_entropy.n_left_out": 1, "mean_map_entropy.n_flat": 0,
        "point_spacing.value": None, "point_spacing.n": 1, "point_spacing.n_copies": 0,
    },
    "authors_example": {
        "color_distance.value": sqrt(1.36) / 10, "color_fidelity.value": -20 * log10(sqrt(1.36) / 10),
        "local_color_recall.value": 0.8, "local_color_recall.coverage": 0.8, "color_consistency.value": 0.02,
        "color_consistency.exclude": 0.02, "color_consistency.n_voxels": 2, "color_consistency.n_singletons": 0,
        "color_consistency.reference.value": 0.04 / 3, "color_consistency.reference.n_singletons": 1,
    },
    "lone_point": {
        "color_consistency.value": 0.02, "color_consistency.zero": 0.04 / 3, "color_consistency.exclude": 0.02,
        "color_consistency.n_voxels": 2, "color_consistency.n_occupied": 3, "color_consistency.n_singletons": 1,
        "local_color_recall.value": 1,
    },
    "voxel_centers": {
        "fitness.per_threshold.1.value": 3 / 4, "completeness.per_threshold.1.n": 3, "f_score.per_threshold.1.value": 3 / 4,
        "fitness.per_threshold.0.value": 1, "fitness.per_threshold.2.value": 0, "accuracy.per_threshold.1.n": 3,
        "overlap.value": 3 / 4, "local_color_recall.coverage": 3 / 4, "local_color_recall.value": 3 / 4,
        "color_distance.n_estimate": 3, "color_distance.n_unmatched_reference": 1,
        "color_distance_by_range.per_range.1.n_estimate": 3, "color_distance_by_range.per_range.2.n_estimate": 1,
    },
    "tilted_plane": {
        "mean_map_entropy.value": None, "mean_map_entropy.n": 0, "mean_map_entropy.n_left_out": 0, "mean_map_entropy.n_flat": 49,
        "mean_map_entropy.reference.value": None, "mean_map_entropy.reference.n_flat": 49,
    },
    "missing_colors": {
        "chamfer.value": 0.25 + (0.5 + sqrt(1.0625)) / 3, "color_distance.value": 0.25, "color_distance.n_estimate": 1,
        "color_distance.n_reference": 1, "color_distance.n_unmatched_estimate": 1, "color_distance.n_unmatched_reference": 2,
        "color_distance.n_without_color_estimate": 1, "color_distance.n_without_color_reference": 1,
        "color_fidelity.value": -20 * log10(0.25), "local_color_recall.value": 1 / 2, "local_color_recall.coverage": 1,
        "local_color_recall.n_reference": 2, "color_consistency.value": 0, "color_consistency.n_occupied": 1,
        "color_consistency.n_without_color": 1, "color_consistency.reference.n_occupied": 2, "delta_e.estimate_to_reference.n": 1,
        "color_psnr.y": -20 * log10(0.2126 / 4), "color_distance_exposure_free.n_pairs": 1,
    },
    "gaussian_voxels": {
        "average_wasserstein.value": (0.75 + WIDE) / 3, "average_wasserstein.median": WIDE, "average_wasserstein.n_voxels": 3,
        "average_wasserstein.cumulative.0.value_m": 0, "average_wasserstein.cumulative.5.value_m": WIDE / 2,
        "average_wasserstein.cumulative.20.value_m": 0.75, "spatial_consistency.n_voxels": 3,
        "spatial_consistency.value": (1 + 1 + (0.75 - BOTH) / BOTH) / 3,
    },
    "gaussian_rotated": {"average_wasserstein.value": sqrt(2 / 3 * (2.5 - 2 * sqrt(1.15625))), "spatial_consistency.value": None},
    "entropy": {
        "mean_map_entropy.value": 1.5 * log(2 * pi * e) + 0.5 * log(0.064), "mean_map_entropy.n": 1,
        "mean_map_entropy.n_left_out": 6, "mean_map_entropy.reference.value": None, "mean_map_entropy.reference.n_left_out": 7,
        "mean_map_entropy.n_flat": 0, "point_spacing.value": 1, "point_spacing.mean": 1, "point_spacing.n": 7,
    },
    "grid_border": {
        "average_wasserstein.value": 0.25, "average_wasserstein.phases.n": 8, "average_wasserstein.phases.values.0": 0.25,
        "average_wasserstein.phases.values.1": 0.375, "average_wasserstein.phases.values.6": 0.25,
        "average_wasserstein.phases.mean": 0.3125, "average_wasserstein.phases.std": 0.0625, "average_wasserstein.floor.value": None,
        "spatial_consistency.value": None, "spatial_consistency.phases.n": 4, "spatial_consistency.phases.values.0": None,
        "spatial_consistency.phases.values.1": 0, "spatial_consistency.phases.mean": 0,
        "color_wasserstein.value": 0.2 * sqrt(3), "color_wasserstein.n_voxels": 1, "color_wasserstein.share_estimate": 1 / 2,
        "color_wasserstein.phases.values.7": 0.3 * sqrt(3), "color_wasserstein.phases.mean": 0.25 * sqrt(3),
        "color_wasserstein.phases.std": 0.05 * sqrt(3), "color_wasserstein.phases.max": 0.3 * sqrt(3),
        "sampled.color_wasserstein.chance.value": 0.2 * sqrt(3), "color_consistency.phases.n": 8, "chamfer.floor.value": 2,
        "fitness.per_threshold.0.floor.value": 0, "color_distance.floor.value": 0, "color_fidelity.floor.value": None,
        "color_distance.value": 0.3 * sqrt(3), "sampled.color_distance.chance.value": 0.3 * sqrt(3), "delta_e.floor.value": None,
    },
    "two_colors": {
        "color_distance.value": sqrt(3) / 2, "color_distance.floor.value": sqrt(3) / 2,
        "sampled.color_distance.chance.value": 3 * sqrt(3) / 8, "color_fidelity.floor.value": -20 * log10(sqrt(3) / 2),
        "sampled.color_fidelity.chance.value": -20 * log10(3 * sqrt(3) / 8), "delta_e.value": 50, "delta_e.floor.value": 50,
        "sampled.delta_e.chance.value": 37.5, "local_color_recall.value": 1, "local_color_recall.floor.value": 3 / 4,
        "sampled.local_color_recall.chance.value": 107 / 128, "sampled.local_color_recall.curve.0.value": 107 / 128,
        "color_consistency.chance.value": 3 / 4, "color_consistency.floor.value": None, "chamfer.floor.value": 2,
        "accuracy.per_threshold.0.floor.value": 1, "accuracy.per_threshold.1.floor.value": None, "color_wasserstein.value": None,
        "color_wasserstein.phases.n": 0, "fitness.per_threshold.0.floor.value": 1, "completeness.per_threshold.1.floor.value": 0,
    },
    "color_gaussians": {
        "color_wasserstein.value": (sqrt(0.45 / 7) + 0.2 * sqrt(3)) / 2, "color_wasserstein.n_voxels": 2,
        "color_wasserstein.share_reference": 1, "color_wasserstein.phases.n": 8, "color_wasserstein.phases.std": 0,
        "color_wasserstein.phases.min": (sqrt(0.45 / 7) + 0.2 * sqrt(3)) / 2, "color_wasserstein.floor.value": None,
        "chamfer.floor.value": 0.5, "color_distance.floor.value": 0.4, "local_color_recall.floor.value": 0,
        "color_consistency.chance.value": 0.152, "accuracy.per_threshold.0.floor.value": 0.25,
        "f_score.per_threshold.0.floor.value": 1,
    },
    "color_gate": {
        "color_distance.value": 0.2, "color_distance.n_estimate": 1, "color_distance.n_unmatched_estimate": 1,
        "color_distance.n_unmatched_reference": 1, "color_fidelity.value": -20 * log10(0.2),
    },
}


def look_up(metrics, path):
    """metrics["a"]["b"][0] for "a.b.0"."""
    for key in path.split("."):
        metrics = metrics[int(key)] if isinstance(metrics, list) else metrics[key]
    return metrics


def differs(got, wanted):
    """Equal to 1e-12, or both null."""
    return got is not None if wanted is None else got is None or abs(got - wanted) > 1e-12 * max(1.0, abs(wanted))


def check_pair(name):
    """Messages of the values of one micro pair that differ from the hand's, from the oracle and from expected.json."""
    folder = SAMPLES / "micro" / name
    expected = json.loads((folder / "expected.json").read_text())
    fresh = evaluate(folder / "reference.ply", folder / "estimate.ply", expected["options"])
    numbers = lambda found: {**found["metrics"], "sampled": found["sampled"]}
    return ["%s: %s: %s is %r, by hand %r" % (name, source, path, look_up(metrics, path), wanted)
            for path, wanted in HAND[name].items()
            for source, metrics in (("oracle", numbers(fresh)), ("expected.json", numbers(expected)))
            if differs(look_up(metrics, path), wanted)]


def check_sharma():
    """CIEDE2000 agrees with the 34 published pairs to their four decimals, both ways round."""
    table = np.loadtxt(HERE / "sharma2005.txt")
    a, b, wanted = table[:, :3], table[:, 3:6], table[:, 6]
    errors = np.maximum(abs(ciede2000(a, b) - wanted), abs(ciede2000(b, a) - wanted))
    return ["CIEDE2000 pair %d is off by %g" % (k + 1, errors[k]) for k in np.flatnonzero(errors > 5.1e-5)]


def check_nearest():
    """Nearest neighbors, and nearest other ones, equal brute force (argmin takes the lowest index) on a lattice full of ties and duplicates."""
    rng = np.random.default_rng(5)
    points, targets = rng.integers(0, 9, (300, 3)) / 4, rng.integers(0, 5, (400, 3)) / 2
    brute = np.argmin(squared_distance(points[:, None], targets[None]), axis=1)
    others = squared_distance(points[:, None], points[None])
    np.fill_diagonal(others, np.inf)
    problems = [] if np.array_equal(nearest(points, targets)[0], brute) else ["nearest differs from brute force"]
    return problems if np.array_equal(nearest_other(points)[0], np.argmin(others, axis=1)) else problems + ["nearest_other differs"]


def main():
    np.seterr(divide="raise", invalid="raise")
    micro = sorted(p.name for p in (SAMPLES / "micro").iterdir())
    problems = [] if micro == sorted(HAND) else ["micro pairs %s, hand values %s" % (micro, sorted(HAND))]
    for name in HAND:
        problems += check_pair(name)
    problems += check_sharma() + check_nearest()
    print("\n".join(problems) or "%d hand values hold" % sum(map(len, HAND.values())))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Reference implementation of every metric of cmap, written apart from the library: numpy and scipy, in double.

usage: oracle.py REF.ply EST.ply [--options file.json]     prints {"options": {...}, "metrics": {id: record}, "sampled": {...}}
"""
import argparse
import json
import os
import sys

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import color  # noqa: E402
import color_wasserstein  # noqa: E402
import geometry  # noqa: E402
import levels  # noqa: E402
import structure  # noqa: E402
from neighbors import common_origin, nearest, thresholded  # noqa: E402
from ply import read_ply  # noqa: E402

DEFAULTS = {
    "thresholds": [0.2, 0.1, 0.08, 0.05, 0.01],
    "overlap-distance": 1.0,
    "lcr-tau": 0.1,
    "lcr-radius": 0.5,
    "lcr-curve": False,
    "ccs-voxel": 0.1,
    "ccs-singletons": "zero",
    "ccs-min-points": 2,
    "ccs-phases": False,
    "cw-voxel": 1.0,
    "cw-min-points": 10,
    "awd-voxel": 3.0,
    "awd-min-points": 100,
    "scs-radius": 5,
    "mme-radius": 0.1,
    "mme-min-neighbors": 10,
    "color-max-distance": None,
    "grid-phases": 8,
}
COLOR_METRICS = ["color_distance", "color_fidelity", "local_color_recall", "color_consistency", "color_wasserstein", "delta_e",
                 "color_distance_by_range", "median_color_distance", "color_distance_exposure_free", "color_psnr"]


def with_defaults(given):
    """The options after defaults; an unknown name is an error."""
    unknown = sorted(set(given) - set(DEFAULTS))
    if unknown:
        raise ValueError("unknown option %s" % ", ".join(unknown))
    return {**DEFAULTS, **given}


def geometry_metrics(e2r, r2e, e2r_at, r2e_at, o):
    """Everything that reads the two distance fields, and the thresholds that these count as at."""
    return {
        "chamfer": geometry.chamfer(e2r, r2e, o["overlap-distance"]),
        "accuracy": geometry.accuracy(e2r, e2r_at, o["thresholds"]),
        "fitness": geometry.share_within(e2r_at, o["thresholds"]),
        "completeness": geometry.share_within(r2e_at, o["thresholds"]),
        "f_score": geometry.f_score(e2r_at, r2e_at, o["thresholds"]),
        "overlap": geometry.overlap(e2r_at, o["overlap-distance"]),
        "hausdorff": geometry.hausdorff(e2r, r2e),
        "rmse": geometry.rmse(e2r, e2r_at, o["overlap-distance"]),
    }


def structure_metrics(ref, est, origin, o):
    """Everything that reads local Gaussians."""
    return {
        **structure.voxel_metrics(est, ref, o["awd-voxel"], o["awd-min-points"], o["scs-radius"], o["grid-phases"]),
        "mean_map_entropy": structure.mean_map_entropy(est - origin, ref - origin, o["mme-radius"], o["mme-min-neighbors"]),
        "point_spacing": structure.point_spacing(est, ref),
    }


def color_metrics(ref, ref_color, est, est_color, e2r, r2e, origin, o):
    """Everything that reads colors; e2r and r2e are color.Direction."""
    cd = color.color_distance(e2r, r2e, o["color-max-distance"])
    best = color.nearest_colors_within(ref - origin, ref_color, est - origin, est_color, o["lcr-radius"])
    recall = color.local_color_recall(best, o["lcr-tau"], o["lcr-curve"])
    return {
        "color_distance": cd,
        "color_fidelity": color.color_fidelity(cd["value"]),
        "local_color_recall": {**recall, **color.without_color(est_color, ref_color)},
        "color_consistency": color.color_consistency(est, est_color, ref, ref_color, o["ccs-voxel"], o["ccs-singletons"],
                                                     o["ccs-min-points"], o["grid-phases"] if o["ccs-phases"] else 1),
        "color_wasserstein": color_wasserstein.color_wasserstein(est, est_color, ref, ref_color, o["cw-voxel"], o["cw-min-points"],
                                                                 o["grid-phases"]),
        "delta_e": color.delta_e(e2r, r2e, o["lcr-radius"]),
        "color_distance_by_range": color.color_distance_by_range(e2r, r2e),
        "median_color_distance": color.median_color_distance(e2r, r2e),
        "color_distance_exposure_free": color.color_distance_exposure_free(e2r, r2e, o["lcr-radius"], o["color-max-distance"]),
        "color_psnr": color.color_psnr(e2r, r2e),
    }


def evaluate(ref_path, est_path, given):
    """All metrics of one pair of files with the given options; color metrics are null unless both clouds have color."""
    o = with_defaults(given)
    (ref, ref_color), (est, est_color) = read_ply(ref_path), read_ply(est_path)
    index_er, e2r = nearest(est, ref)
    index_re, r2e = nearest(ref, est)
    origin = common_origin(ref, est)
    e2r_at = thresholded(e2r, est - origin, ref[index_er] - origin)
    r2e_at = thresholded(r2e, ref - origin, est[index_re] - origin)
    er = re = None
    if ref_color is None or est_color is None:
        metrics = dict.fromkeys(COLOR_METRICS)
    else:
        er = color.Direction(e2r_at, est_color, ref_color[index_er])
        re = color.Direction(r2e_at, ref_color, est_color[index_re])
        metrics = color_metrics(ref, ref_color, est, est_color, er, re, origin, o)
    metrics.update(geometry_metrics(e2r, r2e, e2r_at, r2e_at, o))
    metrics.update(structure_metrics(ref, est, origin, o))
    sampled = levels.add_levels(metrics, (ref, ref_color, est, est_color), er, re, origin, o)
    return {"options": o, "metrics": metrics, "sampled": sampled}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("reference")
    parser.add_argument("estimate")
    parser.add_argument("--options", help="JSON file of options, by the names of cmap_eval's command line")
    args = parser.parse_args()
    given = json.load(open(args.options)) if args.options else {}
    np.seterr(divide="raise", invalid="raise")
    json.dump(evaluate(args.reference, args.estimate, given), sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()

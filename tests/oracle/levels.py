"""Levels of a pair of maps: floor and chance in the metrics' records where every program's must equal them, else beside these, as values with
the errors of the sample that a program takes; and skill = (chance - value) / (chance - floor).

`sampled` is {metric: {"floor" | "chance": {value, se_value, se}}}: a program's number lies within 5 errors sqrt(se^2 + se_value^2).
"""
import numpy as np

import chances
import floors



def add_pair_floors(metrics, pairs, o):
    """Floors of the metrics that read distances."""
    metrics["chamfer"]["floor"] = floors.chamfer(pairs)
    shares = floors.share_within(pairs, o["thresholds"])
    of_each = {"accuracy": floors.accuracy(pairs, o["thresholds"]), "fitness": shares, "completeness": shares, "f_score": shares}
    for name, entries in of_each.items():
        for record, floor in zip(metrics[name]["per_threshold"], entries):
            record["floor"] = floor


def fidelity(level):
    """CF's level of CD's; null where CD's is 0 or null."""
    if not level["value"]:
        return {"value": None}
    slope = 20 / np.log(10) / level["value"]
    errors = {k: slope * level[k] for k in ("se", "se_value") if k in level}
    return {"value": float(-20 * np.log10(level["value"])), **errors}


def add_color_floors(metrics, pairs, ref, ref_color, origin, o):
    """Floors of the color metrics that are the same in every program."""
    metrics["color_distance"]["floor"] = floors.color_distance(pairs, o["color-max-distance"])
    metrics["color_fidelity"]["floor"] = fidelity({"value": metrics["color_distance"]["floor"]["value"]})
    metrics["delta_e"]["floor"] = floors.delta_e(pairs, o["lcr-radius"])
    reference = metrics["color_consistency"]["reference"]
    metrics["color_consistency"]["floor"] = {"value": reference["exclude"]}
    if len(ref) > 1:
        metrics["local_color_recall"]["floor"] = floors.local_color_recall(ref - origin, ref_color, o["lcr-radius"], o["lcr-tau"])


def add_half_floors(metrics, sampled, ref, ref_color, o):
    """Floors between halves: null where no half has enough voxels, else in `sampled`."""
    found = {"average_wasserstein": floors.average_wasserstein(ref, o["awd-voxel"], o["awd-min-points"])}
    if ref_color is not None:
        found["color_wasserstein"] = floors.color_wasserstein(ref, ref_color, o["cw-voxel"], o["cw-min-points"])
    for name, floor in found.items():
        if floor["value"] is None:
            metrics[name]["floor"] = {"value": None}
        elif floor["n_min"] >= floors.LEAST_VOXELS + 5:  # in between one half has a floor and another has none
            sampled.setdefault(name, {})["floor"] = floor


def add_chances(metrics, sampled, maps, e2r, r2e, origin, o):
    """Chances: those of a program that takes all reference points into LCR's record, the others into `sampled`."""
    ref, ref_color, est, est_color = maps
    found = {"color_distance": chances.color_distance(est_color, e2r, r2e, o["color-max-distance"]),
             "delta_e": chances.delta_e(est_color, e2r, r2e, o["lcr-radius"]),
             "color_wasserstein": chances.color_wasserstein(est, est_color, ref, ref_color, o["cw-voxel"], o["cw-min-points"])}
    found["color_fidelity"] = fidelity(found["color_distance"])
    found["local_color_recall"], curve = chances.recall_and_curve(ref - origin, ref_color, est - origin, est_color, o["lcr-radius"],
                                                                  o["lcr-tau"], o["lcr-curve"])
    for name, chance in found.items():
        if chance["value"] is not None:
            sampled.setdefault(name, {})["chance"] = chance
    if curve:
        sampled["local_color_recall"]["curve"] = curve
    metrics["color_consistency"]["chance"] = chances.color_consistency(est_color)


def skill(value, floor, chance, higher):
    """(chance - value) / (chance - floor); null unless the floor is better than chance by more than two combined errors, and without value or
    floor."""
    if value is None or floor["value"] is None or chance["value"] is None:
        return None
    gain = (floor["value"] - chance["value"]) * (1 if higher else -1)
    errors = np.hypot(floor.get("se") or 0.0, chance.get("se") or 0.0)
    return float((chance["value"] - value) / (chance["value"] - floor["value"])) if gain > 2 * errors else None


def add_levels(metrics, maps, e2r, r2e, origin, o):
    """Puts floors and chances into `metrics` and returns `sampled`; e2r and r2e are color.Direction, or None without colors."""
    ref, ref_color, _, est_color = maps
    both_colored = ref_color is not None and est_color is not None
    pairs, sampled = floors.SelfPairs(ref, ref_color, origin), {}
    add_pair_floors(metrics, pairs, o)
    add_half_floors(metrics, sampled, ref, ref_color if both_colored else None, o)
    if both_colored:
        add_color_floors(metrics, pairs, ref, ref_color, origin, o)
        add_chances(metrics, sampled, maps, e2r, r2e, origin, o)
    return sampled

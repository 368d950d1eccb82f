#!/usr/bin/env python3
"""Levels, skill and phases of cmap_eval (METRICS, "Levels") against the oracle's and against values from outside.

usage: levels_test.py [CMAP_EVAL]     CTest sets CMAP_EVAL and CMAP_SOURCE_DIR; CMAP_SHARED_DIR holds data/ and golden/

What is the same in every program (phases, floors of all points) stands in the metrics of expected.json, which the conformance test reads;
here are the levels that come from a sample.
"""
import json
import os
import subprocess
import sys
import tempfile
import unittest
from math import hypot, isfinite, sqrt
from pathlib import Path

SOURCE = Path(os.environ.get("CMAP_SOURCE_DIR", Path(__file__).resolve().parents[2]))
SHARED = Path(os.environ.get("CMAP_SHARED_DIR", SOURCE / "../shared"))
SAMPLES = SOURCE / "data_samples"
TIMEOUT_S = 3600 if "-fsanitize" in os.environ.get("CMAP_CXX_FLAGS", "") else 600

sys.path.insert(0, str(SOURCE / "tests/oracle"))
try:
    import numpy as np

    import chances
    import color
    import color_wasserstein
    import floors
    import levels
    import structure
    from neighbors import common_origin
    from ply import read_ply
except ImportError:
    np = None

ROUNDING = 1e-9
SKILLED = ("color_distance", "color_fidelity", "local_color_recall", "color_wasserstein", "delta_e")
HIGHER = ("color_fidelity", "local_color_recall")


def evaluate(reference, estimate, options):
    """The report's metrics of one run; options by the names of the command line."""
    program = os.environ["CMAP_EVAL"]
    with tempfile.TemporaryDirectory(prefix="cmap-levels-") as folder:
        config, report = Path(folder) / "options.json", Path(folder) / "report.json"
        config.write_text(json.dumps(options))
        subprocess.run([program, reference, estimate, "--config", config, "--quiet", "-o", report], check=True, timeout=TIMEOUT_S)
        return json.loads(report.read_text())["metrics"]


def samples():
    """(name, folder, content of expected.json) of every sample."""
    for path in sorted(SAMPLES.rglob("expected.json")):
        yield str(path.parent.relative_to(SAMPLES)), path.parent, json.loads(path.read_text())


def evaluate_samples():
    """{name: (folder, expected, the program's metrics)}, once for all tests."""
    if not evaluate_samples.found:
        for name, folder, expected in samples():
            found = evaluate(folder / "reference.ply", folder / "estimate.ply", {"metrics": ["all"], **expected["options"]})
            evaluate_samples.found[name] = folder, expected, found
    return evaluate_samples.found


evaluate_samples.found = {}


class Levels(unittest.TestCase):
    def near(self, found, wanted, allowed, what):
        self.assertIsInstance(found, (int, float), what)
        self.assertTrue(isfinite(found), what)
        rounding = ROUNDING * max(1e-3, abs(wanted))
        self.assertLessEqual(abs(found - wanted), allowed + rounding, f"{what}: expected {wanted}, found {found}")

    def relative(self, found, wanted, tolerance, what):
        self.near(found, wanted, tolerance * abs(wanted), what)


@unittest.skipIf(np is None, "no numpy or scipy (apt-get install python3-numpy python3-scipy)")
class Samples(Levels):
    """Every map of data_samples/."""

    def check_level(self, found, wanted, what):
        """Within five errors of such a sample, and of the error that the program claims: it must not claim too little."""
        value, oracle_error = wanted["value"], wanted["se_value"]
        self.near(found["value"], value, 5 * hypot(wanted["se"], oracle_error), what)
        if not what.endswith("color_wasserstein/chance"):  # the error of five draws is itself hardly known
            self.near(found["value"], value, 5 * hypot(found["se"] or 0, oracle_error), f"{what} by its own error {found['se']}")

    def test_sampled_levels(self):
        for name, (_, expected, found) in evaluate_samples().items():
            for metric, wanted in expected["sampled"].items():
                for level in sorted(set(wanted) & {"floor", "chance"}):
                    with self.subTest(f"{name}/{metric}/{level}"):
                        self.check_level(found[metric][level], wanted[level], f"{name}/{metric}/{level}")

    def test_chance_curve_of_local_color_recall(self):
        n_curves = 0
        for name, (_, expected, found) in evaluate_samples().items():
            curve = expected["sampled"].get("local_color_recall", {}).get("curve")
            if curve is None:
                continue
            n_curves += 1
            with self.subTest(name):
                chance = found["local_color_recall"]["curve"]["chance"]
                self.assertEqual(len(chance), len(curve))
                for number, wanted in zip(chance, curve):
                    self.near(number, wanted["value"], 5 * hypot(wanted["se"], wanted["se_value"]), f"{name}, curve")
        self.assertGreater(n_curves, 2)

    def test_number_of_voxels_between_halves(self):
        for name, (_, expected, found) in evaluate_samples().items():
            for metric, wanted in expected["sampled"].items():
                if "n_max" in wanted.get("floor", {}):
                    margin = 0.1 * wanted["floor"]["n_max"]
                    self.assertGreaterEqual(found[metric]["floor"]["n"], wanted["floor"]["n_min"] - margin, f"{name}/{metric}")
                    self.assertLessEqual(found[metric]["floor"]["n"], wanted["floor"]["n_max"] + margin, f"{name}/{metric}")

    def test_missing_floor_has_its_reason(self):
        for name, (_, expected, found) in evaluate_samples().items():
            for metric, wanted in expected["metrics"].items():
                if wanted is not None and wanted.get("floor", {}).get("value", 0) is None:
                    with self.subTest(f"{name}/{metric}"):
                        self.assertIsNone(found[metric]["floor"]["value"])
                        self.assertTrue(found[metric]["floor"]["reason"])

    def test_skill_follows_from_value_floor_and_chance(self):
        n_skills = 0
        for name, (_, _, found) in evaluate_samples().items():
            for metric in SKILLED:
                record = found[metric]
                if not all(level in record for level in ("floor", "chance", "skill")):
                    continue
                n_skills += 1
                with self.subTest(f"{name}/{metric}"):
                    wanted = levels.skill(record["value"], record["floor"], record["chance"], metric in HIGHER)
                    if wanted is None:
                        self.assertIsNone(record["skill"]["value"])
                        self.assertTrue(record["skill"]["reason"])
                    else:
                        self.near(record["skill"]["value"], wanted, 0, "skill")
                        self.check_skill_error(record)
        self.assertGreater(n_skills, 20)

    def check_skill_error(self, record):
        """The error of skill is that of floor and chance, carried through."""
        value, floor, chance = record["value"], record["floor"], record["chance"]
        span = (chance["value"] - floor["value"]) ** 2
        wanted = hypot((value - floor["value"]) * chance["se"], (chance["value"] - value) * floor["se"]) / span
        self.near(record["skill"]["se"], wanted, 0.01 * wanted, "error of skill")

    def test_phases_describe_their_values(self):
        for name, (_, _, found) in evaluate_samples().items():
            for metric in ("average_wasserstein", "spatial_consistency", "color_wasserstein", "color_consistency"):
                band = found[metric].get("phases")
                if band is None:
                    continue
                with self.subTest(f"{name}/{metric}"):
                    known = [v for v in band["values"] if v is not None]
                    self.assertEqual((len(band["values"]), band["n"]), (8, len(known)))
                    self.assertEqual(band["values"][0], found[metric]["value"])
                    if known:
                        mean = sum(known) / len(known)
                        self.near(band["mean"], mean, 0, "mean")
                        self.near(band["std"], sqrt(sum((v - mean) ** 2 for v in known) / len(known)), 1e-12, "std")
                        self.assertEqual((band["min"], band["max"]), (min(known), max(known)))

    def test_skill_map_of_small_references(self):
        """All reference points are in its sample then: every number is exact."""
        n_maps = 0
        for name, (folder, _, found) in evaluate_samples().items():
            skill_map = found["local_color_recall"].get("skill_map")
            (ref, ref_color), (est, est_color) = read_ply(folder / "reference.ply"), read_ply(folder / "estimate.ply")
            if skill_map is None or not 1 < len(ref) <= 2000 or np.isnan(ref_color).any() or np.isnan(est_color).any():
                continue
            n_maps += 1
            origin = common_origin(ref, est)
            for entry in skill_map["per_radius"]:
                with self.subTest(f"{name}, {entry['radius_m']} m"):
                    self.check_skill_map(entry, skill_map["tau"], ref - origin, ref_color, est - origin, est_color)
        self.assertGreater(n_maps, 5)

    def check_skill_map(self, entry, taus, ref, ref_color, est, est_color):
        radius = entry["radius_m"]
        value = color.nearest_colors_within(ref, ref_color, est, est_color, radius)
        floor = floors.nearest_colors_of_others(ref, ref_color, radius)
        chance = chances.local_color_recall(ref, ref_color, est, est_color, radius, taus)
        for k, tau in enumerate(taus):
            self.near(entry["value"][k], color.recalled(value, tau) / len(ref), 0, f"value at tau {tau}")
            self.near(entry["floor"][k], color.recalled(floor, tau) / len(ref), 0, f"floor at tau {tau}")
            self.near(entry["chance"][k], chance[k]["value"], 0, f"chance at tau {tau}")
            if entry["skill"][k] is not None:
                span = entry["chance"][k] - entry["floor"][k]
                self.near(entry["skill"][k], (entry["chance"][k] - entry["value"][k]) / span, 0, f"skill at tau {tau}")


@unittest.skipIf(np is None, "no numpy or scipy (apt-get install python3-numpy python3-scipy)")
class OtherPhases(Levels):
    """The town on 27 grids and on one."""

    TOWN = SAMPLES / "town/reference.ply", SAMPLES / "town/estimate.ply"
    GRID_METRICS = ["average_wasserstein", "spatial_consistency", "color_wasserstein", "color_consistency"]

    def test_thirds(self):
        options = {"metrics": self.GRID_METRICS, "grid-phases": 27, "ccs-phases": True, "ccs-voxel": 0.5, "cw-voxel": 2.0}
        found = evaluate(*self.TOWN, options)
        (ref, ref_color), (est, est_color) = map(read_ply, self.TOWN)
        wanted = structure.voxel_metrics(est, ref, 3.0, 100, 5, 27)
        wanted["color_wasserstein"] = color_wasserstein.color_wasserstein(est, est_color, ref, ref_color, 2.0, 10, 27)
        wanted["color_consistency"] = color.color_consistency(est, est_color, ref, ref_color, 0.5, "zero", 2, 27)
        for metric in self.GRID_METRICS:
            values = found[metric]["phases"]["values"]
            self.assertEqual(len(values), 27)
            for k, value in enumerate(wanted[metric]["phases"]["values"]):
                with self.subTest(f"{metric}, phase {k}"):
                    self.near(values[k], value, 0, metric)

    def test_one_grid_has_no_band(self):
        found = evaluate(*self.TOWN, {"metrics": self.GRID_METRICS, "grid-phases": 1, "ccs-phases": True})
        for metric in self.GRID_METRICS:
            self.assertNotIn("phases", found[metric])

    def test_no_levels(self):
        found = evaluate(*self.TOWN, {"no-levels": True, "lcr-curve": True})
        for metric, record in found.items():
            for level in ("floor", "chance", "skill", "skill_map"):
                self.assertNotIn(level, record, metric)
        self.assertNotIn("chance", found["local_color_recall"]["curve"])


class Golden(Levels):
    """Values from an independent script: a real room and the sample town."""

    def check_pair(self, golden, folder, options):
        golden = SHARED / "golden" / golden
        for path in (golden, folder):
            if not path.exists():
                self.skipTest(f"no real data: {path} is missing; set CMAP_SHARED_DIR")
        wanted = json.loads(golden.read_text())
        found = evaluate(folder / "reference.ply", folder / "estimate.ply", options)
        self.check_values(wanted, found)
        self.check_phases(wanted, found)
        chance, left_out = wanted["chance"], wanted["reference_left_out"]
        self.relative(found["color_distance"]["chance"]["value"], chance["color_distance"], 0.01, "chance of CD")
        self.near(found["local_color_recall"]["chance"]["value"], chance["local_color_recall"], 0.008, "chance of LCR")
        self.relative(found["color_distance"]["floor"]["value"], left_out["color_distance"], 0.02, "floor of CD")
        self.relative(found["chamfer"]["floor"]["value"], 2 * left_out["mean_distance_m"], 0.02, "floor of Chamfer")

    def check_values(self, wanted, found):
        for metric in ("average_wasserstein", "spatial_consistency", "color_wasserstein"):
            self.relative(found[metric]["value"], wanted[metric], 1e-5, metric)

    def check_phases(self, wanted, found):
        bands = {"awd_phases": "average_wasserstein", "scs_phases": "spatial_consistency", "color_wasserstein_phases": "color_wasserstein"}
        for key, metric in bands.items():
            for name, number in wanted[key].items():
                with self.subTest(f"{metric}, {name} of the phases"):
                    self.relative(found[metric]["phases"][name], number, 1e-5, f"{metric}, {name} of the phases")

    def test_tum_fr1(self):
        self.check_pair("levels_tum_fr1.json", SHARED / "data/tum_fr1", {"lcr-radius": 0.05, "cw-voxel": 0.5})

    def test_town(self):
        self.check_pair("levels_town.json", SAMPLES / "town", {"cw-voxel": 2.0})


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-") and os.access(sys.argv[1], os.X_OK):
        os.environ["CMAP_EVAL"] = os.path.abspath(sys.argv.pop(1))
    if "CMAP_EVAL" not in os.environ:
        sys.exit(__doc__)
    unittest.main()

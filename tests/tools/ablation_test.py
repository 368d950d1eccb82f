#!/usr/bin/env python3
"""benchmarks/leaderboard/ablation/run.py on a small street; CTest sets CMAP_RECON (its folder has the other programs) and CMAP_SOURCE_DIR."""

import csv
import importlib.util
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOLS = Path(os.environ["CMAP_RECON"]).resolve().parent
PROGRAM = Path(os.environ["CMAP_SOURCE_DIR"]) / "benchmarks/leaderboard/ablation/run.py"

# A few seconds of a small street, two sessions.
QUICK = ["small_town", "--set", "route.length_m=12", "--set", "scene.block_x_m=32", "--set", "scene.block_y_m=32",
         "--set", "truth.map_points_per_m2=40", "--set", "camera.width_px=160", "--set", "camera.height_px=120",
         "--set", "camera.focal_px=110", "--set", "predictions.width_px=70", "--set", "predictions.session_length=5"]


def load_program():
    specification = importlib.util.spec_from_file_location("ablation", PROGRAM)
    module = importlib.util.module_from_spec(specification)
    sys.modules["ablation"] = module  # where dataclasses look for it
    specification.loader.exec_module(module)
    return module


class Ablation(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="cmap-ablation-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def ablation(self, capture):
        command = [sys.executable, PROGRAM, "--tools", TOOLS, "-o", self.folder / "out", "--scenes", "--capture", capture,
                   "--variants", "prefusion", "robust"]
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.folder / "out/ablation.csv", newline="") as stream:
            return done.stdout, list(csv.DictReader(stream))

    def test_two_variants_are_measured_and_kept(self):
        capture = self.folder / "street"
        subprocess.run([TOOLS / "cmap_simulate", *QUICK, "-o", capture, "--quiet"], check=True)
        table, rows = self.ablation(capture)
        self.assertEqual([(row["capture"], row["variant"], row["failed"]) for row in rows],
                         [("street", "prefusion", ""), ("street", "robust", "")])
        for row in rows:  # a street of tens of meters, of which the truth is known: a wrong frame or scale is far outside
            self.assertLess(float(row["scale_error_max"]), 20)
            self.assertLess(float(row["trajectory_rmse"]), 1)
            self.assertGreater(float(row["completeness@0.2"]), 10)
            self.assertGreater(float(row["session_average_wasserstein"]), 0)
            self.assertGreater(float(row["session_spatial_consistency"]), 0)
            self.assertLess(0, float(row["session_distance"]))
            self.assertLess(float(row["session_distance"]), 1)
        self.assertNotEqual(rows[0]["rmse"], rows[1]["rmse"])
        kept = self.folder / "out/results/street/robust.json"
        result = json.loads(kept.read_text())
        result["values"]["rmse"] = 7.25
        kept.write_text(json.dumps(result))
        again, _ = self.ablation(capture)  # what is kept is not computed again
        self.assertIn("| 7.250 |", again)
        self.assertNotIn("| 7.250 |", table)
        result["key"]["awd_voxel_m"] = 1.5
        kept.write_text(json.dumps(result))
        self.assertEqual(self.ablation(capture)[0], table)  # other parameters: it is

    def test_failed_variant_is_a_row_with_its_reason(self):
        (self.folder / "empty").mkdir()
        table, rows = self.ablation(self.folder / "empty")
        self.assertIn("robust (1 failed)", table)
        self.assertIn("cmap_recon: exit code 3", rows[0]["failed"])

    def test_trajectory_rmse_by_hand(self):
        truth, estimate = self.folder / "truth.tum", self.folder / "estimate.tum"
        truth.write_text("# stamp\n0 0 0 0 0 0 0 1\n2 4 0 0 0 0 0 1\n")
        # At 1 s the truth is at (2, 0, 0); at 3 s there is none: sqrt((0 + 3^2 + 4^2) / 3).
        estimate.write_text("0 0 0 0 0 0 0 1\n1 2 3 0 0 0 0 1\n2 4 0 4 0 0 0 1\n3 9 9 9 0 0 0 1\n")
        self.assertAlmostEqual(load_program().trajectory_rmse_m(truth, estimate), (25 / 3) ** 0.5, places=12)

    def test_scale_errors_in_percent_of_the_truth_without_dropped_sessions(self):
        (self.folder / "truth").mkdir()
        (self.folder / "truth/scales.json").write_text('{"scales": {"a": 2.0, "b": 4.0, "c": 1.0}}')
        (self.folder / "sessions.json").write_text(json.dumps({"sessions": [
            {"name": "a", "scale": 2.1, "dropped": None}, {"name": "b", "scale": 3.0, "dropped": None},
            {"name": "c", "scale": 9.0, "dropped": "no pose"}]}))
        a, b = load_program().scale_errors(self.folder, self.folder)
        self.assertAlmostEqual(a, 5.0)
        self.assertAlmostEqual(b, 25.0)


if __name__ == "__main__":
    unittest.main()

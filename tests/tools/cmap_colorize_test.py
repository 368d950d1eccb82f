#!/usr/bin/env python3
"""cmap_colorize as a user runs it, on simulated captures and, where it is there, on a real drive; CTest sets CMAP_COLORIZE,
CMAP_EVAL, CMAP_SIMULATE and CMAP_SOURCE_DIR."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

PROGRAM, EVAL, SIMULATE = (Path(os.environ[name]).resolve() for name in ("CMAP_COLORIZE", "CMAP_EVAL", "CMAP_SIMULATE"))
SOURCE = Path(os.environ["CMAP_SOURCE_DIR"]).resolve()
DATA = Path(os.environ.get("CMAP_DATA_DIR", SOURCE / "../shared/data"))
DONE, USAGE, INPUT = 0, 2, 3

# Twelve meters of a street, a picture every two; surfaces within 6 m of a camera, whose texture its pixels can show.
STREET = ["small_town", "route.length_m=12", "camera.width_px=800", "camera.height_px=600", "camera.focal_px=500",
          "camera.format=png", "truth.map_max_distance_m=6", "truth.map_points_per_m2=50"]
# Some steps of a corridor, with turns.
CORRIDOR = ["small_indoor", "camera.width_px=640", "camera.height_px=480", "camera.focal_px=380", "camera.format=png",
            "truth.map_points_per_m2=5"]


def simulate(folder, preset, *settings):
    arguments = [argument for setting in settings for argument in ("--set", setting)]
    subprocess.run([SIMULATE, preset, *arguments, "-o", folder, "--quiet"], check=True)


def color_distance(reference, estimate):
    command = [EVAL, reference, estimate, "--metrics", "color_distance", "--format", "json"]
    return json.loads(subprocess.run(command, capture_output=True, check=True).stdout)["metrics"]["color_distance"]


class ColorizeCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="cmap-colorize-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def colorize(self, capture, *arguments, code=DONE):
        result = subprocess.run([PROGRAM, capture, *map(str, arguments)], capture_output=True, text=True)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    @classmethod
    def made_street(cls):
        folder = tempfile.TemporaryDirectory(prefix="cmap-colorize-")
        cls.addClassCleanup(folder.cleanup)
        simulate(Path(folder.name) / "street", *STREET)
        return Path(folder.name) / "street"


class Colorize(ColorizeCase):
    @classmethod
    def setUpClass(cls):
        cls.street = cls.made_street()

    def refused(self, code, says, *arguments, capture=None):
        result = self.colorize(capture or self.street, *arguments, code=code)
        self.assertIn(says, result.stderr)
        self.assertEqual(result.stdout, "")

    def copy(self):
        capture = self.folder / "capture"
        shutil.copytree(self.street, capture)
        return capture

    def test_the_true_texture(self):
        """At the points of the truth: the color of nothing but texture, pixels and occlusion."""
        truth, colored = self.street / "truth/map.ply", self.folder / "colored.ply"
        self.colorize(self.street, "-o", colored, "--map", truth, "--trajectory", self.street / "truth/trajectory.tum")
        found = color_distance(truth, colored)
        self.assertLess(found["value"], 0.03)
        self.assertLess(found["value"], found["floor"]["value"])
        self.assertLess(found["value"], 0.15 * found["chance"]["value"])
        self.assertGreater(found["n_estimate"], 0.97 * found["n_reference"], "nearly all of it is seen")

    def test_a_map_of_the_scans(self):
        colored, report = self.folder / "colored.ply", self.folder / "report.json"
        table = self.colorize(self.street, "-o", colored, "--leave-out-unseen", "--voxel", "0.2", "--json", report).stdout
        self.assertRegex(table, r"map +\d+ points of \d+ in \d+ scans, voxel 0.2 m")
        self.assertIn(b"property uchar red", colored.read_bytes()[:400])
        found = json.loads(report.read_text())
        self.assertEqual(found["schema"], "cmap.colorize/1")
        self.assertEqual(len(found["images"]["used"]), found["images"]["chosen"])
        header = colored.read_bytes()[:400].decode(errors="replace")
        self.assertIn(f"element vertex {found['map']['seen']}\n", header)
        self.colorize(self.street, "-o", colored, "--voxel", "0.2")
        self.assertIn(b"property float red", colored.read_bytes()[:400], "unseen points are NaN")

    def test_same_bytes_for_any_number_of_threads(self):
        outputs = []
        for threads in (1, 4):
            output = self.folder / f"{threads}.ply"
            self.colorize(self.street, "-o", output, "--voxel", "0.2", "--threads", threads)
            outputs.append(output.read_bytes())
        self.assertEqual(outputs[0], outputs[1])

    def test_wrong_clock_and_calibration_show(self):
        spreads = {}
        for name, arguments in {"right": [], "turned": ["--turn", "0,1,0"], "late": ["--time-offset", "0.1"]}.items():
            report = self.folder / f"{name}.json"
            self.colorize(self.street, "-o", self.folder / "x.ply", "--voxel", "0.2", "--json", report, *arguments)
            spreads[name] = json.loads(report.read_text())["map"]["inconsistency"]
        self.assertGreater(spreads["turned"], 1.15 * spreads["right"])
        self.assertGreater(spreads["late"], 1.15 * spreads["right"])

    def test_refining_finds_half_a_degree_and_three_centimeters(self):
        """Within 0.05 deg and 1 cm; told, and written where it was asked for, and no more."""
        capture, refined = self.folder / "corridor", self.folder / "T.txt"
        simulate(capture, *CORRIDOR)
        before = (capture / "capture.json").read_bytes()
        truth = np.array(json.loads(before)["T_lidar_camera"])
        arguments = ["--refine-extrinsic", "--trajectory", capture / "truth/trajectory.tum", "--voxel", "0.05"]
        wrong = ["--turn", "0.3,0.3,0.27", "--shift", "0.02,0.02,-0.01"]
        table = self.colorize(capture, *arguments, *wrong, "--extrinsic-output", refined).stdout
        self.assertIn("not applied", table)
        left = np.linalg.inv(truth) @ np.loadtxt(refined)
        angle_deg = np.degrees(np.linalg.norm([left[2, 1] - left[1, 2], left[0, 2] - left[2, 0], left[1, 0] - left[0, 1]]) / 2)
        self.assertLess(angle_deg, 0.05)
        self.assertLess(np.linalg.norm(left[:3, 3]), 0.01)
        self.assertEqual((capture / "capture.json").read_bytes(), before)

    def test_what_is_missing_is_said(self):
        output = self.folder / "x.ply"
        self.refused(USAGE, "--output", "--voxel", "0.2")
        self.refused(USAGE, "written as PLY", "-o", self.folder / "x.pcd")
        self.refused(USAGE, "own files", "-o", self.street / "truth/mine.ply")
        self.refused(USAGE, "would overwrite", "-o", output, "--json", output)
        self.refused(USAGE, "--refine-extrinsic", "-o", output, "--extrinsic-output", self.folder / "T.txt")
        self.refused(USAGE, 'unknown key "best_views"', "-o", output, "--set", "best_views=3")
        self.refused(USAGE, "most_views", "-o", output, "--set", "most_views=0")
        self.refused(INPUT, "no image has a pose at its time", "-o", output, "--time-offset", "1000")
        self.refused(INPUT, "nowhere.txt", "-o", output, "--extrinsic", "nowhere.txt")
        self.refused(INPUT, "nowhere", "-o", output, capture="nowhere")
        self.assertEqual(list(self.folder.iterdir()), [], "no output is left behind")

    def test_faulty_captures(self):
        capture, output = self.copy(), self.folder / "x.ply"
        image = next((capture / "images").iterdir())
        whole = image.read_bytes()
        other = next((self.street / "truth").glob("preview.png")).read_bytes()
        image.write_bytes(other)
        self.refused(INPUT, image.name, "-o", output, "--voxel", "0.2", capture=capture)  # another size
        image.write_bytes(whole[: len(whole) // 2])
        self.colorize(capture, "-o", output, "--voxel", "0.2", code=INPUT)
        image.write_bytes(whole)
        (capture / "lio.tum").unlink()
        self.refused(INPUT, "no poses", "-o", output, capture=capture)
        text = json.loads((capture / "capture.json").read_text())
        del text["camera"]
        (capture / "capture.json").write_text(json.dumps(text))
        self.refused(INPUT, "camera", "-o", output, capture=capture)
        self.assertFalse(output.exists())


@unittest.skipUnless((DATA / "kitti_0009").is_dir(), f"no real data: {DATA / 'kitti_0009'} is missing; set CMAP_DATA_DIR")
class Drive(ColorizeCase):
    """Fifty meters of a street with parked cars, whose true map was colored from the image of each scan's own time."""

    @classmethod
    def setUpClass(cls):
        cls.capture = DATA / "kitti_0009"

    def test_agrees_with_the_truth(self):
        truth = self.capture / "truth/map.ply"
        for which in ("all", "even", "odd"):
            self.colorize(self.capture, "-o", self.folder / f"{which}.ply", "--map", truth, "--leave-out-unseen",
                          "--images", which, "--set", "exposure=none")
        found = color_distance(truth, self.folder / "all.ply")
        halves = color_distance(self.folder / "even.ply", self.folder / "odd.ply")
        # A perfect map could be expected to score the floor: the truth's own points are that far from each other.
        self.assertLess(found["value"], 0.85 * found["floor"]["value"])
        self.assertLess(found["value"], 0.18 * found["chance"]["value"])
        self.assertLess(halves["value"], 0.04)

    def test_a_map_of_the_scans_is_as_near_as_the_truth_can_tell(self):
        colored = self.folder / "colored.ply"
        self.colorize(self.capture, "-o", colored, "--voxel", "0.03", "--leave-out-unseen", "--set", "exposure=none")
        found = color_distance(self.capture / "truth/map.ply", colored)
        self.assertLess(found["value"], 1.05 * found["floor"]["value"])


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""cmap_convert as a user runs it; CTest sets CMAP_CONVERT and CMAP_SOURCE_DIR. tests/recordings/ holds it to outside writers."""

import csv
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from examples_test import write_recording  # noqa: E402

PROGRAM = Path(os.environ["CMAP_CONVERT"]).resolve()
CONFIGS = Path(os.environ["CMAP_SOURCE_DIR"]) / "configs/recordings"
DONE, USAGE, INPUT = 0, 2, 3


class Convert(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="cmap-convert-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        write_recording(self.folder)
        self.drive, self.rig, self.capture = (self.folder / name for name in ("drive.mcap", "rig.json", "capture"))

    def convert(self, *arguments, code=DONE):
        result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def refused(self, says, *arguments, code=INPUT):
        result = self.convert(*arguments, "-o", self.capture, code=code)
        self.assertIn(says, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual([path for path in self.folder.iterdir() if "capture" in path.name], [], "no output is left behind")

    def test_a_capture_as_an_outside_reader_sees_it(self):
        result = self.convert(self.drive, "-o", self.capture, "--config", self.rig)
        self.assertEqual(result.stdout, "3 scans, 3 images, 3 IMU samples, 0 poses\n")
        self.assertEqual(result.stderr, "")
        for table in ("images.csv", "lidar.csv"):
            rows = list(csv.DictReader((self.capture / table).read_text().splitlines()))
            self.assertEqual([float(row["timestamp_s"]) for row in rows], [1700000000, 1700000001, 1700000002])
            self.assertTrue(all((self.capture / row["file"]).exists() for row in rows))
        self.assertIn("POINTS 50\n", (self.capture / "lidar/000000.pcd").read_bytes().decode(errors="replace"))

    def test_twice_gives_the_same_bytes(self):
        for name in ("a", "b"):
            self.convert(self.drive, "-o", self.folder / name, "--config", self.rig)
        first = {path.relative_to(self.folder / "a"): path.read_bytes() for path in (self.folder / "a").rglob("*") if path.is_file()}
        for path, content in first.items():
            self.assertEqual((self.folder / "b" / path).read_bytes(), content, path)

    def test_what_is_missing_is_named(self):
        self.refused("--config is required", self.drive, code=USAGE)
        self.assertIn("--output is required", self.convert(self.drive, code=USAGE).stderr)
        self.refused("missing.bag: no such file", self.folder / "missing.bag", "--config", self.rig)
        self.refused("no topic /livox/lidar; there is /imu (sensor_msgs/Imu, 3 messages), /left/image_raw",
                     self.drive, "--config", CONFIGS / "mars_lvig_amtown.json")
        self.refused("camera=/c is none of lidar=NAME", self.drive, "--config", self.rig, "--topic", "camera=/c", code=USAGE)
        self.refused("rig.json: is no recording", self.rig, "--config", self.rig)

    def test_what_is_cut_off_is_an_error_and_leaves_nothing(self):
        cut = self.folder / "cut.mcap"
        cut.write_bytes(self.drive.read_bytes()[:-300])
        self.refused("cut.mcap: truncated: the record at byte", cut, "--config", self.rig)

    def test_a_name_that_is_taken_is_refused(self):
        self.capture.mkdir()
        (self.capture / "mine").write_text("mine")
        self.convert(self.drive, "-o", self.capture, "--config", self.rig, code=USAGE)
        self.assertEqual([path.name for path in self.capture.iterdir()], ["mine"])


if __name__ == "__main__":
    unittest.main()

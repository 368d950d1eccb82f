#!/usr/bin/env python3
"""cmap_simulate as a user runs it; CTest sets CMAP_SIMULATE and CMAP_SOURCE_DIR."""

import csv
import json
import os
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np

PROGRAM = Path(os.environ["CMAP_SIMULATE"]).resolve()
PRESETS = Path(os.environ["CMAP_SOURCE_DIR"]) / "configs" / "sim"
DONE, USAGE, INPUT = 0, 2, 3

# A few seconds of a small street.
QUICK = ["small_town", "--set", "route.length_m=6", "--set", "scene.block_x_m=32", "--set", "scene.block_y_m=32",
         "--set", "truth.map_points_per_m2=5", "--set", "camera.width_px=160", "--set", "camera.height_px=120",
         "--set", "camera.focal_px=110", "--set", "predictions.width_px=70", "--set", "predictions.session_length=4"]


def contents(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


class Simulate(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="cmap-simulate-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def simulate(self, *arguments, code=DONE):
        result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
        self.assertEqual(result.returncode, code, result.stderr)
        if code == DONE:
            self.assertEqual(result.stderr, "")
        return result

    def refused(self, says, *arguments, code=USAGE):
        result = self.simulate(*arguments, "-o", self.folder / "refused", code=code)
        self.assertIn(says, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(list(self.folder.iterdir()), [], "no output is left behind")

    def test_capture_as_an_outside_reader_sees_it(self):
        capture = self.folder / "capture"
        self.assertEqual(self.simulate(*QUICK, "-o", capture).stdout, "")
        calibration = json.loads((capture / "capture.json").read_text())
        self.assertEqual(calibration["version"], 1)
        for table in ("images.csv", "lidar.csv"):
            rows = list(csv.DictReader((capture / table).read_text().splitlines()))
            self.assertGreater(len(rows), 3)
            times = [float(row["timestamp_s"]) for row in rows]
            self.assertEqual(times, sorted(times))
            for row in rows:
                self.assertTrue((capture / row["file"]).exists() or any(capture.rglob(Path(row["file"]).name)))
        imu = np.loadtxt(capture / "imu.csv", delimiter=",", skiprows=1)
        still = imu[:200]  # one second of rest at 200 Hz
        self.assertAlmostEqual(np.linalg.norm(still[:, 4:7].mean(axis=0)), 9.81, delta=0.1)
        self.assertLess(np.abs(still[:, 1:4].mean(axis=0)).max(), 0.01)
        scales = json.loads((capture / "truth" / "scales.json").read_text())["scales"]
        sessions = sorted(path.name for path in (capture / "predictions").iterdir())
        self.assertEqual(sorted(scales), sessions)
        session = capture / "predictions" / sessions[0]
        depth, confidence = np.load(session / "depth.npy"), np.load(session / "depth_conf.npy")
        images, poses = np.load(session / "images.npy"), np.load(session / "extrinsic.npy")
        self.assertEqual(depth.shape, images.shape[:3])
        self.assertEqual(depth.shape, confidence.shape)
        self.assertGreater(depth.min(), 0)
        self.assertGreaterEqual(confidence.min(), 1)
        self.assertEqual(depth.shape[2] % 14 + depth.shape[1] % 14, 0)
        np.testing.assert_allclose(poses[0], np.eye(4)[:3], atol=1e-12)
        self.assertTrue((capture / "truth" / "preview.png").read_bytes().startswith(b"\x89PNG"))

    def test_same_bytes_for_any_number_of_threads(self):
        self.simulate(*QUICK, "-o", self.folder / "one", "--threads", 1)
        self.simulate(*QUICK, "-o", self.folder / "four", "--threads", 4)
        self.assertEqual(contents(self.folder / "one"), contents(self.folder / "four"))
        self.simulate(*QUICK, "-o", self.folder / "other", "--seed", 2)
        self.assertNotEqual(contents(self.folder / "one")["imu.csv"], contents(self.folder / "other")["imu.csv"])

    def test_options_printed_are_options_read(self):
        printed = self.simulate("aerial", "--set", "imu.rate_hz=400", "--print-options").stdout
        self.assertEqual(json.loads(printed)["imu"]["rate_hz"], 400)
        file = self.folder / "options.json"
        file.write_text(printed)
        self.assertEqual(self.simulate(file, "--print-options").stdout, printed)
        for preset in PRESETS.glob("*.json"):
            self.assertEqual(self.simulate(preset, "--print-options").stdout,
                             self.simulate(preset.stem, "--print-options").stdout)

    def test_refusals(self):
        self.refused('"moon" is no preset', "moon")
        self.refused("unknown key", "small_town", "--set", "imu.rate=1")
        self.refused("must be above 0", "small_town", "--set", "imu.rate_hz=0")
        self.refused("is not section.field=value", "small_town", "--set", "imu")
        self.refused("cannot be read", "/nonexistent/options.json")
        self.refused("--output", "small_town", "--output", "")
        self.simulate("small_town", code=USAGE)
        self.refused("nowhere.ply", "small_town", "--set", "scene.kind=mesh", "--set", "scene.mesh=nowhere.ply",
                     code=INPUT)

    def test_an_existing_folder_is_not_touched(self):
        taken = self.folder / "taken"
        taken.mkdir()
        (taken / "mine").write_text("mine")
        self.assertIn("taken", self.simulate(*QUICK, "-o", taken, code=USAGE).stderr)
        self.assertEqual([path.name for path in taken.iterdir()], ["mine"])

    def start(self):
        return subprocess.Popen([PROGRAM, *QUICK, "-o", self.folder / "capture", "--quiet"], stderr=subprocess.PIPE,
                                text=True)

    @staticmethod
    def wait_for(path):
        while not path.exists():
            time.sleep(0.005)

    def test_a_stopped_run_is_not_in_the_way(self):
        self.simulate(*QUICK, "-o", self.folder / "alone")
        for made in ("truth", "lidar", "predictions"):  # each run comes farther than the one before
            run = self.start()
            self.wait_for(self.folder / "capture.partial" / made)
            run.kill()
            run.communicate()
            self.assertFalse((self.folder / "capture").exists())
            self.assertTrue((self.folder / "capture.partial").exists())
        self.simulate(*QUICK, "-o", self.folder / "capture")
        self.assertEqual(contents(self.folder / "capture"), contents(self.folder / "alone"))
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["alone", "capture"])

    def test_a_signal_takes_the_rest_with_it(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            run = self.start()
            self.wait_for(self.folder / "capture.partial" / "lidar")
            run.send_signal(number)
            run.communicate()
            self.assertEqual(run.returncode, 128 + number)
            self.assertEqual(list(self.folder.iterdir()), [])

    def test_two_at_once(self):
        runs = [self.start() for _ in range(3)]
        messages = [run.communicate()[1] for run in runs]
        self.assertEqual(sorted(run.returncode for run in runs), [DONE, USAGE, USAGE], messages)
        for run, message in zip(runs, messages):
            if run.returncode == USAGE:
                self.assertRegex(message, "another program is writing into it|it is already there")
        self.simulate(*QUICK, "-o", self.folder / "alone")
        self.assertEqual(contents(self.folder / "capture"), contents(self.folder / "alone"))

    def test_a_folder_of_somebody_else_is_not_taken_for_a_rest(self):
        other = self.folder / "capture.partial"
        other.mkdir()
        (other / "mine").write_text("mine")
        message = self.simulate(*QUICK, "-o", self.folder / "capture", code=USAGE).stderr
        self.assertIn("capture.partial is there, and is not what a run that was stopped has left", message)
        self.assertEqual(contents(other), {"mine": b"mine"})


if __name__ == "__main__":
    unittest.main()

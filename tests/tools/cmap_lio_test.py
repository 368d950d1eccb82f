#!/usr/bin/env python3
"""cmap_lio as a user runs it, and the chain from raw sensors to the numbers of a map, on simulated captures and, where it is there,
on a real drive; CTest sets CMAP_LIO, CMAP_RECON, CMAP_CONVERT, CMAP_SIMULATE and CMAP_SOURCE_DIR."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

PROGRAM, RECON, SIMULATE = (Path(os.environ[name]).resolve() for name in ("CMAP_LIO", "CMAP_RECON", "CMAP_SIMULATE"))
SOURCE = Path(os.environ["CMAP_SOURCE_DIR"]).resolve()
DATA = Path(os.environ.get("CMAP_DATA_DIR", SOURCE / "../shared/data"))
DONE, USAGE, INPUT = 0, 2, 3


def poses(path):
    return np.loadtxt(path, ndmin=2)


def end_error_m(estimate, truth):
    """Of the last pose's position, in the truth's world."""
    last = estimate[-1]
    at = [np.interp(last[0], truth[:, 0], truth[:, k]) for k in (1, 2, 3)]
    return float(np.linalg.norm(last[1:4] - at))


class LioCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="cmap-lio-")
        cls.addClassCleanup(folder.cleanup)
        cls.capture = Path(folder.name) / "capture"
        subprocess.run([SIMULATE, "small_town", "-o", cls.capture, "--quiet"], check=True)

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="cmap-lio-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def lio(self, *arguments, code=DONE):
        result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def copied(self):
        copy = self.folder / "copy"
        shutil.copytree(self.capture, copy, ignore=shutil.ignore_patterns("images", "predictions"))
        return copy


class Simulated(LioCase):
    def test_street(self):
        out = self.folder / "lio"
        result = self.lio(self.capture, "-o", out, "--figure", self.folder / "lio.png", "--scans")
        self.assertIn("at rest", result.stdout)
        truth = poses(self.capture / "truth/trajectory.tum")
        # 24 m of a street, 16 lines of 450 points: 0.3 % of the path would be 7 cm.
        self.assertLess(end_error_m(poses(out / "trajectory.tum"), truth), 0.07)
        health = json.loads((out / "health.json").read_text())
        self.assertEqual(len(health["scans"]), len(poses(out / "trajectory.tum")))
        self.assertEqual(health["scans"][0]["outcome"], "first")
        self.assertEqual(len(list((out / "scans").glob("*.pcd"))), len(health["scans"]))
        self.assertGreater(len(poses(out / "trajectory_imu.tum")), 10 * len(health["scans"]))
        for name in ("map.pcd", "loops.json"):
            self.assertTrue((out / name).is_file())
        self.assertTrue((self.folder / "lio.png").read_bytes().startswith(b"\x89PNG"))

    def test_without_the_imu(self):
        (copy := self.copied()).joinpath("imu.csv").unlink()
        result = self.lio(copy, "-o", self.folder / "lio", code=INPUT)
        self.assertIn("--no-imu does without", result.stderr)
        self.lio(copy, "-o", self.folder / "lio", "--no-imu")
        truth = poses(copy / "truth/trajectory.tum")
        # Nothing but scans: twice what the IMU is asked for.
        self.assertLess(end_error_m(poses(self.folder / "lio/trajectory.tum"), truth), 0.14)

    def test_same_bytes_for_any_number_of_threads(self):
        for threads in (1, 2):
            self.lio(self.capture, "-o", self.folder / str(threads), "--threads", threads)
        for name in ("trajectory.tum", "trajectory_imu.tum", "map.pcd", "loops.json"):
            self.assertEqual((self.folder / "1" / name).read_bytes(), (self.folder / "2" / name).read_bytes(), name)

    def test_imu_out_of_order_and_in_g(self):
        copy = self.copied()
        head, *rows = (copy / "imu.csv").read_text().splitlines()
        in_g = [",".join(cells[:4] + [repr(float(v) / 9.80665) for v in cells[4:]]) for cells in (r.split(",") for r in rows)]
        in_g[10], in_g[11] = in_g[11], in_g[10]
        in_g.insert(20, in_g[20])
        (copy / "imu.csv").write_text("\n".join([head, *in_g]) + "\n")
        result = self.lio(copy, "-o", self.folder / "lio")
        self.assertIn("taken for g", result.stderr)
        self.assertIn("rows were out of order and are sorted; 1 of", result.stderr)
        self.assertLess(end_error_m(poses(self.folder / "lio/trajectory.tum"), poses(copy / "truth/trajectory.tum")), 0.07)


class BadInput(LioCase):
    def refused(self, capture, *arguments, code=INPUT):
        result = self.lio(capture, "-o", self.folder / "out", *arguments, code=code)
        kept = {path.name for path in (self.folder / "out").glob("*")} if (self.folder / "out").exists() else set()
        self.assertLessEqual(kept, {"trajectory.partial.tum"})
        return result.stderr, kept

    def test_wrong_unit_of_accelerations(self):
        copy = self.copied()
        head, *rows = (copy / "imu.csv").read_text().splitlines()
        scaled = [",".join(c[:4] + [repr(1000 * float(v)) for v in c[4:]]) for c in (r.split(",") for r in rows)]
        (copy / "imu.csv").write_text("\n".join([head, *scaled]) + "\n")
        self.assertIn("at rest gravity alone is 9.8 m/s^2, or 1 g (wrong columns or unit?)", self.refused(copy)[0])

    def test_all_points_too_near(self):
        self.assertIn("no scan has a point between", self.refused(self.capture, "--set", "min_range_m=500", "--set",
                                                                  "max_range_m=600")[0])

    def test_imu_of_another_clock(self):
        copy = self.copied()
        calibration = json.loads((copy / "capture.json").read_text())
        calibration["time_offset"]["imu_s"] = 1000.0
        (copy / "capture.json").write_text(json.dumps(calibration))
        self.assertIn("come before the IMU begins", self.refused(copy)[0])

    def test_a_scan_that_is_cut_off_keeps_what_came_before(self):
        copy = self.copied()
        scan = sorted((copy / "lidar").glob("*.pcd"))[40]
        scan.write_bytes(scan.read_bytes()[:2000])
        message, kept = self.refused(copy)
        self.assertIn(scan.name, message)
        self.assertIn("40 poses before that are kept", message)
        self.assertEqual(len(poses(self.folder / "out/trajectory.partial.tum")), 40)
        self.assertEqual(kept, {"trajectory.partial.tum"})

    def test_options(self):
        self.assertIn("voxle_m", self.refused(self.capture, "--set", "voxle_m=1", code=USAGE)[0])
        self.assertIn("avia", self.refused(self.capture, "--preset", "velodyne", code=USAGE)[0])
        self.assertIn("--rig", self.refused(self.capture, "--rig", "x.json", code=USAGE)[0])


class Chain(LioCase):
    def fitness(self, capture, name):
        result = subprocess.run([RECON, capture, "-o", self.folder / name, "--evaluate", self.capture / "truth/map.ply"],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, DONE, result.stderr)
        report = json.loads((self.folder / name / "evaluation.json").read_text())
        rows = report["metrics"]["fitness"]["per_threshold"]
        return next(row["value"] for row in rows if row["threshold_m"] == 0.2), result.stderr

    def test_raw_sensors_do_as_well_as_true_poses(self):
        raw, true = self.folder / "raw", self.folder / "true"
        for copy in (raw, true):
            shutil.copytree(self.capture, copy, ignore=shutil.ignore_patterns("images"))
        (raw / "lio.tum").unlink()
        shutil.copyfile(true / "truth/trajectory.tum", true / "lio.tum")
        by_odometry, said = self.fitness(raw, "by_odometry")
        self.assertIn("no lio.tum; its poses are those of odometry", said)
        self.assertTrue((self.folder / "by_odometry/lio.tum").is_file())
        self.assertAlmostEqual(by_odometry, self.fitness(true, "by_truth")[0], delta=0.02)


@unittest.skipUnless((DATA / "kitti_0009").is_dir(), f"no {DATA / 'kitti_0009'}; set CMAP_DATA_DIR")
class RealDrive(LioCase):
    """A car that drives 10 m/s at its first scan; see benchmarks/odometry/real.py for more."""

    def end_to_end(self, *arguments):
        capture = self.folder / "kitti"
        capture.mkdir(exist_ok=True)
        for path in (DATA / "kitti_0009").iterdir():
            if path.name not in ("imu.csv", "lio.tum") and not (capture / path.name).exists():
                (capture / path.name).symlink_to(path)
        if not (capture / "imu.csv").exists():
            (capture / "imu.csv").symlink_to(DATA / "kitti_0009/imu_100hz.csv")
        self.lio(capture, "-o", self.folder / "lio", *arguments)
        found, truth = poses(self.folder / "lio/trajectory.tum"), poses(DATA / "kitti_0009/lio.tum")
        way = [np.linalg.norm(t[-1, 1:4] - t[0, 1:4]) for t in (found, truth[1:])]
        return abs(way[0] - way[1]) / way[1]

    def test_the_way_is_as_long_as_the_truth(self):
        # Peers that start from a standstill lose 0.5 to 3 m of 54; 0.5 % is 27 cm.
        self.assertLess(self.end_to_end(), 0.005)
        self.assertLess(self.end_to_end("--no-imu"), 0.005)


if __name__ == "__main__":
    unittest.main()

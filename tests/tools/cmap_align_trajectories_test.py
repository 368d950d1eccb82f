#!/usr/bin/env python3
"""What people give cmap_align as trajectories, and what they may expect; CTest sets CMAP_ALIGN, CMAP_EVAL and CMAP_SOURCE_DIR."""

import json
import os
import subprocess
import unittest
from pathlib import Path

import numpy as np

from cmap_eval_testing import INPUT, PROGRAM as EVAL, SCHEMA, TOWN, UNSUPPORTED, USAGE, WithFolders, jsonschema, ply

PROGRAM = Path(os.environ["CMAP_ALIGN"]).resolve()
EPOCH = 1700000000.0
TURN = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
SHIFT = np.array([100.0, -50, 3])


def place(t):
    """A path with turns: not of one speed, not flat, nowhere as before."""
    return np.stack([8 * np.cos(0.25 * t) + 1.5 * np.sin(0.83 * t), 6 * np.sin(0.31 * t) + np.cos(1.1 * t), 0.5 * np.sin(0.47 * t)], 1)


def moved(points):
    return points @ TURN.T + SHIFT


def noise(n, sigma, seed):
    return np.random.default_rng(seed).normal(0, sigma, (n, 3))


def tum(times, points):
    return "".join("%.6f %.9f %.9f %.9f 0 0 0 1\n" % (t, *p) for t, p in zip(times, points))


class Trajectories(WithFolders):
    def setUp(self):
        super().setUp()
        self.times = np.arange(0, 40, 0.1)

    def pair(self, source, target, times=None, target_times=None, write=tum):
        """Files of both; positions, by times since the epoch."""
        times = self.times if times is None else times
        target_times = times if target_times is None else target_times
        paths = self.inputs / "source.tum", self.inputs / "target.tum"
        paths[0].write_text(write(EPOCH + times, source))
        paths[1].write_text(write(EPOCH + target_times, target))
        return paths

    def run_program(self, *arguments, method=True):
        words = [PROGRAM, *map(str, arguments), "-o", self.outputs / "T.txt", "--json", self.outputs / "result.json"]
        return subprocess.run(words + (["--method", "trajectory"] if method else []), capture_output=True, text=True, timeout=60)

    def clear(self):
        for path in self.outputs.iterdir():
            path.unlink()

    def align(self, *arguments, tolerance_m=0.01, says=(), method=True):
        """Done, and where the path is: the transform and the report."""
        result = self.run_program(*arguments, method=method)
        self.assertEqual(result.returncode, 0, result.stderr)
        for words in says:
            self.assertIn(words, result.stderr)
        if not says:
            self.assertEqual(result.stderr, "")
        T = np.loadtxt(self.outputs / "T.txt")
        path = place(self.times)
        self.assertLess(np.abs(path @ T[:3, :3].T + T[:3, 3] - moved(path)).max(), tolerance_m)
        report = json.loads((self.outputs / "result.json").read_text())
        self.assertEqual(report["verdict"], "determined")
        self.assertIn("verdict     determined", result.stdout)
        return report

    def refused(self, code, says, *arguments, method=True):
        for further in ((), ("--quiet",)):
            result = self.run_program(*arguments, *further, method=method)
            self.assertEqual(result.returncode, code, result.stderr)
            for words in says:
                self.assertIn(words, result.stderr.splitlines()[-1])
            self.assertEqual(result.stdout, "")
            self.assertEqual(os.listdir(self.outputs), [], "nothing is left behind")

    def test_one_time_twice_keeps_the_first(self):
        times = np.insert(self.times, 200, self.times[200])
        target = np.insert(moved(place(self.times)), 201, [1, 2, 3], 0)
        self.align(*self.pair(place(self.times), target, self.times, times), "--fit", "se3",
                   says=["a row has the time of an earlier row but another pose, and is left out: the first is kept"])

    def test_rows_in_any_order(self):
        order = np.random.default_rng(1).permutation(len(self.times))
        self.align(*self.pair(place(self.times)[order], moved(place(self.times))[order], self.times[order]),
                   says=["the poses are sorted by time"])

    def test_gaps(self):
        kept = (self.times < 10) | (self.times > 14)
        report = self.align(*self.pair(place(self.times + 0.05), moved(place(self.times[kept])), self.times + 0.05, self.times[kept]),
                            says=["poses of the source have no pair", "4.2 s apart, more than --max-gap, 0.15 s"])
        self.assertEqual(report["n_matches"], 357, "42 in the gap, the last beyond the end")
        slow = np.arange(0, 40, 1.0)
        files = self.pair(place(self.times + 0.05), moved(place(slow)), self.times + 0.05, slow)
        self.clear()
        self.refused(UNSUPPORTED, ["--max-gap takes longer gaps"], *files)
        self.align(*files, "--max-gap", 1.5, tolerance_m=0.2)

    def test_poses_that_jump(self):
        source = place(self.times) + noise(len(self.times), 0.001, 1)
        source[[50, 51, 300]] += [[30, 0, 0], [30, 0, 0], [0, 1e5, 0]]
        report = self.align(*self.pair(source, moved(place(self.times))),
                            says=["3 of 400 poses do not fit and are left out, at 1700000005.000, 1700000005.100, 1700000030.000 s"])
        self.assertEqual(report["n_matches"], 397)
        np.testing.assert_allclose(report["misfit_times_s"], EPOCH + self.times[[50, 51, 300]], rtol=0, atol=1e-6)

    def test_a_straight_path_with_noise(self):
        straight = np.outer(3 * self.times, [1, 0, 0])
        for sigma in (0.002, 0.05):
            source, target = (straight + noise(400, sigma, seed) for seed in (1, 2))
            for fit in ("se3", "sim3"):
                self.refused(UNSUPPORTED, ["the alignment is unsupported", "the rotation about it is not determined", "--allow-unconverged"],
                             *self.pair(source, target), "--fit", fit)
        result = self.run_program(*self.pair(source, target), "--allow-unconverged")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("warning: the alignment is unsupported", result.stderr)
        self.assertIn("verdict     unsupported", result.stdout)
        self.assertEqual(json.loads((self.outputs / "result.json").read_text())["verdict"], "unsupported")
        self.assertEqual(np.loadtxt(self.outputs / "T.txt").shape, (4, 4))

    def test_a_source_that_stands_still(self):
        self.refused(UNSUPPORTED, ["the source stands still"], *self.pair(noise(400, 0.001, 1), place(self.times)))

    def test_paths_that_have_nothing_to_do_with_each_other(self):
        other = np.stack([np.sin(0.05 * self.times**1.5), np.cos(0.9 * self.times), 0.2 * self.times], 1)
        self.refused(UNSUPPORTED, ["the paths do not fit: the RMSE is"], *self.pair(place(self.times), other))

    def test_a_left_handed_export(self):
        files = self.pair(place(self.times) * [1, -1, 1], moved(place(self.times)))
        self.refused(UNSUPPORTED, ["the alignment is mirrored", "left-handed frame"], *files)
        self.refused(UNSUPPORTED, ["mirrored"], *files, "--fit", "se3")

    def test_another_scale_than_the_fit_allows(self):
        files = self.pair(0.1 * place(self.times), moved(place(self.times)))
        self.refused(UNSUPPORTED, ["--fit sim3 finds a scale of 10 "], *files, "--fit", "se3")

    def test_clocks_that_differ(self):
        source = place(self.times) + noise(400, 0.002, 1)
        files = self.pair(source, moved(place(self.times)), self.times + 0.3, self.times)
        result = self.run_program(*files)
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stderr, r"warning: the clocks differ: --time-offset -0\.(300|299)\d would leave an RMSE of 0\.00")
        report = self.align(*files, "--time-offset", "estimate")
        self.assertAlmostEqual(report["time_offset_s"], -0.3, delta=0.005)
        self.assertLess(report["found_time_offset"]["standard_error_s"], 0.005)
        self.assertEqual(self.align(*files, "--time-offset", -0.3)["time_offset_s"], -0.3)
        self.clear()
        self.refused(USAGE, ["--time-offset: two seconds is neither"], *files, "--time-offset", "two seconds")
        far = self.pair(source, moved(place(self.times)), self.times + 1000, self.times)
        self.refused(UNSUPPORTED, ["the times do not meet", "--time-offset estimate"], *far)
        self.align(*far, "--time-offset", "estimate")
        self.clear()
        straight = np.outer(3 * self.times, [1, 0, 0]) + noise(400, 0.01, 1)
        self.refused(UNSUPPORTED, ["the offset between the clocks is not determined"],
                     *self.pair(straight, straight + noise(400, 0.01, 2)), "--time-offset", "estimate")

    def test_pairings(self):
        files = self.pair(place(self.times) + noise(400, 0.01, 1), moved(place(self.times - 0.004)), self.times, self.times - 0.004)
        by_name = {}
        for pairing in ("interpolated", "nearest"):
            report = self.align(*files, "--pairing", pairing, tolerance_m=0.03)
            self.assertEqual([row["pairing"] for row in report["ate"]][0], pairing)
            self.assertEqual(report["rmse_m"], report["ate"][0]["rmse_m"])
            by_name[pairing] = sorted((row["pairing"], row["n_pairs"], row["rmse_m"]) for row in report["ate"])
        self.assertEqual(by_name["interpolated"], by_name["nearest"], "each result tells both")
        self.clear()
        self.refused(UNSUPPORTED, ["--max-difference"], *files, "--pairing", "nearest", "--max-difference", 0.003)

    def test_without_a_method_files_of_poses_are_trajectories(self):
        said = "both files hold poses: they are aligned as --method trajectory does"
        self.align(*self.pair(place(self.times), moved(place(self.times))), says=[said], method=False)

        def euroc(times, points):
            head = "#timestamp,p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []\n"
            return head + "".join("%d,%.9f,%.9f,%.9f,1,0,0,0\n" % (round(t * 1e9), *p) for t, p in zip(times, points))

        def kitti(_, points):
            return "".join("1 0 0 %.9f 0 1 0 %.9f 0 0 1 %.9f\n" % tuple(p) for p in points)

        for write in (euroc, kitti):
            self.align(*self.pair(place(self.times), moved(place(self.times)), write=write), says=[said], method=False)
        result = self.run_program(*self.pair(place(self.times), place(self.times)), "--voxel", 0.2, method=False)
        self.assertEqual(result.returncode, USAGE)
        self.assertIn("--voxel has no meaning for --method trajectory", result.stderr)

    def test_clouds_of_eight_columns_are_clouds(self):
        """Sorted along x, with normals and a curvature, or color and more: no times and quaternions."""
        random = np.random.default_rng(1)
        points = random.uniform(0, 20, (4000, 3))
        points[:, 2] = np.sin(points[:, 0]) + np.cos(points[:, 1])
        points = points[np.argsort(points[:, 0])]
        normals = random.normal(size=(4000, 3))
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        curvature = np.column_stack([points, np.ones(4000), normals, np.zeros(4000)])
        colored = np.column_stack([points, random.integers(0, 255, (4000, 5))])
        for rows in (curvature, colored):
            path = self.inputs / "cloud.txt"
            np.savetxt(path, rows, fmt="%.6g")
            result = self.run_program(path, path, method=False)
            self.assertNotIn("poses", result.stderr)
            self.assertNotIn("trajectory", result.stdout)
        trajectory, _ = self.pair(place(self.times), place(self.times))
        result = self.run_program(trajectory, TOWN / "reference.ply", method=False)
        self.assertEqual(result.returncode, INPUT, "one of poses and one of points")
        self.assertIn("--method trajectory", result.stderr)

    def test_cmap_eval_carries_the_verdict_and_refuses_to_score(self):
        maps = [self.inputs / "reference.ply", self.inputs / "estimate.ply"]
        points = np.random.default_rng(1).uniform(0, 10, (3000, 3))
        maps[0].write_text(ply(moved(points).tolist(), kind="double"))
        maps[1].write_text(ply(points.tolist(), kind="double"))

        def evaluate(files, *arguments):
            report = self.outputs / "report.json"
            result = subprocess.run([EVAL, *maps, "--align", "trajectory", "--est-trajectory", files[0], "--ref-trajectory", files[1],
                                     "-o", report, *map(str, arguments)], capture_output=True, text=True, timeout=60)
            if result.returncode != 0:
                self.assertFalse(report.exists())
                return result, None
            report = json.loads(report.read_text())
            if jsonschema:
                jsonschema.validate(report, SCHEMA)
            return result, report

        files = self.pair(place(self.times), moved(place(self.times)))
        result, report = evaluate(files)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(report["alignment"]["registration"]["verdict"], "determined")
        self.assertIn("(determined, scale error", result.stdout)
        self.assertLess(report["metrics"]["chamfer"]["value"], 1e-6)
        files = self.pair(place(self.times) * [1, -1, 1], moved(place(self.times)))
        (self.outputs / "report.json").unlink()
        result, _ = evaluate(files)
        self.assertEqual(result.returncode, UNSUPPORTED)
        self.assertIn("the alignment is mirrored", result.stderr)
        result, report = evaluate(files, "--allow-unconverged")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(report["alignment"]["registration"]["verdict"], "mirrored")
        self.assertIn("mirrored", " ".join(w["message"] for w in report["warnings"] if w["id"] == "alignment"))


if __name__ == "__main__":
    unittest.main()

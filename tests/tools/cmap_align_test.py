#!/usr/bin/env python3
"""cmap_align as a user runs it; CTest sets CMAP_ALIGN, CMAP_EVAL and CMAP_SOURCE_DIR."""

import json
import math
import os
import re
import shlex
import subprocess
import unittest
from pathlib import Path

import numpy as np

from cmap_eval_testing import INPUT, PROGRAM as EVAL, SOURCE, TOWN, UNSUPPORTED, USAGE, WithFolders, hashes, ply

PROGRAM = Path(os.environ["CMAP_ALIGN"]).resolve()
REFERENCE, ESTIMATE = TOWN / "reference.ply", TOWN / "estimate.ply"


def methods_from_a_start():
    """As --help lists them, down to those that are no registration from a start."""
    text = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, check=True).stdout
    rows = re.findall(r"^  (\w+)  +\S", text.split("Methods, from", 1)[1].split("Usage:", 1)[0], re.MULTILINE)
    return [name for name in rows if name not in ("global", "tanksandtemples", "trajectory")]


def read_ascii_or_binary(path):
    """Positions of the sample town's binary PLY files: float x y z first, uchar colors after."""
    data = path.read_bytes()
    head, body = data.split(b"end_header\n", 1)
    n = int(next(line for line in head.split(b"\n") if line.startswith(b"element vertex")).split()[-1])
    record = np.frombuffer(body, np.uint8).reshape(n, -1)
    return record[:, :12].copy().view("<f4").astype(float)


def similarity(angle, scale, shift):
    T = np.eye(4)
    c, s = math.cos(angle), math.sin(angle)
    T[:3, :3] = scale * np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    T[:3, 3] = shift
    return T


def plane(n, z=0.0):
    random = np.random.default_rng(1)
    return ply([(x, y, z) for x, y in random.uniform(0, 10, (n, 2))])


class Align(WithFolders):
    def setUp(self):
        super().setUp()
        self.matrix, self.json = self.outputs / "T.txt", self.outputs / "result.json"

    def input(self, name, content):
        path = self.inputs / name
        path.write_text(content)
        return path

    def moved_town(self, T):
        points = (read_ascii_or_binary(REFERENCE) - T[:3, 3]) @ np.linalg.inv(T[:3, :3]).T
        return self.input("moved.ply", ply(points.tolist(), kind="double"))

    def run_program(self, *arguments):
        before = hashes(self.inputs)
        result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=600)
        self.assertEqual(hashes(self.inputs), before, "inputs are never changed")
        return result

    def align(self, *arguments):
        result = self.run_program(*arguments, "-o", self.matrix, "--json", self.json)
        self.assertEqual(result.returncode, 0, result.stderr)
        T = np.loadtxt(self.matrix)
        report = json.loads(self.json.read_text())
        self.assertTrue(np.allclose(report["T_dst_src"], T, rtol=1e-15, atol=0))
        self.assertIn(f"method      {report['method']}", result.stdout)
        return T, report

    def refused(self, code, says, *arguments):
        result = self.run_program(*arguments, "-o", self.matrix, "--json", self.json)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertTrue(result.stderr.startswith("cmap_align: "), result.stderr)
        self.assertIn(says, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(os.listdir(self.outputs), [], "nothing is left behind")

    def expect_same(self, T, truth, tolerance_m):
        """On the corners of a 40 m cube."""
        corners = np.array([[x, y, z] for x in (-20, 20) for y in (-20, 20) for z in (-20, 20)], float)
        moved = [corners @ M[:3, :3].T + M[:3, 3] for M in (T, truth)]
        self.assertLess(np.abs(moved[0] - moved[1]).max(), tolerance_m)

    def test_methods_recover_a_motion(self):
        truth = similarity(0.01, 1.0, (0.1, -0.2, 0.05))
        moved = self.moved_town(truth)
        # A copy, but thinned on another lattice; points alone slide along surfaces by parts of their spacing.
        tolerances_m = {"icp": 0.1, "sim3": 0.05}
        self.assertLessEqual(set(tolerances_m), set(methods_from_a_start()))
        for method in methods_from_a_start():
            with self.subTest(method):
                T, report = self.align(moved, REFERENCE, "--method", method)
                self.expect_same(T, truth, tolerances_m.get(method, 0.02))
                self.assertGreater(report["overlap"], 0.95)
                self.assertGreater(report["condition"], 0.01)

    def test_global_needs_no_start(self):
        truth = similarity(2.0, 1.2, (50, -30, 5))
        moved = self.moved_town(truth)
        T, report = self.align(moved, REFERENCE, "--method", "global", "--scale")
        self.expect_same(T, truth, 0.05)
        self.assertLess(abs(report["scale"] / 1.2 - 1), 1e-3)

    def test_the_transform_serves_cmap_eval(self):
        truth = similarity(0.02, 1.0, (0.3, 0.1, 0))
        moved = self.moved_town(truth)
        self.align(moved, REFERENCE)
        report = self.outputs / "report.json"
        subprocess.run([EVAL, REFERENCE, moved, "--transform", self.matrix, "-o", report, "--quiet"], check=True)
        self.assertLess(json.loads(report.read_text())["metrics"]["rmse"]["value"], 0.02)

    def test_initial(self):
        truth = similarity(1.0, 1.0, (500, 0, 0))
        moved = self.moved_town(truth)
        np.savetxt(self.inputs / "T0.txt", similarity(1.005, 1.0, (500.1, 0, 0)))
        T, _ = self.align(moved, REFERENCE, "--initial", self.inputs / "T0.txt", "--voxel", 0.3, "--max-distance", 3)
        self.expect_same(T, truth, 0.05)
        self.matrix.unlink(), self.json.unlink()
        self.refused(UNSUPPORTED, "no overlap", moved, REFERENCE)

    def test_tanks_and_temples(self):
        T, report = self.align(REFERENCE, REFERENCE, "--method", "tanksandtemples", "--tau", 0.2)
        self.assertEqual((report["precision"], report["recall"], report["f_score"]), (1, 1, 1))
        self.expect_same(T, np.eye(4), 1e-6)
        self.matrix.unlink(), self.json.unlink()
        self.refused(USAGE, "--tau", REFERENCE, REFERENCE, "--method", "tanksandtemples")

    def test_trajectories(self):
        def tum(T, times):
            rows = []
            for t in times:
                p = T[:3, :3] @ (5 * math.cos(t), 5 * math.sin(t), math.sin(2 * t)) + T[:3, 3]
                rows.append(" ".join(map(repr, (float(t), *map(float, p), 0.0, 0.0, 0.0, 1.0))))
            return "\n".join(rows) + "\n"

        truth = similarity(0.5, 2.0, (1, 2, 3))
        source = self.input("source.tum", tum(np.eye(4), np.arange(0, 6, 0.1)))
        target = self.input("target.tum", tum(truth, np.arange(0, 6, 0.1)))
        T, report = self.align(source, target, "--method", "trajectory")
        self.expect_same(T, truth, 1e-9)
        self.assertEqual(report["method"], "trajectory-sim3")
        self.matrix.unlink(), self.json.unlink()
        late = self.input("late.tum", tum(truth, np.arange(100, 106, 0.1)))
        self.refused(UNSUPPORTED, "the times do not meet", source, late, "--method", "trajectory")
        broken = self.input("broken.tum", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 1\n")
        self.refused(INPUT, f"{broken}: line 2", source, broken, "--method", "trajectory")

    def test_layouts_of_trajectories(self):
        """One path, and the same moved, in whatever layout: the same transform, and what was decided is said."""
        truth = similarity(0.5, 1.0, (1, 2, 3))
        times = 1700000000 + np.arange(0, 6, 0.125)
        path = np.stack([5 * np.cos(times), 5 * np.sin(times), np.sin(2 * times)], 1)
        moved = path @ truth[:3, :3].T + truth[:3, 3]

        def rows(positions, stamp, row):
            return "".join(row.format(t=stamp(t), x=p[0], y=p[1], z=p[2]) for t, p in zip(times, positions.tolist()))

        tum = "{t} {x!r} {y!r} {z!r} 0 0 0 1\n"
        target = self.input("target.tum", rows(moved, float, tum))
        euroc = "#timestamp,p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []\r\n" + rows(
            path, lambda t: round(t * 1000) * 10**6, "{t},{x!r},{y!r},{z!r},1,0,0,0\r\n")
        lost = rows(path, float, tum) + "1800000000 nan nan nan nan nan nan nan\n"
        kitti = self.input("kitti.txt", rows(path, float, "1 0 0 {x!r} 0 1 0 {y!r} 0 0 1 {z!r}\n"))
        stamps = self.input("times.txt", rows(path, float, "{t!r}\n"))
        for source, arguments, said in (
            (self.input("source.csv", euroc), (), "times are read as nanoseconds"),
            (self.input("lost.tum", lost), (), "1 of 49 rows left out: not finite"),
            (self.input("bom.tum", "\ufeff" + rows(path, float, tum)), (), ""),
            (kitti, ("--times", stamps), ""),
        ):
            with self.subTest(source.name):
                T, report = self.align(source, target, "--method", "trajectory", "--fit", "se3", *arguments)
                self.expect_same(T, truth, 1e-6)
                self.assertIn(said, " ".join(report["warnings"]))
                if not said:
                    self.assertEqual(report["warnings"], [])
        self.matrix.unlink(), self.json.unlink()
        self.refused(INPUT, "--times FILE gives them", kitti, target, "--method", "trajectory")
        self.refused(USAGE, "--times has no meaning", REFERENCE, REFERENCE, "--times", stamps)
        moved_kitti = self.input("moved.txt", rows(moved, float, "1 0 0 {x!r} 0 1 0 {y!r} 0 0 1 {z!r}\n"))
        T, report = self.align(kitti, moved_kitti, "--method", "trajectory", "--fit", "se3")
        self.expect_same(T, truth, 1e-6)
        self.assertIn("paired row by row", " ".join(report["warnings"]))

    def test_what_cannot_be_determined(self):
        flat = self.input("flat.ply", plane(2000))
        line = self.input("line.ply", ply([(x / 10, 0, 0) for x in range(500)]))
        two = self.input("two.ply", ply([(0, 0, 0), (1, 0, 0)]))
        for method in methods_from_a_start():
            with self.subTest(method):
                self.refused(UNSUPPORTED, "translation along (", flat, flat, "--method", method)
                self.refused(UNSUPPORTED, "", line, line, "--method", method, "--voxel", 0.1)
                self.refused(UNSUPPORTED, "", two, two, "--method", method)
        self.refused(UNSUPPORTED, "collinear: the rotation about (1.00, 0.00, 0.00)", line, line, "--method", "icp")

    def test_bad_input(self):
        missing = self.inputs / "none.ply"
        self.refused(INPUT, str(missing), missing, REFERENCE)
        self.refused(INPUT, str(missing), REFERENCE, missing)
        shear = self.input("shear.txt", "1 0.5 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")
        self.refused(INPUT, f"{shear}: ", REFERENCE, REFERENCE, "--initial", shear)

    def test_wrong_usage(self):
        self.refused(USAGE, "--method", REFERENCE, REFERENCE, "--method", "best")
        self.refused(USAGE, "--voxel", REFERENCE, REFERENCE, "--voxel", -1)
        self.refused(USAGE, "--tau has no meaning for --method gicp", REFERENCE, REFERENCE, "--tau", 1)
        self.refused(USAGE, "--scale has no meaning for --method sim3", REFERENCE, REFERENCE, "--method", "sim3", "--scale")
        self.refused(USAGE, "--finest has no meaning beside --voxel", REFERENCE, REFERENCE, "--voxel", 1, "--finest", 0.1)
        result = self.run_program(REFERENCE, REFERENCE, "-o", "/none/T.txt")
        self.assertEqual(result.returncode, USAGE)
        flat = self.input("flat.ply", plane(100))
        result = self.run_program(flat, REFERENCE, "-o", flat)
        self.assertEqual(result.returncode, USAGE)
        self.assertIn("would overwrite", result.stderr)

    def test_the_same_for_any_number_of_threads(self):
        outputs = [self.run_program(ESTIMATE, REFERENCE, "--threads", n).stdout for n in (1, 2, 4)]
        self.assertEqual(outputs[0], outputs[1])
        self.assertEqual(outputs[0], outputs[2])

    def test_the_example_of_the_help_runs(self):
        text = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, check=True).stdout
        command = shlex.split(text.split("Example:\n")[1].splitlines()[0])
        self.assertEqual(command[0], "cmap_align")
        (self.outputs / "data_samples").symlink_to(SOURCE / "data_samples")
        subprocess.run([PROGRAM, *command[1:]], cwd=self.outputs, check=True, capture_output=True)
        self.assertEqual(np.loadtxt(self.matrix).shape, (4, 4))


if __name__ == "__main__":
    unittest.main()

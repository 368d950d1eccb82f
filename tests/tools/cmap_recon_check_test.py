#!/usr/bin/env python3
"""cmap_recon CAPTURE --check: every fault of a spoiled capture in one run. CTest sets CMAP_RECON and CMAP_SIMULATE."""

import json
import shutil
import subprocess
import unittest

import numpy as np
from recon_testing import DONE, INPUT, PROGRAM, USAGE, CaptureCase, edit_json, lines_kept, swapped, times_moved


class Check(CaptureCase):
    def check(self, *arguments, code=INPUT):
        """The lines that --check prints, each fault and warning without the folder of the capture."""
        before = self.tree()
        result = subprocess.run([PROGRAM, self.capture, "--check", *arguments], capture_output=True, text=True)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertEqual(self.tree(), before, "nothing is written")
        return result.stdout.replace(f"{self.capture}/", "").splitlines(), result.stderr

    def tree(self):
        return sorted(path.relative_to(self.folder).as_posix() for path in self.folder.rglob("*"))

    def faults(self, *expected, arguments=()):
        """Exactly these faults, in this order: each named by file, then by place and reason."""
        lines, _ = self.check(*arguments)
        found = [line.removeprefix("fault: ") for line in lines if line.startswith("fault: ")]
        self.assertEqual(len(found), len(expected), "\n".join(lines))
        for text, parts in zip(found, expected):
            self.assertTrue(text.startswith(parts[0]), f"{parts[0]} expected: {text}")
            for part in parts[1:]:
                self.assertIn(part, text)
        self.assertTrue(lines[-1].startswith(f"{len(expected)} fault{'s' if len(expected) > 1 else ''}, "), lines[-1])
        return lines

    def warnings(self, lines, *expected):
        """These are among the warnings, each named by file, then by place and reason."""
        found = [line.removeprefix("warning: ") for line in lines if line.startswith("warning: ")]
        for parts in expected:
            self.assertTrue(any(text.startswith(parts[0]) and all(part in text for part in parts[1:])
                                for text in found), f"{parts} expected:\n" + "\n".join(lines))

    def edit(self, name, old, new):
        path = self.capture / name
        text = path.read_text()
        self.assertIn(old, text)
        path.write_text(text.replace(old, new, 1))

    def change_camera(self, **values):
        path = self.capture / "capture.json"
        edit_json(path, camera={**json.loads(path.read_text())["camera"], **values})

    # Good captures.

    def test_nothing_wrong(self):
        lines, errors = self.check(code=DONE)
        self.assertEqual(lines, ["0 faults, 0 warnings: 4 sessions of 21 frames, 85 poses, 84 scans, 15 pictures"])
        self.assertEqual(errors, "")
        self.assertEqual(self.check("--quiet", code=DONE)[0], [])
        for k in range(4):
            self.pack(k)
        self.assertTrue(self.check(code=DONE)[0][-1].startswith("0 faults, 0 warnings"))

    def test_what_a_run_does_not_need_may_be_missing(self):
        for name in ("images", "lidar"):
            shutil.rmtree(self.capture / name)
            (self.capture / f"{name}.csv").unlink()
        (self.capture / "imu.csv").unlink()
        self.faults(("lidar.csv: no such file",))
        self.check("--registration", "prefusion", code=DONE)
        self.check("--stop-after", "prefusion", code=DONE)

    def test_warnings_are_no_faults(self):
        self.change(1, "depth_conf", lambda confidence: confidence[0, 0, :2].fill(0.5))
        self.change_camera(K=[110, 110, 300, 200])
        lines_kept(self.capture / "lio.tum", lambda row: float(row.split()[0]) > self.times(0)[0] + 0.1)
        lines, _ = self.check(code=DONE)
        self.assertIn("warning: capture.json: camera.K: cx, cy = 300, 200 are not near the middle", lines[0])
        self.assertIn("session_0001/depth_conf.npy: 2 of 23520 confidences are below 1", lines[2])
        self.assertIn("session_0000: 1 of 6 frames have no LiDAR-inertial pose within 0.15 s", lines[1])
        self.assertIn("lidar.csv: ", lines[3])
        self.assertTrue(lines[-1].startswith("0 faults, 4 warnings"))

    def test_scans_that_miss_a_session(self):
        lines_kept(self.capture / "lidar.csv", lambda row: float(row.split(",")[0]) < self.times(3)[0] - 2)
        lines, _ = self.check(code=DONE)
        self.assertIn("warning: predictions/session_0003: no scan at its time", lines[0])

    def test_pictures_of_another_camera(self):
        self.change_camera(width=320, K=[110, 110, 160, 60])
        lines, _ = self.check(code=DONE)
        self.assertIn("its pictures were 160 x 120 pixels", lines[0])
        self.assertIn("but capture.json's camera has 320 x 120", lines[0])

    def test_usage(self):
        result = subprocess.run([PROGRAM, "--check"], capture_output=True, text=True)
        self.assertEqual(result.returncode, USAGE)
        result = subprocess.run([PROGRAM, self.folder / "nowhere", "--check"], capture_output=True, text=True)
        self.assertEqual(result.returncode, INPUT)
        self.assertIn("nowhere: is no folder", result.stdout)

    # All but one file is missing.

    def test_everything_missing_but_one_file(self):
        calibration, lidar = ("capture.json: no such file",), ("lidar.csv: no such file",)
        lio, predictions = ("lio.tum: no such file",), ("predictions: no sessions",)
        frames = ("predictions/session_0000/depth.npy: no such file",)
        arrays = tuple((f"predictions/session_0000/{name}: no such file",) for name in
                       ("meta.json", "frames.csv", "depth_conf.npy", "images.npy", "extrinsic.npy", "intrinsic.npy"))
        for kept, expected in (("capture.json", (lidar, lio, predictions)),
                               ("lio.tum", (calibration, lidar, predictions)),
                               ("imu.csv", (calibration, lidar, lio, predictions)),
                               ("images.csv", (calibration, lidar, lio, predictions)),
                               ("lidar.csv", (calibration, *[("lidar.csv: line",)] * 11, lio, predictions)),
                               ("predictions/session_0000/images.npy",
                                (calibration, lidar, lio, frames, *arrays[:3], *arrays[4:]))):
            shutil.rmtree(self.capture)
            (self.capture / kept).parent.mkdir(parents=True)
            shutil.copy(self.simulated / kept, self.capture / kept)
            with self.subTest(kept):
                self.faults(*expected)
        shutil.rmtree(self.capture)
        self.capture.mkdir()
        self.faults(calibration, lidar, lio, predictions)

    # Twenty spoiled captures: every fault of each in one run.

    def test_01_calibration(self):
        text = json.loads((self.capture / "capture.json").read_text())
        text["camera"]["model"] = "omni"
        text["T_imu_lidar"][0][0] += 1.0
        text["T_cam"] = text.pop("T_lidar_camera")
        (self.capture / "capture.json").write_text(json.dumps(text))
        self.faults(("capture.json: ", "unknown key \"T_cam\"", "key \"T_lidar_camera\" is missing"),
                    ("capture.json: ", 'camera.model is "omni"'), ("capture.json: ", "T_imu_lidar: no rotation"))

    def test_02_calibration_that_is_no_json(self):
        self.edit("capture.json", "{", "")
        (self.capture / "lio.tum").unlink()
        self.faults(("capture.json: ", "parse error"), ("lio.tum: no such file",))

    def test_03_pictures_that_are_not_there(self):
        for k in (3, 7):
            (self.capture / f"images/{k:06}.jpg").unlink()
        lines, _ = self.check(code=DONE)
        self.warnings(lines, ("images.csv: line 5: ", "000003.jpg is no file; the run goes on without"),
                      ("images.csv: line 9: ", "000007.jpg is no file"))
        shutil.rmtree(self.capture / "images")
        lines, _ = self.check("--registration", "prefusion", code=DONE)
        self.warnings(lines, ("images.csv: line 2: ", "000000.jpg is no file"))

    def test_04_scans(self):
        (self.capture / "lidar/000002.pcd").unlink()
        scan = self.capture / "lidar/000030.pcd"
        scan.write_bytes(scan.read_bytes()[:300])
        (self.capture / "lidar/000031.pcd").write_text("")
        self.faults(("lidar.csv: line 4: ", "000002.pcd is no file"), ("lidar/000030.pcd: truncated",),
                    ("lidar/000031.pcd: the file is empty",))
        lines, _ = self.check("--registration", "prefusion", code=DONE)
        self.warnings(lines, ("lidar.csv: line 4: ", "000002.pcd is no file"), ("lidar/000030.pcd: truncated",))

    def test_05_times_out_of_order(self):
        swapped(self.capture / "lidar.csv", 5)
        swapped(self.capture / "imu.csv", 9)
        swapped(self.session(2) / "frames.csv", 2, column=1)
        lines = self.faults(("lidar.csv: line 7: ", "is not after"),
                            ("predictions/session_0002/frames.csv: line 4: ", "is not after"))
        self.warnings(lines, ("imu.csv: rows were out of order and are sorted",))

    def test_06_clocks_of_frames(self):
        times_moved(self.session(1) / "frames.csv", 1, 1e6)
        times_moved(self.session(3) / "frames.csv", 1, 0.3)
        self.faults(("predictions/session_0001: no frame has a LiDAR-inertial pose", "gaps of at most 0.15 s"),
                    ("predictions/session_0001: frame 0", "images.csv has this picture at"),
                    ("predictions/session_0003: frame 0", "images.csv has this picture at"))

    def test_07_poses_of_another_drive(self):
        rows = [row.split(" ", 1) for row in (self.capture / "lio.tum").read_text().splitlines() if row[0] != "#"]
        (self.capture / "lio.tum").write_text("".join(f"{float(time) + 900} {pose}\n" for time, pose in rows))
        self.faults(*[(f"predictions/session_{k:04}: no frame has", "the poses from 9") for k in range(4)],
                    ("lidar.csv: 84 of 84 scans have no LiDAR-inertial pose", "poses from 9"))

    def test_08_poses_that_are_none(self):
        (self.capture / "lio.tum").write_text("moon\n")
        (self.session(0) / "depth_conf.npy").unlink()
        self.faults(("lio.tum: ",), ("predictions/session_0000/depth_conf.npy: no such file",))

    def test_09_arrays_cut_short(self):
        for k, name in ((0, "depth"), (1, "images"), (1, "extrinsic")):
            path = self.session(k) / f"{name}.npy"
            path.write_bytes(path.read_bytes()[:200])
        self.faults(*[(f"predictions/session_{k:04}/{name}.npy: truncated",)
                      for k, name in ((0, "depth"), (1, "images"), (1, "extrinsic"))])

    def test_10_arrays_of_other_shapes(self):
        self.change(0, "images", lambda images: images[:, :-14])
        self.change(0, "extrinsic", lambda poses: poses[:-1])
        self.change(2, "depth_conf", lambda confidence: confidence[:, :, :-1])
        self.faults(("predictions/session_0000/images.npy: has the shape (6, 42, 70, 3)",),
                    ("predictions/session_0000/extrinsic.npy: has the shape (5, 3, 4)",),
                    ("predictions/session_0002/depth_conf.npy: has the shape (6, 56, 69)",))

    def test_11_numbers_that_are_none(self):
        self.change(0, "depth", lambda depth: depth[2, 3].fill(-1.0))
        self.change(0, "extrinsic", lambda poses: poses[4].fill(np.nan))
        self.change(1, "depth", lambda depth: depth.fill(np.nan))
        self.change(2, "depth_conf", lambda confidence: confidence.fill(1.0))
        self.faults(("predictions/session_0000/depth.npy: -1 at frame 2, row 3, column 0",),
                    ("predictions/session_0000/extrinsic.npy: frame 4: no rotation",),
                    ("predictions/session_0001/depth.npy: no pixel has",),
                    ("predictions/session_0002: no pixel has a confidence of 1.5 or more",))

    def test_12_pictures_of_other_ranges(self):
        self.change(0, "images", lambda images: images.astype(np.float32))
        self.change(1, "images", lambda images: images.astype(np.float32) / 127.5 - 1.0)
        self.faults(("predictions/session_0000/images.npy: holds ", "are these 0 to 255? Divide by 255"),
                    ("predictions/session_0001/images.npy: holds -", "are these -1 to 1?"))

    def test_13_intrinsics_of_the_camera_itself(self):
        for k in range(3):
            self.change(k, "intrinsic", lambda cameras: cameras * np.array([[160 / 70], [120 / 56], [1.0]]))
        self.faults(*[(f"predictions/session_{k:04}/intrinsic.npy: frame 0: ", "of one of about 160 x 120",
                       "a picture of 70 x 56 pixels") for k in range(3)])

    def test_14_poses_turned_around(self):
        def inverted(poses):
            return np.array([np.linalg.inv(np.vstack([pose, [0, 0, 0, 1]]))[:3] for pose in poses])

        self.change(0, "extrinsic", inverted)
        self.change(1, "extrinsic", lambda poses: np.diag([1.0, -1.0, -1.0]) @ poses)
        self.faults(("predictions/session_0000: extrinsic: ", "camera-to-world"),
                    ("predictions/session_0001: extrinsic: ", "OpenGL's axes"))

    def test_15_descriptions_of_sessions(self):
        edit_json(self.session(0) / "meta.json", pose_convention="opengl_world_from_cam", frames=7)
        (self.session(1) / "meta.json").unlink()
        self.edit("predictions/session_0002/frames.csv", "index", "number")
        self.faults(("predictions/session_0000/meta.json: frames is 7",),
                    ("predictions/session_0000/meta.json: pose_convention is \"opengl_world_from_cam\"",),
                    ("predictions/session_0001/meta.json: no such file",),
                    ("predictions/session_0002/frames.csv: line 1: the columns",))

    def test_16_one_table_of_frames_for_several_npz(self):
        for k in range(3):
            self.pack(k)
        folder = self.capture / "predictions"
        (folder / "session_0001.frames.csv").unlink()
        (folder / "session_0002.frames.csv").rename(folder / "frames.csv")
        self.faults(("predictions/frames.csv: of which session?", "session_0001.frames.csv, session_0002.frames.csv"),
                    ("predictions/session_0001.frames.csv: no such file",),
                    ("predictions/session_0002.frames.csv: no such",))

    def test_17_a_table_of_frames_copied(self):
        shutil.copy(self.session(0) / "frames.csv", self.session(1) / "frames.csv")
        self.faults(("predictions/session_0001: has the very times of", "session_0000"))

    def test_18_an_archive_that_is_none(self):
        self.pack(0)
        self.pack(1)
        archive = self.session(0).with_suffix(".npz")
        archive.write_bytes(archive.read_bytes()[:1000])
        with np.load(self.session(1).with_suffix(".npz")) as arrays:
            kept = {name: arrays[name] for name in arrays.files if name not in ("intrinsic", "images")}
        np.savez(self.session(1).with_suffix(".npz"), **kept)
        self.faults(("predictions/session_0000.npz: ",),
                    ("predictions/session_0001.npz: the member images.npy is missing",),
                    ("predictions/session_0001.npz: the member intrinsic.npy is missing",))

    def test_19_scans_of_another_clock(self):
        times_moved(self.capture / "lidar.csv", 0, 1e9)
        edit_json(self.capture / "capture.json", time_offset={"image_s": "0"})
        lines = self.faults(("capture.json: time_offset.image_s: ", "is no finite number"),
                            ("lidar.csv: 84 of 84 scans have no LiDAR-inertial pose", "scans from 1000000000.000"))
        self.assertEqual(sum("no scan at its time" in line for line in lines), 4)

    def test_20_rows_of_tables(self):
        self.edit("images.csv", "images/000004.jpg", "")
        self.edit("lidar.csv", "lidar/000004.pcd", "lidar/000004.pcd,7")
        self.edit("predictions/session_0003/frames.csv", "\n1,", "\n5,")
        self.edit("imu.csv", "\n0", "\nnan")
        lines = self.faults(("lidar.csv: line 6: 3 cells",), ("predictions/session_0003/frames.csv: line 3: index 5",))
        self.warnings(lines, ("images.csv: line 6: no file is named",), ("imu.csv: line 2: timestamp_s is 'nan", ))


if __name__ == "__main__":
    unittest.main()

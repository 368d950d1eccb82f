#!/usr/bin/env python3
"""cmap_recon as a user runs it, on good and on damaged captures; CTest sets CMAP_RECON, CMAP_SIMULATE and
CMAP_SOURCE_DIR. The preset is a straight line, so every run is one for a path without a bend, too."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "oracle"))
from ply import read_ply  # noqa: E402
from recon_testing import (DONE, INPUT, PROGRAM, UNSUPPORTED, USAGE, CaptureCase, edit_json, lines_kept, swapped,
                           times_moved)

SOURCE = Path(os.environ["CMAP_SOURCE_DIR"]).resolve()
DATA = Path(os.environ.get("CMAP_DATA_DIR", SOURCE / "../shared/data"))
SANITIZED = "-fsanitize" in os.environ.get("CMAP_CXX_FLAGS", "")

# Session scales from so few frames: VGGT's path, bent by some percent, and 3 frames at the end.
SCALE_TOLERANCE = 0.06
RESULTS = ("map.ply", "trajectory.tum", "sessions.json", "report.json")


class Recon(CaptureCase):
    def recon(self, *arguments, code=DONE, output=None, capture=None):
        command = [PROGRAM, capture or self.capture, "-o", output or self.output, "--quiet", *arguments]
        result = subprocess.run([str(argument) for argument in command], capture_output=True, text=True)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(result.stdout, "")
        return result.stderr

    def refused(self, code, *says, arguments=()):
        """Ends with this code, a message of one line that says this, and no results."""
        message = self.recon(*arguments, code=code)
        for part in says:
            self.assertIn(part, message)
        for name in RESULTS:
            self.assertFalse((self.output / name).is_file(), name)

    def sessions(self, output=None):
        found = json.loads(((output or self.output) / "sessions.json").read_text())["sessions"]
        return {session["name"]: session for session in found}

    def keep_frames(self, k, frames):
        for path in self.session(k).glob("*.npy"):
            np.save(path, np.load(path)[frames])
        table = self.session(k) / "frames.csv"
        header, *rows = table.read_text().splitlines()
        rows = [f"{i},{rows[frame].split(',', 1)[1]}" for i, frame in enumerate(frames)]
        table.write_text("\n".join([header, *rows]) + "\n")
        meta = self.session(k) / "meta.json"
        meta.write_text(json.dumps({**json.loads(meta.read_text()), "frames": len(frames)}))

    def check_scales(self, *ks, suffix=""):
        found = self.sessions()
        for k in ks:
            name = f"session_{k:04}"
            session = found[name + suffix]
            self.assertIsNone(session["dropped"])
            self.assertLess(abs(np.log(session["scale"] / self.truth[name])), SCALE_TOLERANCE, name)

    def check_dropped(self, k, reason):
        """Session k is left out with this reason, told on stderr; the others are as good as ever."""
        message = self.recon()
        name = f"session_{k:04}"
        self.assertIn(reason, self.sessions()[name]["dropped"])
        self.assertIn(f"warning: {name}: dropped: {self.sessions()[name]['dropped']}", message)
        self.check_scales(*(other for other in range(4) if other != k))
        self.assertIn(reason, (self.output / "report.json").read_text())

    def check_flag(self, k, flag, message):
        name = f"session_{k:04}"
        self.assertTrue(any(flag in text for text in self.sessions()[name]["flags"]), self.sessions()[name]["flags"])
        self.assertTrue(any(line.startswith(f"warning: {name}: ") and flag in line for line in message.splitlines()))

    # Good captures.

    def test_a_map_that_an_outside_reader_reads(self):
        self.assertEqual(self.recon("--evaluate", self.capture / "truth" / "map.ply"), "")
        self.check_scales(0, 1, 2, 3)
        header, points = (self.output / "map.ply").read_bytes().split(b"end_header\n", 1)
        n = int(header.split(b"element vertex ")[1].split()[0])
        self.assertGreater(n, 1000)
        self.assertEqual(len(points) % n, 0)
        found, truth = (np.loadtxt(path) for path in (self.output / "trajectory.tum",
                                                      self.capture / "truth" / "trajectory.tum"))
        self.assertEqual(len(found), len({time for k in range(4) for time in self.times(k)}))
        for axis in (1, 2, 3):
            error = found[:, axis] - np.interp(found[:, 0], truth[:, 0], truth[:, axis])
            self.assertLess(np.abs(error).max(), 0.5, "VGGT's drift within a session is a few percent of 10 m")
        report = json.loads((self.output / "report.json").read_text())
        self.assertEqual((report["map"]["points"], report["warnings"]), (n, []))
        self.assertEqual(json.loads((self.output / "evaluation.json").read_text())["schema"], "cmap.report/2")

    def test_same_bytes_again_and_for_any_number_of_threads(self):
        runs = {name: self.folder / name for name in ("one", "two", "again")}
        self.recon("--threads", 1, output=runs["one"])
        self.recon("--threads", 2, output=runs["two"])
        self.recon("--threads", 2, output=runs["again"])
        for name in ("map.ply", "trajectory.tum", "sessions.json"):
            self.assertEqual((runs["one"] / name).read_bytes(), (runs["two"] / name).read_bytes(), name)
            self.assertEqual((runs["again"] / name).read_bytes(), (runs["two"] / name).read_bytes(), name)

    def test_resume(self):
        whole = self.folder / "whole"
        self.recon(output=whole)
        expected = (whole / "map.ply").read_bytes()
        # In the capture's folder: what lies there of the results is no change of the inputs.
        self.output = self.capture / "map"
        self.recon("--stop-after", "registration")
        self.assertFalse((self.output / "map.ply").exists())
        stages = {path: path.read_bytes() for path in (self.output / "stages").iterdir()}
        written = {path: path.stat().st_mtime_ns for path in stages}
        self.recon("--resume")
        self.assertEqual((self.output / "map.ply").read_bytes(), expected)
        self.assertEqual({path: path.stat().st_mtime_ns for path in stages}, written, "taken, not found again")
        for found in ("truncated", {}, {"sessions": 1}, "no number"):
            for path, text in stages.items():
                stage = json.loads(text)
                if found == "no number":
                    stage["found"]["sessions"][0]["outcome"]["rmse_m"] = None
                else:
                    stage["found"] = found
                damaged = json.dumps(stage)
                path.write_text(damaged[:100] if found == "truncated" else damaged)
            self.recon("--resume")
            self.assertEqual((self.output / "map.ply").read_bytes(), expected, found)
        self.change(1, "depth", lambda depth: 1.01 * depth)
        self.recon("--resume")
        self.assertNotEqual((self.output / "map.ply").read_bytes(), expected, "the inputs have changed")

    def test_stop_after(self):
        for stage in ("prefusion", "registration", "posegraph"):
            self.recon("--stop-after", stage)
            self.check_scales(0, 1, 2, 3)
            self.assertFalse((self.output / "map.ply").exists())
        shutil.rmtree(self.output)
        self.refused(USAGE, "--evaluate",
                     arguments=("--stop-after", "prefusion", "--evaluate", self.capture / "truth" / "map.ply"))

    def test_only_session(self):
        self.recon("--only-session", 1)
        self.assertEqual(list(self.sessions()), ["session_0001"])
        self.check_scales(1)
        shutil.rmtree(self.output)
        self.refused(USAGE, "there is no session 9: the capture has 4", arguments=("--only-session", 9))
        self.refused(USAGE, "--only-session", arguments=("--only-session", -1))

    def test_registrations_and_presets(self):
        maps = set()
        for arguments in (("--registration", "prefusion"), ("--registration", "normal"), ("--registration", "paper"),
                          ("--registration", "robust"), ("--preset", "paper")):
            self.recon(*arguments)
            # Centers of shared frames, two of them, say little of the ratio of scales; so does a session of 3.
            self.check_scales(*((1, 2) if "--preset" in arguments else (0, 1, 2)))
            maps.add((self.output / "map.ply").read_bytes())
            if "prefusion" in arguments:
                self.assertEqual({session["scale_registration"] for session in self.sessions().values()}, {1.0})
        self.assertEqual(len(maps), 5)

    def test_options(self):
        self.refused(USAGE, 'unknown key "moon"', arguments=("--set", "moon=1"))
        self.refused(USAGE, "voting_draws", arguments=("--set", "voting_draws=1.5"))
        self.refused(USAGE, "fusion_voxel_m", arguments=("--set", "fusion_voxel_m=0"))
        self.refused(USAGE, "is not name=value", arguments=("--set", "moon"))
        self.refused(USAGE, "--registration", arguments=("--registration", "moon"))
        self.refused(USAGE, "--preset", arguments=("--preset", "moon"))
        self.refused(USAGE, "too small", arguments=("--set", "fusion_voxel_m=1e-9"))
        self.refused(UNSUPPORTED, "no world_points", arguments=("--set", "points=head"))

    def test_kitti(self):
        capture = DATA / "kitti_0009"
        if SANITIZED or not capture.is_dir():
            self.skipTest(f"{capture} is not there, or too slow with sanitizers")
        self.recon("--stop-after", "posegraph", capture=capture)
        truth = json.loads((capture / "truth" / "scales.json").read_text())["scales"]
        found = self.sessions()
        self.assertEqual(sorted(found), sorted(truth))
        for name, scale in truth.items():
            self.assertLess(abs(found[name]["scale"] / scale - 1.0), 0.02, name)

    def test_max_range_leaves_out_what_is_far_from_all_cameras(self):
        path = np.loadtxt(self.capture / "lio.tum")[:, 1:4]

        def farthest_m(*arguments):
            self.recon(*arguments)
            points, _ = read_ply(self.output / "map.ply")
            return max(np.linalg.norm(path - p, axis=1).min() for p in points)

        self.assertGreater(farthest_m(), 30)
        # A camera sits within a meter of the body, the map is within half a meter of where it should be.
        self.assertLess(farthest_m("--set", "fusion_max_range_m=8"), 9.5)

    def test_no_point_within_the_range_is_no_map(self):
        self.refused(UNSUPPORTED, "fusion_max_range_m, 0.01 m", arguments=("--set", "fusion_max_range_m=0.01"))

    def test_session_maps_are_the_parts_of_the_map(self):
        voxel_m = 0.1
        self.recon("--session-maps", "--set", "fusion_doubt=0", "--set", f"fusion_voxel_m={voxel_m}")
        maps = sorted((self.output / "sessions").iterdir())
        self.assertEqual([path.stem for path in maps], sorted(self.truth))
        voxels = {path: set(map(tuple, np.floor(read_ply(path)[0] / voxel_m).astype(int))) for path in
                  [self.output / "map.ply", *maps]}
        whole = voxels.pop(self.output / "map.ply")
        # A mean may lie within rounding of its voxel's border.
        self.assertLess(len(whole ^ set.union(*voxels.values())), 1e-3 * len(whole))
        for part in voxels.values():
            self.assertLess(len(part), 0.9 * len(whole))
        self.recon("--session-maps", "--only-session", "1")
        self.assertEqual([path.stem for path in (self.output / "sessions").iterdir()], ["session_0001"])
        self.recon("--session-maps", "--stop-after", "registration", code=USAGE)

    def test_session_map_that_cannot_be_written(self):
        (self.output / "sessions" / "session_0002.ply").mkdir(parents=True)
        self.refused(USAGE, "session_0002.ply: cannot be written: Is a directory", arguments=("--session-maps",))
        self.assertFalse((self.output / "stages").exists(), "said before anything is done")

    # Inputs that are missing.

    def test_stages_without_inputs(self):
        for missing, message in (("predictions", "predictions: no sessions"),
                                 ("lidar.csv", "lidar.csv: no such file"), ("lidar/000030.pcd", "lidar.csv: line 32"),
                                 ("capture.json", "capture.json: no such file")):
            path, aside = self.capture / missing, self.folder / "aside"
            path.rename(aside)
            self.refused(INPUT, message)
            aside.rename(path)
        lines_kept(self.capture / "lidar.csv", lambda row: False)
        self.refused(INPUT, "lidar.csv", "lists no file")

    def test_pictures_are_never_read(self):
        self.recon()
        expected = (self.output / "map.ply").read_bytes()
        for broken in ("images", "images.csv", "imu.csv"):
            path = self.capture / broken
            shutil.rmtree(path) if path.is_dir() else path.write_text("moon")
            self.recon()
            self.assertEqual((self.output / "map.ply").read_bytes(), expected, broken)
        (self.capture / "images.csv").unlink()
        self.recon()

    def test_scans_are_read_by_registration_alone(self):
        self.recon("--registration", "prefusion", "--set", "pose_graph=false")
        expected = (self.output / "map.ply").read_bytes()
        self.assertGreater(self.sessions()["session_0000"]["overlap"], 0.5)
        scan = self.capture / "lidar" / "000030.pcd"
        scan.write_bytes(scan.read_bytes()[:300])
        message = self.recon("--registration", "prefusion", "--set", "pose_graph=false")
        self.assertIn("not compared with the LiDAR: ", message)
        self.assertEqual((self.output / "map.ply").read_bytes(), expected)
        shutil.rmtree(self.capture / "lidar")
        message = self.recon("--registration", "prefusion", "--set", "pose_graph=false")
        self.assertIn("000000.pcd is no file; the run goes on without", message)
        (self.capture / "lidar.csv").unlink()
        self.assertEqual(self.recon("--registration", "prefusion", "--set", "pose_graph=false"), "")
        self.assertEqual((self.output / "map.ply").read_bytes(), expected)
        self.assertEqual({session["overlap"] for session in self.sessions().values()}, {None}, "not measured")
        self.assertEqual(self.recon("--registration", "prefusion", "--set", "pose_graph=false", "--resume"), "")
        self.recon("--registration", "prefusion")
        self.recon("--stop-after", "prefusion")
        shutil.rmtree(self.output)
        self.refused(INPUT, "lidar.csv: no such file")

    def test_damaged_scan(self):
        scan = self.capture / "lidar" / "000030.pcd"
        scan.write_bytes(scan.read_bytes()[:300])
        self.refused(INPUT, "000030.pcd: truncated")

    def test_most_sessions_broken(self):
        for k in range(2):
            (self.session(k) / "depth.npy").unlink()
        message = self.recon()  # half is enough
        self.assertEqual(message.count("dropped"), 2)
        self.check_scales(2, 3)
        shutil.rmtree(self.output)
        (self.session(2) / "depth.npy").unlink()
        self.refused(UNSUPPORTED, "3 of 4 sessions had to be dropped", "session_0000/depth.npy: no such file")

    def test_a_broken_session_is_dropped(self):
        depth = self.session(1) / "depth.npy"
        depth.write_bytes(depth.read_bytes()[:1000])
        self.check_dropped(1, "session_0001/depth.npy: truncated")

    # Sessions that do not say their scale.

    def test_few_sessions(self):
        self.remove_sessions(2, 3)
        self.recon()
        self.check_scales(0, 1)
        self.remove_sessions(1)
        self.recon()
        self.check_scales(0)

    def test_a_session_of_one_frame(self):
        self.keep_frames(1, [0])
        message = self.recon()
        self.check_flag(1, "no baseline", message)
        self.check_flag(2, "not linked to session_0001: no frame is shared", message)
        self.check_scales(0, 1, 2)  # 1 by the frame that it shares with 0

    def test_sessions_of_one_frame(self):
        for k in range(4):
            self.keep_frames(k, [0])
        self.refused(UNSUPPORTED, "no session has a baseline")

    def test_hovering(self):
        trajectory = self.capture / "lio.tum"
        header, first, *rest = trajectory.read_text().splitlines()
        pose = first.split(" ", 1)[1]
        trajectory.write_text("\n".join([header, first] + [f"{row.split()[0]} {pose}" for row in rest]) + "\n")
        self.refused(UNSUPPORTED, "no session has a baseline")

    def test_a_session_that_believes_to_hover(self):
        self.change(1, "extrinsic", lambda poses: np.repeat(poses[:1], len(poses), 0))
        message = self.recon()
        self.check_flag(1, "the scale is that of its neighbors", message)
        self.check_scales(0, 1, 2)

    def test_all_scales_outliers_but_two(self):
        for k, factor in ((1, 3.0), (2, 0.3)):
            self.change(k, "extrinsic", lambda poses: poses * np.array([1, 1, 1, factor]))
        message = self.recon()
        self.check_scales(0, 1, 2, 3)
        for k in (1, 2):
            self.check_flag(k, "of its path against", message)
            self.assertFalse(self.sessions()[f"session_{k:04}"]["scale_inlier"])
            # An undamaged session has 0.9; with the path left three times as long it was 0.57.
            self.assertGreater(self.sessions()[f"session_{k:04}"]["overlap"], 0.8)

    def test_no_frames_shared(self):
        self.keep_frames(1, [2, 3])
        self.keep_frames(3, [2])
        message = self.recon()
        self.check_scales(0, 1, 2)
        self.check_flag(1, "not linked to session_0000: no frame is shared", message)
        self.check_flag(1, "keeps the scale", message)
        self.check_flag(3, "the scale is the median of the others'", message)

    def test_lidar_misses_a_session(self):
        self.remove_sessions(2, 3)
        first, last = self.times(1)[0] - 1.5, self.times(1)[-1] + 1.5
        lines_kept(self.capture / "lidar.csv", lambda row: not first < float(row.split(",")[0]) < last)
        message = self.recon()
        self.check_flag(1, "the LiDAR has no points at the session's time", message)
        self.assertEqual(self.sessions()["session_0001"]["scale_registration"], 1.0)
        self.check_scales(0, 1)

    # Numbers that are none.

    def test_depths_that_are_none(self):
        for value in (0.0, np.nan, np.inf):
            self.change(1, "depth", lambda depth: depth[:, :10].fill(value))
            message = self.recon()
            self.check_flag(1, "4200 of 23520 pixels", message)
            self.check_scales(0, 1, 2, 3)
            self.assertNotIn(b"nan", (self.output / "sessions.json").read_bytes())

    def test_depths_all_none(self):
        self.change(1, "depth", lambda depth: depth.fill(np.nan))
        self.check_dropped(1, "session_0001/depth.npy: no pixel has a finite positive depth")

    def test_a_negative_depth(self):
        self.change(1, "depth", lambda depth: depth[2, 3].fill(-1.0))
        self.check_dropped(1, "session_0001/depth.npy: -1 at frame 2, row 3, column 0")

    def test_an_endless_depth(self):
        self.change(1, "depth", lambda depth: depth[2, 3, :5].fill(1e30))
        message = self.recon()
        self.check_flag(1, "5 of 23520 pixels are farther than 1000 median depths", message)
        self.check_scales(0, 1, 2, 3)

    def test_a_camera_out_of_this_world(self):
        self.change(1, "extrinsic", lambda poses: poses[3, 0, 3:].fill(1e300))
        self.check_dropped(1, "frame 3: its camera is inf median depths away")

    def test_extrinsics_that_are_no_rotation(self):
        self.change(1, "extrinsic", lambda poses: poses * np.array([1, 1, 1.1, 1]))
        self.check_dropped(1, "session_0001/extrinsic.npy: frame 0: no rotation")
        calibration = self.capture / "capture.json"
        double = [[2, 0, 0, 0], [0, 2, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1]]
        calibration.write_text(json.dumps({**json.loads(calibration.read_text()), "T_lidar_camera": double}))
        shutil.rmtree(self.output)
        self.refused(INPUT, "capture.json: T_lidar_camera: no rotation")

    def test_no_confidence(self):
        self.change(1, "depth_conf", lambda confidence: confidence.fill(1.0))
        self.check_dropped(1, "no pixel has a confidence of 1.5 or more")

    def test_images_of_another_size(self):
        self.change(1, "images", lambda images: images[:, :-14])
        self.check_dropped(1, "session_0001/images.npy: has the shape (6, 42, 70, 3)")

    def test_a_session_of_another_size(self):
        for name in ("depth", "depth_conf", "images"):
            self.change(1, name, lambda array: array[:, ::2, ::2].copy())
        self.change(1, "intrinsic", lambda cameras: cameras * np.array([[0.5], [0.5], [1]]))
        meta = self.session(1) / "meta.json"
        meta.write_text(json.dumps({**json.loads(meta.read_text()), "width": 35, "height": 28}))
        message = self.recon()
        self.check_flag(1, "not linked to session_0000: the pictures have other sizes", message)
        self.check_scales(0, 1, 2)

    # Times.

    def test_times_out_of_order(self):
        path = self.capture / "lidar.csv"
        good = path.read_text()
        swapped(path, 5)
        self.refused(INPUT, "lidar.csv: line 7: ", "is not after")
        path.write_text(good)
        swapped(self.session(1) / "frames.csv", 2, column=1)
        self.check_dropped(1, "session_0001/frames.csv: line 4: ")

    def test_gaps_in_the_poses(self):
        first, last = self.times(1)[2] - 0.2, self.times(1)[3] + 0.2
        lines_kept(self.capture / "lio.tum", lambda row: not first < float(row.split()[0]) < last)
        message = self.recon()
        self.check_flag(1, "2 of 6 frames have no LiDAR-inertial pose", message)
        self.check_scales(0, 1, 2, 3)

    def test_poses_of_another_time(self):
        first, last = self.times(1)[0], self.times(1)[-1]
        poses = [float(row.split()[0]) for row in (self.capture / "lio.tum").read_text().splitlines() if row[0] != "#"]
        times_moved(self.session(1) / "frames.csv", 1, 1e6)
        self.check_dropped(1, "no frame has a LiDAR-inertial pose at its time: the frames are from "
                              f"{first + 1e6:.3f} to {last + 1e6:.3f} s, the poses from {poses[0]:.3f} to "
                              f"{poses[-1]:.3f} s, with gaps of at most 0.15 s allowed")
        shutil.rmtree(self.output)
        lines_kept(self.capture / "lio.tum", lambda row: float(row.split()[0]) < 0.15)
        self.refused(UNSUPPORTED, "4 of 4 sessions had to be dropped", "no frame has a LiDAR-inertial pose",
                     "gaps of at most 0.15 s")

    def test_poses_too_far_apart(self):
        kept = []
        lines_kept(self.capture / "lio.tum", lambda row: kept.append(row) or len(kept) % 10 == 1)
        self.refused(UNSUPPORTED, "1 s or more apart around the frames; at most 0.15 s are allowed (max_gap_s)")
        self.recon("--set", "max_gap_s=1.1")

    def test_a_stated_offset_of_the_image_clock(self):
        """Recorded time + image_s = time of the LiDAR, for frames as well; so it is where odometry has them."""
        self.recon("--stop-after", "prefusion")
        expected, path = self.sessions(), (self.output / "trajectory.tum").read_text()
        offset = json.loads((self.capture / "capture.json").read_text())["time_offset"]
        for by_s in (0.5, -0.25):
            shutil.rmtree(self.capture)
            shutil.copytree(self.simulated, self.capture)
            times_moved(self.capture / "images.csv", 0, -by_s)
            for k in range(4):
                times_moved(self.session(k) / "frames.csv", 1, -by_s)
                if k % 2 == 1:
                    self.pack(k)
            edit_json(self.capture / "capture.json", time_offset={**offset, "image_s": by_s})
            self.recon("--stop-after", "prefusion")
            for name, session in self.sessions().items():
                self.assertLess(abs(session["scale"] / expected[name.removesuffix(".npz")]["scale"] - 1), 1e-6)
            found = np.loadtxt(self.output / "trajectory.tum")
            np.testing.assert_allclose(found, np.loadtxt(path.splitlines()), atol=1e-6)
        edit_json(self.capture / "capture.json", time_offset={**offset, "image_s": 0.0})
        self.recon("--stop-after", "prefusion")
        worst = max(abs(session["scale"] / expected[name.removesuffix(".npz")]["scale"] - 1)
                    for name, session in self.sessions().items())
        self.assertGreater(worst, 1e-3, "the offset makes a difference")

    # Whose frames.

    def test_one_table_of_frames_for_several_npz(self):
        for k in range(4):
            self.pack(k)
        self.recon()
        self.check_scales(*range(4), suffix=".npz")
        shutil.rmtree(self.output)
        (self.capture / "predictions/session_0000.frames.csv").rename(self.capture / "predictions/frames.csv")
        self.refused(INPUT, "predictions/frames.csv: of which session?", "missing: session_0000.frames.csv")
        (self.capture / "predictions/frames.csv").unlink()
        message = self.recon()
        self.assertIn("session_0000.npz: dropped: ", message)
        self.assertIn("session_0000.frames.csv: no such file", message)

    def test_a_copied_table_of_frames(self):
        shutil.copy(self.session(0) / "frames.csv", self.session(1) / "frames.csv")
        self.check_flag(1, "has the very times of session_0000; is its frames.csv a copy?", self.recon())

    # Poses in another convention.

    def convert_poses(self, change):
        """Of all sessions; `change` gets and gives 4x4 matrices."""
        def of_session(poses):
            square = np.concatenate([poses, np.tile([[[0.0, 0.0, 0.0, 1.0]]], (len(poses), 1, 1))], axis=1)
            return np.array([change(T)[:3] for T in square])

        for k in range(4):
            self.change(k, "extrinsic", of_session)

    def test_poses_in_another_convention(self):
        opengl = np.diag([1.0, -1.0, -1.0, 1.0])
        for change, name in ((np.linalg.inv, "camera-to-world"), (lambda T: opengl @ T, "OpenGL's axes"),
                             (lambda T: np.linalg.inv(opengl @ T), "camera-to-world in OpenGL's axes"),
                             (lambda T: opengl @ T @ opengl, "OpenGL's axes")):
            shutil.rmtree(self.capture)
            shutil.copytree(self.simulated, self.capture)
            self.convert_poses(change)
            self.refused(UNSUPPORTED, "session_0000: extrinsic: the poses contradict the LiDAR-inertial ones", name,
                         "camera-from-world in OpenCV's axes (x right, y down, z forward)")

    def test_one_session_in_another_convention(self):
        self.change(1, "extrinsic", lambda poses: np.array(
            [np.linalg.inv(np.vstack([pose, [0, 0, 0, 1]]))[:3] for pose in poses]))
        self.check_dropped(1, "agree with them as camera-to-world")

    def test_intrinsics_of_another_size(self):
        self.change(1, "intrinsic", lambda cameras: cameras * np.array([[4.0], [4.0], [1.0]]))
        self.check_dropped(1, "are they of one of about 280 x 224? Multiply fx and cx by 0.25")

    def test_pictures_just_outside_their_range(self):
        def overstep(images):
            values = images.astype(np.float32) / 255
            values[0, 0, 0] = [-0.02, 1.03, 0.5]
            return values

        self.change(1, "images", overstep)
        message = self.recon()
        self.check_flag(1, "2 of 70560 values are outside [0,1], by up to 0.03", message)
        self.check_scales(0, 1, 2, 3)

    # Outputs.

    def test_the_capture_is_no_place_for_results(self):
        for name in (".", "predictions", "predictions/session_0000", "lidar", "images/new", "truth", "new/.."):
            message = self.recon(output=self.capture / name, code=USAGE)
            self.assertIn("lies in the capture that is read", message)
        link = self.folder / "link"
        link.symlink_to(self.capture)
        self.assertIn("link: lies in the capture", self.recon(output=link, code=USAGE))
        for name in ("images/000000.jpg", "truth/preview.png"):
            message = self.recon("--figure", self.capture / name, code=USAGE)
            self.assertIn(f"{name}: lies in the capture that is read", message)
        self.assertEqual(self.contents(self.capture), self.contents(self.simulated))
        self.recon("--stop-after", "prefusion", output=self.capture / "map")

    def test_the_reference_is_not_overwritten(self):
        self.recon()
        before = (self.output / "map.ply").read_bytes()
        self.assertIn("would overwrite", self.recon("--evaluate", self.output / "map.ply", code=USAGE))
        self.assertEqual((self.output / "map.ply").read_bytes(), before)

    @staticmethod
    def contents(folder):
        return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}

    def start(self):
        command = [PROGRAM, self.capture, "-o", self.output, "--quiet"]
        return subprocess.Popen(command, stderr=subprocess.PIPE, text=True)

    def test_two_at_once_into_one_folder(self):
        runs = [self.start() for _ in range(3)]
        messages = [run.communicate()[1] for run in runs]
        for run, message in zip(runs, messages):
            self.assertIn(run.returncode, (DONE, USAGE), message)
            if run.returncode == USAGE:
                self.assertIn(f"{self.output}: cannot be written: another program is writing into it", message)
        self.assertIn(DONE, [run.returncode for run in runs])
        found = self.contents(self.output)
        self.recon(output=self.folder / "alone")
        self.assertEqual(found["map.ply"], (self.folder / "alone" / "map.ply").read_bytes())

    def test_a_stopped_run_is_not_in_the_way(self):
        self.recon(output=self.folder / "alone")
        expected = (self.folder / "alone" / "map.ply").read_bytes()
        for delay_s in (0.02, 0.1, 0.2, 0.4, 0.8):
            for how in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT):
                run = self.start()
                time.sleep(delay_s)
                run.send_signal(how)
                run.communicate()
                for name in self.contents(self.output) if self.output.exists() else ():
                    if name == "map.ply":
                        self.assertEqual((self.output / name).read_bytes(), expected, "whole or not there")
        self.recon("--resume")
        self.assertEqual((self.output / "map.ply").read_bytes(), expected)

    def test_outputs_that_cannot_be_written(self):
        self.assertIn("/proc/nowhere", self.recon(output="/proc/nowhere", code=USAGE))
        self.output.write_text("mine")
        self.assertIn(f"{self.output}: cannot be made", self.recon(code=USAGE))
        self.assertEqual(self.output.read_text(), "mine")
        self.output.unlink()
        for name in ("map.ply", "trajectory.tum", "sessions.json"):
            taken = self.output / name / "mine"
            taken.mkdir(parents=True)
            self.refused(USAGE, f"{name}: cannot be written")
            self.assertEqual(list(self.output.iterdir()), [self.output / name], "refused before the work begins")
            shutil.rmtree(self.output)
        self.output.mkdir()
        (self.output / "stages").write_text("mine")
        self.refused(USAGE, "stages: cannot be made")


if __name__ == "__main__":
    unittest.main()

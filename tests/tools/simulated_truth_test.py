#!/usr/bin/env python3
"""Simulator and evaluator agree with each other: predictions without errors, put where the truth says that they were
made, are the map that the truth holds. CTest sets CMAP_SIMULATE and CMAP_EVAL."""

import csv
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "oracle"))
from ply import write_ply  # noqa: E402

# Pictures as large as the network's input, without loss and one ray per pixel: a pixel's color is then that of one
# point of the surface, as in the truth. Points 6 mm apart, as textures change within a centimeter.
FARTHEST_M = 4.0
CAPTURE = ["small_indoor", "--set", "route.length_m=2", "--set", "camera.width_px=518", "--set", "camera.height_px=392",
           "--set", "camera.focal_px=308", "--set", "camera.supersampling=1", "--set", "camera.format=png",
           "--set", "camera.rate_hz=4", "--set", "lidar.points_per_s=1000", "--set", "predictions.width_px=518",
           "--set", "truth.map_points_per_m2=30000", "--set", f"truth.map_max_distance_m={FARTHEST_M}"]
WITHOUT_ERRORS = ["depth_noise_fraction", "depth_bias_fraction", "floater_fraction", "pose_noise_m", "pose_noise_deg",
                  "pose_scale_fraction", "pose_drift_fraction", "pose_drift_deg_per_frame", "focal_noise_fraction"]


def rotations(q):
    """Of unit quaternions x y z w, by row."""
    x, y, z, w = q.T
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]).transpose(2, 0, 1)


def camera_poses(capture, times):
    """World from camera, by the true trajectory: 100 poses a second, between which a body hardly turns."""
    truth = np.loadtxt(capture / "truth" / "trajectory.tum")
    quaternions = truth[:, 4:8] * np.where(truth[:, 4:8] @ truth[0, 4:8] < 0, -1, 1)[:, None]
    moving = np.array([np.interp(times, truth[:, 0], column) for column in (*truth[:, 1:4].T, *quaternions.T)]).T
    poses = np.tile(np.eye(4), (len(times), 1, 1))
    poses[:, :3, :3] = rotations(moving[:, 3:] / np.linalg.norm(moving[:, 3:], axis=1, keepdims=True))
    poses[:, :3, 3] = moving[:, :3]
    calibration = json.loads((capture / "capture.json").read_text())
    mount = [np.array(calibration[name]).reshape(4, 4) for name in ("T_imu_lidar", "T_lidar_camera")]
    return poses @ mount[0] @ mount[1]


def concatenation(capture):
    """All points of all frames within reach, and their colors."""
    scales = json.loads((capture / "truth" / "scales.json").read_text())["scales"]
    points, colors = [], []
    for session in sorted((capture / "predictions").iterdir()):
        depths = np.load(session / "depth.npy").squeeze().astype(float) * scales[session.name]
        images, intrinsics = np.load(session / "images.npy"), np.load(session / "intrinsic.npy")
        frames = list(csv.DictReader((session / "frames.csv").read_text().splitlines()))
        poses = camera_poses(capture, [float(frame["timestamp_s"]) for frame in frames])
        for depth, image, K, pose in zip(depths, images, intrinsics, poses):
            v, u = np.indices(depth.shape)
            rays = np.stack([(u - K[0, 2]) / K[0, 0], (v - K[1, 2]) / K[1, 1], np.ones(depth.shape)], axis=-1)
            p = rays * depth[..., None]
            near = np.linalg.norm(p, axis=-1) < FARTHEST_M
            points.append(p[near] @ pose[:3, :3].T + pose[:3, 3])
            colors.append(image[near] if image.shape[-1] == 3 else image.transpose(1, 2, 0)[near])
    colors = np.concatenate(colors)
    if colors.dtype != np.uint8:
        colors = np.round(255 * colors).astype(np.uint8)
    return np.concatenate(points), colors


class SimulatedTruth(unittest.TestCase):
    def test_predictions_without_errors_are_the_true_map(self):
        with tempfile.TemporaryDirectory(prefix="cmap-truth-") as name:
            folder = Path(name)
            exact = [text for name in WITHOUT_ERRORS for text in ("--set", f"predictions.{name}=0")]
            subprocess.run([os.environ["CMAP_SIMULATE"], *CAPTURE, *exact, "--quiet", "-o", folder / "capture"],
                           check=True)
            write_ply(folder / "concatenation.ply", *concatenation(folder / "capture"))
            subprocess.run([os.environ["CMAP_EVAL"], folder / "capture" / "truth" / "map.ply",
                            folder / "concatenation.ply", "--thresholds", "0.05", "--quiet", "-o",
                            folder / "report.json"], check=True)
            metrics = json.loads((folder / "report.json").read_text())["metrics"]
        self.assertGreater(metrics["fitness"]["per_threshold"][0]["value"], 0.99)
        self.assertLess(metrics["chamfer"]["value"], 0.02)
        self.assertLess(metrics["color_distance"]["value"], 0.02)


if __name__ == "__main__":
    unittest.main()

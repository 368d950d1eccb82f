#!/usr/bin/env bash
# genz-icp 0.3.2: the voxels that touch a coordinate of 0 are twice as long; kiss-icp 1.3.0's are not.
# Coordinates are divided and cut towards zero, so that -0.9 and 0.9 share a voxel. Around the sensor, at the origin of a
# scan, one voxel of 1 m is a cube of 2 m, and it keeps one point where kiss-icp keeps eight.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 genz-icp==0.3.2 kiss-icp==1.3.0
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import genz_icp.voxelization
import kiss_icp.voxelization
import numpy as np

points = np.random.default_rng(1).random((200000, 3)) * 20 - 10
near = points[np.abs(points).max(axis=1) < 1]
counts = {}
for module in (kiss_icp.voxelization, genz_icp.voxelization):
    name = module.__name__.split(".")[0]
    counts[name] = [len(module.voxel_down_sample(cloud, 1.0)) for cloud in (points, near, points + 100)]
    print("%s: %d points of 20 m around 0, %d of the 2 m around 0; %d after a shift by 100 m" % (name, *counts[name]))
assert counts["kiss_icp"] == [8000, 8, 8000] and counts["genz_icp"] == [19**3, 1, 8000]
PYTHON

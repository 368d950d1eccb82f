#!/usr/bin/env bash
# ouster-sdk 1.0.1: interp_pose() gives poses for times at which there are none, and between two poses it leaves the straight line.
# Before the first and after the last pose the motion of the nearest pair goes on, without a word: 10 s after the end of a drive
# at 10 m/s the sensor is 100 m further on. Between poses it follows a screw: halfway of a turn by 90 degrees over 1 m it is
# 21 cm beside the line that an interpolation of position and rotation apart would give.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 ouster-sdk==1.0.1 scipy==1.17.1
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
from ouster.sdk.core import interp_pose
from scipy.spatial.transform import Rotation

def poses(positions, degrees):
    matrices = np.tile(np.eye(4), (len(positions), 1, 1))
    matrices[:, :2, 3] = positions
    matrices[:, :3, :3] = Rotation.from_rotvec(np.outer(degrees, [0, 0, 1]), degrees=True).as_matrix()
    return matrices

seconds = np.arange(3.0)
straight = poses(np.outer(seconds, [10, 0]), [0, 0, 0])
outside = interp_pose(np.array([-5.0, 12.0]), seconds, straight)[:, 0, 3]
print("poses from 0 to 20 m in 0 to 2 s; asked for -5 s and 12 s:", outside.round(6), "m")
assert np.allclose(outside, [-50, 120])

turn = poses([[0, 0], [1, 0]], [0, 90])
middle = interp_pose(np.array([0.5]), np.array([0.0, 1.0]), turn)[0]
print("halfway from (0, 0) to (1, 0) with a turn by 90 degrees:", middle[:2, 3].round(4))
assert np.allclose(middle[:2, 3], [0.5, 0.5 - np.sqrt(0.5)], atol=1e-6)
assert np.allclose(middle[:3, :3], Rotation.from_rotvec([0, 0, 45], degrees=True).as_matrix())
PYTHON

#!/usr/bin/env bash
# evo 1.38.1: of two poses of the truth at one time the second is taken, unless the file is unordered elsewhere: then the first.
# Stamps are found by bisection from the right where they rise, else by the least difference. One row out of order, which pairs with
# nothing, changes the error of another pose from 97 m to 0. Repeated stamps of the shorter trajectory count each.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 evo==1.38.1
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
from evo.core import sync
from evo.core.trajectory import PoseTrajectory3D

def trajectory(stamps, x):
    return PoseTrajectory3D(np.column_stack([x, np.zeros((len(x), 2))]), np.tile([1.0, 0, 0, 0], (len(x), 1)), np.array(stamps, float))

def paired(truth, estimate):
    truth, estimate = sync.associate_trajectories(truth, estimate)
    return truth.positions_xyz[:, 0].tolist(), estimate.positions_xyz[:, 0].tolist()

estimate = trajectory([1, 2, 3], [1, 2, 3])
ordered = trajectory([1, 2, 2, 3, 9, 10], [1, 2, 99, 3, 9, 10])       # two poses at 2 s: at 2 m and at 99 m
unordered = trajectory([1, 2, 2, 3, 10, 9], [1, 2, 99, 3, 10, 9])     # the same, its last rows the other way round
print("ordered:  ", paired(ordered, estimate))
print("unordered:", paired(unordered, estimate))
assert paired(ordered, estimate)[0] == [1, 99, 3], "the second pose of 2 s"
assert paired(unordered, estimate)[0] == [1, 2, 3], "the first"
repeated = trajectory([1, 2, 2], [1, 2, 2.5])
print("repeated: ", paired(ordered, repeated))
assert paired(ordered, repeated)[1] == [1, 2, 2.5], "both poses of 2 s count"
PYTHON

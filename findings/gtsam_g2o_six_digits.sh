#!/usr/bin/env bash
# gtsam 4.3.0: writeG2o prints six digits, whatever the size of the numbers.
# Poses at UTM coordinates come back up to 5 m off, and many share one position; 1 km from the origin it is half a centimeter an axis.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 gtsam==4.3.0
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import gtsam
import numpy as np

steps = np.array([[0.1234 * step, 0.2345 * step, 0.0] for step in range(20)])
for name, origin, at_least in (("at the origin", [0, 0, 0], 0), ("1 km away", [1000, 1000, 0], 0.004), ("UTM", [456789, 5428763, 100], 2)):
    positions = steps + origin
    values = gtsam.Values()
    for index, position in enumerate(positions):
        values.insert(index, gtsam.Pose3(gtsam.Rot3(), position))
    gtsam.writeG2o(gtsam.NonlinearFactorGraph(), values, "path.g2o")
    _, back = gtsam.readG2o("path.g2o", True)
    read = np.array([back.atPose3(index).translation() for index in range(len(positions))])
    error = np.linalg.norm(read - positions, axis=1).max()
    different = len(np.unique(read, axis=0))
    print("%s: up to %.6f m off, %d of %d positions differ" % (name, error, different, len(positions)))
    assert error >= at_least and (name != "at the origin" or error < 1e-5) and (name != "UTM" or different < 10)
print(open("path.g2o").readline().strip())
PYTHON

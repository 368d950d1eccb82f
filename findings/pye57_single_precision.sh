#!/usr/bin/env bash
# pye57 0.4.19: coordinates are written in single precision, though E57 and the arrays have double.
# At UTM coordinates a northing is off by up to 25 cm, and nothing says so. An offset given as the pose's translation keeps double.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 pye57==0.4.19
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
import pye57

random = np.random.default_rng(1)
origin = np.array([456789.0, 5428765.0, 100.0])
local = random.random((1000, 3)) * 20

def error_of(xyz, translation):
    """The largest difference on each axis between what was meant and what is read back, in meters."""
    with pye57.E57("scan.e57", mode="w") as file:
        file.write_scan_raw(dict(zip(("cartesianX", "cartesianY", "cartesianZ"), xyz.T)), translation=translation)
    scan = pye57.E57("scan.e57").read_scan(0, ignore_missing_fields=True)
    back = np.stack([scan["cartesian" + axis] for axis in "XYZ"], axis=1)
    assert back.dtype == np.float64
    return np.abs(back - (local + origin)).max(axis=0)

whole, shifted = error_of(local + origin, np.zeros(3)), error_of(local, origin)
print("UTM coordinates as they are: off by up to", whole.round(4), "m; as a pose and the rest:", shifted.round(7), "m")
assert 0.2 < whole[1] <= 0.25 and 0.01 < whole[0] < 0.02 and shifted.max() < 2e-6
PYTHON

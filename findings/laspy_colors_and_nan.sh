#!/usr/bin/env bash
# laspy 2.7.0: colors from 0 to 1 become 0, except a full 1; a NaN coordinate becomes the lowest integer on its axis; steps are 1 cm.
# laspy.create() takes values of any type: 0.25 and 0.75 are cut to 0, NaN lands 21475 km away (a RuntimeWarning of numpy's is
# all one sees), and 1.2345 is stored as 1.23 unless the scale is set first.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 laspy==2.7.0
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import warnings

import laspy
import numpy as np

warnings.simplefilter("ignore")
las = laspy.create(point_format=3)
las.x, las.y, las.z = np.array([1.2345, np.nan, 3.0]), np.array([1.0, 2.0, 3.0]), np.zeros(3)
las.red = las.green = las.blue = np.array([0.25, 0.75, 1.0])
las.write("points.las")
back = laspy.read("points.las")
print("x", np.array(back.x), "y", np.array(back.y), "red", np.array(back.red), "smallest x of the header", back.header.mins[0])
assert np.array(back.red).tolist() == [0, 0, 1]
assert abs(back.x[0] - 1.23) < 1e-9 and back.y[1] == 2.0
assert back.X[1] == -2**31 and abs(back.header.mins[0] + 21474836.48) < 1e-6
PYTHON

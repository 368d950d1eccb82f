#!/usr/bin/env bash
# pye57 0.4.19: a scan that is read and written with its own header is moved by its pose once more.
# read_scan() applies the pose by default, write_scan_raw(data, scan_header=header) writes the pose of the header again. Nothing
# else of the file differs; with transform=False the copy is right.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 pye57==0.4.19
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
import pye57

def x_of(path):
    return pye57.E57(path).read_scan(0, ignore_missing_fields=True)["cartesianX"]

points = {"cartesianX": np.array([1.0, 2.0, 3.0]), "cartesianY": np.zeros(3), "cartesianZ": np.zeros(3)}
with pye57.E57("scan.e57", mode="w") as file:
    file.write_scan_raw(points, rotation=np.array([1.0, 0, 0, 0]), translation=np.array([10.0, 0, 0]))
scan = pye57.E57("scan.e57")
for transform in (True, False):
    data = scan.read_scan(0, ignore_missing_fields=True, transform=transform)
    with pye57.E57("copy.e57", mode="w") as file:
        file.write_scan_raw(data, scan_header=scan.get_header(0))
    print("read with transform=%s, written with its header: x %s instead of %s" % (transform, x_of("copy.e57"), x_of("scan.e57")))
    assert x_of("copy.e57").tolist() == ([21, 22, 23] if transform else [11, 12, 13])
PYTHON

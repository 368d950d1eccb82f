#!/usr/bin/env bash
# meshio 5.3.5 and plyfile 1.1.5: meshio writes `property int64 red`, a type that PLY does not define and plyfile refuses.
# Any array of Python integers ends so, since numpy makes them 8 bytes. Cells, with the same integers, are cut to 32 bits with a warning
# "PLY doesn't support 64-bit integers"; colors of a vertex are not.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 meshio==5.3.5 plyfile==1.1.5
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import meshio
import numpy as np
import plyfile

colors = {"red": np.array([10, 20, 30]), "green": np.array([40, 50, 60]), "blue": np.array([70, 80, 90])}
meshio.Mesh(np.eye(3), [], point_data=colors).write("points.ply")
header = open("points.ply", "rb").read().split(b"end_header")[0].decode()
print([line for line in header.splitlines() if "red" in line])
assert "property int64 red" in header
assert meshio.read("points.ply").point_data["red"].tolist() == [10, 20, 30]
try:
    plyfile.PlyData.read("points.ply")
    raise AssertionError("plyfile reads it")
except plyfile.PlyHeaderParseError as error:
    print("plyfile:", str(error)[:40])
    assert "int64" in str(error)
PYTHON

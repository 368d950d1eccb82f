#!/usr/bin/env bash
# Open3D 0.20.0: an ASCII PLY says `property double` and holds six significant digits.
# At UTM coordinates a point moves by meters: 4649776.5 is written as 4.64978e+06. As binary PLY nothing is lost.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 open3d==0.20.0
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
import open3d

point = np.array([[465123.25, 4649776.5, 132.125]])
cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(point))
for ascii_text in (False, True):
    open3d.io.write_point_cloud("point.ply", cloud, write_ascii=ascii_text)
    back = np.asarray(open3d.io.read_point_cloud("point.ply").points)
    print("ascii" if ascii_text else "binary", back[0], "off by %.2f m" % np.linalg.norm(back - point))
    assert (3 < np.linalg.norm(back - point) < 4) if ascii_text else (back == point).all()
text = open("point.ply").read()
print(text.split("end_header\n")[1].strip())
assert "property double y" in text and "4.64978e+06" in text
PYTHON

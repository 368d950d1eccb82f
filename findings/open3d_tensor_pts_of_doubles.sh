#!/usr/bin/env bash
# Open3D 0.20.0: the tensor writer of PTS takes the bytes of double coordinates for floats, and reports success.
# One point at (465123.25, 4649776.5, 1.5) comes out near (0, 0, 0); with float coordinates all is well.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 open3d==0.20.0
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
import open3d

def written(kind):
    points = open3d.t.geometry.PointCloud(open3d.core.Tensor(np.array([[465123.25, 4649776.5, 1.5]], kind)))
    points.point.colors = open3d.core.Tensor(np.array([[10, 20, 30]], np.uint8))
    success = open3d.t.io.write_point_cloud("points.pts", points)
    row = open("points.pts").read().split("\n")[1].split()
    print(np.dtype(kind).name, "success" if success else "failure", row)
    return success, [float(value) for value in row[:3]]

success, xyz = written(np.float32)
assert success and xyz == [465123.25, 4649776.5, 1.5]
success, xyz = written(np.float64)
assert success and max(abs(value) for value in xyz[:2]) < 3
PYTHON

#!/usr/bin/env bash
# pypcd4 1.5.1: PointCloud.from_msg() looks at neither row_step nor is_bigendian of a PointCloud2 message.
# Rows that are padded by one point's bytes give a made-up point (0, 0, 0) each; padded by half a point's they shift the coordinates
# of all rows after the first. Big-endian numbers are read as little-endian, near 1e-41. Nothing is raised. pointcloud2 0.6.0 reads
# all of them right.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 pypcd4==1.5.1 pointcloud2==0.6.0
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
from types import SimpleNamespace

import numpy as np
import pointcloud2
from pypcd4 import PointCloud

FLOAT32 = 7
xyz = np.arange(1, 19, dtype=float).reshape(2, 3, 3)

def message(padding, big):
    """Two rows of three points, 16 bytes each, and some bytes after each row."""
    layout = {"names": list("xyz"), "formats": [(">" if big else "<") + "f4"] * 3, "offsets": [0, 4, 8], "itemsize": 16}
    points = np.zeros((2, 3), np.dtype(layout))
    for index, name in enumerate("xyz"):
        points[name] = xyz[..., index]
    fields = [SimpleNamespace(name=name, offset=4 * index, datatype=FLOAT32, count=1) for index, name in enumerate("xyz")]
    data = b"".join(row.tobytes() + bytes(padding) for row in points)
    return SimpleNamespace(header=None, height=2, width=3, fields=fields, is_bigendian=big, point_step=16,
                           row_step=48 + padding, data=data, is_dense=True)

for padding, big in ((0, False), (16, False), (8, False), (0, True)):
    case = message(padding, big)
    seen = PointCloud.from_msg(case).numpy(("x", "y", "z"))
    right = pointcloud2.read_points(case)
    right = np.stack([right[axis] for axis in "xyz"], axis=1)
    print("rows padded by %d bytes, big-endian %s: pypcd4 %d points, the fourth %s; pointcloud2 %d, %s"
          % (padding, big, len(seen), seen[3].tolist(), len(right), right[3].tolist()))
    assert (right == xyz.reshape(-1, 3)).all()
    assert len(seen) == {0: 6, 16: 8, 8: 7}[padding]
    assert (seen[:3] == right[:3]).all() != big and (seen[3].tolist() == [10, 11, 12]) == (padding == 0 and not big)
PYTHON

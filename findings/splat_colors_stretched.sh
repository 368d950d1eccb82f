#!/usr/bin/env bash
# 3dgs-edit-tools 0.3.0: a point cloud made of splats has its colors stretched so that the file's own range fills 0 to 255.
# The darkest number of all channels becomes 0 and the brightest 255, instead of 0.5 + 0.2820948 f_dc. Splats of nearly one gray
# become black and white, and the same splat has another color as soon as one more is in the file.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 gsply==0.4.6 plyfile==1.1.5 open3d==0.20.0 pandas==3.1.1 matplotlib==3.11.2 3dgs-edit-tools==0.3.0
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import gsply
import numpy as np
from plyfile import PlyData
from src.gs_to_pointcloud import convert_3dgs_to_pointcloud

def converted(rgb):
    """The colors, 0 to 255, of the cloud that is made of splats with these colors."""
    count = len(rgb)
    colors = ((rgb / 255 - 0.5) / 0.28209479177387814).astype(np.float32)
    gsply.plywrite("splats.ply", np.random.default_rng(1).random((count, 3)).astype(np.float32), np.full((count, 3), -3, np.float32),
                   np.tile(np.array([1, 0, 0, 0], np.float32), (count, 1)), np.full(count, 2, np.float32), colors, None)
    convert_3dgs_to_pointcloud("splats.ply", "points.ply")
    vertex = PlyData.read("points.ply")["vertex"]
    return np.stack([vertex[channel] for channel in ("red", "green", "blue")], axis=1).astype(int)

gray = np.array([[120.0, 120, 120], [124, 124, 124], [130, 130, 130]])
for name, rgb in (("nearly one gray", gray), ("the same and one white", np.vstack([gray, [[255.0, 255, 255]]]))):
    seen = converted(rgb)
    print("%s: meant %s, written %s" % (name, rgb[:, 0].astype(int).tolist(), seen[:, 0].tolist()))
    stretched = np.floor((rgb - rgb.min()) / (rgb.max() - rgb.min()) * 255)
    assert np.abs(seen - stretched).max() <= 1 and np.abs(seen - rgb).max() > 100
PYTHON

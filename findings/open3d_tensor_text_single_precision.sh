#!/usr/bin/env bash
# Open3D 0.20.0: the tensor readers of text clouds (.xyz, .xyzn, .xyzrgb, .pts) give single precision, the legacy ones double.
# UTM coordinates from o3d.t.io.read_point_cloud() are up to 25 cm off, and in a cube of 1 m six points of a thousand fall
# together. Doubles of a PLY are kept by both.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 open3d==0.20.0
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
import open3d

xyz = np.random.default_rng(1).random((1000, 3)).round(3) + [456789, 5428765, 100]
unit = np.tile([0.0, 0.0, 1.0], (1000, 1))
for suffix, columns in (("xyz", [xyz]), ("xyzn", [xyz, unit]), ("xyzrgb", [xyz, unit]), ("pts", [xyz])):
    path = "points." + suffix
    np.savetxt(path, np.hstack(columns), fmt="%.3f", header="1000" if suffix == "pts" else "", comments="")
    tensor = open3d.t.io.read_point_cloud(path).point.positions.numpy()
    legacy = np.asarray(open3d.io.read_point_cloud(path).points)
    error = np.abs(tensor.astype(float) - xyz).max()
    print("%s: tensor %s, up to %.3f m off, %d different points of 1000; legacy %.1g m off"
          % (suffix, tensor.dtype, error, len(np.unique(tensor, axis=0)), np.abs(legacy - xyz).max()))
    assert tensor.dtype == np.float32 and 0.2 < error <= 0.25 and np.abs(legacy - xyz).max() < 1e-6

cloud = open3d.t.geometry.PointCloud(open3d.core.Tensor(xyz))
open3d.t.io.write_point_cloud("points.ply", cloud)
assert (open3d.t.io.read_point_cloud("points.ply").point.positions.numpy() == xyz).all()
PYTHON

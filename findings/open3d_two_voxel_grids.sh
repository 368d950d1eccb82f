#!/usr/bin/env bash
# Open3D 0.20.0: voxel_down_sample is two functions of one name.
# The legacy grid starts half a voxel below the lowest point of each axis, the tensor grid at 0: of a floor in one 0.5 m layer the
# first makes two, twice the points, and one more point far below moves all its voxels. The tensor one cuts the mean of 8-bit colors to
# whole numbers, half a step too dark on the average, where the legacy one keeps the mean.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 open3d==0.20.0
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
import open3d

def both(xyz, rgb):
    """The points and colors, 0 to 255, of the legacy and of the tensor cloud, sampled at 0.5 m."""
    tensor = open3d.t.geometry.PointCloud(open3d.core.Tensor(xyz))
    tensor.point.colors = open3d.core.Tensor(rgb)
    legacy = tensor.to_legacy().voxel_down_sample(0.5)
    tensor = tensor.voxel_down_sample(0.5)
    return np.asarray(legacy.points), np.asarray(legacy.colors) * 255, tensor.point.positions.numpy(), tensor.point.colors.numpy()

random = np.random.default_rng(1)
xyz = random.random((100000, 3)) * [10, 10, 0.4] + [0, 0, 0.05]
rgb = random.integers(0, 256, xyz.shape).astype(np.uint8)
legacy, legacy_rgb, tensor, tensor_rgb = both(xyz, rgb)
print("legacy %d points, tensor %d; mean color %.2f and %.2f" % (len(legacy), len(tensor), legacy_rgb.mean(), tensor_rgb.mean()))
assert len(legacy) == 882 and len(tensor) == 400
cells = np.unique(np.floor(xyz[:, :2] / 0.5).astype(int), axis=0, return_inverse=True)[1].reshape(-1)
means = np.array([rgb[cells == cell].mean(axis=0) for cell in range(400)])
assert (np.sort(tensor_rgb.ravel()) == np.sort(np.floor(means).ravel())).all()
print("mean of the cells' colors %.2f" % means.mean())
assert 0.45 < means.mean() - tensor_rgb.mean() < 0.55

below = both(np.vstack([xyz, [[-0.2, -0.2, -0.2]]]), np.vstack([rgb, rgb[:1]]))
kept = [len(set(map(tuple, np.round(new, 9))) & set(map(tuple, np.round(old, 9)))) for new, old in ((below[0], legacy), (below[2], tensor))]
print("one more point below: legacy keeps %d of its points, tensor %d" % tuple(kept))
assert kept[0] < 20 and kept[1] == 400
PYTHON

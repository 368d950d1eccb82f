#!/usr/bin/env bash
# Open3D 0.20.0: the tensor cloud's radius outlier filter counts a point as its own neighbor, the legacy one does not.
# Both pages speak of fewer neighbors than nb_points in a sphere. With nb_points 1 the tensor filter keeps every point, lone
# ones too, where the legacy one removes these; its result for n is the legacy one's for n - 1.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 open3d==0.20.0
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
import open3d

random = np.random.default_rng(1)
xyz = np.vstack([random.random((500, 3)) * [5, 5, 0], random.random((200, 3)) * 50 + [0, 0, 10]])
legacy = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(xyz))
tensor = open3d.t.geometry.PointCloud(open3d.core.Tensor(xyz))

def kept(count):
    """The indices that the legacy and the tensor filter keep."""
    return [legacy.remove_radius_outlier(count, 0.5)[1], np.flatnonzero(tensor.remove_radius_outliers(count, 0.5)[1].numpy()).tolist()]

for count in (1, 10, 15):
    print("nb_points %d: legacy keeps %d of %d points, tensor %d" % (count, len(kept(count)[0]), len(xyz), len(kept(count)[1])))
    assert kept(count)[0] == kept(count + 1)[1] != kept(count)[1]
assert len(kept(1)[1]) == len(xyz) > len(kept(1)[0])
PYTHON

#!/usr/bin/env bash
# Open3D 0.20.0 and point-cloud-utils 0.34.0: one NaN spoils distances if it is the first point of the target, and only then.
# 1000 random points against 1000 others: with the NaN in front more than half of the distances, all of them finite, are
# too large; with the same NaN in second or last place every distance is right. Nothing is said.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 open3d==0.20.0 point-cloud-utils==0.34.0
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
import open3d
import point_cloud_utils

def by_open3d(source, target):
    cloud = lambda xyz: open3d.geometry.PointCloud(open3d.utility.Vector3dVector(xyz))
    return np.asarray(cloud(source).compute_point_cloud_distance(cloud(target)))

def by_pcu(source, target):
    return point_cloud_utils.k_nearest_neighbors(source, target, 1)[0].ravel()

random = np.random.default_rng(1)
source, target = random.random((1000, 3)), random.random((1000, 3))
true = np.sqrt(((source[:, None] - target[None]) ** 2).sum(axis=2)).min(axis=1)
for name, distances in (("Open3D", by_open3d), ("point-cloud-utils", by_pcu)):
    for place in (0, 1, 1000):
        found = distances(source, np.insert(target, place, np.nan, axis=0))
        wrong = np.mean(np.abs(found - true) > 1e-6)
        print("%s, NaN at index %d: %.0f %% of distances wrong, mean %.3f instead of %.3f" % (
            name, place, 100 * wrong, found.mean(), true.mean()))
        assert np.isfinite(found).all() and (wrong > 0.5 if place == 0 else wrong == 0)
PYTHON

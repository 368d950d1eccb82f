#!/usr/bin/env bash
# pymeshlab 2025.7.post1: get_hausdorff_distance leaves out every point farther away than half a bounding box's diagonal.
# A map with a tenth of its points 2 m off a room of 1 m is told to be perfect: largest distance 0, mean 0, RMS 0. The one sign is
# n_samples, 900 of 1000. With maxdist set to more the largest distance is 2 and the mean 0.15, as they should be.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 pymeshlab==2025.7.post1 scipy==1.17.1
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
import pymeshlab
from scipy.spatial import KDTree

reference = np.random.default_rng(1).random((1000, 3))
estimate = reference.copy()
estimate[:100, 2] += 2.0
right = KDTree(reference).query(estimate)[0]
print("KDTree: largest %.3f, mean %.4f of %d points" % (right.max(), right.mean(), len(right)))

meshes = pymeshlab.MeshSet()
meshes.add_mesh(pymeshlab.Mesh(estimate))
meshes.add_mesh(pymeshlab.Mesh(reference))
usual = meshes.get_hausdorff_distance(sampledmesh=0, targetmesh=1)
wide = meshes.get_hausdorff_distance(sampledmesh=0, targetmesh=1, maxdist=pymeshlab.PureValue(10.0))
for name, seen in (("as it is", usual), ("maxdist 10", wide)):
    print("pymeshlab, %s: largest %.3f, mean %.4f of %d points" % (name, seen["max"], seen["mean"], seen["n_samples"]))
assert usual["max"] == usual["mean"] == usual["RMS"] == 0 and usual["n_samples"] == 900
assert abs(wide["max"] - right.max()) < 1e-5 and abs(wide["mean"] - right.mean()) < 1e-5 and wide["n_samples"] == 1000
PYTHON

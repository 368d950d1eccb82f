#!/usr/bin/env bash
# small_gicp 1.0.1: align() of clouds at UTM coordinates says that it has converged, with no inlier at all.
# Voxels must have indices within 21 bits: at the usual 0.25 m every UTM point is out of range, and one point is left of a cloud. The
# docs say that points out of range are ignored, and each costs a line on stderr. But the result has converged, with an error of 0 and
# the identity as its transform, for clouds 32 cm apart. With the origin taken off they are aligned to a few millimeters.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 small_gicp==1.0.1
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import os

import numpy as np
import small_gicp

os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
random = np.random.default_rng(1)
target = random.random((20000, 3)) * [20, 20, 5]
source = random.permutation(target) + [0.3, 0.1, 0.0]
for name, origin in (("at the origin", [0, 0, 0]), ("UTM", [456789, 5428765, 100])):
    print("%s: voxelgrid_sampling leaves %d points" % (name, small_gicp.voxelgrid_sampling(target + origin, 0.25).size()))
    for kind in ("ICP", "PLANE_ICP", "GICP"):
        result = small_gicp.align(target + origin, source + origin, registration_type=kind)
        print("%s, %s: converged %s, inliers %d, error %.3g, translation %s"
              % (name, kind, result.converged, result.num_inliers, result.error, result.T_target_source[:3, 3].round(3)))
        assert result.converged
        if name == "UTM":
            assert result.num_inliers == 0 and result.error == 0 and (result.T_target_source == np.eye(4)).all()
        else:
            assert np.abs(result.T_target_source[:3, 3] + [0.3, 0.1, 0.0]).max() < 0.01
PYTHON

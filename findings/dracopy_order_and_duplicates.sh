#!/usr/bin/env bash
# DracoPy 2.2.0: a point cloud comes back in another order; without colors equal points are merged, and the steps are not those stated.
# Errors or labels kept beside the cloud then belong to other points (preserve_order=True keeps them). Its docstring gives 11 bits as the
# number of steps on the longest side; it is 14: 6 cm on a map of 1 km, on z too.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 DracoPy==2.2.0 scipy==1.17.1
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import DracoPy
import numpy as np
from scipy.spatial import KDTree

def decoded(points, **options):
    return np.asarray(DracoPy.decode(DracoPy.encode(points, **options)).points)

random = np.random.default_rng(1)
points = (random.random((5000, 3)) * [1000, 1000, 20]).astype(np.float32)
colors = random.integers(0, 256, points.shape).astype(np.uint8)
by_index = np.abs(decoded(points) - points).max()
nearest = KDTree(points).query(decoded(points))[0].max()
kept = np.abs(decoded(points, preserve_order=True) - points).max()
eleven = KDTree(points).query(decoded(points, quantization_bits=11))[0].max()
print("same index: up to %.0f m off; nearest point: %.3f m; with preserve_order: %.4f m an axis; 11 bits: %.2f m"
      % (by_index, nearest, kept, eleven))
assert by_index > 900 and nearest < 0.06 and 0.03 < kept < 0.031 and eleven > 0.3
assert "quantization_bits=11" in DracoPy.encode.__doc__

twice = np.vstack([points, points])
other_colors = np.vstack([colors, 255 - colors])
counts = [len(decoded(twice)), len(decoded(twice, colors=other_colors)), len(decoded(twice, preserve_order=True))]
print("each point twice: %d of 10000 come back, with two colors %d, with preserve_order %d" % tuple(counts))
assert counts == [5000, 10000, 10000]
PYTHON

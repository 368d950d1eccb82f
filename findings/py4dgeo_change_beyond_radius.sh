#!/usr/bin/env bash
# py4dgeo 1.2.0: M3C2 reaches as far as the cylinder is wide, unless max_distance is more than its radius.
# Left as it is (0), and set to anything less than the radius, max_distance counts as the radius: a change of 0.51 m measured with a
# radius of 0.5 m is NaN, one of 0.49 m is not. The mean of a map whose half moved by 0.2 m and half by 0.6 m is then 0.2 m. On the other
# hand a max_distance of 5 cm does not keep out a surface 40 cm away.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 py4dgeo==1.2.0
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
import py4dgeo

random = np.random.default_rng(1)

def floor(height):
    """A floor of 20 m by 10 m; of two heights each is that of one half."""
    xyz = random.random((40000, 3)) * [20, 10, 0]
    xyz[:, 2] = np.where(xyz[:, 0] < 10, height[0], height[-1]) + random.normal(0, 0.001, len(xyz))
    return py4dgeo.Epoch(xyz)

def distances(height, **options):
    corepoints = np.array([[x, 5.0, 0.0] for x in range(2, 19) if x != 10])
    m3c2 = py4dgeo.M3C2(epochs=(floor([0.0]), floor(height)), corepoints=corepoints, cyl_radius=0.5, normal_radii=[0.5], **options)
    return m3c2.run()[0]

for height, options, share in (([0.49], {}, 1), ([0.51], {}, 0), ([0.51], {"max_distance": 0.6}, 1), ([0.4], {"max_distance": 0.05}, 1)):
    found = np.isfinite(distances(height, **options)).mean()
    print("moved by %.2f m, radius 0.5 m, %s: %d %% measured" % (height[0], options or "max_distance as it is", 100 * found))
    assert found == share
halves = distances([0.2, 0.6])
wide = distances([0.2, 0.6], max_distance=2.0)
print("half by 0.2 m, half by 0.6 m: mean %.3f m; with max_distance 2 m: %.3f m" % (np.nanmean(halves), np.nanmean(wide)))
assert abs(np.nanmean(halves) - 0.2) < 0.002 and abs(np.nanmean(wide) - 0.4) < 0.002
PYTHON

#!/usr/bin/env bash
# splat-transform 3.7.0 (npm) and gsply 0.4.6: splats more than 2048 m from the origin are moved when they are saved as .spz.
# SPZ keeps coordinates in 24 bits of 1/4096 m. splat-transform lets them wrap: x 2049 is saved as -2047; gsply stops them at
# 2047.9998. Neither says a word: a cloud at UTM coordinates, or a long drive, comes back folded or flat. Within 2048 m both are right.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 gsply==0.4.6 zstandard==0.25.0
cd "$folder"
npm install --silent --no-audit --no-fund @playcanvas/splat-transform@3.7.0
"$folder/environment/bin/python" - <<'PYTHON'
import subprocess

import gsply
import numpy as np

x = np.array([0.0, 100.25, 2047.5, 2049.0, 4097.0, -2049.0], np.float32)
count = len(x)
means = np.column_stack([x, np.zeros((count, 2))]).astype(np.float32)
scales, opacities = np.full((count, 3), -3, np.float32), np.full(count, 2, np.float32)
quats, colors = np.tile(np.array([1, 0, 0, 0], np.float32), (count, 1)), np.zeros((count, 3), np.float32)
gsply.plywrite("splats.ply", means, scales, quats, opacities, colors, None)
subprocess.run(["node_modules/.bin/splat-transform", "-w", "splats.ply", "transform.spz"], check=True, capture_output=True)
subprocess.run(["node_modules/.bin/splat-transform", "-w", "transform.spz", "back.ply"], check=True, capture_output=True)
gsply.write_spz("gsply.spz", gsply.plyread("splats.ply"))
found = {"splat-transform": gsply.plyread("back.ply").means[:, 0], "gsply": gsply.read_spz("gsply.spz").means[:, 0]}
print("saved", x.tolist())
for name, back in found.items():
    print("%s: %s" % (name, back.round(4).tolist()))
    assert np.abs(back[:3] - x[:3]).max() < 1e-3
wrapped = (x[3:] + 2048) % 4096 - 2048
assert np.abs(found["splat-transform"][3:] - wrapped).max() < 1e-3
assert np.abs(found["gsply"][3:] - np.clip(x[3:], -2048, 2048)).max() < 1e-3
assert np.abs(gsply.read_spz("transform.spz").means[3:, 0] - wrapped).max() < 1e-3
PYTHON

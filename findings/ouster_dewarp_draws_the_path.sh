#!/usr/bin/env bash
# ouster-sdk 1.0.1: dewarp() turns rays without a return into points along the sensor's path.
# XYZLut gives them as (0, 0, 0), also where it applies the sensor's mounting; dewarp() moves them with all others, so that a map has
# a point in the middle of the sensor for each. After it they can no longer be told by their coordinates; RANGE must be asked.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 ouster-sdk==1.0.1
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import warnings

import numpy as np
from ouster.sdk import core

warnings.simplefilter("ignore")
info = core.SensorInfo.from_default(core.LidarMode._512x10)
mounting = np.eye(4)
mounting[:3, 3] = [0, 0, 1.8]
info.sensor_to_body = mounting
scan = core.LidarScan(info)
ranges = scan.field(core.ChanField.RANGE)
ranges[:] = 0
ranges[::2] = 20000
xyz = core.XYZLut(info, use_extrinsics=True)(scan)
poses = np.tile(np.eye(4), (scan.w, 1, 1))
poses[:, 0, 3] = np.arange(scan.w) * 0.01
world = core.dewarp(xyz, poses)
missing = ranges == 0
print("no return: %d of %d; at (0, 0, 0) before dewarp: %d, after it: %d"
      % (missing.sum(), missing.size, (xyz == 0).all(axis=-1).sum(), (world == 0).all(axis=-1).sum()))
assert ((xyz == 0).all(axis=-1) == missing).all() and (world == 0).all(axis=-1).sum() == 32
assert np.allclose(world[missing], np.broadcast_to(poses[:, :3, 3], world.shape)[missing])
print("their x in the world: 0 to %.2f m, y and z 0: the path of the body" % world[missing][:, 0].max())
PYTHON

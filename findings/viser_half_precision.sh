#!/usr/bin/env bash
# viser 1.1.1: add_point_cloud() turns coordinates into half precision, and 8-bit colors are cut, not rounded.
# 300.1 m becomes 300.0, beyond 65504 m all is infinite (numpy's warning is all one sees), and 0.999 becomes 254. With
# precision="float32" a local map is right to the tenth of a millimeter; UTM is still half a meter off.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 viser==1.1.1
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import warnings

import numpy as np
import viser

warnings.simplefilter("ignore")
server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
xyz = np.array([[300.1, 0.0, 0.0], [2001.0, 0.0, 0.0], [456789.0, 5428765.3, 100.0]])
for options in ({}, {"precision": "float32"}):
    cloud = server.scene.add_point_cloud("/cloud", points=xyz, colors=np.full((3, 3), 0.999), **options)
    print(options or "as it is", cloud.points.dtype, "x", cloud.points[:, 0], "y", cloud.points[2, 1], "color", cloud.colors[0, 0])
    assert cloud.colors[0, 0] == 254
    if options:
        assert np.abs(cloud.points - xyz)[:2].max() < 1e-4 and abs(cloud.points[2, 1] - xyz[2, 1]) > 0.1
    else:
        assert cloud.points[:, 0].tolist() == [300.0, 2001.0, np.inf] and np.isinf(cloud.points[2, 1])
server.stop()
PYTHON

#!/usr/bin/env bash
# Open3D 0.20.0: `ushort` and `uint16` are two names of one PLY type, but only one is read with its colors.
# The tensor reader drops colors of type ushort (a warning in the console) and keeps uint16; the legacy reader divides both
# by 255, so that white is 257 where colors go from 0 to 1.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 open3d==0.20.0
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
import open3d

def write_white_point(path, type_name):
    header = "ply\nformat binary_little_endian 1.0\nelement vertex 1\n"
    header += "".join("property float %s\n" % axis for axis in "xyz")
    header += "".join("property %s %s\n" % (type_name, channel) for channel in ("red", "green", "blue")) + "end_header\n"
    with open(path, "wb") as stream:
        stream.write(header.encode() + np.array([1, 2, 3], "<f4").tobytes() + np.array([65535] * 3, "<u2").tobytes())

for type_name in ("ushort", "uint16"):
    path = type_name + ".ply"
    write_white_point(path, type_name)
    tensor = "colors" in open3d.t.io.read_point_cloud(path).point
    legacy = np.asarray(open3d.io.read_point_cloud(path).colors)[0, 0]
    print("%s: tensor reader %s colors; legacy reader says white is %g" % (type_name, "has" if tensor else "has no", legacy))
    assert tensor == (type_name == "uint16") and abs(legacy - 257) < 1e-9
PYTHON

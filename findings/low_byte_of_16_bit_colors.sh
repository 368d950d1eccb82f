#!/usr/bin/env bash
# trimesh 5.2.0 and pyvista 0.49.1 (VTK 9.7.2): of 16-bit PLY colors the low byte is kept.
# Colors x 257 (0x8080) look perfect, the same colors x 256 (0x8000, what LAS files hold) are black: a file that looks right
# in these viewers may look so only by its convention.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 trimesh==5.2.0 pyvista==0.49.1 vtk==9.7.2
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
import pyvista
import trimesh

EIGHT_BIT = np.array([18, 128, 255], np.uint16)

def write_ply(path, gray):
    rows = np.zeros(len(gray), [("xyz", "<f4", 3), ("rgb", "<u2", 3)])
    rows["xyz"][:, 0], rows["rgb"] = np.arange(len(gray)), gray[:, None]
    header = "ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % len(gray)
    header += "".join("property float %s\n" % axis for axis in "xyz")
    header += "".join("property ushort %s\n" % channel for channel in ("red", "green", "blue")) + "end_header\n"
    with open(path, "wb") as stream:
        stream.write(header.encode() + rows.tobytes())

for factor, expected in ((257, EIGHT_BIT), (256, 0 * EIGHT_BIT)):
    write_ply("gray.ply", EIGHT_BIT * np.uint16(factor))
    seen = {"trimesh": trimesh.load("gray.ply").colors[:, 0], "pyvista": pyvista.read("gray.ply")["RGB"][:, 0]}
    for name, gray in seen.items():
        print("%s, x%d: %s is read as %s" % (name, factor, EIGHT_BIT.tolist(), gray.tolist()))
        assert (gray == expected).all()
PYTHON

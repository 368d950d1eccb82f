#!/usr/bin/env bash
# VTK 9.7.2, here through pyvista 0.49.1: its PTS reader leaves out the first two points, and its coordinates are single precision.
# A file of n points comes back as n - 2 without a word, a file of two points empty, whether or not its first line is the number of
# points. UTM coordinates are up to 25 cm off unless the reader is told to use double, which pyvista.read() does not.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 pyvista==0.49.1 vtk==9.7.2
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
import pyvista

random = np.random.default_rng(1)

def read(xyz, rgb, counted):
    with open("points.pts", "w") as file:
        if counted:
            print(len(xyz), file=file)
        for (x, y, z), (red, green, blue) in zip(xyz, rgb):
            print("%.3f %.3f %.3f 7 %d %d %d" % (x, y, z, red, green, blue), file=file)
    return pyvista.read("points.pts")

for count in (2, 10, 1000):
    xyz, rgb = random.random((count, 3)).round(3) * 8, random.integers(0, 256, (count, 3))
    for counted in (True, False):
        cloud = read(xyz, rgb, counted)
        print("%d points, %s a line with their number: %d are read" % (count, "with" if counted else "without", cloud.n_points))
        assert cloud.n_points == count - 2
        assert np.allclose(cloud.points, xyz[2:], atol=1e-5) and (cloud.point_data["Color"] == rgb[2:]).all()

utm = random.random((100, 3)).round(3) + [456789, 5428765, 100]
cloud = read(utm, np.zeros((100, 3), int), True)
error = np.abs(np.asarray(cloud.points, float) - utm[2:]).max()
print("UTM: %s, up to %.3f m off" % (cloud.points.dtype, error))
assert cloud.points.dtype == np.float32 and 0.2 < error <= 0.25
PYTHON

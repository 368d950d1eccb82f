#!/usr/bin/env bash
# copclib 2.6.3 writes, laspy 2.7.0 reads: a COPC file without the octree's root looks empty to laspy's CopcReader.
# copclib writes the nodes that it is given. CopcReader goes down from the root and stops where a node is not listed: query() returns
# 0 of 200 points, or 101 of 201 with a root and a gap below it, and raises nothing. laspy.read() and copclib itself return all.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 laspy==2.7.0 lazrs==0.8.2 copclib==2.6.3
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import copclib
import laspy
import numpy as np

random = np.random.default_rng(1)

def write(nodes):
    """A COPC file of 16 m with nodes as (key, number of points, lower corner, size)."""
    config = copclib.CopcConfigWriter(7, copclib.Vector3(0.01, 0.01, 0.01), copclib.Vector3(0, 0, 0))
    writer = copclib.FileWriter("points.copc.laz", config)
    header, info = writer.copc_config.las_header, writer.copc_config.copc_info
    header.min, header.max = copclib.Vector3(0, 0, 0), copclib.Vector3(16, 16, 16)
    info.center_x = info.center_y = info.center_z = info.halfsize = 8
    info.spacing = 1
    for key, count, corner, size in nodes:
        points = copclib.Points(header)
        for _ in range(count):
            point = points.CreatePoint()
            point.x, point.y, point.z = (corner + size * random.random(3)).tolist()
            points.AddPoint(point)
        writer.AddNode(copclib.VoxelKey(*key), points)
    writer.Close()

root, corner, deep = ((0, 0, 0, 0), 1, 0, 16), ((1, 0, 0, 0), 100, 0, 8), ((2, 3, 3, 3), 100, 12, 4)
for name, nodes, queried in (("no root", (corner, deep), 0), ("root, a gap below it", (root, corner, deep), 101)):
    write(nodes)
    reader = laspy.CopcReader.open("points.copc.laz")
    counts = reader.header.point_count, len(laspy.read("points.copc.laz").points), len(copclib.FileReader("points.copc.laz").GetAllPoints())
    print("%s: header %d, laspy.read %d, copclib %d points;" % (name, *counts), "laspy's CopcReader", len(reader.query()))
    assert len(set(counts)) == 1 and len(reader.query()) == queried
PYTHON

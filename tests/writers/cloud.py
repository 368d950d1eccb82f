"""The cloud that every writer is given: 2,000 points of a room with random colors, where it is or at UTM coordinates."""
from collections import namedtuple

import numpy as np

N_POINTS = 2000
SIZE_M = (20.0, 15.0, 3.0)
ORIGINS_M = {"local": (0.0, 0.0, 0.0), "utm": (465123.0, 4649776.0, 132.0)}

# xyz: N x 3 double, meters; rgb: N x 3 double in [0,1]; rgb8, rgb16: the same rounded to 8 and 16 bits.
Cloud = namedtuple("Cloud", "place origin xyz rgb rgb8 rgb16")


def make_cloud(place):
    """The cloud at a place of ORIGINS_M, the same in every run."""
    random = np.random.Generator(np.random.PCG64(20260))
    origin = np.array(ORIGINS_M[place])
    xyz = origin + random.uniform(0.0, 1.0, (N_POINTS, 3)) * SIZE_M
    rgb = random.uniform(0.0, 1.0, (N_POINTS, 3))
    return Cloud(place, origin, xyz, rgb, np.round(rgb * 255).astype(np.uint8), np.round(rgb * 65535).astype(np.uint16))


def write_reference(cloud, path):
    """Binary PLY of double coordinates and float colors: nothing is lost that counts here."""
    record = np.dtype([("xyz", "<f8", 3), ("rgb", "<f4", 3)])
    rows = np.empty(len(cloud.xyz), record)
    rows["xyz"], rows["rgb"] = cloud.xyz, cloud.rgb
    header = ["ply", "format binary_little_endian 1.0", "element vertex %d" % len(rows)]
    header += ["property double %s" % axis for axis in "xyz"] + ["property float %s" % name for name in ("red", "green", "blue")]
    with open(path, "wb") as stream:
        stream.write(("\n".join(header + ["end_header", ""])).encode("ascii"))
        stream.write(rows.tobytes())

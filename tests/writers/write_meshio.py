"""meshio: PLY with one point cell a vertex or without cells, colors of any type."""
import meshio
import numpy as np

from family import run_family


def mesh(cloud, colors, cells):
    data = {name: colors[:, k] for k, name in enumerate(("red", "green", "blue"))}
    return meshio.Mesh(cloud.xyz, [("vertex", np.arange(len(cloud.xyz))[:, None])] if cells else [], point_data=data)


def ply(cloud, files):
    for name, colors, scale in (("uint8", cloud.rgb8, 255), ("int64", cloud.rgb8.astype(np.int64), 255), ("double", cloud.rgb, 1)):
        mesh(cloud, colors, cells=False).write(files.path("%s.ply" % name, scale=scale))
        mesh(cloud, colors, cells=False).write(files.path("%s ascii.ply" % name, scale=scale), binary=False)
    mesh(cloud, cloud.rgb8, cells=True).write(files.path("vertex cells.ply"))


if __name__ == "__main__":
    run_family([ply])

"""trimesh: PointCloud.export, which always adds an alpha of 255."""
import trimesh

from family import run_family


def export(cloud, files):
    points = trimesh.PointCloud(cloud.xyz, colors=cloud.rgb8)
    lost = {"says": "coars|digit|step|rounded|precis"} if cloud.place == "utm" else {}
    points.export(files.path("export.ply", **lost))
    points.export(files.path("export ascii.ply", **lost), encoding="ascii")
    points.export(files.path("export.xyz", scale=255, columns="x y z r g b -"))


def float_colors(cloud, files):
    lost = {"says": "coars|digit|step|rounded|precis"} if cloud.place == "utm" else {}
    trimesh.PointCloud(cloud.xyz, colors=cloud.rgb).export(files.path("export of 0-1.ply", **lost))


if __name__ == "__main__":
    run_family([export, float_colors])

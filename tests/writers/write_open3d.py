"""Open3D: legacy and tensor writers, every format and color type they take."""
import numpy as np
import open3d

from family import run_family

COARSE = {"says": "coars|digit|step|rounded|precis"}


def coarse(cloud):
    return COARSE if cloud.place == "utm" else {}


def legacy(cloud, files):
    points = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(cloud.xyz))
    points.colors = open3d.utility.Vector3dVector(cloud.rgb)
    save = open3d.io.write_point_cloud
    save(files.path("legacy binary.ply"), points)
    save(files.path("legacy ascii.ply", **coarse(cloud)), points, write_ascii=True)
    save(files.path("legacy binary.pcd", **coarse(cloud)), points)
    save(files.path("legacy ascii.pcd", **coarse(cloud)), points, write_ascii=True)
    save(files.path("legacy compressed.pcd", **coarse(cloud)), points, compressed=True)
    save(files.path("legacy.xyzrgb", columns="x y z r g b"), points)
    save(files.path("legacy.xyz", columns="x y z"), points)
    save(files.path("legacy.pts", skip=1, columns="x y z - r g b", scale=255), points)


def legacy_normals(cloud, files):
    points = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(cloud.xyz))
    points.colors = open3d.utility.Vector3dVector(cloud.rgb)
    points.normals = open3d.utility.Vector3dVector(np.tile([0.0, 0.6, 0.8], (len(cloud.xyz), 1)))
    open3d.io.write_point_cloud(files.path("legacy normals.ply"), points)
    open3d.io.write_point_cloud(files.path("legacy normals.xyzn", columns="x y z - - -", says="normal"), points)


def tensor(cloud, coordinate, colors):
    points = open3d.t.geometry.PointCloud(open3d.core.Tensor(cloud.xyz.astype(coordinate)))
    points.point.colors = open3d.core.Tensor(colors)
    return points


def tensor_ply(cloud, files):
    save = open3d.t.io.write_point_cloud
    for name, colors in (("uchar", cloud.rgb8), ("ushort", cloud.rgb16), ("float", cloud.rgb.astype(np.float32)), ("double", cloud.rgb)):
        points = tensor(cloud, np.float64, colors)
        save(files.path("tensor %s.ply" % name), points)
        save(files.path("tensor %s ascii.ply" % name, **coarse(cloud)), points, write_ascii=True)
    save(files.path("tensor float32 xyz.ply", **coarse(cloud)), tensor(cloud, np.float32, cloud.rgb8))


def tensor_pcd(cloud, files):
    save = open3d.t.io.write_point_cloud
    for name, colors in (("uchar", cloud.rgb8), ("ushort", cloud.rgb16), ("float", cloud.rgb.astype(np.float32))):
        for coordinate in (np.float64, np.float32):
            stored = "%s %s" % (np.dtype(coordinate).name, name)
            lost = coarse(cloud) if coordinate == np.float32 else {}
            points = tensor(cloud, coordinate, colors)
            save(files.path("tensor %s.pcd" % stored, **lost), points)
            save(files.path("tensor %s compressed.pcd" % stored, **lost), points, compressed=True)
            save(files.path("tensor %s ascii.pcd" % stored, **lost), points, write_ascii=True)


def tensor_text(cloud, files):
    """Of float coordinates: of double ones these writers fail, or write other numbers."""
    save = open3d.t.io.write_point_cloud
    save(files.path("tensor.npz", key="positions", color_key="colors"), tensor(cloud, np.float64, cloud.rgb8))
    points = tensor(cloud, np.float32, cloud.rgb.astype(np.float32))
    save(files.path("tensor.xyzrgb", columns="x y z r g b", **coarse(cloud)), points)
    save(files.path("tensor.xyz", columns="x y z", **coarse(cloud)), points)
    save(files.path("tensor.pts", skip=1, columns="x y z r g b", scale=255, **coarse(cloud)), tensor(cloud, np.float32, cloud.rgb8))


if __name__ == "__main__":
    run_family([legacy, legacy_normals, tensor_ply, tensor_pcd, tensor_text])

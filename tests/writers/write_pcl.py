"""PCL's programs (Debian's pcl-tools): what they make of a PCD or PLY with packed colors."""
import os
import subprocess

import numpy as np

from cloud import write_reference
from family import run_family

COARSE = "coars|digit|step|rounded|precis"


def write_pcd(cloud, path, coordinate, color_type):
    """Binary PCD, x y z of 4 or 8 bytes and rgb packed as F or U."""
    record = np.dtype([("xyz", coordinate, 3), ("rgb", "<u4")])
    rows = np.empty(len(cloud.xyz), record)
    rows["xyz"] = cloud.xyz
    rows["rgb"] = cloud.rgb8.astype(np.uint32) @ np.array([65536, 256, 1], np.uint32)
    size, n = np.dtype(coordinate).itemsize, len(rows)
    header = ("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb\nSIZE %d %d %d 4\nTYPE F F F %s\nCOUNT 1 1 1 1\n"
              "WIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA binary\n" % (size, size, size, color_type, n, n))
    with open(path, "wb") as stream:
        stream.write(header.encode("ascii"))
        stream.write(rows.tobytes())


def run(*words):
    """pcl_ply2ply's exit code is 1 whatever happened; a file that is missing is noticed by family.Files."""
    subprocess.run(words, check=words[0] != "pcl_ply2ply", capture_output=True, timeout=60)


def input_file(cloud, files, coordinate="<f4", color_type="F"):
    path = os.path.join(files.folder, "%s_input_%s%s" % (files.place, coordinate[1:], color_type))
    write_pcd(cloud, path + ".pcd", coordinate, color_type)
    return path + ".pcd"


def coarse(cloud):
    return {"says": COARSE} if cloud.place == "utm" else {}


def convert_pcd(cloud, files):
    for color_type in "FU":
        source = input_file(cloud, files, "<f4", color_type)
        for mode, name in enumerate(("ascii", "binary", "compressed")):
            target = files.path("convert_pcd_ascii_binary %s rgb %s.pcd" % (color_type, name), **coarse(cloud))
            run("pcl_convert_pcd_ascii_binary", source, target, str(mode))
    source = input_file(cloud, files, "<f8", "F")
    run("pcl_convert_pcd_ascii_binary", source, files.path("convert_pcd_ascii_binary double.pcd", **coarse(cloud)), "0")
    run("pcl_convert_pcd_ascii_binary", source, files.path("convert_pcd_ascii_binary double compressed.pcd"), "2")


def pcd2ply(cloud, files):
    """An unsigned rgb stays in one piece in the rows, where the header has three bytes."""
    source = input_file(cloud, files)
    run("pcl_pcd2ply", "-format", "1", source, files.path("pcd2ply F rgb.ply", **coarse(cloud)))
    run("pcl_pcd2ply", "-format", "0", source, files.path("pcd2ply F rgb ascii.ply", **coarse(cloud)))
    source = input_file(cloud, files, "<f4", "U")
    longer = {"undecodable": True, "says": "left|longer|beyond|more bytes|size"}
    run("pcl_pcd2ply", "-format", "1", source, files.path("pcd2ply U rgb.ply", **longer))
    packed = {"undecodable": True, "says": "not of type"}
    run("pcl_pcd2ply", "-format", "0", source, files.path("pcd2ply U rgb ascii.ply", **packed))


def ply2pcd(cloud, files):
    """From a PLY of double coordinates and float colors."""
    source = os.path.join(files.folder, files.place + "_source.ply")
    write_reference(cloud, source)
    run("pcl_ply2pcd", "-format", "0", source, files.path("ply2pcd ascii.pcd", **coarse(cloud)))
    run("pcl_ply2pcd", "-format", "1", source, files.path("ply2pcd binary.pcd"))
    run("pcl_ply2ply", "--format=ascii", source, files.path("ply2ply ascii.ply", **coarse(cloud)))
    run("pcl_ply2ply", "--format=binary_big_endian", source, files.path("ply2ply big-endian.ply"))


def converter(cloud, files):
    source = input_file(cloud, files)
    for form in ("ascii", "binary"):
        run("pcl_converter", "-f", form, source, files.path("converter %s.ply" % form, **coarse(cloud)))
    run("pcl_converter", "-f", "binary_compressed", source, files.path("converter compressed.pcd", **coarse(cloud)))


if __name__ == "__main__":
    run_family([convert_pcd, pcd2ply, ply2pcd, converter])

"""plyfile: every type that a vertex property may have, both byte orders, text, other elements before and after."""
import numpy as np
import plyfile

from family import run_family

RGB = ("red", "green", "blue")


def vertices(cloud, coordinate, color, colors, names=RGB, more=()):
    rows = np.empty(len(cloud.xyz), [(k, coordinate) for k in "xyz"] + [(k, color) for k in names] + list(more))
    for k, name in enumerate("xyz"):
        rows[name] = cloud.xyz[:, k]
    for k, name in enumerate(names):
        rows[name] = colors[:, k]
    for name, *_ in more:
        rows[name] = 7
    return rows


def write(path, rows, others_before=(), others_after=(), **options):
    vertex = plyfile.PlyElement.describe(rows, "vertex")
    plyfile.PlyData([*others_before, vertex, *others_after], **options).write(path)


def color_types(cloud, files):
    eight, sixteen, unit = cloud.rgb8, cloud.rgb16, cloud.rgb
    for name, kind, colors, scale in (
            ("uchar", "u1", eight, 255), ("ushort", "u2", sixteen, 65535), ("ushort x256", "u2", eight * np.uint16(256), 65280),
            ("ushort 8 bit", "u2", eight, 255), ("int 0-255", "i4", eight, 255), ("short 0-255", "i2", eight, 255),
            ("uint 0-255", "u4", eight, 255), ("float 0-1", "f4", unit, 1), ("double 0-1", "f8", unit, 1),
            ("float 0-255", "f4", eight, 255), ("float 0-255 fractions", "f4", unit * 255, 255), ("double 16 bit", "f8", sixteen, 65535)):
        write(files.path("double, %s.ply" % name, scale=scale), vertices(cloud, "f8", kind, colors))


def coordinate_types(cloud, files):
    lost = {"says": "coars|digit|step|rounded|precis"} if cloud.place == "utm" else {}
    write(files.path("float, uchar.ply", **lost), vertices(cloud, "f4", "u1", cloud.rgb8))
    widened = cloud._replace(xyz=cloud.xyz.astype(np.float32))
    write(files.path("float widened to double, uchar.ply", **lost), vertices(widened, "f8", "u1", cloud.rgb8))


def byte_orders(cloud, files):
    rows = vertices(cloud, "f8", "u2", cloud.rgb16)
    write(files.path("big-endian.ply"), rows, byte_order=">")
    write(files.path("text.ply"), rows, text=True)
    write(files.path("text, uchar.ply"), vertices(cloud, "f8", "u1", cloud.rgb8), text=True)


def names(cloud, files):
    for name, of in (("r g b", "rgb"), ("diffuse", ["diffuse_" + k for k in RGB]), ("upper case", ["Red", "Green", "Blue"])):
        write(files.path("names %s.ply" % name), vertices(cloud, "f8", "u1", cloud.rgb8, of))


def other_content(cloud, files):
    camera = plyfile.PlyElement.describe(np.zeros(3, [("fx", "f4"), ("model", "i4")]), "camera")
    more = [("alpha", "u1"), ("scalar_intensity", "f4"), ("label", "i4")]
    rows = vertices(cloud, "f8", "u1", cloud.rgb8, more=more)
    write(files.path("more properties.ply"), rows)
    write(files.path("another element first.ply"), rows, others_before=[camera])
    write(files.path("another element first, text.ply"), rows, others_before=[camera], text=True)
    write(files.path("another element last, comments.ply"), rows, others_after=[camera], comments=["made by a test"], obj_info=["none"])


def faces(cloud, files):
    triangles = np.zeros(5, [("vertex_indices", "i4", (3,))])
    triangles["vertex_indices"] = np.arange(15).reshape(5, 3)
    element = plyfile.PlyElement.describe(triangles, "face")
    write(files.path("faces.ply", says="mesh|face"), vertices(cloud, "f8", "u1", cloud.rgb8), others_after=[element])


if __name__ == "__main__":
    run_family([color_types, coordinate_types, byte_orders, names, other_content, faces])

"""laspy: point formats with color, 16-bit colors as the three conventions have them."""
import laspy
import numpy as np

from family import run_family

N_SCALES = {"x257": (257, 65535), "x256": (256, 65280), "8 bit": (1, 255)}


def las(cloud, version, point_format, scale_m=0.001):
    header = laspy.LasHeader(version=version, point_format=point_format)
    header.scales, header.offsets = [scale_m] * 3, np.floor(cloud.origin)
    data = laspy.LasData(header)
    data.x, data.y, data.z = cloud.xyz.T
    return data


def formats(cloud, files):
    for version, point_format in (("1.2", 2), ("1.2", 3), ("1.3", 5), ("1.4", 7), ("1.4", 8), ("1.4", 10)):
        data = las(cloud, version, point_format)
        data.red, data.green, data.blue = cloud.rgb16.T
        data.write(files.path("LAS %s format %d.las" % (version, point_format)))


def color_conventions(cloud, files):
    for name, (factor, white) in N_SCALES.items():
        data = las(cloud, "1.2", 2, 0.0001)
        data.red, data.green, data.blue = cloud.rgb8.T.astype(np.uint16) * factor
        data.write(files.path("LAS colors %s.las" % name, scale=white))


def without_color(cloud, files):
    las(cloud, "1.4", 6).write(files.path("LAS 1.4 format 6.las"))
    las(cloud, "1.2", 2).write(files.path("LAS format 2, colors left 0.las", no_color=True, says="black|no color"))


def losses(cloud, files):
    """Colors of 0..1 are cut to 0; the raw records are integers without their scale."""
    data = las(cloud, "1.4", 7)
    data.red, data.green, data.blue = cloud.rgb.T
    data.write(files.path("LAS float colors.las", no_color=True, says="black|no color"))
    np.save(files.path("points.array.npy", says="scale|integers"), data.points.array)


if __name__ == "__main__":
    run_family([formats, color_conventions, without_color, losses])

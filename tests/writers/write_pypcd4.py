"""pypcd4: packed colors, channels of their own, every encoding."""
import numpy as np
from pypcd4 import Encoding, PointCloud

from family import run_family

ENCODINGS = {"ascii": Encoding.ASCII, "binary": Encoding.BINARY, "compressed": Encoding.BINARY_COMPRESSED}


def packed(cloud, files):
    """As text a packed color is printed with ten decimals: 0.0000000000."""
    points = PointCloud.from_xyzrgb_points(np.column_stack([cloud.xyz.astype(np.float32), PointCloud.encode_rgb(cloud.rgb8)]))
    coarse = ["coars|digit|step|rounded|precis"] if cloud.place == "utm" else []
    for name, encoding in ENCODINGS.items():
        black = {"no_color": True, "says": "black|no color"} if name == "ascii" else {"says": coarse[0]} if coarse else {}
        points.save(files.path("packed %s.pcd" % name, **black), encoding=encoding)


def channels(cloud, files):
    for kind, colors, scale in ((np.uint8, cloud.rgb8, 255), (np.uint16, cloud.rgb16, 65535), (np.int32, cloud.rgb8, 255),
                                (np.float32, cloud.rgb, 1)):
        columns = [*cloud.xyz.T, *colors.astype(kind).T]
        for names in (("r", "g", "b"), ("red", "green", "blue")):
            points = PointCloud.from_points(columns, ("x", "y", "z", *names), (np.float64,) * 3 + (kind,) * 3)
            for name, encoding in ENCODINGS.items():
                if name == "binary" or names[0] == "r":
                    label = "double, %s %s %s.pcd" % (names[0], np.dtype(kind).name, name)
                    points.save(files.path(label, scale=scale), encoding=encoding)


if __name__ == "__main__":
    run_family([packed, channels])

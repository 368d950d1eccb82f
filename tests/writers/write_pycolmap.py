"""pycolmap: a reconstruction's points, as text and binary."""
import os
import shutil

import numpy as np
import pycolmap

from family import run_family


def write(cloud, files):
    model = pycolmap.Reconstruction()
    for xyz, rgb in zip(cloud.xyz, cloud.rgb8):
        model.add_point3D(xyz, pycolmap.Track(), rgb)
    folder = os.path.join(files.folder, "model_" + files.place)
    os.makedirs(folder, exist_ok=True)
    model.write_binary(folder)
    model.write_text(folder)
    shutil.move(os.path.join(folder, "points3D.bin"), files.path("points3D.bin"))
    shutil.move(os.path.join(folder, "points3D.txt"), files.path("points3D.txt", columns="- x y z r g b -", skip=3, scale=255))
    model.export_PLY(files.path("export_PLY.ply", **({"says": "coars|digit|step|rounded|precis"} if cloud.place == "utm" else {})))


if __name__ == "__main__":
    run_family([write])

"""pyvista (VTK): PLY with the array that is named as texture, without colors if none is."""
import pyvista

from family import run_family

COARSE = "coars|digit|step|rounded|precis"


def save(cloud, files):
    points = pyvista.PolyData(cloud.xyz)
    points["RGB"] = cloud.rgb8
    lost = {"says": COARSE} if cloud.place == "utm" else {}
    points.save(files.path("save.ply", **lost))
    points.save(files.path("save texture.ply", **lost), texture="RGB")
    points.save(files.path("save texture ascii.ply", **lost), texture="RGB", binary=False)
    points.save(files.path("save.vtk", undecodable=True, says="VTK"))


if __name__ == "__main__":
    run_family([save])

"""pyntcloud: coordinates become float on writing, whatever they were."""
import pandas
import pyntcloud

from family import run_family

COARSE = "coars|digit|step|rounded|precis"


def points(cloud):
    columns = {name: cloud.xyz[:, k] for k, name in enumerate("xyz")}
    columns.update({name: cloud.rgb8[:, k] for k, name in enumerate(("red", "green", "blue"))})
    return pyntcloud.PyntCloud(pandas.DataFrame(columns))


def to_file(cloud, files):
    lost = {"says": COARSE} if cloud.place == "utm" else {}
    points(cloud).to_file(files.path("to_file.ply", **lost))
    points(cloud).to_file(files.path("to_file as_text.ply", **lost), as_text=True)
    points(cloud).to_file(files.path("to_file.npz", key="points", **lost))


def text(cloud, files):
    """Of all columns only x y z are written."""
    lost = {"says": COARSE} if cloud.place == "utm" else {}
    points(cloud).to_file(files.path("to_file.csv", columns="- x y z", sep=",", skip=1, **lost))
    points(cloud).to_file(files.path("to_file.xyz", columns="x y z", sep=" ", **lost), index=False, header=False, sep=" ")


if __name__ == "__main__":
    run_family([to_file, text])

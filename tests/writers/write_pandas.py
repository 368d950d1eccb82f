"""pandas: to_csv in the ways people call it."""
import pandas

from family import run_family

NAMES = ["x", "y", "z", "red", "green", "blue"]


def frame(cloud, names):
    return pandas.DataFrame({**{n: cloud.xyz[:, k] for k, n in enumerate(names[:3])}, **{n: cloud.rgb8[:, k] for k, n in enumerate(names[3:])}})


def to_csv(cloud, files):
    how = {"columns": "x y z r g b", "scale": 255}
    rows = frame(cloud, NAMES)
    rows.to_csv(files.path("to_csv.csv", columns="- x y z r g b", scale=255, skip=1, sep=","))
    rows.to_csv(files.path("to_csv no index.csv", skip=1, sep=",", **how), index=False)
    rows.to_csv(files.path("to_csv no header.csv", sep=",", **how), index=False, header=False)
    rows.to_csv(files.path("to_csv tab.txt", skip=1, sep="\t", **how), index=False, sep="\t")
    rows.to_csv(files.path("to_csv decimal comma.csv", skip=1, sep=";", decimal=",", **how), index=False, sep=";", decimal=",")
    rows.to_csv(files.path("to_csv byte order mark.csv", skip=1, sep=",", **how), index=False, encoding="utf-8-sig")
    rows.to_csv(files.path("to_csv blank.txt", skip=1, sep=" ", **how), index=False, sep=" ", float_format="%.4f")


def to_csv_names(cloud, files):
    how = {"columns": "x y z r g b", "scale": 255, "skip": 1, "sep": ","}
    frame(cloud, ["X", "Y", "Z", "R", "G", "B"]).to_csv(files.path("to_csv XYZRGB.csv", **how), index=False)
    frame(cloud, ["Easting", "Northing", "Height", "Red", "Green", "Blue"]).to_csv(files.path("to_csv easting.csv", **how), index=False)
    swapped = frame(cloud, NAMES)[["red", "green", "blue", "z", "y", "x"]]
    swapped.to_csv(files.path("to_csv other order.csv", columns="r g b z y x", scale=255, skip=1, sep=","), index=False)


if __name__ == "__main__":
    run_family([to_csv, to_csv_names])

"""numpy alone: savetxt, save, savez, tofile, and the text layouts that MATLAB and R write."""
import numpy as np

from family import run_family

COARSE = "coars|digit|step|rounded|precis"


def table(cloud, colors):
    return np.column_stack([cloud.xyz, colors])


def savetxt(cloud, files):
    how = {"columns": "x y z r g b"}
    np.savetxt(files.path("savetxt default 0-255.txt", scale=255, **how), table(cloud, cloud.rgb8))
    np.savetxt(files.path("savetxt default 0-1.txt", **how), table(cloud, cloud.rgb))
    np.savetxt(files.path("savetxt fraction 0-255.txt", scale=255, **how), table(cloud, cloud.rgb * 255))
    np.savetxt(files.path("savetxt 16 bit.xyz", scale=65535, **how), table(cloud, cloud.rgb16), fmt=["%.6f"] * 3 + ["%d"] * 3)
    np.savetxt(files.path("savetxt mm.xyz", scale=255, **how), table(cloud, cloud.rgb8), fmt=["%.3f"] * 3 + ["%d"] * 3)
    np.savetxt(files.path("savetxt comma header.csv", scale=255, skip=1, sep=",", **how), table(cloud, cloud.rgb8), delimiter=",",
               header="x,y,z,r,g,b", comments="")
    np.savetxt(files.path("savetxt comment header.txt", scale=255, skip=1, **how), table(cloud, cloud.rgb8), header="x y z r g b")
    np.savetxt(files.path("savetxt slashes header.asc", scale=255, skip=1, **how), table(cloud, cloud.rgb8), header="X Y Z R G B",
               comments="//")
    lost = {"says": COARSE} if cloud.place == "utm" else {}
    np.savetxt(files.path("savetxt semicolon 9 digits.txt", scale=255, sep=";", **how, **lost), table(cloud, cloud.rgb8), delimiter=";", fmt="%.9g")
    np.savetxt(files.path("savetxt crlf.txt", scale=255, **how), table(cloud, cloud.rgb8), newline="\r\n")


def savetxt_other_columns(cloud, files):
    normals = np.tile([0.0, 0.6, 0.8], (len(cloud.xyz), 1))
    intensity = np.arange(len(cloud.xyz)) % 100
    np.savetxt(files.path("savetxt points only.xyz", columns="x y z"), cloud.xyz)
    np.savetxt(files.path("savetxt colors and normals.txt", scale=255, columns="x y z r g b - - -"),
               np.column_stack([table(cloud, cloud.rgb8), normals]))
    np.savetxt(files.path("savetxt normals and colors.txt", scale=255, columns="x y z - - - r g b"),
               np.column_stack([cloud.xyz, normals, cloud.rgb8]))
    np.savetxt(files.path("savetxt intensity.pts", scale=255, skip=1, columns="x y z - r g b"),
               np.column_stack([cloud.xyz, intensity, cloud.rgb8]), fmt=["%.6f"] * 3 + ["%d"] * 4, header=str(len(cloud.xyz)), comments="")


def matlab(cloud, files):
    """writematrix (15 digits), writetable (names), dlmwrite (5 digits), save -ascii (8 digits)."""
    how = {"columns": "x y z r g b", "scale": 255}
    np.savetxt(files.path("MATLAB writematrix.csv", sep=",", **how), table(cloud, cloud.rgb8), delimiter=",", fmt="%.15g")
    np.savetxt(files.path("MATLAB writetable.csv", sep=",", skip=1, **how), table(cloud, cloud.rgb8), delimiter=",", fmt="%.15g",
               header="X,Y,Z,Red,Green,Blue", comments="")
    lost = {"says": COARSE} if cloud.place == "utm" else {}
    np.savetxt(files.path("MATLAB dlmwrite.txt", sep=",", **how, **lost), table(cloud, cloud.rgb8), delimiter=",", fmt="%.5g")
    np.savetxt(files.path("MATLAB save ascii.txt", **how, **lost), table(cloud, cloud.rgb8), fmt="%16.7e")


def r_write_table(cloud, files):
    """R's write.table and write.csv: quoted names, and numbered rows that write.table's header does not name."""
    how = {"columns": "- x y z r g b", "scale": 255, "skip": 1}
    rows = ['"%d"%s%s' % (k + 1, "%s", "%s".join("%.15g" % v for v in row)) for k, row in enumerate(table(cloud, cloud.rgb8))]
    names = ['"%s"' % name for name in ("x", "y", "z", "red", "green", "blue")]
    for name, sep, first in (("R write.csv.csv", ",", ['""']), ("R write.table.txt", " ", [])):
        with open(files.path(name, sep=sep, **how), "w") as stream:
            stream.write(sep.join(first + names) + "\n" + "".join(row.replace("%s", sep) + "\n" for row in rows))


def npy(cloud, files):
    how = {"columns": "x y z r g b"}
    np.save(files.path("save double 0-1.npy", **how), table(cloud, cloud.rgb))
    np.save(files.path("save double 0-255.npy", scale=255, **how), table(cloud, cloud.rgb8))
    lost = {"says": COARSE} if cloud.place == "utm" else {}
    np.save(files.path("save float 0-1.npy", **how, **lost), table(cloud, cloud.rgb).astype(np.float32))
    np.save(files.path("save big-endian.npy", **how), table(cloud, cloud.rgb).astype(">f8"))
    np.save(files.path("save points only.npy", columns="x y z"), cloud.xyz)
    record = np.dtype([(k, "<f8") for k in "xyz"] + [(k, "u1") for k in ("red", "green", "blue")])
    rows = np.empty(len(cloud.xyz), record)
    for k, name in enumerate("xyz"):
        rows[name] = cloud.xyz[:, k]
    for k, name in enumerate(("red", "green", "blue")):
        rows[name] = cloud.rgb8[:, k]
    np.save(files.path("save records.npy"), rows)


def npz(cloud, files):
    for points, colors in (("points", "colors"), ("xyz", "rgb"), ("positions", "colors")):
        name = "savez %s %s.npz" % (points, colors)
        np.savez(files.path(name, key=points, color_key=colors), **{points: cloud.xyz, colors: cloud.rgb8})
    np.savez_compressed(files.path("savez compressed floats.npz", key="points", color_key="colors"), points=cloud.xyz,
                        colors=cloud.rgb.astype(np.float32))


def kitti(cloud, files):
    """Sensor coordinates: not for UTM."""
    if cloud.place == "local":
        rows = np.column_stack([cloud.xyz, np.linspace(0, 1, len(cloud.xyz))]).astype("<f4")
        rows.tofile(files.path("tofile KITTI.bin"))


if __name__ == "__main__":
    run_family([savetxt, savetxt_other_columns, matlab, r_write_table, npy, npz, kitti])

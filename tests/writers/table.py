"""docs/WRITERS.md: what every writer's files are worth, and the best that a perfect map can score in each way of storing."""
import os
import re

import numpy as np

from cloud import make_cloud
from scores import closest_pair_m, score

HEAD = """# What files of other programs are worth

One cloud of 2,000 points of a room (20 x 15 x 3 m) with random colors, once near 0 and once at UTM coordinates (465 km, 4650 km),
written by the libraries and programs below and compared with itself. Every number is of a decoder that shares no code with cmap
(tests/writers); `cmap_eval` gives the same to 2e-5, or says what the writer has lost. This page is written by

```sh
tests/writers/make_environment.sh build/writers          # 2.5 GB, minutes; names the Debian packages that are missing
build/writers/bin/python tests/writers/cross_table_test.py build/release/tools/cmap_eval build/writers_files --table docs/WRITERS.md
```

The test `writers/cross_table` does the same with the Python it finds (Debian's has numpy alone), or with that of
`cmake -DCMAP_WRITERS_PYTHON=$PWD/build/writers/bin/python`.
"""

BEST = """
## The best a perfect map can score

Chamfer is the sum of both mean distances, CD the color distance, CF = -20 log10 CD. A map that is the reference itself gets no better
than this once it is stored so: differences between maps below these values mean nothing.

| coordinates stored as | Chamfer, local (m) | Chamfer, UTM (m) |
|---|---|---|
"""

COLORS = """
| colors stored as | CD | CF (dB) |
|---|---|---|
"""

WRITERS = """
## Writers

"Stored" is what the file holds, as its header or its numbers say; a dash for Chamfer: no such file, or one that cannot be decoded as
its header says. Where a writer rounded so much that points fall together, CD depends on which of several equally near points is taken:
both ends are given. The last column is what `cmap_eval` says of what was lost.
"""


def significant(values, digits):
    return np.array([float("%.*g" % (digits, v)) for v in values.ravel()]).reshape(values.shape)


def coordinate_forms(xyz):
    """How coordinates are stored, and what is left of them."""
    return {"double; text of 16 digits": xyz, "float (4 bytes)": xyz.astype(np.float32).astype(np.float64),
            "text of 9 significant digits": significant(xyz, 9), "text of 6 significant digits": significant(xyz, 6),
            "LAS, steps of 0.001 m": np.round(xyz, 3), "LAS, steps of 0.01 m": np.round(xyz, 2)}


def color_forms(rgb):
    """How colors are stored, and what is read of them."""
    eight = np.round(rgb * 255)
    return {"float, 0 to 1": rgb.astype(np.float32), "16 bit": np.round(rgb * 65535) / 65535, "8 bit, rounded": eight / 255,
            "8 bit, cut (CloudCompare, MeshLab, point-cloud-utils)": np.floor(rgb * 255) / 255,
            "8 bit x 256, read as / 65535 (not by cmap)": eight * 256 / 65535,
            "one gray value a point (no color)": np.repeat(rgb @ [[0.299], [0.587], [0.114]], 3, axis=1)}


def number(value):
    return "–" if value is None else "0" if value < 1e-12 else "%.3g" % value


def best_lines():
    clouds = {place: make_cloud(place) for place in ("local", "utm")}
    lines = [BEST]
    for name in coordinate_forms(clouds["local"].xyz):
        values = []
        for cloud in clouds.values():
            stored = coordinate_forms(cloud.xyz)[name]
            values.append(number(score(cloud.xyz, None, closest_pair_m(cloud.xyz), stored, None).chamfer_m))
        lines.append("| %s | %s |\n" % (name, " | ".join(values)))
    lines.append(COLORS)
    rgb = clouds["local"].rgb
    for name, stored in color_forms(rgb).items():
        cd = np.linalg.norm(stored - rgb, axis=1).mean()
        lines.append("| %s | %.3g | %.1f |\n" % (name, cd, -20 * np.log10(cd)))
    return lines


def color_cell(found):
    if found is None or found.color_low is None:
        return "–"
    low, high = "%.5f" % found.color_low, "%.5f" % found.color_high
    return low if low == high else "%s to %s" % (low, high)


def said_cell(verdict):
    """The first message that names what the case says was lost; a pipe would end the cell."""
    if verdict.wrong:
        return "**not yet right**"
    wanted = verdict.case.get("says")
    named = [line for line in verdict.said if wanted and re.search(wanted, line, re.I)]
    return named[0].replace(os.path.dirname(verdict.case["path"]) + "/", "").replace("|", "\\|") if named else ""


def writer_lines(family, verdicts):
    lines = ["\n### %s\n\n| file | stored | Chamfer, local (m) | Chamfer, UTM (m) | CD, local | CD, UTM | said (UTM) |\n" % family,
             "|---|---|---|---|---|---|---|\n"]
    by_name = {}
    for verdict in verdicts:
        by_name.setdefault(verdict.case["name"], {})[verdict.case["place"]] = verdict
    for name, places in by_name.items():
        both = [places.get("local"), places.get("utm")]
        last = both[1] or both[0]
        found = [verdict.found if verdict else None for verdict in both]
        chamfer = [number(scores.chamfer_m if scores else None) for scores in found]
        lines.append("| %s | %s | %s | %s | %s |\n" % (
            name, last.stored, " | ".join(chamfer), " | ".join(color_cell(scores) for scores in found), said_cell(last)))
    return lines


def write_table(path, verdicts, titles):
    """titles: family -> heading with its version."""
    lines = [HEAD] + best_lines() + [WRITERS]
    for family, title in titles.items():
        lines += writer_lines(title, [verdict for verdict in verdicts if verdict.case["family"] == family])
    with open(path, "w", encoding="utf-8") as stream:
        stream.write("".join(lines))

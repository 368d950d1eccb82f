"""CloudCompare (Debian's package) without a display: text and PLY, read with a global shift; colors are cut to 8 bits."""
import os
import subprocess

from cloud import write_reference
from family import run_family

ASC, PLY = ["-C_EXPORT_FMT", "ASC"], ["-C_EXPORT_FMT", "PLY", "-PLY_EXPORT_FMT"]
TEXT = {"columns": "x y z r g b", "scale": 255}


def save(path, *options):
    """Words of the command line that write the open cloud once more."""
    return [*options, "-SAVE_CLOUDS", "FILE", path]


def every_format(cloud, files):
    """All in one run of the program, which takes seconds to start."""
    source = os.path.join(files.folder, files.place + "_source.ply")
    write_reference(cloud, source)
    digits = {"says": "coars|digit|step|rounded|precis"} if cloud.place == "utm" else {}
    words = save(files.path("ASC.asc", **TEXT), *ASC, "-PREC", "8")
    words += save(files.path("ASC comma.csv", sep=",", **TEXT), *ASC, "-PREC", "6", "-SEP", "COMMA")
    words += save(files.path("ASC header, count.txt", skip=2, **TEXT), *ASC, "-SEP", "SPACE", "-ADD_HEADER", "-ADD_PTS_COUNT")
    words += save(files.path("PLY binary.ply"), *PLY, "BINARY_LE")
    words += save(files.path("PLY big-endian.ply"), *PLY, "BINARY_BE")
    words += save(files.path("PLY ascii.ply", **digits), *PLY, "ASCII")
    subprocess.run(["xvfb-run", "-a", "CloudCompare", "-SILENT", "-AUTO_SAVE", "OFF", "-NO_TIMESTAMP", "-O", "-GLOBAL_SHIFT", "AUTO",
                    source, *words], check=True, capture_output=True, timeout=250)


if __name__ == "__main__":
    run_family([every_format])

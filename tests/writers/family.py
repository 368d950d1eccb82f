"""What the write_*.py files share: a family of writers fills a folder and says of each file how it is to be read."""
import json
import os
import sys
import traceback

from cloud import ORIGINS_M, make_cloud


class Files:
    """The files of one family at one place. path() names the next file and notes how an independent decoder reads it:

    scale    what the color numbers are divided by (the decoder's default: 255 for bytes, 65535 for two bytes, 1 for floats)
    columns  of text and NPY: what each column is ("x y z r g b", "-" for one that is neither)
    skip, sep, decimal   of text: lines before the rows, separator, decimal point
    key, color_key       of NPZ: the arrays
    says     a regular expression: what the writer lost, to be named by the program, which may refuse the file then
    no_color the colors that the file seems to hold are none
    undecodable          the file does not hold what its header says: it must be refused
    """

    def __init__(self, folder, place):
        self.folder, self.place, self.cases = folder, place, []

    def path(self, name, **how):
        path = os.path.join(self.folder, "%s_%s" % (self.place, name.replace(" ", "_")))
        self.cases.append({"name": name, "place": self.place, "path": path, **how})
        return path


def run_family(writers):
    """Called by each write_*.py: FOLDER on the command line is filled, what was written is printed as JSON."""
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    cases, failures = [], []
    for place in ORIGINS_M:
        cloud = make_cloud(place)
        for write in writers:
            files = Files(folder, place)
            try:
                write(cloud, files)
            except Exception:  # one writer that fails must not hide the others
                failures.append("%s at %s: %s" % (write.__name__, place, traceback.format_exc(limit=-2)))
            cases += [case for case in files.cases if os.path.exists(case["path"])]
            missing = [case["name"] for case in files.cases if not os.path.exists(case["path"])]
            failures += ["%s at %s wrote no %s" % (write.__name__, place, name) for name in missing]
    with open(os.path.join(folder, "cases.json"), "w") as stream:
        json.dump({"cases": cases, "failures": failures}, stream, indent=1)

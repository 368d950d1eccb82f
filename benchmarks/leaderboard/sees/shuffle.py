#!/usr/bin/env python3
"""A map against its reference, as it is and with its colors shuffled among all its points: what local color recall says, and what others.

Without maps: the simulated room, whose estimate is exact but for one half that is 40 % too bright.
"""
import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import defects
import scenes

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tests/oracle"))
from ply import read_ply  # noqa: E402

SHOWN = {"LCR": ("local_color_recall", "value"), "its coverage": ("local_color_recall", "coverage"), "CD": ("color_distance", "value"),
         "CW": ("color_wasserstein", "value")}


def room(folder):
    """Reference and estimate."""
    paths = [folder / "reference.ply", folder / "estimate.ply"]
    scenes.write(paths[0], *scenes.sample("room", 1, 1))
    scenes.write(paths[1], *defects.exposure(*scenes.sample("room", 1, 2), 40, None))
    return paths


def evaluate(program, reference, estimate):
    """With the paper's parameters, which are the program's defaults."""
    command = [program, reference, estimate, "--metrics", "color", "-o", "-"]
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, text=True, check=True)
    metrics = json.loads(done.stdout)["metrics"]
    return [metrics[name][part] for name, part in SHOWN.values()]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], epilog=__doc__.splitlines()[2])
    parser.add_argument("cmap_eval", type=Path)
    parser.add_argument("maps", type=Path, nargs="*", metavar="REFERENCE ESTIMATE", help="PLY")
    args = parser.parse_args()
    if len(args.maps) not in (0, 2):
        parser.error("two maps, or none")
    with tempfile.TemporaryDirectory(prefix="cmap-shuffle-") as folder:
        reference, estimate = args.maps or room(Path(folder))
        points, colors = read_ply(estimate)
        shuffled = Path(folder) / "shuffled.ply"
        scenes.write(shuffled, points, colors[np.random.default_rng(1).permutation(len(colors))])
        print("%-15s %s" % ("", "".join("%14s" % name for name in SHOWN)))
        for name, path in (("as it is", estimate), ("colors shuffled", shuffled)):
            print("%-15s %s" % (name, "".join("%14.4f" % value for value in evaluate(args.cmap_eval, reference, path))))


if __name__ == "__main__":
    sys.exit(main())

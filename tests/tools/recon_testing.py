"""What tests of cmap_recon share: a small simulated capture, copied for each test, and ways to change it."""

import csv
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

PROGRAM = Path(os.environ["CMAP_RECON"]).resolve()
SIMULATE = Path(os.environ["CMAP_SIMULATE"]).resolve()
DONE, USAGE, INPUT, UNSUPPORTED = 0, 2, 3, 4

# Six seconds of a street in four sessions (6, 6, 6 and 3 frames, two shared with the next), few pixels and beams.
QUICK = ["route.length_m=24", "truth.map_points_per_m2=5", "camera.width_px=160", "camera.height_px=120",
         "camera.focal_px=110", "predictions.width_px=70", "predictions.session_length=6", "lidar.azimuth_steps=300"]


def simulate(output, *settings):
    arguments = [argument for setting in settings for argument in ("--set", setting)]
    subprocess.run([SIMULATE, "small_town", *arguments, "-o", output, "--quiet"], check=True)


def lines_kept(path, keep):
    """A table without the rows that `keep` refuses; comments and the header stay."""
    rows = path.read_text().splitlines()
    path.write_text("".join(row + "\n" for row in rows if not row[0].isdigit() or keep(row)))


def swapped(path, row, column=0, separator=","):
    """The times of a row and the next change places."""
    rows = [line.split(separator) for line in path.read_text().splitlines()]
    rows[row][column], rows[row + 1][column] = rows[row + 1][column], rows[row][column]
    path.write_text("".join(separator.join(cells) + "\n" for cells in rows))


def times_moved(path, column, by_s):
    """A table whose times are later."""
    header, *rows = list(csv.reader(path.read_text().splitlines()))
    for row in rows:
        row[column] = f"{float(row[column]) + by_s:.9f}"
    path.write_text("".join(",".join(row) + "\n" for row in [header, *rows]))


def edit_json(path, **values):
    path.write_text(json.dumps({**json.loads(path.read_text()), **values}))


class CaptureCase(unittest.TestCase):
    """A capture of each test's own, in self.capture, and a place for results, self.output."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="cmap-recon-")
        cls.addClassCleanup(folder.cleanup)
        cls.simulated = Path(folder.name) / "capture"
        simulate(cls.simulated, *QUICK)
        cls.truth = json.loads((cls.simulated / "truth" / "scales.json").read_text())["scales"]
        assert len(cls.truth) == 4

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="cmap-recon-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.capture, self.output = self.folder / "capture", self.folder / "map"
        shutil.copytree(self.simulated, self.capture)

    def session(self, k):
        return self.capture / "predictions" / f"session_{k:04}"

    def change(self, k, name, change):
        """An array of session k, in place, or for what `change` returns."""
        path = self.session(k) / f"{name}.npy"
        array = np.load(path)
        changed = change(array)
        np.save(path, array if changed is None else changed)

    def remove_sessions(self, *ks):
        for k in ks:
            shutil.rmtree(self.session(k))

    def times(self, k):
        return [float(row.split(",")[1]) for row in (self.session(k) / "frames.csv").read_text().splitlines()[1:]]

    def pack(self, k):
        """Session k as NAME.npz with NAME.frames.csv."""
        folder = self.session(k)
        np.savez(folder.with_suffix(".npz"), **{path.stem: np.load(path) for path in folder.glob("*.npy")})
        (folder / "frames.csv").rename(folder.with_suffix(".frames.csv"))
        shutil.rmtree(folder)

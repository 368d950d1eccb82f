#!/usr/bin/env python3
"""benchmarks/leaderboard/sees on small rooms: what must hold of the metrics, and its parts; CTest sets CMAP_EVAL and CMAP_SOURCE_DIR."""

import csv
import itertools
import os
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path

import numpy as np

PROGRAM = Path(os.environ["CMAP_EVAL"]).resolve()
SOURCE = Path(os.environ["CMAP_SOURCE_DIR"]).resolve()
SEES = SOURCE / "benchmarks/leaderboard/sees"
sys.path.insert(0, str(SEES))
import defects  # noqa: E402
import judgment  # noqa: E402
import neighbors  # noqa: E402

OF_COLOR = ("shuffled", "one_color", "color_noise", "blurred", "exposure", "bleeding")


class QuickRun(unittest.TestCase):
    """Rooms of 20,000 points, the smallest and the largest size of every defect."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="cmap-sees-")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        command = [sys.executable, SEES / "run.py", PROGRAM, "-o", cls.folder, "--quick", "--scenes", "room"]
        subprocess.run([str(word) for word in command], stdout=subprocess.DEVNULL, check=True)
        with open(cls.folder / "room.csv", newline="") as stream:
            cls.values = {(row["defect"], float(row["size"])): row for row in csv.DictReader(stream)}

    def value(self, metric, defect="exact", size=0):
        return float(self.values[defect, size][metric])

    def times(self, metric, defect, size):
        """How many times the exact estimate's value."""
        return self.value(metric, defect, size) / self.value(metric)

    def test_shuffled_colors_are_seen_by_distances_not_by_the_papers_recall(self):
        self.assertGreater(self.times("CD", "shuffled", 0.1), 1.1)
        self.assertGreater(self.times("CD", "shuffled", 5), 4)
        self.assertGreater(self.times("CW", "shuffled", 5), 4)
        self.assertLess(self.times("LCR, 0.05 m", "shuffled", 5), 0.9)
        self.assertGreater(self.times("LCR, 0.5 m", "shuffled", 5), 0.995)

    def test_one_color_is_perfectly_consistent_and_seen_by_all_others(self):
        self.assertEqual(self.value("CCS, 0.1 m", "one_color", 100), 0)
        self.assertLess(self.times("CCS, 0.1 m", "blurred", 2), 0.8)
        for metric in ("CD", "CW", "CIEDE2000"):
            self.assertGreater(self.times(metric, "one_color", 100), 3, metric)
        self.assertLess(self.times("LCR, 0.5 m", "one_color", 100), 0.9)

    def test_other_defects_of_color(self):
        for defect, size in (("color_noise", 0.4), ("blurred", 2), ("exposure", 40), ("bleeding", 0.2)):
            for metric in ("CD", "CW", "CIEDE2000"):
                self.assertGreater(self.times(metric, defect, size), 1.3, (metric, defect))
            self.assertLess(self.value("skill of CW", defect, size), 0.95, defect)

    def test_color_does_not_bear_on_geometry(self):
        metrics = [row.title for row in judgment.groups("room")[2]]
        self.assertIn("AWD", metrics)
        for (defect, size), metric in itertools.product(self.values, metrics):
            if defect in OF_COLOR:
                self.assertEqual(self.value(metric, defect, size), self.value(metric), (metric, defect))

    def test_defects_of_geometry(self):
        for defect, size in (("noise", 0.2), ("double_wall", 0.2), ("drift", 0.2), ("holes", 40)):
            self.assertGreater(self.times("Chamfer", defect, size), 1.2, defect)
            self.assertGreater(self.times("AWD", defect, size), 1.2, defect)
        self.assertLess(self.times("completeness@0.02", "holes", 40), 0.9)
        self.assertGreater(self.times("fitness@0.02", "holes", 40), 0.98)

    def test_copies_with_jitter_buy_no_color(self):
        for size in (2, 8):
            self.assertGreater(self.times("CD", "densified", size), 1.02)
            self.assertLess(self.value("skill of CW", "densified", size), self.value("skill of CW") + 0.05)
            self.assertGreater(self.times("completeness@0.02", "densified", size), 1.1)  # recall they buy
            self.assertLess(self.times("fitness@0.02", "densified", size), 0.9)

    def test_table_and_figure(self):
        table = (self.folder / "table.md").read_text()
        self.assertRegex(table, r"\| CCS, 0\.1 m \| 0\.1 \|[^|]*\*\*wrong: 100\*\*")
        drawn = xml.etree.ElementTree.parse(self.folder / "room.svg").getroot()
        words = {element.text for element in drawn.iter("{http://www.w3.org/2000/svg}text")}
        self.assertLessEqual({row.title for row in judgment.rows("room")} | {"▼100"}, words)


class Shuffle(unittest.TestCase):
    def run_command(self, *maps):
        """What is printed: values of the map as it is, and with its colors shuffled."""
        words = re.search(r"^python3 (benchmarks/leaderboard/sees/shuffle.py) \S+", (SOURCE / "README.md").read_text(), re.M)
        command = [sys.executable, words[1], PROGRAM, *maps]
        printed = subprocess.run([str(word) for word in command], cwd=SOURCE, capture_output=True, text=True, check=True).stdout
        return [dict(zip(("recall", "coverage", "distance", "wasserstein"), map(float, line.split()[-4:])))
                for line in printed.splitlines()[1:]]

    def test_the_readmes_command_shows_what_it_says(self):
        as_it_is, shuffled = self.run_command()
        self.assertGreater(shuffled["recall"], as_it_is["recall"] + 0.03)
        self.assertGreater(shuffled["distance"], 2 * as_it_is["distance"])
        self.assertGreater(shuffled["wasserstein"], 2 * as_it_is["wasserstein"])

    def test_other_maps(self):
        as_it_is, shuffled = self.run_command(*(SOURCE / "data_samples/town" / name for name in ("reference.ply", "estimate.ply")))
        self.assertAlmostEqual(as_it_is["recall"], 0.8250, places=4)
        self.assertLess(shuffled["recall"], as_it_is["recall"])


class Parts(unittest.TestCase):
    def setUp(self):
        self.rng = np.random.default_rng(4)
        self.points, self.colors = self.rng.random((500, 3)), self.rng.random((500, 3))

    def test_nearest_against_all_pairs(self):
        queries = self.points + 0.1 * defects.SIDEWARD
        distances = np.linalg.norm(queries[:, None] - self.points, axis=2)
        np.testing.assert_array_equal(neighbors.nearest(self.points, queries, 0.101), distances.argmin(axis=1))

    def test_neighborhood_means_by_hand(self):
        points = np.array([[0.5, 0, 0], [1.5, 0, 0], [2.5, 0, 0], [9, 0, 0]])
        means = neighbors.neighborhood_means(points, np.array([[1.0], [2], [6], [5]]), 1.5)  # three cells of 1
        np.testing.assert_allclose(means[:, 0], [1.5, 3, 4, 5])

    def test_shuffling_keeps_all_colors_and_moves_them_no_farther_than_its_cubes(self):
        points, made = defects.shuffled(self.points, self.colors, 0.2, self.rng)
        self.assertIs(points, self.points)
        np.testing.assert_array_equal(np.sort(made, axis=0), np.sort(self.colors, axis=0))
        origin = [np.flatnonzero((self.colors == color).all(axis=1))[0] for color in made]
        self.assertLess(np.abs(self.points[origin] - self.points).max(), 0.2)
        self.assertLess(np.mean(np.arange(500) == origin), 0.9)

    def test_judgment_by_hand(self):
        def runs(value):
            return {"scale": {"chamfer": {"value": value, "better": "lower"}}}

        row = judgment.Row("Chamfer", "chamfer")
        seeds = [{("exact", 0): runs(exact), ("d", 1): runs(exact + 0.1), ("d", 2): runs(exact + 0.3), ("d", 3): runs(exact - 0.3),
                  ("d", 4): runs(None)} for exact in (1.0, 1.2)]  # noise 0.2
        cell = judgment.judge_cell(row, seeds, "d", [1, 2, 3, 4])
        self.assertEqual(cell.signs, [0, 1, -1, 0])
        self.assertIsNone(cell.changes[3])
        self.assertEqual(judgment.words(cell), "2, **wrong: 3**")


if __name__ == "__main__":
    unittest.main()

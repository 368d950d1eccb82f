#!/usr/bin/env python3
"""cmap_eval --html: what the page holds, against the maps themselves and scipy's neighbors. How it looks and works in a
browser is tests/report/html_report_test.mjs."""

import base64
import gzip
import json
import re
import unittest

import numpy as np
from scipy.spatial import cKDTree

from cmap_eval_testing import DONE, TOWN, UNSUPPORTED, USAGE, CmapEval, ply

REFERENCE, ESTIMATE = TOWN / "reference.ply", TOWN / "estimate.ply"


def element(page, name):
    found = re.findall(rf'<script type="[^"]*" id="{name}">(.*?)</script>', page, re.S)
    assert len(found) == 1, name
    return found[0]


def unpacked(page):
    """The fields of both maps by name, as lib/report/packed_map.hpp says they are coded."""
    description = json.loads(element(page, "cmap-page"))
    data = gzip.decompress(base64.b64decode(element(page, "cmap-points"), validate=True))
    maps, place = {}, 0
    for entry in description["maps"]:
        n, fields = entry["points"], {}
        for plane in entry["planes"]:
            size = int(plane["type"][1:]) // 8
            planes = np.frombuffer(data[place : place + n * size], np.uint8).reshape(size, n).astype(np.int64)
            place += n * size
            zigzag = sum(planes[k] << 8 * k for k in range(size))
            values = np.cumsum((zigzag >> 1) ^ -(zigzag & 1)) % (1 << 8 * size)
            fields[plane["field"]] = plane["max"] * (values / 65535) ** 2 if "max" in plane else values
        steps = np.stack([fields[axis] for axis in "xyz"], axis=1)
        fields["xyz"] = np.array(entry["origin_m"]) + steps * np.array(entry["step_m"])
        maps[entry["id"]] = fields
    assert place == len(data), "nothing follows the last plane"
    return description, maps


def read(path):
    """Positions and colors of a binary PLY of float x, y, z and uchar red, green, blue."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    kinds = {b"float": "<f4", b"uchar": "u1"}
    properties = [line.split() for line in data[:end].splitlines() if line.startswith(b"property")]
    rows = np.frombuffer(data[end:], [(name.decode(), kinds[kind]) for _, kind, name in properties])
    return (np.stack([rows[n].astype(float) for n in names], axis=1) for names in ("xyz", ("red", "green", "blue")))


class Html(CmapEval):
    def setUp(self):
        super().setUp()
        self.html = self.outputs / "report.html"

    def page_of(self, *arguments):
        result = self.run_program(*arguments, "--html", self.html)
        self.assertEqual((result.returncode, result.stderr), (DONE, b""))
        return self.html.read_text()

    def test_the_report_in_the_page_is_the_report(self):
        page = self.page_of(REFERENCE, ESTIMATE, "-o", self.json)
        self.assertEqual(json.loads(element(page, "cmap-report")), json.loads(self.json.read_text()))
        self.assertIn("curve", json.loads(self.json.read_text())["metrics"]["local_color_recall"])

    def test_every_metric_is_defined(self):
        page = self.page_of(REFERENCE, ESTIMATE, "--metrics", "all", "-o", self.json)
        defined = {m["id"]: m["definition"] for m in json.loads(element(page, "cmap-page"))["metrics"]}
        self.assertEqual(list(defined), list(json.loads(self.json.read_text())["metrics"]))
        self.assertTrue(all(text.endswith((".", ":")) and len(text) > 20 for text in defined.values()), defined)

    def test_points_and_errors_are_those_of_the_maps(self):
        description, maps = unpacked(self.page_of(REFERENCE, ESTIMATE))
        clouds = {"reference": tuple(read(REFERENCE)), "estimate": tuple(read(ESTIMATE))}
        for name, other in (("reference", "estimate"), ("estimate", "reference")):
            points, colors = clouds[name]
            found = maps[name]
            self.assertEqual(len(found["xyz"]), len(points), "the town has fewer points than the page takes")
            offset, nearest = cKDTree(points).query(found["xyz"])
            self.assertLess(offset.max(), 0.5 * np.sqrt(3) * 1e-3 + 1e-9)  # half a step of a millimeter an axis
            lone = cKDTree(points).query(found["xyz"], k=2)[0][:, 1] > 2e-3  # told apart from others in spite of rounding
            self.assertGreater(np.count_nonzero(lone), 0.99 * len(points))
            self.assertEqual(len(set(nearest[lone])), np.count_nonzero(lone), "every point once")
            for channel, letter in enumerate("rgb"):
                np.testing.assert_array_equal(found[letter][lone], colors[nearest[lone], channel])
            distance, neighbor = cKDTree(clouds[other][0]).query(points[nearest])
            step = np.sqrt(distance.max() * distance) / 65535 + distance.max() / 65535**2  # half a step of the root
            self.assertLess((np.abs(found["distance"] - distance) - step)[lone].max(), 1e-6)
            color_distance = np.linalg.norm(colors[nearest] - clouds[other][1][neighbor], axis=1) / 255
            self.assertLess(np.abs(found["color_distance"] - color_distance)[lone].max(), np.sqrt(3) / 65535)

    def test_classes_are_those_of_the_metric(self):
        page = self.page_of(REFERENCE, ESTIMATE, "-o", self.json)
        recall = json.loads(self.json.read_text())["metrics"]["local_color_recall"]
        counts = np.bincount(unpacked(page)[1]["reference"]["lcr"].astype(int), minlength=3)
        self.assertEqual(counts[2], recall["n_recalled"])
        self.assertEqual(counts[1] + counts[2], recall["n_covered"])

    def test_histograms_count_every_point(self):
        description, _ = unpacked(self.page_of(REFERENCE, ESTIMATE))
        (reference, _), (estimate, _) = read(REFERENCE), read(ESTIMATE)
        distances = {
            "estimate_to_reference": cKDTree(reference).query(estimate)[0],
            "reference_to_estimate": cKDTree(estimate).query(reference)[0],
        }
        histogram = description["distributions"][0]
        for direction in histogram["directions"]:
            edges = histogram["bin_width"] * np.arange(len(direction["counts"]) + 1)
            values = distances[direction["id"]]
            # A distance on an edge may fall to either side of it, by rounding: none does here.
            self.assertGreater(np.abs(values[:, None] - edges[None, ::20]).min(), 1e-12)
            np.testing.assert_array_equal(direction["counts"], np.histogram(values, edges)[0])
            self.assertEqual(direction["beyond"], np.count_nonzero(values > edges[-1]))

    def test_the_same_bytes_for_any_number_of_threads(self):
        pages = [self.page_of(REFERENCE, ESTIMATE, "--threads", n) for n in "12"]
        self.assertEqual(*(element(page, "cmap-points") for page in pages))
        self.assertEqual(*(element(page, "cmap-page") for page in pages))

    def test_nothing_is_fetched_and_no_name_becomes_markup(self):
        (self.inputs / "<").mkdir()
        evil = self.input("</script><b>&.ply", REFERENCE.read_bytes())
        page = self.page_of(evil, ESTIMATE)
        self.assertNotIn("</script><b>", page)
        self.assertEqual(json.loads(element(page, "cmap-report"))["inputs"]["reference"]["path"], str(evil))
        self.assertEqual(re.findall(r'(?:src|href)\s*=\s*["\']?(?!data:|blob:|#)', page.split("cmap-report")[0]), [])
        self.assertLess(len(page), 6e6)

    def test_maps_without_color(self):
        plain = self.input("plain.ply", ply([(0, 0, 0), (1, 0, 0)]))
        description, maps = unpacked(self.page_of(plain, plain))
        self.assertEqual([layer["id"] for layer in description["layers"]], ["reference-height", "estimate-height", "distance"])
        self.assertNotIn("r", maps["reference"])
        self.refused(UNSUPPORTED, "no color", plain, plain, "--metrics", "color", "--html", self.html)

    def test_refused_names(self):
        self.refused(USAGE, "page.json: the page is HTML", REFERENCE, ESTIMATE, "--html", self.outputs / "page.json")
        self.refused(USAGE, "cannot be written", REFERENCE, ESTIMATE, "--html", self.outputs / "none/report.html")
        copy = self.input("map.html", REFERENCE.read_bytes())
        self.refused(USAGE, "would overwrite", copy, ESTIMATE, "--html", copy)


if __name__ == "__main__":
    unittest.main()

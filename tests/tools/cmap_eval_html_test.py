#!/usr/bin/env python3
"""cmap_eval --html: what the page holds, against the maps themselves and scipy's neighbors. How it looks and works in a
browser is tests/report/html_report_test.mjs."""

import base64
import gzip
import json
import re
import unittest
from pathlib import Path

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
        grid = np.repeat(np.arange(len(entry["grids"])), [g["points"] for g in entry["grids"]])
        assert len(grid) == n, "every point is in a grid"
        for plane in entry["planes"]:
            size = int(plane["type"][1:]) // 8
            planes = np.frombuffer(data[place : place + n * size], np.uint8).reshape(size, n).astype(np.int64)
            place += n * size
            zigzag = sum(planes[k] << 8 * k for k in range(size))
            values = np.cumsum((zigzag >> 1) ^ -(zigzag & 1)) % (1 << 8 * size)
            most = np.array(plane.get("max", [0, 0]))[grid]
            fields[plane["field"]] = most * (values / 65534) ** 2 if "max" in plane else values
        steps = np.stack([fields[axis] for axis in "xyz"], axis=1)
        origins, sizes = (np.array([g[key] for g in entry["grids"]]) for key in ("origin_m", "step_m"))
        fields["xyz"], fields["step"] = origins[grid] + steps * sizes[grid], sizes[grid]
        maps[entry["id"]] = fields
    assert place == len(data), "nothing follows the last plane"
    return description, maps


def shared(report):
    """A report as its page holds it: names of files, without their folders."""
    inputs = {role: {**given, "path": Path(given["path"]).name} for role, given in report["inputs"].items()}
    words = [Path(word).name if word.startswith("/") else word for word in report["run"]["command"].split(" ")]
    return {**report, "inputs": inputs, "run": {**report["run"], "command": " ".join(words)}}


def double_ply(points):
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
    header += "".join(f"property double {axis}\n" for axis in "xyz") + "end_header\n"
    return header.encode() + points.astype("<f8").tobytes()


def colored_ply(points, colors):
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
    header += "".join(f"property float {axis}\n" for axis in "xyz")
    header += "".join(f"property uchar {name}\n" for name in ("red", "green", "blue")) + "end_header\n"
    rows = np.zeros(len(points), [("xyz", "<f4", 3), ("rgb", "u1", 3)])
    rows["xyz"], rows["rgb"] = points, colors
    return header.encode() + rows.tobytes()


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

    def page_of(self, *arguments, **options):
        result = self.run_program(*arguments, "--html", self.html, **options)
        self.assertEqual((result.returncode, result.stderr), (DONE, b""))
        return self.html.read_text()

    def test_the_report_in_the_page_is_the_report(self):
        page = self.page_of(REFERENCE, ESTIMATE, "-o", self.json)
        report = json.loads(self.json.read_text())
        self.assertEqual(json.loads(element(page, "cmap-report")), shared(report))
        self.assertIn("curve", report["metrics"]["local_color_recall"])

    def test_a_page_names_files_and_no_folders(self):
        folder = self.inputs / "home of ann"
        folder.mkdir()
        reference = self.input("home of ann/reference.ply", REFERENCE.read_bytes())
        transform = self.input("home of ann/T.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")
        for arguments in ((reference, ESTIMATE, "--transform", transform), (reference,)):
            page = self.page_of(*arguments, "-o", self.json)
            self.assertIn(str(reference), self.json.read_text(), "the report does")
            for part in ("home of ann", str(self.folder), str(TOWN)):
                self.assertNotIn(part, page)
            self.assertIn("reference.ply", page)

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
            step = np.sqrt(distance.max() * distance) / 65534 + distance.max() / 65534**2  # half a step of the root
            self.assertLess((np.abs(found["distance"] - distance) - step)[lone].max(), 1e-6)
            color_distance = np.linalg.norm(colors[nearest] - clouds[other][1][neighbor], axis=1) / 255
            self.assertLess(np.abs(found["color_distance"] - color_distance)[lone].max(), np.sqrt(3) / 65534)

    def test_positions_of_any_size(self):
        """2 cm, 400 m and UTM, each with a stray that coarsens nothing but itself: every point within half a step,
        which is at most a ten thousandth of the map's size."""
        random = np.random.default_rng(1)
        for size, origin in ((0.02, (0, 0, 0)), (400, (0, 0, 0)), (60, (452_000, 5_411_000, 250))):
            points = np.array(origin) + size * random.random((3000, 3)) * (1, 1, 0.2)
            stray = np.array([origin]) + (0, 0, -1e7)
            path = self.input("map.ply", double_ply(np.vstack([points, stray])))
            _, maps = unpacked(self.page_of(path))
            found, step = maps["estimate"]["xyz"], maps["estimate"]["step"]
            self.assertLessEqual(step[:-1].max(), max(1e-4 * size, 1e-6) * np.sqrt(2.04))
            # The map itself is kept in single precision from an origin close by.
            rounding = np.spacing(np.float32(2 * size)) + np.spacing(np.abs(np.array(origin, float)))
            offset, nearest = cKDTree(points).query(found[:-1])
            self.assertEqual(len(set(nearest)), len(points), "every point once")
            self.assertTrue((np.abs(found[:-1] - points[nearest]) <= 0.5 * step[:-1] + rounding).all(), size)
            self.assertLess(np.abs(found[-1] - stray).max(), 2.0, "the stray is there")

    def test_shares_of_classes_are_of_all_points(self):
        """Thinned evenly over its surface, this map keeps fewer than half of its dense points, but every sparse one."""
        dense = np.stack(np.meshgrid(np.arange(600) / 60, np.arange(600) / 60, [0]), axis=-1).reshape(-1, 3)
        sparse = np.stack(np.meshgrid(50 + np.arange(200) / 2, np.arange(200) / 2, [0]), axis=-1).reshape(-1, 3)
        points = np.vstack([dense, sparse])
        colors = np.repeat([(200, 0, 0), (0, 0, 200)], [len(dense), len(sparse)], axis=0)
        reference = self.input("reference.ply", colored_ply(points, colors))
        estimate = self.input("estimate.ply", colored_ply(points, np.full_like(colors, (200, 0, 0))))
        description, maps = unpacked(self.page_of(reference, estimate, "-o", self.json))
        metric = json.loads(self.json.read_text())["metrics"]["local_color_recall"]["value"]
        self.assertEqual(metric, 0.9)
        self.assertLess((maps["reference"]["lcr"] == 2).mean(), 0.8, "of the page's points")
        layers = {layer["id"]: layer for layer in description["layers"]}
        shares = {c["label"]: c["share"] for c in layers["lcr"]["classes"]}
        self.assertEqual(shares, {"not covered": 0, "wrong color": 0.1, "recalled": metric})
        ranked = layers["color-distance"]["ranked"]
        self.assertEqual((ranked["points"], len(ranked["values"])), (400_000, 10_001))
        self.assertEqual(np.count_nonzero(ranked["values"]), 1000, "of ranks 40 apart")

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
        evil = Path("</script><!--<script><b>&.ply")
        self.input(evil, REFERENCE.read_bytes())
        page = self.page_of(evil, ESTIMATE, cwd=self.inputs)
        self.assertNotIn("</script><!--", page)
        self.assertNotIn("<!--<script>", page)
        self.assertEqual(json.loads(element(page, "cmap-report"))["inputs"]["reference"]["path"], str(evil))
        self.assertEqual(re.findall(r'(?:src|href)\s*=\s*["\']?(?!data:|blob:|#)', page.split("cmap-report")[0]), [])
        self.assertLess(len(page), 6e6)

    def test_maps_without_color(self):
        plain = self.input("plain.ply", ply([(0, 0, 0), (1, 0, 0)]))
        description, maps = unpacked(self.page_of(plain, plain))
        self.assertEqual([layer["id"] for layer in description["layers"]], ["reference-height", "estimate-height", "distance"])
        self.assertNotIn("r", maps["reference"])
        self.refused(UNSUPPORTED, "no color", plain, plain, "--metrics", "color", "--html", self.html)

    def test_an_empty_selection_has_no_page(self):
        for maps in ((REFERENCE, ESTIMATE), (REFERENCE,)):
            result = self.run_program(*maps, "--crop", "900,900,900,901,901,901", "--html", self.html)
            self.expect_refusal(result, UNSUPPORTED, "crop")

    def test_a_map_of_one_color_and_of_one_point(self):
        for points in ([(1, 2, 3)], [(1, 2, 3)] * 40, [(i, 0, 0) for i in range(40)]):
            path = self.input("one.ply", colored_ply(np.array(points), np.full((len(points), 3), 7)))
            self.assertEqual(len(unpacked(self.page_of(path, path))[1]["estimate"]["xyz"]), len(points))

    def test_refused_names(self):
        self.refused(USAGE, "page.json: the page is HTML", REFERENCE, ESTIMATE, "--html", self.outputs / "page.json")
        self.refused(USAGE, "cannot be written", REFERENCE, ESTIMATE, "--html", self.outputs / "none/report.html")
        copy = self.input("map.html", REFERENCE.read_bytes())
        self.refused(USAGE, "would overwrite", copy, ESTIMATE, "--html", copy)


if __name__ == "__main__":
    unittest.main()

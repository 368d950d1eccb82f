#!/usr/bin/env python3
"""cmap_eval with one map: what needs no reference, against numpy and scipy, and what is refused without one."""

import json
import unittest

import numpy as np
from scipy.spatial import cKDTree

from cmap_eval_html_test import element, read, shared, unpacked
from cmap_eval_testing import DONE, INPUT, NOT_MET, SCHEMA, TOWN, UNSUPPORTED, USAGE, CmapEval, jsonschema, ply

MAP = TOWN / "estimate.ply"


class OneMap(CmapEval):
    def test_the_numbers_are_those_of_the_definitions(self):
        report = self.evaluate(MAP, "--ccs-voxel", "0.5", "--mme-radius", "0.5")
        points, colors = (part.astype(float) for part in read(MAP))
        places = np.unique(points, axis=0)
        nearest = cKDTree(places).query(places, k=2)[0][:, 1]
        spacing = report["metrics"]["point_spacing"]
        self.assertEqual((spacing["n"], spacing["n_copies"]), (len(places), len(points) - len(places)))
        self.assertAlmostEqual(spacing["value"], np.median(nearest), delta=1e-9)
        self.assertAlmostEqual(spacing["mean"], nearest.mean(), delta=1e-9)
        _, voxel = np.unique(np.floor(points / 0.5), axis=0, return_inverse=True)
        traces = [np.cov(colors[voxel == v] / 255, rowvar=False).trace() for v in range(voxel.max() + 1) if (voxel == v).sum() > 1]
        consistency = report["metrics"]["color_consistency"]
        self.assertAlmostEqual(consistency["median"], np.median(traces), delta=1e-9)
        entropies = []
        for i, around in enumerate(cKDTree(points).query_ball_point(points, 0.5)):
            others = [k for k in around if k != i]
            if len(others) >= 10:
                entropies.append(0.5 * np.log((2 * np.pi * np.e) ** 3 * np.linalg.det(np.cov(points[others], rowvar=False))))
        self.assertAlmostEqual(report["metrics"]["mean_map_entropy"]["value"], np.mean(entropies), delta=1e-6)

    def test_the_report_is_that_of_a_pair_without_the_reference(self):
        alone = self.evaluate(MAP, "--metrics", "color,mme,density")
        pair = self.evaluate(TOWN / "reference.ply", MAP, "--metrics", "color,mme,density")
        self.assertEqual(alone["schema"], "cmap.report/2")
        self.assertEqual(alone["inputs"], {"estimate": pair["inputs"]["estimate"]})
        self.assertIsNone(alone["alignment"])
        self.assertEqual(set(alone["metrics"]), {"color_consistency", "mean_map_entropy", "point_spacing"})
        for metric, record in alone["metrics"].items():
            of_pairs = ("reference", "floor", "chance")
            without = {key: value for key, value in pair["metrics"][metric].items() if key not in of_pairs}
            self.assertEqual(record, without, metric)

    def test_the_schema_knows_one_map(self):
        if jsonschema is None:
            self.skipTest("no jsonschema")
        alone = self.evaluate(MAP)
        pair = self.evaluate(TOWN / "reference.ply", MAP, "--metrics", "default,mme,density")
        mixed = [dict(alone, alignment=pair["alignment"]), dict(alone, metrics=pair["metrics"]), dict(pair, alignment=None)]
        for metric in ("color_consistency", "mean_map_entropy", "point_spacing"):
            mixed.append(dict(alone, metrics={metric: pair["metrics"][metric]}))
        mixed.append(dict(alone, inputs=pair["inputs"]))
        mixed.append(dict(pair, inputs=alone["inputs"]))
        for report in mixed:
            with self.assertRaises(jsonschema.ValidationError):
                jsonschema.Draft7Validator(SCHEMA).validate(report)

    def test_table_and_json_on_stdout(self):
        table = self.run_program(MAP).stdout.decode()
        self.assertRegex(table, rf"^map       {MAP}: [0-9,]+ points, PLY binary little endian, color u8\n")
        self.assertRegex(table, r"\ndensity\n  point spacing +0\.\d+ m +[0-9,]+ places, mean 0\.\d+\n")
        self.assertNotIn("reference", table)
        printed = self.run_program(MAP, "--format", "json", "-o", self.json).stdout.decode()
        self.check_report(printed)
        self.assertEqual(printed, self.json.read_text())
        self.assertEqual(self.run_program(MAP, "--quiet").stdout, b"")

    def test_the_page(self):
        html = self.outputs / "map.html"
        result = self.run_program(MAP, "--html", html, "-o", self.json)
        self.assertEqual((result.returncode, result.stderr), (DONE, b""))
        page = html.read_text()
        self.assertEqual(json.loads(element(page, "cmap-report")), shared(json.loads(self.json.read_text())))
        description, maps = unpacked(page)
        self.assertEqual(description["title"], "estimate.ply")
        self.assertEqual([layer["id"] for layer in description["layers"]], ["estimate", "estimate-height"])
        self.assertEqual(description["distributions"], [])
        points, colors = read(MAP)
        offset, nearest = cKDTree(points).query(maps["estimate"]["xyz"])
        self.assertEqual(len(offset), len(points))
        self.assertLess(offset.max(), 0.5 * np.sqrt(3) * 1e-3 + 1e-9)

    def test_requirements(self):
        met = ("--require", "point_spacing<=1", "--require", "MME<=0", "--mme-radius", "0.5")
        self.assertEqual(self.run_program(MAP, *met).returncode, DONE)
        result = self.run_program(MAP, "--require", "point_spacing<=0.001", "-o", self.json)
        self.assertEqual(result.returncode, NOT_MET)
        self.assertIn("requirement not met: point_spacing<=0.001 (found 0.", result.stderr.decode())
        self.check_report(self.json.read_text())

    def refused_alone(self, code, says, *arguments):
        outputs = ("-o", self.json, "--html", self.outputs / "map.html")
        self.expect_refusal(self.run_program(*arguments, *outputs), code, says)

    def test_what_needs_a_reference_is_refused_by_name(self):
        missing = "needs a reference map, which is missing"
        for metric in ("LCR", "chamfer", "geometry", "distribution", "color_psnr"):
            self.refused_alone(USAGE, f"metrics: {metric} {missing}", MAP, "--metrics", metric)
        self.refused_alone(USAGE, f'require "LCR>=0.2": local_color_recall {missing}', MAP, "--require", "LCR>=0.2")
        for option, *value in (("align", "gicp"), ("as", "open3d"), ("bootstrap", "10"), ("observed", "auto"), ("sensitivity",)):
            self.refused_alone(USAGE, f"{option}: {missing}", MAP, f"--{option}", *value)
        config = self.input("config.json", '{"align": "icp"}')
        self.refused_alone(USAGE, f"align: {missing}", MAP, "--config", config)
        for option in ("transform", "initial", "ref-trajectory", "est-trajectory", "observed-from"):
            self.refused_alone(USAGE, [f"--{option} needs two maps", str(MAP)], MAP, f"--{option}", self.reference)
        for option in ("export-errors", "export-reference-errors", "figure"):
            self.refused_alone(USAGE, f"--{option} needs two maps", MAP, f"--{option}", self.outputs / "x.ply")
        self.refused_alone(USAGE, "cmap_render", MAP, "--figure", self.outputs / "x.png")

    def test_bad_maps(self):
        self.refused_alone(INPUT, "none.ply: no such file", self.inputs / "none.ply")
        empty = self.input("empty.ply", ply([]))
        self.refused_alone(INPUT, str(empty), empty)
        bare = self.input("bare.ply", ply([(0, 0, 0), (1, 0, 0)]))
        report = self.evaluate(bare)
        self.assertIsNone(report["metrics"]["color_consistency"]["value"])
        self.assertEqual(report["metrics"]["point_spacing"]["value"], 1)
        self.json.unlink()
        self.refused_alone(UNSUPPORTED, "the map has no color", bare, "--metrics", "color")
        self.refused_alone(UNSUPPORTED, "no point of the map is inside", bare, "--crop", "5,5,5,6,6,6")

    def test_an_empty_name_is_no_missing_one(self):
        """A script's unset variable must not turn a comparison into something else."""
        self.refused_alone(USAGE, "EST", self.reference, "")
        self.refused_alone(USAGE, "REF", "")

    def test_the_parameters_of_a_report_are_a_configuration(self):
        first = self.evaluate(MAP, "--mme-radius", "0.3", "--voxel", "0.2")
        again = self.evaluate(MAP, "--config", self.input("again.json", json.dumps(first["parameters"])))
        del first["run"], again["run"]
        self.assertEqual(again, first)

    def test_the_same_bytes_for_any_number_of_threads(self):
        reports = [self.evaluate(MAP, "--threads", n) for n in "14"]
        for report in reports:
            del report["run"]
        self.assertEqual(*map(json.dumps, reports))


if __name__ == "__main__":
    unittest.main()

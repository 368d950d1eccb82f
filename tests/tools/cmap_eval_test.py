#!/usr/bin/env python3
"""Drives cmap_eval as a user does: reports, tables, options, and the files that it reads and writes."""

import hashlib
import json
import os
import shlex
import subprocess
import time
import unittest
from pathlib import Path

import numpy as np

from cmap_eval_testing import (
    jsonschema,
    PROGRAM,
    SOURCE,
    MICRO,
    TOWN,
    SCHEMA,
    DONE,
    NOT_MET,
    UNSUPPORTED,
    ply,
    binary_ply,
    pcd,
    las,
    POINTS,
    CmapEval,
)


class Results(CmapEval):
    def expect_numbers(self, found, expected, place):
        """Every expected number is found, to 1e-6; records may hold more."""
        if isinstance(expected, dict):
            for key, value in expected.items():
                self.assertIn(key, found, place)
                self.expect_numbers(found[key], value, f"{place}/{key}")
        elif isinstance(expected, list):
            self.assertEqual(len(found), len(expected), place)
            for i, (a, b) in enumerate(zip(found, expected)):
                self.expect_numbers(a, b, f"{place}/{i}")
        elif isinstance(expected, float):
            self.assertIsNotNone(found, place)
            self.assertLessEqual(abs(found - expected), max(1e-9, 1e-6 * abs(expected)), place)
        else:
            self.assertEqual(found, expected, place)

    def test_alignment(self):
        moved = self.input("T.txt", "1 0 0 0.1\n0 1 0 -0.1\n0 0 1 0.05\n0 0 0 1\n")
        town, copy = TOWN / "reference.ply", TOWN / "reference.ply"
        report = self.evaluate(town, copy, "--align", "gicp", "--initial", moved, "--metrics", "chamfer")
        alignment = report["alignment"]
        self.assertEqual(alignment["method"], "gicp")
        self.assertGreater(alignment["before"]["chamfer"]["value"], 0.05)
        self.assertLess(report["metrics"]["chamfer"]["value"], 1e-4)
        self.assertTrue(alignment["registration"]["converged"])
        self.assertLess(abs(alignment["scale_error"]), 1e-12, "a rigid method")
        result = self.run_program(town, copy, "--align", "gicp", "--initial", moved, "--metrics", "chamfer")
        self.assertRegex(result.stdout.decode(), r"before the alignment by gicp .*\n  Chamfer distance +CD# +0\.\d+ m\n")
        # The town's own times: a circle, and the same circle seen from elsewhere.
        poses = [(0.1 * i, 5 * np.cos(0.1 * i), 5 * np.sin(0.1 * i), 0.1 * i % 1) for i in range(60)]
        tum = [self.input(f"{n}.tum", "".join(f"{t} {x + n} {y} {z} 0 0 0 1\n" for t, x, y, z in poses)) for n in (0, 2)]
        report = self.evaluate(
            town, copy, "--align", "trajectory", "--ref-trajectory", tum[0], "--est-trajectory", tum[1], "--metrics", "chamfer"
        )
        self.assertAlmostEqual(report["alignment"]["T_ref_est"][0][3], -2, places=9)
        lost = self.input("lost.tum", tum[1].read_text() + "100 nan nan nan nan nan nan nan\n")
        report = self.evaluate(
            town, copy, "--align", "trajectory", "--ref-trajectory", tum[0], "--est-trajectory", lost, "--metrics", "chamfer"
        )
        self.assertAlmostEqual(report["alignment"]["T_ref_est"][0][3], -2, places=9)
        self.assertEqual(report["warnings"][0]["id"], "trajectory_rows_left_out")
        self.assertIn("lost.tum: 1 of 61 rows left out", report["warnings"][0]["message"])

    def test_transforms_as_people_have_them(self):
        town = (TOWN / "reference.ply", TOWN / "estimate.ply", "--metrics", "chamfer")
        T = [[0.8, -0.6, 0, 0.5], [0.6, 0.8, 0, 0.25], [0, 0, 1, -0.125], [0, 0, 0, 1]]
        plain = self.input("T.txt", "".join(" ".join(map(repr, row)) + "\n" for row in T))
        expected = self.evaluate(*town, "--transform", plain)
        self.assertEqual(expected["alignment"]["T_ref_est"], T)
        np.save(self.folder / "T.npy", np.array(T))
        flat = sum(map(list, zip(*T)), [])
        for path in (
            self.input("print.txt", str(np.array(T))),
            self.input("repr.txt", repr(np.array(T))),
            self.input("bom.txt", "\ufeff" + plain.read_text().replace("\n", "\r\n")),
            self.input("upper.json", json.dumps({"result": {"transformation": T[:3]}})),
            self.input("columns.json", json.dumps({"extrinsic": flat})),
            self.folder / "T.npy",
        ):
            with self.subTest(path.name):
                report = self.evaluate(*town, "--transform", path)
                self.assertEqual(report["alignment"]["T_ref_est"], T)
                self.assertEqual(report["metrics"], expected["metrics"])
                said = [w["message"] for w in report["warnings"] if w["id"] == "transform_column_major"]
                self.assertEqual(len(said), path.name == "columns.json")

    def test_tanks_and_temples(self):
        report = self.evaluate(TOWN / "reference.ply", TOWN / "reference.ply", "--as", "tanksandtemples", "--metrics", "f_score")
        alias = report["aliases"]["tanksandtemples"]
        self.assertEqual((alias["precision"], alias["recall"], alias["f_score"], alias["tau_m"]), (1, 1, 1, 0.2))

    def test_fairness_beside_the_plain_numbers(self):
        metrics = ("--metrics", "default,mme", "--mme-radius", "0.5")
        arguments = ("--bootstrap", "50", "--block", "4", "--observed", "auto", "--sensitivity", *metrics)
        report = self.evaluate(TOWN / "reference.ply", TOWN / "estimate.ply", *arguments)
        plain = self.evaluate(TOWN / "reference.ply", TOWN / "estimate.ply", *metrics)
        self.assertEqual(report["metrics"], plain["metrics"], "never in place of the plain numbers")
        ids = set(plain["metrics"])
        self.assertEqual(set(report["sensitivity"]["metrics"]), ids)
        self.assertEqual(set(report["intervals"]["metrics"]), ids - {"hausdorff"})
        self.assertEqual(set(report["unobserved"]["metrics"]), ids - {"hausdorff"})
        self.assertFalse({"sensitivity", "intervals", "unobserved"} & set(plain))
        table = self.run_program(TOWN / "reference.ply", TOWN / "estimate.ply", *arguments).stdout.decode()
        for heading in ("when the estimate is off by 0.01 m", "95 % intervals, 50 replicates of", "could not have seen"):
            self.assertIn(heading, table)

    def test_what_the_sensor_saw(self):
        """The same path as a TUM file and as a capture's scans; from far away nothing is seen."""
        town = (TOWN / "reference.ply", TOWN / "estimate.ply", "--metrics", "chamfer")
        center = np.mean(np.array(self.evaluate(*town)["inputs"]["reference"]["bounds_m"]["min"]))
        rows = "".join(f"{0.1 * i:.1f} {center + i} {center + i} 5 0 0 0 1\n" for i in range(20))
        from_path = self.evaluate(*town, "--observed-from", self.input("path.tum", rows))
        self.assertEqual((from_path["unobserved"]["method"], from_path["parameters"]["observed"]), ("sensor", "sensor"))
        share = from_path["unobserved"]["reference"]["share_unobserved"]
        self.assertTrue(0 < share < 1, share)
        capture = self.folder / "capture"
        (capture / "lidar").mkdir(parents=True)
        identity = [[float(i == j) for j in range(4)] for i in range(4)]
        camera = {"model": "pinhole", "width": 4, "height": 4, "K": [4, 4, 2, 2], "distortion": []}
        (capture / "capture.json").write_text(json.dumps(
            {"version": 1, "camera": camera, "T_imu_lidar": identity, "T_lidar_camera": identity}))
        for name in ("images.csv", "imu.csv", "predictions"):
            (capture / name).write_text("not opened")
        (capture / "lidar.csv").write_text("timestamp_s,file\n" + "".join(f"{0.1 * i:.1f},lidar/0.pcd\n" for i in range(20)))
        (capture / "lidar" / "0.pcd").write_text(
            "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3\n")
        (capture / "lio.tum").write_text(rows)
        from_scans = self.evaluate(*town, "--observed-from", capture)
        self.assertEqual(from_scans["unobserved"], from_path["unobserved"])
        far = self.evaluate(*town, "--observed-from", self.input("far.tum", "0 5000 0 5 0 0 0 1\n"))
        self.assertEqual(far["unobserved"]["reference"]["share_unobserved"], 1)
        for status, arguments in ((2, ("--observed", "sensor")), (3, ("--observed-from", "none.tum"))):
            self.assertEqual(self.run_program(*town, *arguments).returncode, status)

    def test_golden_values(self):
        for folder in (TOWN, MICRO / "two_points"):
            with self.subTest(folder.name):
                expected = json.loads((folder / "expected.json").read_text())
                config = self.input("config.json", json.dumps(expected["options"]))
                report = self.evaluate(
                    folder / "reference.ply", folder / "estimate.ply", "--metrics", "all", "--config", config
                )
                self.expect_numbers(report["metrics"], expected["metrics"], folder.name)

    def test_the_examples_of_the_help_run(self):
        """From the root of the source, or a folder that looks like it."""
        help_text = self.run_program("--help").stdout.decode()
        examples = [line for line in help_text.splitlines() if line.startswith("  cmap_eval ")]
        self.assertEqual(len(examples), 3, "a pair, one map, and what the numbers are worth")
        (self.folder / "data_samples").symlink_to(SOURCE / "data_samples")
        (self.folder / "bin").mkdir()
        (self.folder / "bin/cmap_eval").symlink_to(PROGRAM)
        result = self.run_program(
            "-ec",
            "\n".join(examples),
            program=["bash"],
            cwd=self.folder,
            environment={"PATH": f"{self.folder}/bin:{os.environ['PATH']}"},
        )
        self.assertEqual(result.returncode, DONE, result.stderr.decode())
        self.assertIn("LCR", result.stdout.decode())
        self.check_report((self.folder / "report.json").read_text())
        self.check_report((self.folder / "map.json").read_text())

    def test_the_help_names_every_option_and_exit_code(self):
        help_text = self.run_program("--help").stdout.decode()
        parameters = self.evaluate(self.reference, self.estimate)["parameters"]
        for option in (*parameters, "output", "format", "levels", "config", "preset", "transform", "require", "export-errors",
                       "export-reference-errors", "threads", "quiet", "version"):
            self.assertIn(f" --{option} ", help_text.replace("\n", " ").replace(",", " "))
        for code in ("0 done", "1 a --require", "2 wrong usage", "3 an input", "4 the inputs", "70 internal"):
            self.assertIn(code, help_text)

    def test_version_needs_no_heavy_library(self):
        start = time.monotonic()
        result = self.run_program("--version")
        print(f"cmap_eval --version: {1e3 * (time.monotonic() - start):.1f} ms")
        self.assertRegex(result.stdout.decode(), r"^cmap_eval \d+\.\d+\.\d+\n$")
        libraries = subprocess.run(["ldd", PROGRAM], stdout=subprocess.PIPE, check=True).stdout.decode()
        self.assertIn("libc.so", libraries)
        for heavy in ("libpcl", "libvtk", "libopencv", "libflann"):
            self.assertNotIn(heavy, libraries)

    def test_table_and_json_on_stdout(self):
        table = self.run_program(self.reference, self.estimate).stdout.decode()
        self.assertRegex(table, r"local color recall +LCR +↑ +33\.33 % +coverage 33\.33 %")
        self.assertNotIn("\x1b", table, "no colors or progress in a pipe")
        printed = self.run_program(self.reference, self.estimate, "--format", "json", "-o", self.json).stdout.decode()
        self.check_report(printed)
        self.assertEqual(printed, self.json.read_text())

    def test_quiet_prints_nothing(self):
        result = self.run_program(self.reference, self.estimate, "--quiet", "-o", self.json)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (DONE, b"", b""))
        self.assertTrue(self.json.exists())

    def test_a_report_replaces_the_old_one(self):
        self.json.write_text("old")
        self.evaluate(self.reference, self.estimate)
        self.assertEqual(os.listdir(self.outputs), ["report.json"])

    def test_inputs_are_described(self):
        report = self.evaluate(self.reference, self.estimate)
        for which, path in (("reference", self.reference), ("estimate", self.estimate)):
            self.assertEqual(report["inputs"][which]["sha256"], hashlib.sha256(path.read_bytes()).hexdigest())
            self.assertEqual(report["inputs"][which]["path"], str(path))
        self.assertIn(str(self.reference), report["run"]["command"])
        self.assertGreater(report["run"]["wall_s"], 0)

    def test_the_command_can_be_typed_again(self):
        report = self.evaluate(self.reference, self.estimate, "--require", "Overlap >= 0")
        self.assertIn("Overlap >= 0", shlex.split(report["run"]["command"]))

    def test_every_format_is_read(self):
        for name, content, form in (
            ("a.pcd", pcd(POINTS), "PCD"),
            ("a.las", las(POINTS), "LAS 1.2"),
            ("a.ply", binary_ply(POINTS), "PLY"),
            ("a.xyz", "0 0 0\n1 0 0\n0 2 0\n", "text"),
        ):
            report = self.evaluate(
                self.input(name, content), self.input("same.ply", ply(POINTS)), "--metrics", "geometry"
            )
            self.assertIn(form, report["inputs"]["reference"]["format"])
            self.assertEqual(report["metrics"]["chamfer"]["value"], 0)

    def test_the_command_line_wins_over_the_file_over_the_preset(self):
        config = self.input("config.json", '// mine\n{"lcr-radius": 0.07, "ccs-voxel": 0.3}')
        report = self.evaluate(
            self.reference, self.estimate, "--preset", "indoor", "--config", config, "--ccs-voxel", "0.4"
        )
        parameters = report["parameters"]
        self.assertEqual((parameters["awd-voxel"], parameters["lcr-radius"], parameters["ccs-voxel"]), (0.5, 0.07, 0.4))

    def test_the_parameters_of_a_report_are_a_configuration(self):
        """With it, another run finds the same; maps without color are no less welcome than before."""
        bare = self.input("bare.ply", ply(POINTS))
        options = ["--voxel", "0.5", "--crop", "-1,-1,-1,9,9,9", "--as", "open3d"]
        for pair, arguments in (((self.reference, self.estimate), options), ((self.reference, bare), [])):
            first = self.evaluate(*pair, *arguments)
            config = self.input("again.json", json.dumps(first["parameters"]))
            again = self.evaluate(*pair, "--config", config)
            del first["run"], again["run"]
            self.assertEqual(again, first)

    def test_a_transform_moves_the_estimate(self):
        matrix = self.input("T.txt", "1 0 0 0\n0 1 0 -0.25\n0 0 1 0\n0 0 0 1\n")
        report = self.evaluate(self.reference, self.estimate, "--transform", matrix)
        self.assertEqual(report["alignment"]["method"], "given")
        self.assertEqual(report["alignment"]["T_ref_est"][1], [0, 1, 0, -0.25])
        self.assertEqual(report["metrics"]["hausdorff"]["estimate_to_reference"]["max"], 2.75)

    def test_requirements(self):
        met = [
            "--require",
            "LCR>=0.3",
            "--require",
            "chamfer<=5",
            "--require",
            "accuracy@0.1<=9",
            "--require",
            "lcr.coverage>0",
        ]
        self.evaluate(self.reference, self.estimate, "--thresholds", "4,0.1", *met[:4], *met[6:])
        result = self.run_program(self.reference, self.estimate, *met, "--require", "chamfer<=1", "-o", self.json)
        self.assertEqual(result.returncode, NOT_MET)
        self.assertEqual(
            result.stderr.decode(),
            "cmap_eval: requirement not met: accuracy@0.1<=9 (found no value)\n"
            "cmap_eval: requirement not met: chamfer<=1 (found 4.375)\n",
        )
        self.assertIn("Chamfer", result.stdout.decode(), "everything is written")
        self.check_report(self.json.read_text())

    def test_maps_without_color(self):
        bare = self.input("bare.ply", ply(POINTS))
        report = self.evaluate(self.reference, bare)
        self.assertIn("no_color", [warning["id"] for warning in report["warnings"]])
        self.assertIsNone(report["metrics"]["local_color_recall"]["value"])
        self.assertIsNotNone(report["metrics"]["chamfer"]["value"])
        self.refused(UNSUPPORTED, "the estimate has no color", self.reference, bare, "--metrics", "color")
        self.refused(UNSUPPORTED, "the reference has no color", bare, self.estimate, "--metrics", "geometry,delta_e")

    def test_points_that_are_not_finite_are_dropped_and_counted(self):
        some = self.input("some.ply", ply([(0, 0, 0), ("nan", 0, 0), (0, "inf", 0), (0, 0, "-inf"), (1, 1, 1)]))
        report = self.evaluate(some, some)
        self.assertEqual(
            (report["inputs"]["reference"]["points"], report["inputs"]["reference"]["finite_points"]), (5, 2)
        )
        self.assertIn("3 of 5 points are not finite", report["warnings"][0]["message"])

    def test_one_point(self):
        one = self.input("one.ply", ply([(1, 2, 3)]))
        report = self.evaluate(one, one, "--metrics", "all")
        self.assertEqual(report["metrics"]["chamfer"]["value"], 0)
        self.assertIsNone(report["metrics"]["mean_map_entropy"]["value"])

    def test_list_properties_are_skipped(self):
        faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        mesh = ply(POINTS).replace("end_header\n", faces) + "3 0 1 2\n"
        in_vertex = ply([(*row, "2 7 8") for row in POINTS]).replace(
            "end_header", "property list uchar int tags\nend_header"
        )
        for content in (mesh, in_vertex):
            path = self.input("lists.ply", content)
            self.assertEqual(self.evaluate(path, path)["inputs"]["reference"]["points"], 3)

    def test_a_name_in_any_encoding(self):
        path = os.fsencode(self.inputs) + b"/caf\xe9.ply"
        Path(os.fsdecode(path)).write_text(ply(POINTS))
        self.evaluate(os.fsdecode(path), self.estimate)

    def test_the_schema_refuses_other_reports(self):
        """What makes every check of a report above worth something."""
        if jsonschema is None:
            self.skipTest(
                "no jsonschema: apt-get install python3-jsonschema; reports were not checked against the schema"
            )
        jsonschema.Draft7Validator.check_schema(SCHEMA)
        good = self.evaluate(
            self.reference,
            self.estimate,
            "--metrics",
            "all",
            "--as",
            "color-map-evaluation,cloudanalyzer,mapeval,open3d,mpeg,cloudcompare",
        )

        def broken(*path, value=None):
            report = json.loads(json.dumps(good))
            place = report
            for key in path[:-1]:
                place = place[key]
            if value is None:
                del place[path[-1]]
            else:
                place[path[-1]] = value
            return report

        good["metrics"]["chamfer"]["floor"] = {"value": 0.2, "se": 0.001, "n": 3}
        good["metrics"]["color_distance"]["skill"] = {"value": None, "reason": "the floor is no better than chance"}
        band = {"n": 1, "mean": 0.1, "std": 0, "min": 0.1, "max": 0.1, "values": [0.1, None]}
        good["metrics"]["average_wasserstein"]["phases"] = band
        good["metrics"]["accuracy"]["per_threshold"][0]["floor"] = {"value": 0.2, "se": 0.001, "n": 3}
        self.check_report(json.dumps(good))
        for report in (
            broken("metrics", "chamfer", "floor", "value"),
            broken("metrics", "chamfer", "floor", "se", value=-0.1),
            broken("metrics", "color_distance", "skill", "reason"),
            broken("metrics", "average_wasserstein", "phases", "values"),
            broken("metrics", "average_wasserstein", "phases", "values", value=[]),
            broken("metrics", "accuracy", "per_threshold", 0, "floor", value=0.2),
            broken("schema", value="cmap.report/1"),
            broken("extra", value=1),
            broken("warnings"),
            broken("inputs", "reference", "sha256", value="abc"),
            broken("parameters", "lcr-tau"),
            broken("parameters", "lcr_tau", value=0.1),
            broken("alignment", "T_ref_est", 3),
            broken("metrics", "my_metric", value={"value": 1}),
            broken("metrics", "chamfer", "value", value="0.1"),
            broken("metrics", "Chamfer", value=good["metrics"]["chamfer"]),
            broken("metrics", "chamfer", "value"),
            broken("metrics", "chamfer", "unit"),
            broken("metrics", "chamfer", "better", value="smaller"),
            broken("metrics", "chamfer", "variants", "l1_mean", value=True),
            broken("metrics", "accuracy", "per_threshold", 0, "threshold_m"),
            broken("metrics", "accuracy", "per_threshold", value=[]),
            broken("run", "threads", value=0),
            broken("metrics", "color_distance_by_range", "per_range", 0, "value", value="none"),
            broken("aliases", "open3d", "definition"),
            broken("aliases", "lidar", value={"value": 1.0}),
            broken("warnings", value=[{"id": "x"}]),
        ):
            with self.assertRaises(jsonschema.ValidationError):
                jsonschema.Draft7Validator(SCHEMA).validate(report)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""Drives cmap_eval as a user does: reports, exit codes, messages, and what is left on the disk.

CTest sets CMAP_EVAL (the program) and CMAP_SOURCE_DIR.
"""

import hashlib
import json
import os
import resource
import shlex
import struct
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

try:
    import jsonschema
except ImportError:
    jsonschema = None

PROGRAM = Path(os.environ["CMAP_EVAL"]).resolve()
SOURCE = Path(os.environ["CMAP_SOURCE_DIR"]).resolve()
DATA = Path(os.environ.get("CMAP_DATA_DIR", SOURCE / "../shared/data"))
SANITIZED = "-fsanitize" in os.environ.get("CMAP_CXX_FLAGS", "")
MICRO, TOWN = SOURCE / "data_samples/micro", SOURCE / "data_samples/town"
SCHEMA = json.loads((SOURCE / "configs/report.schema.json").read_text())

DONE, NOT_MET, USAGE, INPUT, UNSUPPORTED = 0, 1, 2, 3, 4
NOBODY = 65534


def ply(points, fields="xyz", kind="float", count=None):
    """An ASCII PLY file with these rows."""
    properties = "".join(f"property {kind} {name}\n" for name in fields)
    rows = "".join(" ".join(map(str, row)) + "\n" for row in points)
    return f"ply\nformat ascii 1.0\nelement vertex {len(points) if count is None else count}\n{properties}end_header\n{rows}"


def binary_ply(points, count=None):
    """A binary PLY file of x, y, z."""
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points) if count is None else count}\n"
    header += "property float x\nproperty float y\nproperty float z\nend_header\n"
    return header.encode() + b"".join(struct.pack("<3f", *row) for row in points)


def pcd(points, count=None):
    """A binary PCD file of x, y, z."""
    n = len(points) if count is None else count
    header = f"VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {n}\nHEIGHT 1\nPOINTS {n}\nDATA binary\n"
    return header.encode() + b"".join(struct.pack("<3f", *row) for row in points)


def las(points, count=None):
    """A LAS 1.2 file of format 0, in millimeters."""
    n = len(points) if count is None else count
    header = struct.pack("<4s20xBB32s32sHHHIIBHI20x", b"LASF", 1, 2, b"", b"", 1, 2024, 227, 227, 0, 0, 20, n)
    header += struct.pack("<12d", 1e-3, 1e-3, 1e-3, 0, 0, 0, 0, 0, 0, 0, 0, 0)
    return header + b"".join(struct.pack("<3i8x", *(round(1000 * v) for v in row)) for row in points)


POINTS = [(0, 0, 0), (1, 0, 0), (0, 2, 0)]


def without_run(text):
    """A report's text up to the only part that may differ between two runs."""
    head, run, _ = text.partition('\n  "run": {')
    assert run, "the report has no run"
    return head


def hashes(folder):
    return {path: hashlib.sha256(path.read_bytes()).hexdigest() for path in folder.rglob("*") if path.is_file()}


class CmapEval(unittest.TestCase):
    """A folder of inputs, which no run may change, and one of outputs."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="cmap-eval-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.inputs, self.outputs = self.folder / "inputs", self.folder / "outputs"
        self.inputs.mkdir()
        self.outputs.mkdir()
        self.reference = self.input("reference.ply", (MICRO / "two_points/reference.ply").read_bytes())
        self.estimate = self.input("estimate.ply", (MICRO / "two_points/estimate.ply").read_bytes())
        self.json = self.outputs / "report.json"
        self.errors = self.outputs / "errors.ply"
        self.addCleanup(self.check_inputs)
        self.before = {}

    def check_inputs(self):
        self.assertEqual(hashes(self.inputs), self.before, "inputs are never changed")

    def input(self, name, content):
        path = self.inputs / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    def run_program(self, *arguments, environment=None, program=(PROGRAM,), **options):
        """Runs the program to its end; nothing may take longer than two minutes."""
        self.before = hashes(self.inputs)
        options.setdefault("stdout", subprocess.PIPE)
        return subprocess.run(
            [*map(os.fspath, program), *map(os.fspath, arguments)], stderr=subprocess.PIPE, timeout=600 if SANITIZED else 120,
            env={**os.environ, **(environment or {})}, **options)

    def as_nobody(self):
        """Options that run the program without the rights of root."""
        if os.geteuid() != 0:
            return {}
        self.folder.chmod(0o755)
        self.outputs.chmod(0o777)
        try:
            subprocess.run([PROGRAM, "--version"], stdout=subprocess.DEVNULL, user=NOBODY, check=True)
        except OSError:
            self.skipTest("the program cannot be run by another user than root here")
        return {"user": NOBODY, "group": NOBODY, "extra_groups": []}

    def check_report(self, text):
        report = json.loads(text, parse_constant=lambda word: self.fail(f"{word} in a report"))
        if jsonschema:
            jsonschema.Draft7Validator(SCHEMA).validate(report)
        return report

    def evaluate(self, *arguments, code=DONE, **options):
        """The report of a run, checked against the schema."""
        result = self.run_program(*arguments, "-o", self.json, **options)
        self.assertEqual(result.returncode, code, result.stderr.decode())
        return self.check_report(self.json.read_text())

    def refused(self, code, says, *arguments, **options):
        """A run with every output asked for that must end with this code and message, and leave nothing."""
        outputs = ["-o", self.json, "--export-errors", self.errors, "--export-reference-errors", self.outputs / "reference.ply"]
        for left in self.outputs.iterdir():  # by a failure before
            left.unlink()
        self.expect_refusal(self.run_program(*arguments, *outputs, **options), code, says)

    def expect_refusal(self, result, code, says):
        message = result.stderr.decode()
        self.assertEqual(result.returncode, code, message)
        self.assertTrue(message.startswith("cmap_eval: "), message)
        self.assertLessEqual(len(message.splitlines()), 2, message)
        for part in [says] if isinstance(says, str) else says:
            self.assertIn(part, message)
        if result.stdout is not None:
            self.assertEqual(result.stdout, b"")
        self.assertEqual(os.listdir(self.outputs), [], "nothing is left behind, not even a temporary file")

    def refused_map(self, name, content, *says):
        """Neither place takes this map; the message names the file, the place and the reason."""
        broken = self.input(name, content)
        for pair in ((broken, self.estimate), (self.reference, broken)):
            self.refused(INPUT, [f"{broken}: ", *says], *pair)


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

    def test_golden_values(self):
        for folder in (TOWN, MICRO / "two_points"):
            with self.subTest(folder.name):
                expected = json.loads((folder / "expected.json").read_text())
                config = self.input("config.json", json.dumps(expected["options"]))
                report = self.evaluate(folder / "reference.ply", folder / "estimate.ply", "--metrics", "all", "--config", config)
                self.expect_numbers(report["metrics"], expected["metrics"], folder.name)

    def test_the_example_of_the_help_runs(self):
        """From the root of the source, or a folder that looks like it."""
        help_text = self.run_program("--help").stdout.decode()
        example = next(line for line in help_text.splitlines() if line.startswith("  cmap_eval "))
        (self.folder / "data_samples").symlink_to(SOURCE / "data_samples")
        (self.folder / "bin").mkdir()
        (self.folder / "bin/cmap_eval").symlink_to(PROGRAM)
        result = self.run_program(
            "-c", example, program=["bash"], cwd=self.folder, environment={"PATH": f"{self.folder}/bin:{os.environ['PATH']}"})
        self.assertEqual(result.returncode, DONE, result.stderr.decode())
        self.assertIn("LCR", result.stdout.decode())
        self.check_report((self.folder / "report.json").read_text())

    def test_the_help_names_every_option_and_exit_code(self):
        help_text = self.run_program("--help").stdout.decode()
        for option in ("output format config preset metrics thresholds overlap-distance lcr-tau lcr-radius lcr-curve ccs-voxel "
                       "ccs-min-points awd-voxel awd-min-points scs-radius mme-radius mme-min-neighbors color-max-distance voxel "
                       "crop transform require export-errors export-reference-errors as index threads quiet version").split():
            self.assertIn(f"--{option}", help_text)
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
        self.assertTrue(table.isprintable() or "\x1b" not in table, "no colors or progress in a pipe")
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

    def test_every_format_is_read(self):
        for name, content, form in (("a.pcd", pcd(POINTS), "PCD"), ("a.las", las(POINTS), "LAS 1.2"), ("a.ply", binary_ply(POINTS), "PLY"),
                                    ("a.xyz", "0 0 0\n1 0 0\n0 2 0\n", "text")):
            report = self.evaluate(self.input(name, content), self.input("same.ply", ply(POINTS)), "--metrics", "geometry")
            self.assertIn(form, report["inputs"]["reference"]["format"])
            self.assertEqual(report["metrics"]["chamfer"]["value"], 0)

    def test_the_command_line_wins_over_the_file_over_the_preset(self):
        config = self.input("config.json", '// mine\n{"lcr-radius": 0.07, "ccs-voxel": 0.3}')
        report = self.evaluate(self.reference, self.estimate, "--preset", "indoor", "--config", config, "--ccs-voxel", "0.4")
        parameters = report["parameters"]
        self.assertEqual((parameters["awd-voxel"], parameters["lcr-radius"], parameters["ccs-voxel"]), (0.5, 0.07, 0.4))

    def test_the_parameters_of_a_report_are_a_configuration(self):
        first = self.evaluate(self.reference, self.estimate, "--voxel", "0.5", "--crop", "-1,-1,-1,9,9,9", "--as", "open3d")
        config = self.input("again.json", json.dumps(first["parameters"]))
        self.assertEqual(without_run(json.dumps(self.evaluate(self.reference, self.estimate, "--config", config), indent=2)),
                         without_run(json.dumps(first, indent=2)))

    def test_a_transform_moves_the_estimate(self):
        matrix = self.input("T.txt", "1 0 0 0\n0 1 0 -0.25\n0 0 1 0\n0 0 0 1\n")
        report = self.evaluate(self.reference, self.estimate, "--transform", matrix)
        self.assertEqual(report["alignment"]["method"], "given")
        self.assertEqual(report["alignment"]["T_ref_est"][1], [0, 1, 0, -0.25])
        self.assertEqual(report["metrics"]["hausdorff"]["estimate_to_reference"]["max"], 2.75)

    def test_requirements(self):
        met = ["--require", "LCR>=0.3", "--require", "chamfer<=5", "--require", "accuracy@0.1<=9", "--require", "lcr.coverage>0"]
        self.evaluate(self.reference, self.estimate, "--thresholds", "4,0.1", *met[:4], *met[6:])
        result = self.run_program(self.reference, self.estimate, *met, "--require", "chamfer<=1", "-o", self.json)
        self.assertEqual(result.returncode, NOT_MET)
        self.assertEqual(result.stderr.decode(), "cmap_eval: requirement not met: accuracy@0.1<=9 (found no value)\n"
                                                 "cmap_eval: requirement not met: chamfer<=1 (found 4.375)\n")
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
        self.assertEqual((report["inputs"]["reference"]["points"], report["inputs"]["reference"]["finite_points"]), (5, 2))
        self.assertIn("3 of 5 points are not finite", report["warnings"][0]["message"])

    def test_one_point(self):
        one = self.input("one.ply", ply([(1, 2, 3)]))
        report = self.evaluate(one, one, "--metrics", "all")
        self.assertEqual(report["metrics"]["chamfer"]["value"], 0)
        self.assertIsNone(report["metrics"]["mean_map_entropy"]["value"])

    def test_list_properties_are_skipped(self):
        faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        mesh = ply(POINTS).replace("end_header\n", faces) + "3 0 1 2\n"
        in_vertex = ply([(*row, "2 7 8") for row in POINTS]).replace("end_header", "property list uchar int tags\nend_header")
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
            self.skipTest("no jsonschema: apt-get install python3-jsonschema; reports were not checked against the schema")
        jsonschema.Draft7Validator.check_schema(SCHEMA)
        good = self.evaluate(self.reference, self.estimate, "--metrics", "all", "--as", "mapeval,open3d,mpeg,cloudcompare")

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

        for report in (broken("schema", value="cmap.report/2"), broken("extra", value=1), broken("warnings"),
                       broken("inputs", "reference", "sha256", value="abc"), broken("parameters", "lcr-tau"),
                       broken("parameters", "lcr_tau", value=0.1), broken("alignment", "T_ref_est", 3),
                       broken("metrics", "my_metric", value={"value": 1}), broken("metrics", "chamfer", "value", value="0.1"),
                       broken("metrics", "chamfer", "value", value=-1), broken("metrics", "chamfer", "unit", value="mm"),
                       broken("metrics", "local_color_recall", "coverage", value=1.5), broken("metrics", "rmse", "n", value=1.5),
                       broken("metrics", "accuracy", "per_threshold", 0, "n"), broken("run", "threads", value=0),
                       broken("metrics", "color_distance_by_range", "per_range", 0, "value", value="none"),
                       broken("aliases", "open3d", "mean_distance"), broken("warnings", value=[{"id": "x"}])):
            with self.assertRaises(jsonschema.ValidationError):
                jsonschema.Draft7Validator(SCHEMA).validate(report)


class BadMaps(CmapEval):
    def test_missing(self):
        self.refused(INPUT, ["none.ply: no such file"], self.inputs / "none.ply", self.estimate)
        self.refused(INPUT, ["none.ply: no such file"], self.reference, self.inputs / "none.ply")

    def test_a_folder(self):
        self.refused(INPUT, [f"{self.inputs}: is a folder"], self.inputs, self.estimate)

    def test_unreadable(self):
        secret = self.input("secret.ply", ply(POINTS))
        secret.chmod(0)
        self.addCleanup(secret.chmod, 0o644)  # before check_inputs, which reads it
        self.refused(INPUT, [f"{secret}: cannot be opened: Permission denied"], secret, self.estimate, **self.as_nobody())

    def test_empty(self):
        for name in ("empty.ply", "empty.pcd", "empty.las", "empty.xyz"):
            self.refused_map(name, "", "the file is empty")

    def test_unknown_format(self):
        self.refused_map("random.bin", bytes(range(256)), "is of no known format; PLY, PCD, LAS")
        self.refused_map("image.png", b"\x89PNG\r\n\x1a\n" + bytes(64), "PLY, PCD, LAS")
        self.refused_map("letter.txt", "Dear all,\nhere is the map.\n", "line 2", "'here' is not a number")

    def test_truncated_header(self):
        self.refused_map("a.ply", ply(POINTS).partition("end_header")[0], "line 6", "truncated: the file ends before 'end_header'")
        self.refused_map("a.pcd", pcd(POINTS).partition(b"POINTS")[0], "line 7", "truncated: the file ends before the line DATA")
        self.refused_map("a.las", las(POINTS)[:100], "truncated", "byte")

    def test_truncated_body(self):
        self.refused_map("ascii.ply", ply(POINTS[:2], count=3), "truncated: 3 points", "byte")
        self.refused_map("rows.ply", ply([(0.25, 0.25, 0.25), (1, 1, 1)], count=3), "line 9", "truncated: the file ends after 2 of 3 points")
        self.refused_map("cut.ply", ply([(0.25, 0.25, 0.25), (1, 1, 1)])[:-3], "line 9", "ends before the value of 'z'")
        self.refused_map("binary.ply", binary_ply(POINTS)[:-1], "truncated: 3 points", "byte")
        self.refused_map("binary.pcd", pcd(POINTS)[:-1], "truncated", "byte")
        self.refused_map("points.las", las(POINTS)[:-1], "truncated", "byte")

    def test_absurd_counts_do_not_allocate(self):
        maps = {"ascii.ply": ply(POINTS, count=10**15), "binary.ply": binary_ply(POINTS, count=10**15),
                "huge.ply": binary_ply(POINTS, count=10**30), "a.pcd": pcd(POINTS, count=10**15), "a.las": las(POINTS, count=2**32 - 1),
                "list.ply": binary_ply([]).replace(b"vertex 0", b"vertex 1").replace(b"end_", b"property list uint int a\nend_")
                            + struct.pack("<3fI", 0, 0, 0, 2**32 - 1)}
        for name, content in maps.items():
            with self.subTest(name):
                path = self.input(name, content)
                start = time.monotonic()
                self.refused(INPUT, f"{path}: ", path, self.estimate, preexec_fn=self.limit_memory)
                self.assertLess(time.monotonic() - start, 10)

    @staticmethod
    def limit_memory():
        if not SANITIZED:  # sanitizers reserve terabytes of addresses
            resource.setrlimit(resource.RLIMIT_AS, (2**30, 2**30))

    def test_wrong_types(self):
        self.refused_map("type.ply", ply(POINTS, kind="decimal"), "line 4", "unknown property type 'decimal'")
        self.refused_map("string.ply", ply([(0, 0, "here")]), "line 8", "'z': 'here' is not a number")
        self.refused_map("half.ply", ply([(0, 0, 0.5)], kind="int"), "line 8", "'0.5' is not of type int")
        self.refused_map("red.ply", ply([(0, 0, 0, 1, 2, 3)], ["x", "y", "z", "red", "green", "blue"], "int"), "color 'red' has type int32")
        self.refused_map("list.ply", ply([]).replace("float z", "list uchar float z"), "'z' is not a single number")
        self.refused_map("type.pcd", pcd(POINTS).replace(b"TYPE F F F", b"TYPE F F Q"), "'z' has unknown TYPE Q")
        self.refused_map("a.xyz", "1 2 3\n4 five 6\n", "line 2", "'five' is not a number")

    def test_missing_coordinate(self):
        self.refused_map("flat.ply", ply([(0, 0)], "xy"), "no field 'z'")

    def test_nothing_finite(self):
        bad = [("nan",) * 3, ("inf", 0, 0), (0, "-inf", 0)]
        self.refused_map("nan.ply", ply(bad), "none of its 3 points is finite")
        self.refused_map("nan.pcd", pcd([tuple(map(float, row)) for row in bad]), "none of its 3 points is finite")
        self.refused_map("nan.xyz", "nan nan nan\n", "none of its 1 points is finite")

    def test_no_points(self):
        self.refused_map("none.ply", ply([]), "holds no points")
        self.refused_map("none.pcd", pcd([]), "holds no points")
        self.refused_map("none.las", las([]), "holds no points")
        self.refused_map("none.xyz", "# only a comment\n", "holds no line of numbers")

    def test_absurd_coordinates(self):
        self.refused_map("far.ply", ply([(0, 0, 1e30)]), "point 1: z = 1e+30 is beyond")

    def test_bad_transform(self):
        for content, says in (("1 2 3", "16"), ("", "empty"), ("0 " * 16, "0 0 0 1"), ("2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "rotation"),
                              ("x", "number")):
            matrix = self.input("T.txt", content)
            self.refused(INPUT, [f"{matrix}: ", says], self.reference, self.estimate, "--transform", matrix)
        self.refused(INPUT, "none.txt: no such file", self.reference, self.estimate, "--transform", self.inputs / "none.txt")

    def test_a_crop_that_leaves_nothing(self):
        self.refused(UNSUPPORTED, "crop: no point of the reference is inside", self.reference, self.estimate, "--crop", "90,90,90,91,91,91")


class BadUsage(CmapEval):
    def refused_options(self, says, *options, **how):
        self.refused(USAGE, says, self.reference, self.estimate, *options, **how)

    def test_wrong_arguments(self):
        self.refused(USAGE, ["REF", "--help"])
        self.refused(USAGE, ["EST", "--help"], self.reference)
        self.refused_options("--lcr-radus", "--lcr-radus", "1")
        self.refused_options("third.ply", "third.ply")
        self.refused_options("--lcr-radius", "--lcr-radius", "1", "--lcr-radius", "2")
        self.refused_options(["--threads", "0"], "--threads", "0")
        self.refused_options(["--format", "xml"], "--format", "xml")

    def test_wrong_values(self):
        for option, value, says in (("--lcr-radius", "-1", "must be above 0"), ("--lcr-radius", "wide", '"wide" is not a number'),
                                    ("--lcr-radius", "", "is not a number"), ("--lcr-radius", "inf", "inf"),
                                    ("--thresholds", "0.1,-0.2", "must be above 0"), ("--thresholds", "", "is not a list of numbers"),
                                    ("--awd-min-points", "1", "is not a whole number"), ("--metrics", "colour", '"colour" is unknown'),
                                    ("--metrics", "", "names no metric"), ("--crop", "1,2,3", "is not xmin,ymin"),
                                    ("--as", "pcl", '"pcl" is unknown'), ("--index", "octree", '"octree" is neither'),
                                    ("--ccs-voxel", "1e-12", "too small"), ("--voxel", "0", "must be above 0")):
            with self.subTest(f"{option} {value}"):
                self.refused_options(says if says == "too small" else [option[2:], says], option, value)

    def test_empty_names_of_files(self):
        """An unset variable of a script must not pass for "no such option"."""
        for option in ("--config", "--preset", "--transform"):
            with self.subTest(option):
                self.refused_options(option[2:], option, "")
        self.expect_refusal(self.run_program(self.reference, self.estimate, "-o", ""), USAGE, "output")

    def test_wrong_configurations(self):
        for content, says in (('{"lcr_radius": 1}', 'unknown key "lcr_radius"'), ('{"lcr-radius": -1}', "lcr-radius: -1 must be above 0"),
                              ('{"lcr-radius": "1"}', 'lcr-radius: "1" is not a number'), ("[]", "JSON object"), ("", "line 1"),
                              ('{"voxel": 1', "line 1")):
            config = self.input("config.json", content)
            self.refused_options([f"{config}: ", says], "--config", config)
        self.refused_options("none.json: ", "--config", self.inputs / "none.json")
        self.refused_options(f"{self.inputs}: ", "--config", self.inputs)
        self.refused_options(['"urban" is unknown', "paper, indoor, outdoor, aerial, mapeval"], "--preset", "urban")

    def test_wrong_requirements(self):
        for requirement, says in (("lidar>=1", 'unknown metric "lidar"'), ("LCR=1", "expected METRIC"), ("accuracy<=1", "accuracy@0.2"),
                                  ("accuracy@7<=1", "7 m is not among the thresholds"), ("mme<=1", "mean_map_entropy is not computed"),
                                  ("chamfer.median<=1", "chamfer has no field"), ("", "expected METRIC")):
            with self.subTest(requirement):
                self.refused_options([f'require "{requirement}"', says], "--require", requirement)

    def test_unknown_instruction_set(self):
        self.refused_options(["CMAP_SIMD=mmx", "plain, sse2, avx2 or avx512"], environment={"CMAP_SIMD": "mmx"})


class BadOutputs(CmapEval):
    def outputs_of(self, path):
        return (("-o", path), ("--export-errors", path), ("--export-reference-errors", path))

    def test_a_folder_that_is_missing(self):
        path = self.outputs / "none/out"
        for output in self.outputs_of(path):
            result = self.run_program(self.reference, self.estimate, *output)
            self.expect_refusal(result, USAGE, f"{path}: cannot be written: No such file or directory")

    def test_a_folder_in_place_of_a_file(self):
        for output in self.outputs_of(self.folder):
            self.expect_refusal(self.run_program(self.reference, self.estimate, *output), USAGE, "Is a directory")

    def test_a_folder_that_is_read_only(self):
        how = self.as_nobody()
        self.outputs.chmod(0o555)
        for output in self.outputs_of(self.outputs / "out"):
            self.expect_refusal(self.run_program(self.reference, self.estimate, *output, **how), USAGE, "out: cannot be written: Permission denied")

    def test_a_full_device(self):
        for output in self.outputs_of("/dev/full"):
            result = self.run_program(self.reference, self.estimate, *output)
            self.expect_refusal(result, USAGE, "/dev/full: cannot be written: No space left on device")

    def test_stdout_is_full(self):
        for options in ((), ("--format", "json")):
            with self.subTest(options), open("/dev/full", "wb") as full:
                result = self.run_program(self.reference, self.estimate, "-o", self.json, *options, stdout=full)
                self.expect_refusal(result, USAGE, "No space left on device")

    def test_a_file_that_may_not_grow(self):
        """The town's errors take a megabyte; half of it may be written."""
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (500_000, 500_000))  # Python ignores SIGXFSZ
        for output in self.outputs_of(self.errors)[1:]:
            result = self.run_program(TOWN / "reference.ply", TOWN / "estimate.ply", *output, preexec_fn=limit, restore_signals=False)
            self.expect_refusal(result, USAGE, "errors.ply: cannot be written: File too large")

    def test_a_full_disk(self):
        """A file system of 64 kB, mounted for the run alone."""
        alone = ["unshare", "--map-root-user", "--mount", "bash", "-c"]
        mount = f"mount -t tmpfs -o size=64k tmpfs {shlex.quote(str(self.outputs))} && "
        if subprocess.run([*alone, mount + "true"], stderr=subprocess.DEVNULL).returncode != 0:
            self.skipTest("no file system can be mounted here")
        for output in self.outputs_of(self.errors)[1:]:
            command = shlex.join(map(str, [PROGRAM, TOWN / "reference.ply", TOWN / "estimate.ply", *output]))
            look = f"{command}; code=$?; ls -A {shlex.quote(str(self.outputs))} >&2; exit $code"
            result = self.run_program(mount + look, program=alone)
            self.expect_refusal(result, USAGE, "errors.ply: cannot be written: No space left on device")
            self.assertNotIn("errors.ply", result.stderr.decode().splitlines()[1:], "seen inside the mount")
            self.assertEqual(len(result.stderr.decode().splitlines()), 1, "nothing is left in the mount")

    def test_one_output_that_fails_takes_the_others_with_it(self):
        others = ["--export-errors", self.errors, "--export-reference-errors", self.outputs / "reference.ply"]
        result = self.run_program(self.reference, self.estimate, *others, "-o", "/dev/full")
        self.expect_refusal(result, USAGE, "/dev/full")
        result = self.run_program(self.reference, self.estimate, "-o", self.json, "--export-errors", "/dev/full")
        self.expect_refusal(result, USAGE, "/dev/full")

    def test_an_input_is_no_output(self):
        link, hard_link = self.inputs / "link.ply", self.inputs / "hard_link.ply"
        link.symlink_to(self.reference.name)
        os.link(self.estimate, hard_link)
        config = self.input("config.json", "{}")
        matrix = self.input("T.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1")
        for path in (self.reference, self.estimate, link, hard_link, config, matrix, self.inputs / "../inputs/estimate.ply"):
            for output in self.outputs_of(path):
                with self.subTest(output):
                    content = path.read_bytes()
                    result = self.run_program(self.reference, self.estimate, "--config", config, "--transform", matrix, *output)
                    after = path.read_bytes()
                    path.write_bytes(content)  # a failure here must not make the others fail
                    self.assertEqual(after, content, "the input was overwritten")
                    self.expect_refusal(result, USAGE, [str(path), "input"])

    def test_two_outputs_have_two_names(self):
        for first, second in ((0, 1), (1, 2), (0, 2)):
            outputs = self.outputs_of(self.errors)
            with self.subTest((first, second)):
                result = self.run_program(self.reference, self.estimate, *outputs[first], *outputs[second])
                left = os.listdir(self.outputs)
                self.errors.unlink(missing_ok=True)
                self.assertEqual(left, [])
                self.expect_refusal(result, USAGE, str(self.errors))


class Determinism(CmapEval):
    NEEDS = {"plain": set(), "sse2": {"sse2"}, "avx2": {"avx2"}, "avx512": {"avx512f", "avx512dq", "avx512bw", "avx512vl"}}

    def outputs_of(self, pair, arguments, level=None):
        """Everything a run writes, less the report's description of the run."""
        paths = [self.outputs / name for name in ("report.json", "estimate.ply", "reference.ply")]
        result = self.run_program(*pair, *arguments, "-o", paths[0], "--export-errors", paths[1], "--export-reference-errors", paths[2],
                                  environment={"CMAP_SIMD": level} if level else None)
        self.assertEqual(result.returncode, DONE, result.stderr.decode())
        report = self.check_report(paths[0].read_text())
        if level:
            self.assertEqual(report["run"]["simd"], level)
        return without_run(paths[0].read_text()), *(hashlib.sha256(path.read_bytes()).hexdigest() for path in paths[1:])

    def expect_the_same_from_every_run(self, folder, *arguments):
        flags = next((line.split() for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("flags")), [])
        pair = (folder / "reference.ply", folder / "estimate.ply")
        expected = self.outputs_of(pair, [*arguments, "--threads", "1"], "plain")
        for threads in (1, 2, 3):
            self.assertEqual(self.outputs_of(pair, [*arguments, "--threads", str(threads)]), expected, f"{threads} threads")
        for level, needs in self.NEEDS.items():
            with self.subTest(level):
                if needs <= set(flags):
                    self.assertEqual(self.outputs_of(pair, arguments, level), expected)
                else:
                    result = self.run_program(*pair, environment={"CMAP_SIMD": level})
                    self.assertEqual(result.returncode, USAGE, "this processor lacks it")

    def test_town(self):
        self.expect_the_same_from_every_run(TOWN, "--metrics", "all", "--mme-radius", "0.6", "--lcr-curve", "--as", "mapeval,open3d,mpeg,cloudcompare")

    def test_large_real_map(self):
        folder = DATA / "tum_fr1"
        if SANITIZED or not folder.is_dir():
            self.skipTest(f"{folder} is not there, or too slow with sanitizers")
        self.expect_the_same_from_every_run(folder, "--preset", "indoor", "--overlap-distance", "0.2")


if __name__ == "__main__":
    if jsonschema is None:
        print("no jsonschema: reports are not checked against the schema (apt-get install python3-jsonschema)")
    unittest.main()

#!/usr/bin/env python3
"""Names of files as people type them: several spellings of one file, pipes, `-`; and words that are nearly right."""

import json
import os
import socket
import subprocess
import unittest
from pathlib import Path

from cmap_eval_testing import DONE, INPUT, MICRO, USAGE, CmapEval

ALIGN, COMPARE = (Path(os.environ[name]).resolve() for name in ("CMAP_ALIGN", "CMAP_COMPARE"))
RENDER = Path(os.environ["CMAP_RENDER"]).resolve() if "CMAP_RENDER" in os.environ else None


def without_run(report):
    return {key: value for key, value in report.items() if key != "run"}


class Spellings(CmapEval):
    def refused_pair(self, first, second):
        """Two outputs that are one file."""
        arguments = [self.reference, self.estimate, "--export-errors", first, "--export-reference-errors", second]
        result = self.run_program(*arguments, cwd=self.outputs)
        self.assertEqual(result.returncode, USAGE, result.stderr.decode())
        self.assertIn(f"{second}: would overwrite {first}", result.stderr.decode())

    def test_two_outputs_that_are_one_file(self):
        (self.outputs / "sub").mkdir()
        (self.outputs / "again").symlink_to(".")
        (self.outputs / "link.ply").symlink_to("a.ply")
        before = sorted(os.listdir(self.outputs))
        for second in ("./a.ply", "sub/../a.ply", "again/a.ply", "link.ply", self.outputs / "a.ply"):
            with self.subTest(second):
                self.refused_pair("a.ply", second)
                self.refused_pair(second, "a.ply")
                self.assertEqual(sorted(os.listdir(self.outputs)), before, "nothing is written")

    def test_an_output_that_is_an_input(self):
        (self.outputs / "link.ply").symlink_to(self.estimate)
        os.link(self.estimate, self.outputs / "hard.ply")
        for output in ("link.ply", "hard.ply", f"../inputs/{self.estimate.name}"):
            result = self.run_program(self.reference, self.estimate, "--export-errors", output, cwd=self.outputs)
            self.assertEqual(result.returncode, USAGE, output)
            self.assertIn("would overwrite", result.stderr.decode())
        with open(self.estimate, "rb") as redirected:
            result = self.run_program(
                self.reference, "/dev/stdin", "--export-errors", self.estimate, stdin=redirected, cwd=self.outputs
            )
        self.assertEqual(result.returncode, USAGE, "redirected from a file, /dev/stdin is that file")


class Streams(CmapEval):
    def setUp(self):
        super().setUp()
        self.expected = self.evaluate(self.reference, self.estimate)
        self.json.unlink()

    def same_but_for_the_path(self, report, name):
        expected = without_run(self.expected)
        expected["inputs"]["estimate"]["path"] = name
        self.assertEqual(without_run(report), expected)

    def test_a_pipe_with_outputs(self):
        outputs = ["-o", self.json, "--export-errors", self.errors]
        for name, shown in (("/dev/stdin", "/dev/stdin"), ("-", "standard input")):
            result = self.run_program(self.reference, name, *outputs, input=self.estimate.read_bytes())
            self.assertEqual(result.returncode, DONE, result.stderr.decode())
            self.same_but_for_the_path(json.loads(self.json.read_text()), shown)
            self.assertTrue(self.errors.read_bytes().startswith(b"ply"))

    def test_process_substitution(self):
        command = '"$0" <(cat "$1") <(cat "$2") -o "$3" --quiet'
        words = [os.environ["CMAP_EVAL"], self.reference, self.estimate, self.json]
        result = subprocess.run(["bash", "-c", command, *map(str, words)], capture_output=True, text=True)
        self.assertEqual((result.returncode, result.stderr), (DONE, ""))
        report = json.loads(self.json.read_text())
        self.assertEqual(report["metrics"], self.expected["metrics"])

    def test_standard_input_of_every_kind(self):
        """A file, its rest, a socket: whatever a shell or a program makes of it."""
        with open(self.estimate, "rb") as file:
            result = self.run_program(self.reference, "-", "-o", self.json, stdin=file)
            self.assertEqual(result.returncode, DONE, result.stderr.decode())
        self.same_but_for_the_path(json.loads(self.json.read_text()), "standard input")
        ours, its = socket.socketpair()
        ours.sendall(self.estimate.read_bytes())
        ours.close()
        result = self.run_program(self.reference, "-", "-o", self.json, stdin=its)
        its.close()
        self.assertEqual(result.returncode, DONE, result.stderr.decode())
        self.same_but_for_the_path(json.loads(self.json.read_text()), "standard input")

    def test_standard_input_without_a_map(self):
        for content, says in ((b"", "the file is empty"), (b"\x00\x01\x02", "is of no known format")):
            result = self.run_program(self.reference, "-", input=content)
            self.expect_refusal(result, INPUT, f"standard input: {says}")

    def test_standard_input_once(self):
        self.expect_refusal(self.run_program("-", "-", input=b""), USAGE, "standard input can be read only once")

    def test_the_report_to_standard_output(self):
        for name in ("-", "/dev/stdout"):
            result = self.run_program(self.reference, self.estimate, "-o", name)
            self.assertEqual((result.returncode, result.stderr), (DONE, b""))
            report = self.check_report(result.stdout.decode())  # the report alone: no table
            self.assertEqual(without_run(report), without_run(self.expected))
        self.assertEqual(os.listdir(self.outputs), [])

    def test_one_output_to_standard_output(self):
        for other in ("-", "/dev/stdout"):
            result = self.run_program(self.reference, self.estimate, "-o", "-", "--export-errors", other)
            self.expect_refusal(result, USAGE, "standard output can take only one of the outputs")

    def test_a_map_through_two_programs(self):
        """What cmap_eval writes, cmap_eval reads; cmap_align too."""
        result = self.run_program(self.reference, self.estimate, "--export-errors", "-")
        self.assertEqual(result.returncode, DONE, result.stderr.decode())
        self.assertTrue(result.stdout.startswith(b"ply\n"))
        again = self.run_program(self.estimate, "-", "-o", "-", input=result.stdout)
        self.assertEqual(json.loads(again.stdout)["metrics"]["chamfer"]["value"], 0, again.stderr.decode())

    def test_configurations_transforms_and_reports(self):
        config = self.run_program(self.reference, self.estimate, "--config", "-", "-o", "-", input=b'{"lcr-radius": 0.25}')
        self.assertEqual(json.loads(config.stdout)["parameters"]["lcr-radius"], 0.25, config.stderr.decode())
        shift = b"1 0 0 5  0 1 0 0  0 0 1 0  0 0 0 1"
        moved = self.run_program(self.reference, self.estimate, "--transform", "-", "-o", "-", input=shift)
        self.assertEqual(json.loads(moved.stdout)["alignment"]["T_ref_est"][0][3], 5, moved.stderr.decode())
        self.evaluate(self.reference, self.estimate)
        compared = self.run_program(self.json, "-", "-o", "-", input=self.json.read_bytes(), program=(COMPARE,))
        self.assertIn("standard input", compared.stdout.decode().splitlines()[0], compared.stderr.decode())
        broken = self.run_program(self.json, "-", input=b"{", program=(COMPARE,))
        self.assertIn("cmap_compare: standard input: parse error at line 1", broken.stderr.decode())

    @unittest.skipUnless(RENDER, "built without figures")
    def test_pictures(self):
        arguments = [self.reference, "-o", "-", "--size", "640x480", "--quiet"]
        picture = self.run_program(*arguments, program=(RENDER,))
        self.assertEqual(picture.returncode, DONE, picture.stderr.decode())
        self.assertTrue(picture.stdout.startswith(b"\x89PNG"))
        result = self.run_program(self.reference, "--turntable", "-", program=(RENDER,))
        self.assertEqual(result.returncode, USAGE)
        self.assertIn("-: a turntable needs a name", result.stderr.decode())
        result = self.run_program(self.json, self.json, "--figure", "x.pdf", program=(COMPARE,))
        self.assertIn("x.pdf: pictures are .png, .jpg or .tif; a chart can also be .svg", result.stderr.decode())


class NearlyRight(CmapEval):
    """What was meant is said, and what is wrong in the order of the command line."""

    def says(self, says, *arguments, program=None):
        options = {"program": (program,)} if program else {}
        result = self.run_program(*arguments, **options)
        self.assertEqual(result.returncode, USAGE, result.stderr.decode())
        self.assertIn(says, result.stderr.decode())
        self.assertEqual(os.listdir(self.outputs), [])

    def test_options(self):
        pair = (self.reference, self.estimate)
        self.says("not expected: --lcr-raduis 0.1; did you mean --lcr-radius?", *pair, "--lcr-raduis", "0.1")
        self.says("not expected: --lcr-raduis=0.1; did you mean --lcr-radius?", *pair, "--lcr-raduis=0.1")
        self.says("not expected: --export-error x.ply; did you mean --export-errors?", *pair, "--export-error", "x.ply")
        self.says("not expected: --nonsense\nRun", *pair, "--nonsense")
        self.says("not expected: third.ply fourth.ply\nRun", *pair, "third.ply", "fourth.ply")
        self.says("not expected: --out x.json; did you mean --output?", *pair, "--out", "x.json", program=ALIGN)
        self.says("not expected: --fromat; did you mean --format?", self.json, "--fromat", program=COMPARE)

    def test_words(self):
        pair = (self.reference, self.estimate)
        self.says('"acuracy" is unknown; did you mean accuracy?', *pair, "--metrics", "acuracy")
        self.says('preset: "indor" is unknown; did you mean indoor?', *pair, "--preset", "indor")
        self.says('--format: "jsno" is none of table, json; did you mean json?', *pair, "--format", "jsno")
        self.says('"gcip" is none of', *pair, "--align", "gcip")
        self.says("did you mean gicp?", *pair, "--align", "gcip")
        self.says('as: "mapval" is unknown; did you mean mapeval?', *pair, "--as", "mapval")
        self.says('unknown metric "LRC"; did you mean LCR?', *pair, "--require", "LRC>=0.2")
        config = self.input("config.json", '{"lcr_radius": 1}')
        self.says('unknown key "lcr_radius"; did you mean lcr-radius?', *pair, "--config", config)
        self.says('--method: "gcip" is none of', *pair, "--method", "gcip", program=ALIGN)

    @unittest.skipUnless(RENDER, "built without figures")
    def test_layers_and_views(self):
        pair = (self.reference, self.estimate, "-o", self.outputs / "a.png")
        self.says('layer "colour-distance" is unknown; did you mean color-distance?', *pair, "--panels", "colour-distance", program=RENDER)
        self.says('camera "obliqe" is none of', *pair, "--camera", "obliqe", program=RENDER)
        self.says("did you mean oblique?", *pair, "--camera", "obliqe", program=RENDER)

    def test_the_reference_passes_every_gate(self):
        result = self.run_program(self.reference, self.reference, "--quiet", "--require", "CF>=100", "--require", "LCR>=100%")
        self.assertEqual((result.returncode, result.stderr), (DONE, b""))

    def test_shares_in_percent(self):
        """Of two reference points one is recalled: 50 %."""
        report = self.evaluate(self.reference, self.estimate)
        share = report["metrics"]["overlap"]["value"]
        for text, code in ((f"overlap>={100 * share}%", 0), (f"overlap>{100 * share} %", 1)):
            result = self.run_program(self.reference, self.estimate, "--quiet", "--require", text)
            self.assertEqual(result.returncode, code, result.stderr.decode())
        self.json.unlink()
        self.says("accuracy is no share", self.reference, self.estimate, "--require", "accuracy@0.2<=5%")


class MovedMap(CmapEval):
    """cmap_align --output-cloud."""

    def test_it_is_where_the_transform_moves_it(self):
        moved, transform = self.outputs / "moved.ply", self.outputs / "T.txt"
        town = MICRO.parent / "town"
        arguments = [town / "estimate.ply", town / "reference.ply", "--voxel", "0.5", "-o", transform]
        result = self.run_program(*arguments, "--output-cloud", moved, program=(ALIGN,))
        self.assertEqual(result.returncode, DONE, result.stderr.decode())
        by_transform = self.evaluate(town / "reference.ply", town / "estimate.ply", "--transform", transform)
        by_cloud = self.evaluate(town / "reference.ply", moved)
        for metric in ("chamfer", "rmse", "color_distance", "local_color_recall"):
            values = [report["metrics"][metric]["value"] for report in (by_transform, by_cloud)]
            self.assertAlmostEqual(*values, delta=1e-6 * values[0], msg=metric)
        unmoved = self.evaluate(town / "reference.ply", town / "estimate.ply")
        self.assertNotAlmostEqual(
            unmoved["metrics"]["rmse"]["value"], by_cloud["metrics"]["rmse"]["value"], delta=1e-5, msg="it moves"
        )

    def test_refusals(self):
        pair = (self.estimate, self.reference)
        for says, arguments in [
            ("the moved map is written as PLY", ("--output-cloud", self.outputs / "moved.las")),
            ("would overwrite", ("--output-cloud", self.reference)),
            ("would overwrite", ("--output-cloud", self.outputs / "a.ply", "-o", self.outputs / "./a.ply")),
            ("has no meaning for --method trajectory", ("--method", "trajectory", "--output-cloud", "moved.ply")),
        ]:
            result = self.run_program(*pair, *arguments, program=(ALIGN,))
            self.assertEqual(result.returncode, USAGE, result.stderr.decode())
            self.assertIn(says, result.stderr.decode())
            self.assertEqual(os.listdir(self.outputs), [])


if __name__ == "__main__":
    unittest.main()

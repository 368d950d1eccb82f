#!/usr/bin/env python3
"""Drives cmap_compare as a user does: formats, refusals, files that it writes."""

import csv
import io
import json
import os
import re
import subprocess
import unittest
import xml.etree.ElementTree as xml
from pathlib import Path

from cmap_eval_testing import DONE, INPUT, PROGRAM, SOURCE, UNSUPPORTED, USAGE, CmapEval, ply
from latex_check import check_latex

COMPARE = Path(os.environ["CMAP_COMPARE"]).resolve()


class Compare(CmapEval):
    def setUp(self):
        super().setUp()
        self.a = self.report("a.json", self.reference, self.estimate, "--lcr-curve")
        self.b = self.report("b.json", self.reference, self.reference, "--lcr-curve")

    def report(self, name, *arguments):
        path = self.inputs / name
        subprocess.run([PROGRAM, *arguments, "--quiet", "-o", path], check=True)
        return path

    def compare(self, *arguments, code=DONE):
        result = self.run_program(*arguments, program=(COMPARE,))
        self.assertEqual(result.returncode, code, result.stderr.decode())
        return result.stdout.decode()

    def levels(self, name, source, skill, chance, phases):
        """A copy of a report with what its numbers are worth, as the metrics have it."""
        report = json.loads(source.read_text())
        metrics = report["metrics"]
        distance, wasserstein = metrics["color_distance"], metrics["average_wasserstein"]
        distance["floor"] = {"value": 0.05, "se": 0.001, "n": 3}
        distance["chance"] = {"value": chance, "se": 0.001, "n": 3}
        distance["skill"] = {"value": skill, "se": 0.002}
        wasserstein["value"] = phases[0]
        wasserstein["phases"] = {
            "n": len(phases), "mean": sum(phases) / len(phases), "std": 0.0625, "min": min(phases), "max": max(phases), "values": phases
        }
        curve = metrics["local_color_recall"]["curve"]
        curve["chance"] = [0.5 * value for value in curve["value"]]
        return self.input(name, json.dumps(report))

    def changed(self, name, change):
        """A copy of report a with something changed."""
        report = json.loads(self.a.read_text())
        change(report)
        return self.input(name, json.dumps(report))

    def refused(self, code, says, *arguments):
        """Nothing is printed or left behind."""
        result = self.run_program(
            *arguments, "-o", self.outputs / "table.txt", "--figure", self.outputs / "f.svg", program=(COMPARE,)
        )
        message = result.stderr.decode()
        self.assertEqual(result.returncode, code, message)
        self.assertTrue(message.startswith("cmap_compare: "), message)
        for part in [says] if isinstance(says, str) else says:
            self.assertIn(part, message)
        self.assertEqual(result.stdout, b"")
        self.assertEqual(os.listdir(self.outputs), [])

    def test_intervals_of_differences(self):
        """Planes 0.125 and 0.25 m above the reference: every block is worse by 2 x 0.125 m Chamfer, without doubt."""
        plane = [(x, y) for x in range(40) for y in range(40)]
        maps = {z: self.input(f"{z}.ply", ply([(x, y, z) for x, y in plane])) for z in (0, 0.125, 0.25)}
        blocks = ("--metrics", "chamfer,hausdorff", "--bootstrap", "100", "--block", "5")
        near, far = (self.report(f"at_{z}.json", maps[0], maps[z], *blocks) for z in (0.125, 0.25))
        table = self.compare(near, far, "--baseline", near)
        self.assertIn("95 % intervals of these differences", table)
        intervals = table[table.index("95 % intervals") :]
        self.assertRegex(intervals, r"Chamfer distance +CD# +↓ +m +-0.2500 to -0.2500")
        self.assertRegex(intervals, r"Hausdorff distance +↓ +m +-\n")
        without = self.report("without.json", maps[0], maps[0.25], "--metrics", "chamfer")
        self.assertNotIn("intervals of these", self.compare(near, without, "--baseline", near))

    def test_what_noise_explains_shares_its_mark(self):
        """Planes over a plane: near; far, worse in every block; uneven, worse in one half and nearly as much better in the other."""
        plane = [(x, y) for x in range(40) for y in range(40)]
        ground = self.input("ground.ply", ply([(x, y, 0) for x, y in plane]))
        heights = {
            "near": lambda x: 0.125,
            "far": lambda x: 0.25,
            "uneven": lambda x: 0.135 if x < 20 else 0.1151,
        }
        maps = {name: self.input(f"{name}.ply", ply([(x, y, z(x)) for x, y in plane])) for name, z in heights.items()}
        blocks = ("--metrics", "chamfer,hausdorff", "--bootstrap", "200", "--block", "5")
        near, far, uneven = (self.report(f"{name}.json", ground, path, *blocks) for name, path in maps.items())
        self.assertRegex(self.compare(near, far), r"Chamfer distance +CD# +↓ +m +0.2500\* +0.5000\+\n")
        table = self.compare(near, far, uneven)
        self.assertRegex(table, r"Chamfer distance +CD# +↓ +m +0.2500\* +0.5000\+ +0.2501\*\n")
        self.assertRegex(table, r"Hausdorff distance +↓ +m +0.1250\? +0.2500 +0.1350\n", "a maximum has no interval")
        self.assertIn("0 of 2 rankings distinguishable at 95 %, 1 not, 1 not tested (no interval of the difference)\n", table)
        plain = self.compare(near, far, uneven, "--plain-ranking")
        self.assertRegex(plain, r"Chamfer distance +CD# +↓ +m +0.2500\* +0.5000 +0.2501\+\n")
        self.assertNotIn("distinguishable", plain)

    def test_levels_and_phases(self):
        """Skill has rows; AWD its spread over the grid's phases, one of which ranks the other way round."""
        a = self.levels("x.json", self.a, 0.5, 0.25, [1.0, 2.0])
        b = self.levels("y.json", self.b, 0.75, 0.3, [1.5, 1.75])
        table = self.compare(a, b)
        self.assertRegex(table, r"skill of color distance +↑ +0.5000 +0.7500\?\n")
        self.assertRegex(table, r"AWD +↓ +m +1.000\* ± 0.062 +1.500\* ± 0.062\n")
        self.assertIn("over the grid's phases", table)
        rows = csv.DictReader(io.StringIO(self.compare(a, b, "--metrics", "CD,AWD", "--format", "csv")))
        values = {(row["metric"], row["part"]): (row["x"], row["y"]) for row in rows}
        self.assertEqual(values["color_distance", "floor"], ("0.05", "0.05"))
        self.assertEqual(values["color_distance", "chance"], ("0.25", "0.3"))
        self.assertEqual(values["color_distance", "skill"], ("0.5", "0.75"))
        self.assertEqual(values["average_wasserstein", "phase_std"], ("0.0625", "0.0625"))
        for bands in ([], ["--bands"]):
            text = self.compare(a, b, "--format", "latex", *bands)
            self.assertEqual("$\\pm$ 0.062" in text, bool(bands))
            check_latex(self, text, self.folder)
        self.compare(a, b, "--figure", self.outputs / "f.svg")
        svg = (self.outputs / "f.svg").read_text()
        for says in ("local color recall ↑ [%], dashed: by chance", "Lines over bars", "skill of color distance ↑"):
            self.assertIn(says, svg)

    def test_text(self):
        """The two-points pair by hand: chamfer 4.375, overlap 0.5; the reference against itself 0 and 1."""
        table = self.compare(self.a, self.b, "--plain-ranking")
        self.assertRegex(table, r"metric +symbol +unit +a +b")
        self.assertRegex(table, r"Chamfer distance +CD# +↓ +m +4.375\+ +0\*")
        self.assertRegex(table, r"overlap +Overlap +↑ +% +50.00\+ +100.00\*")
        self.assertRegex(table, r"color fidelity +CF +↑ +dB +[0-9.]+\+ +∞\*", "what is perfect is best")
        self.assertRegex(table, r"average Wasserstein distance +AWD +↓ +m +- +-\n", "null is a dash, never 0")
        self.assertIn("3 points, SHA-256", table)

    def test_csv_has_the_numbers_of_the_reports(self):
        rows = list(csv.DictReader(io.StringIO(self.compare(self.a, self.b, "--format", "csv"))))
        reports = {name: json.loads((self.inputs / f"{name}.json").read_text())["metrics"] for name in "ab"}
        of_values = [row for row in rows if row["part"] in ("", "coverage")]
        for row in of_values:
            for name, metrics in reports.items():
                record = metrics[row["metric"]]
                if row["at_m"]:
                    levels = {str(level["threshold_m"]): level["value"] for level in record["per_threshold"]}
                    expected = levels[row["at_m"]]
                else:
                    expected = record["coverage"] if row["part"] else record["value"]
                if name == "b" and row["metric"] == "color_fidelity":
                    expected = float("inf")  # null in JSON: the reference against itself
                self.assertEqual(row[name], "" if expected is None else row[name])
                self.assertEqual(float(row[name]) if row[name] else None, expected, row)
                self.assertNotRegex(row[name], r"\.\d{3}(e|$)", "spreadsheets read a point before three digits as thousands")
        metrics = {row["metric"] for row in of_values}
        self.assertEqual(len(of_values), len(metrics) + 1 + 4 * (5 - 1), "each metric, coverage, five thresholds")

    def test_baseline(self):
        for arguments in ((self.a, self.b), (self.b,)):
            table = self.compare(*arguments, "--baseline", self.a)
            self.assertIn("Better (+) or worse (-) than a", table)
            self.assertRegex(table, r"Chamfer distance .*\+4.375 \(\+100.0 %\)")
        self.assertRegex(self.compare(self.a, self.b, "--baseline", self.b), r"overlap .*-50.00 \(-50.0 %\)")

    def test_names_and_metrics(self):
        table = self.compare(self.a, self.b, "--names", "Ours,The truth", "--metrics", "AC,chamfer")
        self.assertRegex(table, r"unit +Ours +The truth")
        self.assertEqual(table.count("accuracy"), 5)
        self.assertNotIn("overlap", table)

    def test_markdown(self):
        table = self.compare(self.a, self.b, "--format", "markdown", "--names", "a|b,c_d")
        self.assertIn("| a\\|b | c\\_d |", table)
        rows = [line for line in table.splitlines() if line.startswith("|")]
        self.assertEqual({len(re.findall(r"(?<!\\)\|", row)) for row in rows}, {7})
        self.assertIn("| 4.375 | 0? |", table)
        self.assertIn("| *4.375* | **0** |", self.compare(self.a, self.b, "--format", "markdown", "--plain-ranking"))

    def test_latex(self):
        text = self.compare(self.a, self.b, "--format", "latex", "--names", "100 % & more_{},\\evil#~^", "--baseline", self.a)
        self.assertIn("4.375 & \\cellcolor{gray!25}0 ", text)
        check_latex(self, text, self.folder)
        text = self.compare(self.a, self.b, "--format", "latex", "--plain-ranking")
        self.assertIn("\\cellcolor{orange!35}4.375 & \\cellcolor{red!35}0", text)
        check_latex(self, text, self.folder)

    def test_html_is_self_contained(self):
        page = self.compare(self.a, self.b, "--format", "html", "--names", "<img src=x>,b", "--baseline", self.a)
        self.assertNotIn("<img", page)
        self.assertNotRegex(page, r"(src|href)=\"(?!#)")
        self.assertIn("default-src 'none'", page)
        self.assertIn('class="value untested" data-value="0"', page)
        page = self.compare(self.a, self.b, "--format", "html", "--plain-ranking")
        self.assertIn('class="value best" data-value="0"', page)

    def test_output_file(self):
        self.assertEqual(self.compare(self.a, self.b, "-o", self.outputs / "t.txt"), "")
        self.assertEqual((self.outputs / "t.txt").read_text(), self.compare(self.a, self.b))

    def test_figure(self):
        svg = self.outputs / "f.svg"
        self.compare(self.a, self.b, "--names", "<&>,b", "--figure", svg)
        texts = [element.text for element in xml.parse(svg).getroot().iter("{http://www.w3.org/2000/svg}text")]
        for text in ("<&>", "Chamfer distance ↓ [m]", "4.375", "accuracy ↓ [m]", "threshold [m]", "tau"):
            self.assertIn(text, texts)
        picture = self.outputs / "f.png"
        if "CMAP_RENDER" in os.environ:
            self.compare(self.a, self.b, "--figure", picture)
            self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        else:
            self.compare(self.a, self.b, "--figure", picture, code=UNSUPPORTED)

    def test_refuses_what_does_not_compare(self):
        other = self.changed("other.json", lambda r: r["parameters"].update({"lcr-tau": 0.2}))
        self.refused(USAGE, [f"{self.a} and {other} have different parameters", "lcr-tau is 0.1 and 0.2"], self.a, other)
        other = self.changed("other.json", lambda r: r["inputs"]["reference"].update(sha256="0" * 64))
        self.refused(USAGE, [f"{self.a} and {other} have different references", "cmap_leaderboard"], self.a, other)
        other = self.changed("other.json", lambda r: r["metrics"]["chamfer"].update(unit="mm"))
        self.refused(USAGE, f"{self.a} and {other} define chamfer differently", self.a, other)
        self.refused(USAGE, "different parameters", other, "--baseline", self.report("c.json", self.reference, self.estimate, "--lcr-tau", "0.3"))

    def earlier(self, report):
        """Turns a report into one of cmap 0.1.0."""
        report.update(schema="cmap.report/1")
        report["tool"]["version"] = "0.1.0"
        report["parameters"].pop("ccs-singletons", None)
        report["parameters"]["ccs-voxel"] = 0.2
        consistency = report["metrics"]["color_consistency"]
        consistency["parameters"] = {"voxel_m": 0.2, "min_points": 2}

    def test_reports_of_an_earlier_version(self):
        """What did not change compares, with a word; what did is refused, with the way out."""
        earlier = self.changed("earlier.json", self.earlier)
        self.refused(USAGE, ["0.1.0", "ccs-singletons", "--metrics"], earlier, self.b)
        result = self.run_program(earlier, self.b, "--metrics", "geometry", program=(COMPARE,))
        self.assertEqual(result.returncode, DONE, result.stderr.decode())
        self.assertRegex(result.stderr.decode(), r"^cmap_compare: warning: version of cmap: 0\.1\.0 for earlier; ")
        self.assertIn("within rounding of the threshold", result.stderr.decode())
        self.assertRegex(result.stdout.decode(), r"\n *version of cmap: 0\.1\.0 for earlier; ")
        self.assertRegex(result.stdout.decode(), r"Chamfer distance +CD# +↓ +m +4.375 +0\?")
        same = self.changed("same.json", lambda r: r["tool"].update(version="0.0.3"))
        result = self.run_program(self.a, same, program=(COMPARE,))
        self.assertEqual(result.returncode, DONE, result.stderr.decode())
        self.assertIn("version of cmap: 0.0.3 for same; ", result.stderr.decode())
        self.assertEqual(self.run_program(self.a, self.b, program=(COMPARE,)).stderr, b"", "one version: no word")

    def test_one_map_each(self):
        alone = [self.report(f"{name}.json", path) for name, path in (("x", self.reference), ("y", self.estimate))]
        table = self.compare(*alone)
        self.assertRegex(table, r"point spacing +m +[0-9.]+ +[0-9.]+\n")
        self.assertNotIn("SHA-256", table)
        for form in ("markdown", "csv", "latex", "html"):
            self.compare(*alone, "--format", form)
        self.compare(*alone, "--figure", self.outputs / "f.svg")
        (self.outputs / "f.svg").unlink()
        self.refused(USAGE, "about a map alone", self.a, alone[0])

    def test_refuses_what_is_no_report(self):
        self.refused(USAGE, "is no report of cmap_eval: its schema is missing", self.a, self.input("x.json", "{}"))
        newer = self.changed("x.json", lambda r: r.update(schema="cmap.report/3"))
        self.refused(USAGE, f'{newer}: is no report of cmap_eval: its schema is "cmap.report/3"', self.a, newer)
        self.refused(USAGE, "is no report", SOURCE / "configs/report.schema.json", self.a)
        self.refused(INPUT, "parse error at line", self.a, self.input("x.json", self.a.read_text()[:500]))
        self.refused(INPUT, "cannot be read as a report", self.a, self.inputs / "none.json")
        self.refused(INPUT, "cannot be read as a report", self.a, self.inputs)
        damaged = self.changed("x.json", lambda r: r["metrics"]["chamfer"].pop("value"))
        self.refused(INPUT, f'{damaged}: damaged report: metrics.chamfer has no "value"', self.a, damaged)
        self.refused(INPUT, "parse error", self.a, self.input("x.json", '{"schema": "cmap.report/1", "metrics": NaN}'))

    def test_wrong_usage(self):
        self.refused(USAGE, "is given twice", self.a, self.a)
        self.refused(USAGE, "names: 1 for 2 reports", self.a, self.b, "--names", "x")
        self.refused(USAGE, '"nonsense" is unknown', self.a, self.b, "--metrics", "nonsense")
        self.refused(USAGE, "no report has any of MME", self.a, self.b, "--metrics", "MME")
        self.refused(USAGE, "--baseline", self.a, self.b, "--baseline", "")
        self.refused(USAGE, "--format", self.a, self.b, "--format", "pdf")
        result = self.run_program(self.a, self.b, "-o", self.b, program=(COMPARE,))
        self.assertEqual(result.returncode, USAGE)
        self.assertIn("would overwrite", result.stderr.decode())
        result = self.run_program(self.a, "--figure", self.outputs / "f.txt", program=(COMPARE,))
        self.assertEqual(result.returncode, USAGE if "CMAP_RENDER" in os.environ else UNSUPPORTED)
        self.assertEqual(os.listdir(self.outputs), [])

    def test_the_examples_of_the_help_run(self):
        help_text = self.compare("--help")
        examples = [line for line in help_text.splitlines() if line.startswith("  cmap_")]
        self.assertEqual(len(examples), 5)
        (self.folder / "data_samples").symlink_to(SOURCE / "data_samples")
        (self.folder / "bin").mkdir()
        for program in (PROGRAM, COMPARE):
            (self.folder / "bin" / program.name).symlink_to(program)
        result = self.run_program(
            "-ec",
            "\n".join(examples),
            program=["bash"],
            cwd=self.folder,
            environment={"PATH": f"{self.folder}/bin:{os.environ['PATH']}"},
        )
        self.assertEqual(result.returncode, DONE, result.stderr.decode())
        check_latex(self, (self.folder / "table.tex").read_text(), self.folder)


if __name__ == "__main__":
    unittest.main()

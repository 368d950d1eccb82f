#!/usr/bin/env python3
"""Drives cmap_leaderboard as a user does: a small leaderboard of generated maps, runs that are killed, damaged results."""

import csv
import fcntl
import io
import json
import os
import random
import re
import shutil
import subprocess
import time
import unittest
import urllib.parse
from pathlib import Path

import numpy as np

from cmap_eval_testing import DONE, INPUT, PROGRAM, SCHEMA, SOURCE, USAGE, CmapEval, jsonschema
from latex_check import check_latex

LEADERBOARD = Path(os.environ["CMAP_LEADERBOARD"]).resolve()
GOLDEN = SOURCE / "../shared/golden/paper_tables.json"
PAPER = SOURCE / "benchmarks/leaderboard/paper.json"
HAS_FIGURES = "CMAP_RENDER" in os.environ


def write_map(path, points, colors):
    rows = np.empty(len(points), [("xyz", "<f4", 3), ("rgb", "u1", 3)])
    rows["xyz"], rows["rgb"] = points, np.clip(np.rint(colors), 0, 255)
    properties = "".join(f"property float {n}\n" for n in "xyz") + "".join(
        f"property uchar {n}\n" for n in ("red", "green", "blue")
    )
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n{properties}end_header\n"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(header.encode() + rows.tobytes())


def sheet(n, seed, noise=0.0):
    """A painted, wavy surface of 10 m x 10 m; noise in meters and, times 500, in 8-bit color."""
    rng = np.random.default_rng(seed)
    x, y = 10 * rng.random((2, n))
    points = np.stack([x, y, 0.3 * np.sin(x) * np.cos(y)], axis=1)
    colors = np.stack([128 + 100 * np.sin(x), 128 + 100 * np.cos(y), 12 * (x + y)], axis=1)
    return points + noise * rng.standard_normal((n, 3)), colors + 500 * noise * rng.standard_normal((n, 3))


def files_below(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


class Leaderboard(CmapEval):
    """Two sequences; method Fine is better than Coarse everywhere; Broken has a truncated map and a missing one; Absent
    failed on one and names none for the other."""

    def setUp(self):
        super().setUp()
        for k, sequence in enumerate(("hill", "dale")):
            write_map(self.inputs / sequence / "reference.ply", *sheet(4000, 10 * k))
            write_map(self.inputs / sequence / "fine.ply", *sheet(3500, 10 * k + 1, 0.01))
            write_map(self.inputs / sequence / "coarse.ply", *sheet(2500, 10 * k + 2, 0.05))
        (self.inputs / "hill/broken.ply").write_bytes((self.inputs / "hill/fine.ply").read_bytes()[:20000])
        self.board = {
            "version": 1,
            "parameters": {"awd-min-points": 50},
            "sequences": [{"name": s, "reference": f"{s}/reference.ply"} for s in ("hill", "dale")],
            "methods": [
                {"name": "Coarse", "maps": {s: f"{s}/coarse.ply" for s in ("hill", "dale")}},
                {"name": "Fine & dandy", "maps": {s: f"{s}/fine.ply" for s in ("hill", "dale")}},
                {"name": "Broken", "maps": {"hill": "hill/broken.ply", "dale": "dale/none.ply"}},
                {"name": "Absent", "failed": ["hill"]},
            ],
        }

    def manifest(self, board=None, name="manifest.json"):
        path = self.folder / name
        path.write_text(json.dumps(board or self.board))
        return path

    def arguments(self, output, *more):
        return [self.manifest(), "--data-root", self.inputs, "-o", output, *more]

    def run_board(self, output=None, *more, code=DONE):
        result = self.run_program(*self.arguments(output or self.outputs / "board", *more), program=(LEADERBOARD,))
        self.assertEqual(result.returncode, code, result.stderr.decode())
        return result.stdout.decode(), result.stderr.decode()

    def test_tables(self):
        text, log = self.run_board(None, "--plain-ranking")
        board = self.outputs / "board"
        self.assertRegex(text, r"Chamfer distance \(CD#\) ↓ \[m\]\nmethod +hill +dale\nCoarse +0.\d+\+ +0.\d+\+\nFine")
        self.assertRegex(text, r"Fine & dandy +0.\d+\* +0.\d+\*\nBroken +x +-\nAbsent +x +-\n")
        self.assertIn("x hill / Broken: hill/broken.ply: ", text, "the reason, without the data root")
        self.assertIn("- dale / Broken: there is no file dale/none.ply", text)
        self.assertIn("- dale / Absent: the manifest names no map", text)
        self.assertIn("x hill / Absent: has no map, as the manifest says", text)
        self.assertIn("[1/8] hill / Coarse: evaluated in", log)
        self.assertIn("[3/8] hill / Broken: failed: ", log)
        rows = list(csv.DictReader(io.StringIO((board / "tables.csv").read_text())))
        for row in rows:
            if row["state"] != "done":
                self.assertEqual((row["value"], row["rank"]), ("", ""), "never a zero")
                continue
            folder = board / "pairs" / row["sequence"] / row["method"].replace(" ", "~20").replace("&", "~26")
            record = json.loads((folder / "report.json").read_text())["metrics"][row["metric"]]
            if row["at_m"]:
                value = next(e["value"] for e in record["per_threshold"] if str(e["threshold_m"]) == row["at_m"])
            else:
                value = {"": record, "skill": record.get("skill"), "coverage": {"value": record.get("coverage")}}[row["part"]]["value"]
            self.assertEqual(float(row["value"]), value)
        best = {(row["sequence"], row["method"]) for row in rows if row["metric"] == "chamfer" and row["rank"] == "best"}
        self.assertEqual(best, {("hill", "Fine & dandy"), ("dale", "Fine & dandy")})
        check_latex(self, (board / "tables.tex").read_text(), self.folder)
        self.assertIn("Fine \\& dandy & \\cellcolor{red!35}", (board / "tables.tex").read_text())
        self.assertIn("| Fine &amp; dandy | **", (board / "tables.md").read_text())

    def test_rankings_are_tested(self):
        """Fine is better than Coarse in nearly every block; without blocks nobody knows."""
        text, _ = self.run_board()
        self.assertRegex(text, r"Coarse +0.\d+ +0.\d+\nFine & dandy +0.\d+\? +0.\d+\?\n")
        self.assertRegex(text, r"rankings distinguishable.*, \d+ not tested \(no --bootstrap\)\n")
        self.board["parameters"].update({"bootstrap": 100, "block": 2})
        text, _ = self.run_board()
        self.assertRegex(text, r"Chamfer distance .*\nmethod +hill +dale\nCoarse +0.\d+\+ +0.\d+\+\nFine & dandy +0.\d+\* +0.\d+\*\n")
        self.assertRegex(text, r"\d+ of \d+ rankings distinguishable at 95 %")
        self.assertNotIn("no --bootstrap", text)
        rows = list(csv.DictReader(io.StringIO((self.outputs / "board/tables.csv").read_text())))
        ranks = {row["method"]: row["rank"] for row in rows if row["metric"] == "chamfer" and row["sequence"] == "hill"}
        self.assertEqual(ranks, {"Coarse": "second", "Fine & dandy": "best", "Broken": "", "Absent": ""})

    def test_reports_are_those_of_cmap_eval(self):
        self.run_board()
        path = self.outputs / "board/pairs/hill/Coarse/report.json"
        report = json.loads(path.read_text())
        if jsonschema:
            jsonschema.Draft7Validator(SCHEMA).validate(report)
        self.assertEqual(
            report["run"], {"command": "cmap_eval hill/reference.ply hill/coarse.ply --lcr-curve --awd-min-points 50"}
        )
        again = subprocess.run(
            [PROGRAM, *report["run"]["command"].split()[1:], "--format", "json"], cwd=self.inputs, capture_output=True
        )
        same = json.loads(again.stdout)
        for part in report:
            if part != "run":
                self.assertEqual(report[part], same[part], "the command gives the same report")

    def test_every_link_leads_somewhere(self):
        self.run_board()
        board = self.outputs / "board"
        page = (board / "index.html").read_text()
        links = [urllib.parse.unquote(link) for link in re.findall(r'(?:href|src)="([^"#]+)"', page)]
        self.assertEqual(len(links), 4 * (5 if HAS_FIGURES else 2))
        for link in links:
            self.assertTrue((board / link).is_file(), link)
        self.assertNotIn("http", page.replace("http-equiv", ""))

    def test_a_second_run_computes_nothing_and_changes_nothing(self):
        self.run_board()
        first = files_below(self.outputs)
        text, log = self.run_board()
        self.assertEqual(log.count("done before"), 4)
        self.assertNotIn("evaluated", log)
        self.assertEqual(files_below(self.outputs), first)

    def test_killed_at_any_moment_it_leaves_the_same_bytes(self):
        whole = self.outputs / "whole"
        start = time.monotonic()
        self.run_board(whole)
        duration = time.monotonic() - start
        expected = files_below(whole)
        rng = random.Random(1)
        killed = self.outputs / "killed"
        n_killed = 0
        for share in [0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95] + [rng.random() for _ in range(5)]:
            if share < 0.3:
                shutil.rmtree(killed, ignore_errors=True)
            process = subprocess.Popen(
                [LEADERBOARD, *self.arguments(killed)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
            )
            time.sleep(share * duration)
            process.kill()
            n_killed += process.wait() != 0
            self.check_partial(killed)
        # On a machine that is suddenly free, later runs, which go on where others were killed, end before their time.
        self.assertGreater(n_killed, 0, "some run was killed while it worked")
        self.run_board(killed)
        self.assertEqual(files_below(killed), expected, "the same files with the same bytes")
        shutil.rmtree(killed / "pairs/hill")
        self.run_board(killed)
        self.assertEqual(files_below(killed), expected)

    def test_a_pair_that_dies_stops_no_other(self):
        """As the system does where memory runs out: it kills the process of the pair at hand."""
        output = self.outputs / "board"
        process = subprocess.Popen(
            [LEADERBOARD, *self.arguments(output)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
        while process.poll() is None and not (child := children.read_text().split()):
            time.sleep(0.001)
        os.kill(int(child[0]), 9)
        text, log = process.communicate()
        self.assertEqual(process.returncode, DONE, log)
        self.assertIn("x hill / Coarse: its evaluation was ended by signal 9", text)
        self.assertEqual(log.count("evaluated in"), 3, "the others are done")
        text, log = self.run_board()
        self.assertEqual((log.count("done before"), log.count("evaluated in")), (3, 1))
        self.assertNotIn("signal", text)

    def check_partial(self, folder):
        """Whatever has its name is complete."""
        for path in folder.rglob("*.json"):
            if not path.name.startswith("."):
                json.loads(path.read_text())

    def test_damaged_and_outdated_results_are_computed_again(self):
        self.run_board()
        board = self.outputs / "board"
        expected = files_below(board)
        pair = board / "pairs/hill/Coarse"
        report = (pair / "report.json").read_text()

        def record_of(**tool):
            record = json.loads((pair / "pair.json").read_text())
            record["key"]["tool"].update(tool)
            (pair / "pair.json").write_text(json.dumps(record))

        damages = {
            "report.json is not as it was written": lambda: (pair / "report.json").write_text(report.replace("0.", "1.", 1)),
            "report.html is not as it was written": lambda: (pair / "report.html").write_text("<html>"),
            "parse error": lambda: (pair / "pair.json").write_text('{"schema": '),
            "pair.json is not as it was written": lambda: (pair / "pair.json").write_text("[]"),
            "it is of another version": lambda: record_of(version="0.1.0"),
            "of another version": lambda: record_of(schema="cmap.report/1"),
            "cannot be read": lambda: (pair / "report.json").unlink(),
        }
        for says, damage in damages.items():
            with self.subTest(says):
                damage()
                _, log = self.run_board()
                self.assertIn(f"hill / Coarse: what is stored is not used, it is ", log)
                self.assertIn(says, log)
                self.assertEqual(log.count("done before"), 3, "the others stay")
                self.assertEqual(files_below(board), expected)

    def test_other_maps_and_parameters_are_evaluated_again(self):
        self.run_board()
        write_map(self.inputs / "hill/coarse.ply", *sheet(2000, 77, 0.02))
        _, log = self.run_board()
        self.assertEqual((log.count("done before"), log.count("evaluated in")), (3, 1))
        self.board["parameters"]["lcr-tau"] = 0.05
        _, log = self.run_board()
        self.assertEqual(log.count("evaluated in"), 4)

    def test_a_mended_map_joins_the_others(self):
        self.run_board()
        write_map(self.inputs / "dale/none.ply", *sheet(3000, 5, 0.02))
        text, log = self.run_board()
        self.assertIn("dale / Broken: evaluated in", log)
        self.assertNotIn("none.ply", text)

    def test_the_same_for_any_number_of_threads_and_place(self):
        self.run_board(self.outputs / "one", "--threads", "1")
        elsewhere = self.folder / "elsewhere"
        shutil.copytree(self.inputs, elsewhere)
        result = self.run_program(
            self.manifest(), "--data-root", elsewhere, "-o", self.outputs / "two", "--threads", "2", program=(LEADERBOARD,)
        )
        self.assertEqual(result.returncode, DONE)
        self.assertEqual(files_below(self.outputs / "one"), files_below(self.outputs / "two"))

    def refused(self, code, says, *arguments):
        result = self.run_program(*arguments, program=(LEADERBOARD,))
        message = result.stderr.decode()
        self.assertEqual(result.returncode, code, message)
        self.assertTrue(message.startswith("cmap_leaderboard: "), message)
        self.assertIn(says, message)
        self.assertEqual(result.stdout, b"")

    def test_refusals(self):
        """Every bad line of a manifest is in tests/board/leaderboard_manifest_test.cpp."""
        output = self.outputs / "board"
        broken = self.folder / "broken.json"
        broken.write_text("{")
        where = ["--data-root", self.inputs, "-o", output]
        self.refused(USAGE, f"{broken}: parse error at line 1", broken, *where)
        self.refused(USAGE, "cannot be read as a manifest", self.folder / "none.json", *where)
        self.refused(USAGE, "unknown key", self.manifest({**self.board, "extra": 1}), *where)
        manifest = self.manifest()
        self.refused(INPUT, "the data root is no folder", manifest, "--data-root", self.folder / "none", "-o", output)
        self.refused(USAGE, "holds the input hill/reference.ply", manifest, "--data-root", self.inputs, "-o", self.inputs)
        self.refused(USAGE, "--output", manifest, "--data-root", self.inputs)
        self.assertFalse(output.exists(), "nothing is left behind")
        file = self.outputs / "file"
        file.write_text("mine")
        self.refused(USAGE, "cannot be made", manifest, "--data-root", self.inputs, "-o", file)
        self.assertEqual(file.read_text(), "mine")

    def test_two_runs_do_not_write_into_one_folder(self):
        output = self.outputs / "board"
        output.mkdir()
        descriptor = os.open(output, os.O_RDONLY)
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        self.refused(USAGE, "another program is writing into it", *self.arguments(output))
        os.close(descriptor)

    def test_quiet(self):
        self.assertEqual(self.run_board(None, "--quiet"), ("", ""))

    def test_the_example_of_the_help_runs(self):
        help_text = self.run_program("--help", program=(LEADERBOARD,)).stdout.decode()
        example = next(line for line in help_text.splitlines() if line.startswith("  cmap_leaderboard "))
        (self.folder / "bin").mkdir()
        (self.folder / "bin/cmap_leaderboard").symlink_to(LEADERBOARD)
        for name in ("data_samples", "benchmarks"):
            (self.folder / name).symlink_to(SOURCE / name)
        path = {"PATH": f"{self.folder}/bin:{os.environ['PATH']}"}
        result = self.run_program("-c", example, program=["bash"], cwd=self.folder, environment=path)
        self.assertEqual(result.returncode, DONE, result.stderr.decode())
        self.assertRegex(result.stdout.decode(), r"estimate +1.899 +4.375 +256.0\n")


class Paper(CmapEval):
    """benchmarks/leaderboard: the paper's tables."""

    @unittest.skipUnless(GOLDEN.exists(), "no ../shared/golden/paper_tables.json")
    def test_paper_json_is_the_paper(self):
        golden, paper = json.loads(GOLDEN.read_text()), json.loads(PAPER.read_text())
        ids = {
            "multimappinggeo": {
                "CD": "chamfer", "AC": "accuracy", "Overlap": "overlap", "AWD": "average_wasserstein", "Fitness": "fitness"
            },
            "multimappingcolor": {
                "CD": "color_distance", "CF": "color_fidelity", "CCS": "color_consistency", "LCR": "local_color_recall"
            },
        }
        expected = {}
        for table, symbols in ids.items():
            self.assertEqual(set(golden[table]), set(symbols))
            for symbol, metric in symbols.items():
                scale = 100 if symbol in ("Overlap", "LCR") else 1
                expected[metric] = {
                    sequence: {m: None if v is None else round(v / scale, 12) for m, v in methods.items()}
                    for sequence, methods in golden[table][symbol].items()
                }
        self.assertEqual(paper["metrics"], expected)
        names = {"RMSE": "rmse", "AWD": "average_wasserstein", "CD": "chamfer", "SCS": "spatial_consistency"}
        registration = {
            sequence: {variant: {names[k]: v for k, v in values.items()} for variant, values in variants.items()}
            for sequence, variants in golden["registration"].items()
        }
        self.assertEqual(paper["registration"], registration)

    def test_color_distances_and_fidelities_agree(self):
        """CF = -20 log10(CD / scale): to the last digit for MUN-FRL, but for three entries for MARS-LVIG."""
        paper = json.loads(PAPER.read_text())
        off = {}
        for sequence, methods in paper["metrics"]["color_distance"].items():
            for method, distance in methods.items():
                fidelity = -20 * np.log10(distance / paper["color_distance_scale"][sequence])
                error = abs(fidelity - paper["metrics"]["color_fidelity"][sequence][method])
                if error > 0.0125:
                    off[sequence, method] = error
        self.assertEqual(set(off), {("AMtown01", "SLAM3R"), ("AMvalley01", "Ours"), ("HKisland01", "V-Sim(3)")})
        self.assertLess(max(off.values()), 0.081)

    @unittest.skipUnless(GOLDEN.exists(), "no ../shared/golden/paper_tables.json")
    def test_typeset_tables_are_the_papers(self):
        """reproduce.sh without a single map: everything is missing, and the published tables read as printed."""
        golden = json.loads(GOLDEN.read_text())
        result = self.run_program(
            self.inputs,
            self.outputs / "board",
            program=[SOURCE / "benchmarks/leaderboard/reproduce.sh"],
            environment={"CMAP_LEADERBOARD": str(LEADERBOARD)},
        )
        self.assertEqual(result.returncode, DONE, result.stderr.decode())
        tables = {}
        for block in result.stdout.decode().split("\n\n"):
            lines = block.splitlines()
            if "published" in lines[0] and len(lines) > 2:
                tables[lines[0].split(" ↓")[0].split(" ↑")[0]] = [line.split() for line in lines[1:]]
        titles = {
            "multimappinggeo": {
                "CD": "Chamfer distance (CD#)",
                "AC": "accuracy <= 0.2 m (AC)",
                "Overlap": "overlap (Overlap)",
                "AWD": "average Wasserstein distance (AWD)",
                "Fitness": "fitness (precision) <= 0.2 m (COM)",
            },
            "multimappingcolor": {
                "CD": "color distance (CD)",
                "CF": "color fidelity (CF)",
                "CCS": "color consistency (CCS)",
                "LCR": "local color recall (LCR)",
            },
        }
        for table, symbols in titles.items():
            for symbol, title in symbols.items():
                head, *rows = tables[title]
                step = 2 if title == "color distance (CD)" else 1
                for row in rows:
                    cells = row[1::step]
                    for sequence, cell in zip(golden[table][symbol], cells, strict=True):
                        printed = golden[table][symbol][sequence][row[0]]
                        self.assertEqual(None if cell == "x" else float(cell.strip("*+?")), printed, (title, row))


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""Programs that are stopped, by a signal or by a full disk, leave nothing in the way, and nothing half-written.

CMAP_MOMENTS: at how many random moments each program is stopped by each signal (default 2).
"""

import json
import os
import random
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

PROGRAMS = {name: Path(os.environ[name.upper()]).resolve() for name in ("cmap_eval", "cmap_leaderboard")}
for name in ("cmap_render", "cmap_align", "cmap_compare"):
    if name.upper() in os.environ:
        PROGRAMS[name] = Path(os.environ[name.upper()]).resolve()
SOURCE = Path(os.environ["CMAP_SOURCE_DIR"]).resolve()
TOWN = SOURCE / "data_samples/town"
REFERENCE, ESTIMATE = TOWN / "reference.ply", TOWN / "estimate.ply"
MOMENTS = int(os.environ.get("CMAP_MOMENTS", "2"))
HAS_FIGURES = "cmap_render" in PROGRAMS
CODES = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGKILL: -9}
LINES = {signal.SIGINT: "interrupted", signal.SIGTERM: "terminated"}


def listing(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def without_run(content):
    """A report without its only part that differs between runs; others as they are."""
    return content.partition(b'\n  "run": {')[0]


class Interrupted(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="cmap-interrupted-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name) / "out"
        self.random = random.Random(15)

    def start(self, *command):
        self.folder.mkdir(exist_ok=True)
        program, *arguments = map(str, command)
        return subprocess.Popen(
            [PROGRAMS[program], *arguments], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
        )

    def run_whole(self, *command):
        """How long it takes, and what it writes."""
        shutil.rmtree(self.folder, ignore_errors=True)
        start = time.monotonic()
        process = self.start(*command)
        _, said = process.communicate(timeout=600)
        self.assertEqual(process.returncode, 0, said)
        return time.monotonic() - start, contents(self.folder)

    def stop_at_moments(self, command, check, outputs_before=None, quiet=True):
        """Stops the command at random moments; `check` looks at the folder, with whether the run was stopped."""
        duration, whole = self.run_whole(*command)
        stopped = 0
        for kind, code in CODES.items():
            for _ in range(MOMENTS):
                shutil.rmtree(self.folder, ignore_errors=True)
                self.folder.mkdir()
                if outputs_before:
                    outputs_before()
                start = time.monotonic()
                process = self.start(*command)
                try:
                    process.wait(self.random.random() * duration)
                    # The first run may have been the slow one, as files were cold.
                    duration = min(duration, time.monotonic() - start)
                except subprocess.TimeoutExpired:
                    process.send_signal(kind)
                _, said = process.communicate(timeout=600)
                self.wait_for_children(process)
                with self.subTest(command=command[0], signal=kind.name):
                    # While the system still loads the program, the signal ends it by itself: a shell sees the same code.
                    self.assertIn(process.returncode, (0, code, -kind), said)
                    if process.returncode > 0:
                        lines, line = said.splitlines(), f"{command[0]}: {LINES[kind]}"
                        # Another thread may end a line of progress between this one and the end.
                        self.assertEqual(lines.count(line), 1, said)
                        if quiet:
                            self.assertEqual(lines, [line])
                    stopped += process.returncode != 0
                    check(process.returncode != 0)
        self.assertGreater(stopped, 0, "some run was stopped while it worked")
        shutil.rmtree(self.folder)
        _, again = self.run_whole(*command)
        self.assertEqual(sorted(again), sorted(whole))
        return whole

    def wait_for_children(self, process):
        """What a killed program has started ends with it, a moment later."""
        for _ in range(500):
            if not self.children_of_killed():
                return
            time.sleep(0.02)
        self.fail("a child outlives its program")

    def children_of_killed(self):
        """Processes in the output folder: nobody else is there."""
        found = []
        for entry in Path("/proc").iterdir():
            try:
                if entry.name.isdigit() and os.readlink(entry / "cwd") == str(self.folder):
                    found.append(entry.name)
            except OSError:
                pass
        return found

    def eval_command(self):
        command = ["cmap_eval", REFERENCE, ESTIMATE, "--quiet", "-o", "report.json", "--html", "page.html"]
        command += ["--export-errors", "est.ply", "--export-reference-errors", "ref.ply"]
        return command + (["--figure", "figure.png"] if HAS_FIGURES else [])

    def test_eval_leaves_all_outputs_or_none(self):
        command = self.eval_command()
        n_outputs = 5 if HAS_FIGURES else 4

        def check(was_stopped):
            left = listing(self.folder)
            self.assertFalse([name for name in left if name.startswith(".")], "no temporary file")
            if not was_stopped:
                self.assertEqual(len(left), n_outputs)
            for name in left:
                self.assertIn(name, ("report.json", "page.html", "est.ply", "ref.ply", "figure.png"))
            if "report.json" in left:
                json.loads((self.folder / "report.json").read_text())

        self.stop_at_moments(command, check)

    def test_eval_replaces_outputs_whole_or_not_at_all(self):
        command = self.eval_command()
        _, whole = self.run_whole(*command)
        sizes = {name: len(content) for name, content in whole.items() if name.endswith((".ply", ".png"))}

        def old_outputs():
            for name in whole:
                (self.folder / name).write_text("old")

        def check(was_stopped):
            self.assertEqual(listing(self.folder), sorted(whole), "nothing else")
            for name, size in sizes.items():
                self.assertIn((self.folder / name).stat().st_size, (3, size), "old or new")

        self.stop_at_moments(command, check, old_outputs)

    @unittest.skipUnless(HAS_FIGURES, "built without figures")
    def test_render(self):
        picture = ["cmap_render", REFERENCE, ESTIMATE, "--quiet", "--size", "640x400", "-o", "figure.png"]
        turns = [["--turntable", "frames"]] + ([["--turntable", "turn.mp4"]] if shutil.which("ffmpeg") else [])
        for turn in turns:

            def check(was_stopped):
                left = listing(self.folder)
                self.assertFalse([name for name in left if name.startswith(".")], "no temporary file")
                if was_stopped and turn[1] == "frames" and "frames.partial" in left:
                    # Only where the program had no time to speak, and the next run replaces it.
                    command = [*picture[:-2], "--frames", "2", *turn]
                    process = self.start(*command)
                    _, said = process.communicate(timeout=600)
                    self.assertEqual(process.returncode, 0, said)
                    self.assertEqual(len(listing(self.folder / "frames")), 2)

            self.stop_at_moments([*picture, "--frames", "6", *turn], check)

    def test_leaderboard(self):
        board = {
            "version": 1,
            "sequences": [{"name": "town", "reference": "reference.ply"}],
            "methods": [{"name": n, "maps": {"town": f}} for n, f in (("Ours", "estimate.ply"), ("Truth", "reference.ply"))],
        }
        manifest = self.folder.parent / "manifest.json"
        manifest.write_text(json.dumps(board))
        command = ["cmap_leaderboard", manifest, "--data-root", TOWN, "-o", "board"]

        def check(was_stopped):
            temporary = [name for name in listing(self.folder) if Path(name).name.startswith(".")]
            self.assertEqual(temporary, [])
            for path in self.folder.rglob("*.json"):
                json.loads(path.read_text())

        self.stop_at_moments(command, check, quiet=False)

    def test_a_stopped_leaderboard_goes_on(self):
        board = {"version": 1, "sequences": [{"name": "town", "reference": "reference.ply"}]}
        board["methods"] = [{"name": "Ours", "maps": {"town": "estimate.ply"}}]
        manifest = self.folder.parent / "manifest.json"
        manifest.write_text(json.dumps(board))
        command = ["cmap_leaderboard", manifest, "--data-root", TOWN, "-o", "board"]
        duration, whole = self.run_whole(*command)
        shutil.rmtree(self.folder)
        for kind in CODES:
            process = self.start(*command)
            time.sleep(0.5 * duration)
            process.send_signal(kind)
            process.communicate(timeout=600)
        process = self.start(*command)
        _, said = process.communicate(timeout=600)
        self.assertEqual(process.returncode, 0, said)
        self.assertEqual(contents(self.folder), whole, "the same bytes")

    def test_a_pair_whose_process_is_stopped_says_so(self):
        manifest = self.folder.parent / "manifest.json"
        board = {"version": 1, "sequences": [{"name": "town", "reference": "reference.ply"}]}
        board["methods"] = [{"name": "Ours", "maps": {"town": "estimate.ply"}}]
        manifest.write_text(json.dumps(board))
        process = self.start("cmap_leaderboard", manifest, "--data-root", TOWN, "-o", "board")
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
        while process.poll() is None and not (child := children.read_text().split()):
            time.sleep(0.001)
        os.kill(int(child[0]), signal.SIGTERM)
        _, said = process.communicate(timeout=600)
        self.assertEqual(process.returncode, 0, said)
        self.assertIn("its evaluation was ended by signal 15", said)


class FullDisk(unittest.TestCase):
    """A small file system where this machine lets us have one, and the shell's limit everywhere."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="cmap-full-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_in(self, folder, *command, before=""):
        program, *arguments = map(str, command)
        return subprocess.run(
            ["sh", "-c", f'{before} exec "$@"', "sh", PROGRAMS[program], *arguments],
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=600,
        )

    def refused(self, result, program, *says):
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertTrue(result.stderr.startswith(f"{program}: "), result.stderr)
        for part in says:
            self.assertIn(part, result.stderr)

    def test_limit_of_the_shell(self):
        """ulimit -f: 100 blocks of 512 bytes hold the report, not the errors of 30,000 points."""
        outputs = ["-o", "report.json", "--export-errors", "errors.ply"]
        result = self.run_in(self.folder, "cmap_eval", REFERENCE, ESTIMATE, *outputs, before="ulimit -f 100;")
        self.refused(result, "cmap_eval", "errors.ply: cannot be written: File too large")
        self.assertEqual(listing(self.folder), [])

    def test_small_file_system(self):
        small = self.folder / "small"
        small.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256k", "none", small], capture_output=True)
        if mounted.returncode != 0:
            self.skipTest("no file system can be mounted here")
        self.addCleanup(subprocess.run, ["umount", small])
        (small / "report.json").write_text("old")
        outputs = ["-o", "report.json", "--export-errors", "errors.ply"]
        for program, arguments in [
            ("cmap_eval", [REFERENCE, ESTIMATE, *outputs]),
            ("cmap_align", [ESTIMATE, REFERENCE, "--voxel", "0.5", "-o", "T.txt", "--output-cloud", "moved.ply"]),
        ]:
            if program in PROGRAMS:
                result = self.run_in(small, program, *arguments)
                self.refused(result, program, ".ply: cannot be written: No space left on device")
                self.assertEqual(listing(small), ["report.json"])
        self.assertEqual((small / "report.json").read_text(), "old")
        if HAS_FIGURES:
            result = self.run_in(small, "cmap_render", REFERENCE, "-o", "a.png", "--size", "3000x2000", "--quiet")
            self.refused(result, "cmap_render", "a.png: cannot be written: No space left on device")
            result = self.run_in(small, "cmap_render", REFERENCE, "--turntable", "frames", "--frames", "40", "--quiet")
            self.refused(result, "cmap_render", "cannot be written: No space left on device")
            self.assertEqual(listing(small), ["report.json"])

    def test_standard_output(self):
        for command in (["cmap_eval", REFERENCE, ESTIMATE], ["cmap_eval", REFERENCE, ESTIMATE, "-o", "-"]):
            with open("/dev/full", "w") as full:
                program, *arguments = map(str, command)
                result = subprocess.run(
                    [PROGRAMS[program], *arguments], stdout=full, stderr=subprocess.PIPE, text=True, timeout=600
                )
            self.assertEqual(result.returncode, 2)
            self.assertRegex(result.stderr, "^cmap_eval: standard output: .*No space left on device\n$")


class ClosedPipe(unittest.TestCase):
    def test_whoever_stops_reading_has_read_enough(self):
        """As `| head -1` does: nothing on stderr, and the files are written."""
        with tempfile.TemporaryDirectory(prefix="cmap-pipe-") as folder:
            for arguments in (["-o", "report.json"], ["--format", "json", "-o", "report.json"], ["-o", "-"]):
                process = subprocess.Popen(
                    [PROGRAMS["cmap_eval"], REFERENCE, ESTIMATE, *arguments],
                    cwd=folder,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.PIPE,
                    text=True,
                )
                process.stdout.close()
                self.assertEqual(process.stderr.read(), "")
                process.stderr.close()
                self.assertEqual(process.wait(timeout=600), 0)
                if "report.json" in arguments:
                    json.loads((Path(folder) / "report.json").read_text())
                    (Path(folder) / "report.json").unlink()


if __name__ == "__main__":
    unittest.main()

"""What the tests of cmap_eval share: runs of the program, small maps, checks of reports and refusals.

CTest sets CMAP_EVAL (the program) and CMAP_SOURCE_DIR.
"""

import hashlib
import json
import os
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

try:
    import jsonschema
except ImportError:
    jsonschema = None
    print("no jsonschema: reports are not checked against the schema (apt-get install python3-jsonschema)")

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
    return {
        path: hashlib.sha256(path.read_bytes()).hexdigest()
        for path in folder.rglob("*")
        if path.is_file() and os.access(path, os.R_OK)
    }


class WithFolders(unittest.TestCase):
    """A folder of inputs and one of outputs."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="cmap-test-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.inputs, self.outputs = self.folder / "inputs", self.folder / "outputs"
        self.inputs.mkdir()
        self.outputs.mkdir()


class CmapEval(WithFolders):
    """Of inputs, which no run may change."""

    def setUp(self):
        super().setUp()
        self.reference = self.input("reference.ply", (MICRO / "two_points/reference.ply").read_bytes())
        self.estimate = self.input("estimate.ply", (MICRO / "two_points/estimate.ply").read_bytes())
        self.json = self.outputs / "report.json"
        self.errors = self.outputs / "errors.ply"

    def input(self, name, content):
        path = self.inputs / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    def run_program(self, *arguments, environment=None, program=(PROGRAM,), **options):
        """Runs the program to its end; nothing may take longer than two minutes."""
        before = hashes(self.inputs)
        options.setdefault("stdout", subprocess.PIPE)
        result = subprocess.run(
            [*map(os.fspath, program), *map(os.fspath, arguments)],
            stderr=subprocess.PIPE,
            timeout=600 if SANITIZED else 120,
            env={**os.environ, **(environment or {})},
            **options,
        )
        self.assertEqual(hashes(self.inputs), before, "inputs are never changed")
        return result

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
        outputs = [
            "-o",
            self.json,
            "--export-errors",
            self.errors,
            "--export-reference-errors",
            self.outputs / "reference.ply",
        ]
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

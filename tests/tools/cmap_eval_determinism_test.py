#!/usr/bin/env python3
"""The same inputs give the same bytes, whatever the threads and the instruction set."""

import hashlib
import unittest
from pathlib import Path

from cmap_eval_testing import DATA, SANITIZED, TOWN, DONE, USAGE, without_run, CmapEval


class Determinism(CmapEval):
    NEEDS = {
        "plain": set(),
        "sse2": {"sse2"},
        "avx2": {"avx2"},
        "avx512": {"avx512f", "avx512dq", "avx512bw", "avx512vl"},
    }

    def outputs_of(self, pair, arguments, level=None):
        """Everything a run writes, less the report's description of the run."""
        paths = [self.outputs / name for name in ("report.json", "estimate.ply", "reference.ply")]
        result = self.run_program(
            *pair,
            *arguments,
            "-o",
            paths[0],
            "--export-errors",
            paths[1],
            "--export-reference-errors",
            paths[2],
            environment={"CMAP_SIMD": level} if level else None,
        )
        self.assertEqual(result.returncode, DONE, result.stderr.decode())
        report = self.check_report(paths[0].read_text())
        if level:
            self.assertEqual(report["run"]["simd"], level)
        return without_run(paths[0].read_text()), *(hashlib.sha256(path.read_bytes()).hexdigest() for path in paths[1:])

    def expect_the_same_from_every_run(self, folder, *arguments):
        flags = next(
            (line.split() for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("flags")), []
        )
        pair = (folder / "reference.ply", folder / "estimate.ply")
        expected = self.outputs_of(pair, [*arguments, "--threads", "1"], "plain")
        for threads in (1, 2, 3):
            self.assertEqual(
                self.outputs_of(pair, [*arguments, "--threads", str(threads)]), expected, f"{threads} threads"
            )
        for level, needs in self.NEEDS.items():
            with self.subTest(level):
                if needs <= set(flags):
                    self.assertEqual(self.outputs_of(pair, arguments, level), expected)
                else:
                    result = self.run_program(*pair, environment={"CMAP_SIMD": level})
                    self.assertEqual(result.returncode, USAGE, "this processor lacks it")

    def test_town(self):
        self.expect_the_same_from_every_run(
            TOWN,
            "--metrics",
            "all",
            "--mme-radius",
            "0.6",
            "--lcr-curve",
            "--as",
            "color-map-evaluation,cloudanalyzer,mapeval,open3d,mpeg,cloudcompare",
        )

    def test_large_real_map(self):
        folder = DATA / "tum_fr1"
        if SANITIZED or not folder.is_dir():
            self.skipTest(f"{folder} is not there, or too slow with sanitizers")
        self.expect_the_same_from_every_run(folder, "--preset", "indoor", "--overlap-distance", "0.2")


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""Times whole runs of cmap_eval on the benchmark towns: wall and CPU seconds (median of the runs) and peak memory.

usage: evaluate_pairs.py CMAP_EVAL TOWNS [--runs N] [-- OPTION ...]
Every folder of TOWNS that holds reference.ply and estimate.ply is evaluated; options after -- go to cmap_eval.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import tempfile
import time


def run_once(program, folder, options):
    """Wall s, CPU s, peak memory in bytes and points of one run."""
    with tempfile.TemporaryDirectory() as scratch:
        report = os.path.join(scratch, "report.json")
        start = time.perf_counter()
        process = subprocess.Popen([program, folder / "reference.ply", folder / "estimate.ply", "-o", report, "--quiet", *options])
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - start
        if status != 0:
            raise SystemExit(f"{program} failed on {folder}")
        inputs = json.loads(pathlib.Path(report).read_text())["inputs"]
        points = inputs["reference"]["points"] + inputs["estimate"]["points"]
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024, points


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("towns", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("options", nargs="*")
    arguments = parser.parse_args()
    print(f"{'town':>12} {'points':>12} {'wall s':>8} {'CPU s':>8} {'bytes/point':>12}")
    for folder in sorted(f for f in arguments.towns.iterdir() if (f / "estimate.ply").exists()):
        runs = [run_once(arguments.program, folder, arguments.options) for _ in range(arguments.runs + 1)][1:]
        wall, cpu, memory, points = (statistics.median(column) for column in zip(*runs))
        print(f"{folder.name:>12} {points:12.0f} {wall:8.2f} {cpu:8.2f} {memory / points:12.1f}")


if __name__ == "__main__":
    main()

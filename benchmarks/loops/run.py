#!/usr/bin/env python3
"""Loops of a simulated drive of 3 km, over several towns and drifts, as the tables of README.md.

    benchmarks/loops/run.py build/release/benchmarks/loops/loops_town_benchmark OUT [--seeds 1 2 3]

Into OUT/SEED: result.json, loops.json, curve_METHOD.csv. A seed whose result is there is not run again.
"""
import argparse
import json
import subprocess
from pathlib import Path

METHODS = {
    "ring_submaps": "ours, submaps of 30 m",
    "ring_scans": "ours, single scans",
    "scan_context_submaps_lanes": "Scan Context, submaps, five lanes",
    "scan_context_submaps": "Scan Context, submaps",
    "scan_context_scans": "Scan Context, single scans",
}


def result_of(program, out, seed):
    path = out / str(seed) / "result.json"
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        done = subprocess.run([program, str(seed), str(path.parent)], check=True, capture_output=True, text=True)
        path.write_text(done.stdout)
    return json.loads(path.read_text())


def print_loops(results):
    print("| seed | path m | revisits | found | accepted | right | end to start before, after m | RMS before, after m | took |")
    print("|---|---|---|---|---|---|---|---|---|")
    for r in results:
        loops, before, after = r["loops"], r["odometry"], r["closed"]
        print(f"| {r['seed']} | {r['path_m']:.0f} | {loops['revisits']} | {loops['found']} ({loops['recall']:.0%}) | "
              f"{loops['accepted']} | {loops['right']} ({loops['precision']:.0%}), worst {loops['worst_loop_error_m']:.2f} m | "
              f"{before['end_to_start_m']:.2f}, {after['end_to_start_m']:.3f} | {before['rms_m']:.2f}, {after['rms_m']:.2f} | "
              f"{r['loops_s']:.0f} s |")


def print_descriptors(results):
    print("\n| descriptor alone | recall at 100 % precision | best F1 | area |")
    print("|---|---|---|---|")
    for key, name in METHODS.items():
        values = [r["descriptors"][key] for r in results]
        columns = [" ".join(f"{v[field]:.2f}" for v in values) for field in ("recall_at_full_precision", "best_f1", "area")]
        print(f"| {name} | {' | '.join(columns)} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    args = parser.parse_args()
    results = [result_of(args.program.resolve(), args.out, seed) for seed in args.seeds]
    print_loops(results)
    print_descriptors(results)


main()

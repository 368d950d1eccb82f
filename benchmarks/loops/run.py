#!/usr/bin/env python3
"""Loops of a simulated drive of 3 km, over several towns and drifts, as the tables of README.md.

    benchmarks/loops/run.py build/release/benchmarks/loops/loops_town_benchmark OUT [--seeds 1 2 3]

Into OUT/SEED: result.json, loops.json, curve_METHOD.csv; into OUT: curves.svg. A seed whose result is there is not run again.
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


def print_precision(out, seeds):
    """Precision where a recall is reached, the mean of the seeds."""
    recalls = (0.1, 0.25, 0.5, 0.75, 0.9, 1.0)
    print("\n| precision at recall | " + " | ".join(f"{r:.0%}" for r in recalls) + " |")
    print("|---|" + "---|" * len(recalls))
    for key, name in METHODS.items():
        found = [[max((p for p, r in curve_of(out, seed, key) if r >= recall - 1e-9), default=None) for seed in seeds]
                 for recall in recalls]
        cells = ["-" if None in values else f"{sum(values) / len(values):.2f}" for values in found]
        print(f"| {name} | {' | '.join(cells)} |")


def curve_of(out, seed, key):
    """(precision, recall) by falling threshold."""
    rows = (out / str(seed) / f"curve_{key}.csv").read_text().splitlines()[1:]
    return [tuple(map(float, row.split(",")[1:])) for row in rows]


def write_svg(out, seeds):
    """Precision over recall, a line a method and seed."""
    colors = ("#1b6ca8", "#8fbbd9", "#c0392b", "#e59866", "#b0b0b0")
    lines = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 640 300" font-family="sans-serif" font-size="12">',
             '<rect width="640" height="300" fill="white"/><path d="M50 20V250H350" fill="none" stroke="black"/>',
             '<text x="150" y="285">recall 0 to 1</text><text x="12" y="25">1</text><text x="12" y="255">0</text>',
             '<text transform="translate(30 180) rotate(-90)">precision</text>']
    for i, (key, name) in enumerate(METHODS.items()):
        for seed in seeds:
            points = " ".join(f"{50 + 300 * r:.1f},{250 - 230 * p:.1f}" for p, r in curve_of(out, seed, key))
            lines.append(f'<polyline points="{points}" fill="none" stroke="{colors[i]}" stroke-width="1.5"/>')
        lines.append(f'<text x="375" y="{60 + 22 * i}" fill="{colors[i]}">{name}</text>')
    (out / "curves.svg").write_text("\n".join([*lines, "</svg>", ""]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    args = parser.parse_args()
    results = [result_of(args.program.resolve(), args.out, seed) for seed in args.seeds]
    print_loops(results)
    print_descriptors(results)
    print_precision(args.out, args.seeds)
    write_svg(args.out, args.seeds)


main()

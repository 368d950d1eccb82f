#!/usr/bin/env python3
"""What each number sees: planted defects of growing size on exact estimates of two simulated scenes, and how every metric moves.

Writes OUT/table.md (which metric moves from which size on, and which the wrong way) and, of each scene, OUT/SCENE.csv (every value and
skill) and OUT/SCENE.svg. Reports are kept in OUT, so that a run that was stopped goes on where it was.
"""
import argparse
import csv
import hashlib
import itertools
import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

import defects
import figure
import judgment
import scenes

HERE = Path(__file__).resolve().parent
EXACT = ("exact", 0)


def cases(scene, quick):
    """The exact estimate, then every defect in every size; quick: the smallest and the largest."""
    yield EXACT
    for name, defect in defects.planted(scene).items():
        yield from ((name, size) for size in (defect.sizes[::len(defect.sizes) - 1] if quick else defect.sizes))


def damaged(scene, seed, case, estimate):
    """The estimate with one defect, always the same for a seed."""
    name, size = case
    if case == EXACT:
        return estimate
    planted = defects.planted(scene)
    rng = np.random.default_rng([seed, 3, list(planted).index(name), int(1000 * size)])
    return planted[name].make(*estimate, size, rng)


def arguments(scene):
    """Of the two evaluations of a pair: with the parameters of its scale, and color recall and consistency with the paper's."""
    own = scenes.SCENES[scene]
    return {"scale": ["--preset", own.preset, "--metrics", "all"], "paper": ["--metrics", "local_color_recall,color_consistency"]}


def evaluate(program, reference, estimate, options, report):
    """Metrics of a pair from the program's report, which is kept."""
    if not report.exists():
        partial = report.with_suffix(".partial")
        command = [program, reference, estimate, *options, "--threads", "1", "--quiet", "-o", partial]
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
        if done.returncode:
            raise RuntimeError("%s: %s" % (estimate.name, done.stderr.strip()))
        partial.rename(report)
    return json.loads(report.read_text())["metrics"]


def measure_seed(args, folder, scene, seed):
    """Metrics of every case of one sampling: case -> evaluation -> metrics."""
    sample = [scenes.sample(scene, seed, what, args.share) for what in (1, 2)]
    reference = folder / ("%s-%d.ply" % (scene, seed))
    scenes.write(reference, *sample[0])
    measured = {}
    for case in cases(scene, args.quick):
        name = "%s-%d-%s-%g" % (scene, seed, *case)
        reports = {run: folder / ("%s-%s.json" % (name, run)) for run in arguments(scene)}
        estimate = folder / (name + ".ply")
        if not all(report.exists() for report in reports.values()):
            scenes.write(estimate, *damaged(scene, seed, case, sample[1]))
        measured[case] = {run: evaluate(args.cmap_eval, reference, estimate, options, reports[run])
                          for run, options in arguments(scene).items()}
        estimate.unlink(missing_ok=True)
    return measured


def report_folder(args):
    """Of this program, these scenes and defects: what others have made is not taken."""
    parts = [args.cmap_eval.read_bytes(), *((HERE / name).read_bytes() for name in ("scenes.py", "defects.py", "neighbors.py"))]
    parts.append(json.dumps([arguments(scene) for scene in scenes.SCENES] + [args.share]).encode())
    folder = args.output / "reports" / hashlib.sha256(b"".join(parts)).hexdigest()[:12]
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def measure(args):
    """scene -> seed -> case -> evaluation -> metrics."""
    folder = report_folder(args)
    asked = list(itertools.product(args.scenes, args.seeds))
    with ThreadPoolExecutor(args.jobs) as pool:
        done = list(pool.map(lambda one: measure_seed(args, folder, *one), asked))
    return {scene: {seed: done[asked.index((scene, seed))] for seed in args.seeds} for scene in args.scenes}


def write_values(path, scene, seeds):
    """A line for each case: the mean over the seeds of every number shown, empty where one of them has none."""
    with open(path, "w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(["defect", "size"] + [row.title for row in judgment.rows(scene)])
        for case in next(iter(seeds.values())):
            values = [[row.value(measured[case]) for measured in seeds.values()] for row in judgment.rows(scene)]
            writer.writerow([case[0], "%g" % case[1]] + ["" if None in known else "%.5g" % np.mean(known) for known in values])


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cmap_eval", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--scenes", nargs="+", choices=list(scenes.SCENES), default=list(scenes.SCENES))
    parser.add_argument("--seeds", nargs="+", type=int, default=[1, 2, 3])
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--quick", action="store_true", help="smallest and largest sizes of two samplings with fewer points")
    args = parser.parse_args()
    args.share = 0.4 if args.quick else 1.0
    args.seeds = args.seeds[:2] if args.quick else args.seeds
    return args


def main():
    args = parse()
    measured = measure(args)
    tables = []
    for scene, seeds in measured.items():
        write_values(args.output / (scene + ".csv"), scene, seeds)
        found = judgment.judge(scene, seeds)
        (args.output / (scene + ".svg")).write_text(figure.draw(scene, found))
        tables += ["### %s" % scene.capitalize(), "", judgment.markdown(scene, found), ""]
    (args.output / "table.md").write_text("\n".join(tables))
    print("\n".join(tables))
    return 0


if __name__ == "__main__":
    sys.exit(main())

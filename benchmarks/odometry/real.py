#!/usr/bin/env python3
"""Odometry on recorded drives beside its peers: real.py --help. Needs numpy and scipy.

kitti_0009 has truth; kit_muehlburgertor has none, but the car stands at first and surfaces show how well scans are
straightened. README.md has a table made by it."""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

import deskewing
import kit_capture
from scans import Scans
from simulated import cpu_ms, odometry
from trajectories import Comparison, Trajectory

LENGTHS_M = [10, 15, 20, 25, 30, 35, 40]
# rko-lio starts at rest, and is judged from where it has found its speed.
PEERS = {"kiss-icp": 0, "kiss-icp-raw": 0, "rko-lio": 8}


def kitti_capture(data, folder):
    """kitti_0009 with the IMU at its full rate."""
    capture = folder / "kitti_0009"
    if not capture.exists():
        capture.mkdir(parents=True)
        for entry in (data / "kitti_0009").iterdir():
            if entry.name not in ("imu.csv", "imu_100hz.csv", "lio.tum"):
                os.symlink(entry, capture / entry.name)
        os.symlink(data / "kitti_0009" / "imu_100hz.csv", capture / "imu.csv")
    return capture


def kit_muehlburgertor(data, folder):
    capture = folder / "kit_muehlburgertor"
    if not capture.exists():
        kit_capture.main(data / "kit_muehlburgertor", capture)
    return capture


def errors(trajectory, truth, skip):
    comparison = Comparison(trajectory, truth, skip)
    relative, turn = comparison.relative_error(LENGTHS_M)
    end, end_deg = comparison.end_to_end()
    return {"relative_percent": relative, "relative_deg_per_m": turn, "end_percent": end, "end_deg": end_deg}


def ours(args, capture, with_imu):
    """Runs cmap_lio; its trajectory at scan ends, the one within scans, and CPU."""
    output = args.output / f"{capture.name}_{'imu' if with_imu else 'no_imu'}"
    more = ["--preset", "velodyne64", *([] if with_imu else ["--no-imu"])]
    health = odometry([args.programs / "cmap_lio"], capture, output, more)
    inner = Trajectory.read(output / ("trajectory_imu.tum" if with_imu else "trajectory.tum"))
    return Trajectory.read(output / "trajectory.tum"), inner, cpu_ms(health)


def peer(args, name, capture):
    """Runs it in its environment."""
    output = args.output / f"{capture.name}_{name}.tum"
    here = Path(__file__).resolve().parent
    done = subprocess.run([args.peers / "bin" / "python", here / "peers.py", name, capture, output], check=True,
                          stdout=subprocess.PIPE, text=True)
    said = next(line for line in done.stdout.splitlines() if line.startswith("{"))  # rko-lio adds times of its own
    return Trajectory.read(output), json.loads(said)["cpu_ms"]


def median_run(args, run):
    """The trajectory of the first run (they are all the same) and the median of the CPU times."""
    runs = [run() for _ in range(args.runs)]
    return (*runs[0][:-1], float(np.median([r[-1] for r in runs])))


def facing_cm(scans, inner):
    distances = deskewing.facing_distances_m(scans, inner)
    return 100.0 * float(np.median(distances)) if len(distances) else float("nan")


def kitti(args):
    capture = kitti_capture(args.data, args.output)
    scans, truth = Scans(capture), Trajectory.read(args.data / "kitti_0009" / "lio.tum")
    results = {}
    for with_imu in (True, False):
        ends, inner, cpu = median_run(args, lambda: ours(args, capture, with_imu))
        name = "cmap_lio" + ("" if with_imu else " --no-imu")
        results[name] = {**errors(ends, truth, 0), "facing_cm": facing_cm(scans, inner), "cpu_ms": cpu}
        results[name + " from the ninth"] = errors(ends, truth, 8)
    for name, skip in PEERS.items() if args.peers else ():
        ends, cpu = median_run(args, lambda: peer(args, name, capture))
        results[name] = {**errors(ends, truth, skip), "cpu_ms": cpu}
    for mode in ("without", "with"):
        results[f"truth, {mode} deskewing"] = {
            "facing_cm": 100.0 * float(np.median(deskewing.facing_distances_m(scans, truth, mode)))}
    return results


def wander_cm(trajectory, n):
    """How far poses of the first n scans are from their mean: the farthest."""
    positions = trajectory.positions[:n]
    return 100.0 * float(np.linalg.norm(positions - positions.mean(0), axis=1).max())


def alternation(trajectory, n):
    """Of the first n scans' steps: -0.5 if poses are off at random, -1 if every second one is off the other way."""
    steps = np.diff(trajectory.positions[:n], axis=0)
    return float((steps[:-1] * steps[1:]).sum() / (steps * steps).sum())


def standing(trajectory, n):
    return {"wander_cm": wander_cm(trajectory, n), "alternation": alternation(trajectory, n)}


def kit(args):
    capture = kit_muehlburgertor(args.data, args.output)
    scans = Scans(capture)
    ends, inner, cpu = median_run(args, lambda: ours(args, capture, False))
    facing = facing_cm(scans, inner)
    results = {"cmap_lio --no-imu": {"facing_cm": facing, **standing(ends, args.standing), "cpu_ms": cpu}}
    for mode in ("without", "reversed"):
        distances = deskewing.facing_distances_m(scans, inner, mode)
        results[f"the same, {mode}"] = {"facing_cm": 100.0 * float(np.median(distances))}
    for name in ("kiss-icp", "kiss-icp-raw") if args.peers else ():
        peer_ends, cpu = median_run(args, lambda: peer(args, name, capture))
        results[name] = {"facing_cm": facing_cm(scans, peer_ends), **standing(peer_ends, args.standing), "cpu_ms": cpu}
    return results


def show(title, results):
    columns = ["relative_percent", "end_percent", "end_deg", "facing_cm", "wander_cm", "alternation", "cpu_ms"]
    print(f"\n{title}\n\n| | " + " | ".join(columns) + " |\n|---" + "|---" * len(columns) + "|")
    for name, values in results.items():
        cells = [f"{values[c]:.3g}" if c in values else "" for c in columns]
        print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


def arguments():
    parser = argparse.ArgumentParser(description="cmap_lio and its peers on kitti_0009 and kit_muehlburgertor.")
    parser.add_argument("--programs", type=Path, required=True, help="folder of cmap_lio")
    parser.add_argument("--data", type=Path, required=True, help="folder with kitti_0009 and kit_muehlburgertor")
    parser.add_argument("--output", type=Path, required=True, help="folder for captures, trajectories, results.json")
    parser.add_argument("--peers", type=Path, help="environment of make_environment.sh; none: cmap_lio alone")
    parser.add_argument("--runs", type=int, default=3, help="of which the median CPU time counts")
    parser.add_argument("--standing", type=int, default=26, help="scans of kit_muehlburgertor before the car moves")
    args = parser.parse_args()
    for name in ("programs", "data", "output", "peers"):
        if getattr(args, name):
            setattr(args, name, getattr(args, name).resolve())
    return args


def main():
    args = arguments()
    args.output.mkdir(parents=True, exist_ok=True)
    results = {}
    for title, make in (("kitti_0009", kitti), ("kit_muehlburgertor", kit)):
        if not (args.data / title).exists():
            print(f"{title}: not there, skipped")
            continue
        results[title] = make(args)
        show(title, results[title])
    (args.output / "results.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    sys.exit(main())

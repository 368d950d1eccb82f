#!/usr/bin/env python3
"""Odometry on simulated ways of 500 m against the truth: simulated.py --help. Needs numpy and scipy."""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import numpy as np

import deskewing
from scans import Scans
from simulated_captures import SENSORS, WAYS, make_capture
from trajectories import Comparison, Trajectory

LENGTHS_M = [50, 100, 150, 200, 250, 300, 350, 400]
PRESETS = {"spinning_32": "velodyne32", "avia": "avia", "mid360": "mid360"}
# Lines of the spinning sensor lie 2 m apart on the ground 80 m below.
ALOFT = {"spinning_32": ["--preset", "aerial", "--set", "voxel_m=4"]}
HEAD = ("sensor", "way", "seed", "imu", "length m", "end %", "relative %", "attitude deg", "end deg", "deskew cm",
        "95 % cm", "ms a scan")


def odometry(program, capture, output, more):
    """Its files, and CPU seconds a scan."""
    command = [*program, str(capture), "--output", str(output), "--quiet", "--no-loops", *more]
    subprocess.run(command, check=True)
    health = json.loads((output / "health.json").read_text())
    return health


def cpu_ms(health):
    return 1e3 * float(np.median([scan["cpu_s"] for scan in health["scans"]]))


def measured(capture, output, health):
    truth = Trajectory.read(capture / "truth" / "trajectory.tum")
    comparison = Comparison(Trajectory.read(output / "trajectory.tum"), truth)
    errors = deskewing.errors_m(Scans(capture), Trajectory.read(output / "trajectory_imu.tum"), truth)
    end, end_deg = comparison.end_to_end()
    return {
        "length_m": comparison.length_m, "end_percent": end, "end_deg": end_deg,
        "relative_percent": comparison.relative_error(LENGTHS_M)[0],
        "attitude_deg": float(comparison.attitude_deg().max()),
        "deskew_median_cm": 100.0 * float(np.median(errors)),
        "deskew_p95_cm": 100.0 * float(np.percentile(errors, 95)), "cpu_ms": cpu_ms(health),
    }


def row(sensor, way, seed, with_imu, m):
    cells = [sensor, way, str(seed), "yes" if with_imu else "no", f"{m['length_m']:.0f}"]
    cells += [f"{m[name]:.3f}" for name in ("end_percent", "relative_percent")]
    cells += [f"{m[name]:.2f}" for name in ("attitude_deg", "end_deg", "deskew_median_cm", "deskew_p95_cm")]
    return "| " + " | ".join([*cells, f"{m['cpu_ms']:.1f}"]) + " |"


def arguments():
    parser = argparse.ArgumentParser(description="Makes captures with cmap_simulate, runs cmap_lio, compares.")
    parser.add_argument("--programs", type=Path, required=True, help="folder of cmap_simulate and cmap_lio")
    parser.add_argument("--captures", type=Path, required=True, help="folder for captures, made if need be")
    parser.add_argument("--output", type=Path, required=True, help="folder for trajectories and results.json")
    parser.add_argument("--sensors", nargs="+", default=list(SENSORS), choices=list(SENSORS))
    parser.add_argument("--ways", nargs="+", default=list(WAYS), choices=list(WAYS))
    parser.add_argument("--seeds", nargs="+", type=int, default=[1])
    parser.add_argument("--no-imu", action="store_true")
    parser.add_argument("--set", action="append", default=[], help="option of cmap_lio, as there")
    return parser.parse_args()


def main():
    args = arguments()
    print("| " + " | ".join(HEAD) + " |\n" + "|---" * len(HEAD) + "|", flush=True)
    results = []
    for seed in args.seeds:
        for way in args.ways:
            for sensor in args.sensors:
                capture = make_capture(args.programs / "cmap_simulate", args.captures, sensor, way, seed)
                output = args.output / (capture.name + ("_no_imu" if args.no_imu else ""))
                more = ["--preset", PRESETS[sensor]]
                if way == "aerial":
                    more = ALOFT.get(sensor, ["--preset", "aerial"])
                more = [*more, *(["--no-imu"] if args.no_imu else [])]
                for setting in args.set:
                    more += ["--set", setting]
                health = odometry([args.programs / "cmap_lio"], capture, output, more)
                m = measured(capture, output, health)
                results.append({"sensor": sensor, "way": way, "seed": seed, "imu": not args.no_imu, **m})
                print(row(sensor, way, seed, not args.no_imu, m), flush=True)
    (args.output / "results.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""What each stage of cmap_recon is worth: every variant of it on simulated captures with exact truth, and on one of your own.

The columns are those of the paper's Table IV (RMSE, AWD, Chamfer, SCS), of the sessions and of the whole map against the truth, with the
true error of the scales and of the trajectory. What is done is kept in OUT/results, so that a run that was stopped goes on where it was.
"""
import argparse
import bisect
import csv
import hashlib
import json
import math
import shutil
import statistics
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

# Arguments of cmap_recon. The first four are the rows of Table IV; the others take one thing out of the last of them.
VARIANTS = {
    "prefusion": ["--registration", "prefusion"],
    "normal": ["--registration", "normal"],
    "paper": ["--registration", "paper"],
    "robust": ["--registration", "robust"],
    "all as printed": ["--preset", "paper"],
    "no pose graph": ["--set", "pose_graph=false"],
    "no LiDAR priors": ["--set", "lidar_priors=false"],
    "rotation paper": ["--set", "rotation=paper"],
    "voting paper": ["--set", "voting=paper"],
}


@dataclass
class Scene:
    """Options of cmap_simulate, the scale at which its maps are compared, and arguments of cmap_recon that its size asks for."""
    preset: str
    small: list
    full: list = field(default_factory=list)
    awd_voxel_m: float = 3.0
    recon: list = field(default_factory=list)


# The small captures have about 30 images and sessions of very different units. In the town the camera sees 100 m far, the LiDAR 40 m:
# where the fields of view differ, matching alone shrinks the larger cloud. Session 1 of town_outlier has a stretched path; the camera of
# town_misstated is not where the calibration says, and its stamps are 50 ms off.
# indoor_default is indoor with cmap_recon's registration_voxel_m of 0.2 m, a tenth of the corridor.
FAR_CAMERA = ["lidar.max_range_m=40", "lidar.half_detection_range_m=30", "predictions.max_depth_m=100", "truth.map_max_distance_m=100"]
SESSIONS = ["predictions.session_length=8", "predictions.session_overlap=3", "predictions.unit_factor=3"]
OUTLIER = ["predictions.outlier_sessions=[1]"]
MISSTATED = ["stated.camera_rotation_error_deg=[0,2,0]", "stated.image_time_error_s=0.05"]
SMALL_TOWN = SESSIONS + FAR_CAMERA + ["route.length_m=56"]
SMALL_INDOOR = SESSIONS + ["route.length_m=14", "truth.map_points_per_m2=200"]
SCENES = {
    "town": Scene("town", SMALL_TOWN, FAR_CAMERA),
    "town_outlier": Scene("town", SMALL_TOWN + OUTLIER, FAR_CAMERA + OUTLIER),
    "town_misstated": Scene("town", SMALL_TOWN + MISSTATED, FAR_CAMERA + MISSTATED),
    "indoor": Scene("indoor", SMALL_INDOOR, awd_voxel_m=1.0, recon=["--set", "registration_voxel_m=0.05"]),
    "indoor_default": Scene("indoor", SMALL_INDOOR, awd_voxel_m=1.0),
    "aerial": Scene("aerial", SESSIONS + ["route.length_m=150", "truth.map_points_per_m2=8"], awd_voxel_m=5.0,
                    recon=["--set", "registration_voxel_m=0.5"]),
}

# Column, unit, digits; lower is better unless the name ends in @0.2.
COLUMNS = {
    "scale_error_max": ("scale error, max", "%", 2),
    "scale_error_median": ("median", "%", 2),
    "rmse": ("RMSE", "m", 3),
    "session_average_wasserstein": ("AWD of sessions", "m", 3),
    "session_distance": ("distance of sessions", "m", 3),
    "session_spatial_consistency": ("SCS of sessions", "1", 3),
    "average_wasserstein": ("AWD", "m", 3),
    "chamfer": ("Chamfer", "m", 3),
    "spatial_consistency": ("SCS", "1", 3),
    "fitness@0.2": ("fitness@0.2", "%", 1),
    "completeness@0.2": ("completeness@0.2", "%", 1),
    "trajectory_rmse": ("trajectory", "m", 3),
}


@dataclass
class Capture:
    """A folder with truth/, made if `simulate` says how, and how its maps are compared."""
    name: str
    group: str
    folder: Path
    awd_voxel_m: float
    recon: list
    simulate: list = field(default_factory=list)


def captures(args):
    """The simulated captures of the chosen scenes and seeds, then the given ones."""
    for name in args.scenes:
        scene = SCENES[name]
        settings = scene.full if args.full else scene.small
        for seed in args.seeds:
            arguments = [scene.preset if args.full else "small_" + scene.preset, "--seed", str(seed)]
            for setting in settings + ["scene.seed=%d" % seed]:
                arguments += ["--set", setting]
            label = "%s%s-%d" % (name, "-full" if args.full else "", seed)
            yield Capture(label, name, args.output / "captures" / label, scene.awd_voxel_m, scene.recon, arguments)
    for folder in args.capture:
        yield Capture(folder.resolve().name, folder.resolve().name, folder, 3.0, [])


def run(command):
    """Runs a program; a failure ends the benchmark with the program's own last line."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if done.returncode:
        reason = (done.stderr.strip().splitlines() or ["no message"])[-1]
        raise RuntimeError("%s: exit code %d: %s" % (Path(command[0]).name, done.returncode, reason))


def simulate(capture, tools):
    """Makes the capture unless it is there as asked for."""
    if not capture.simulate:
        return
    made = capture.folder.with_name(capture.folder.name + ".json")
    asked = json.dumps({"arguments": capture.simulate, "program": sha256(tools / "cmap_simulate")})
    if capture.folder.is_dir() and made.exists() and made.read_text() == asked:
        return
    made.unlink(missing_ok=True)
    for folder in (capture.folder, capture.folder.with_name(capture.folder.name + ".partial")):  # the second of a run that was killed
        shutil.rmtree(folder, ignore_errors=True)
    capture.folder.parent.mkdir(parents=True, exist_ok=True)
    run([tools / "cmap_simulate", *capture.simulate, "-o", capture.folder, "--quiet"])
    made.write_text(asked)


def sha256(path):
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


def scale_errors(capture_folder, map_folder):
    """|scale / truth - 1| of every session that has both, in percent."""
    truth = json.loads((capture_folder / "truth/scales.json").read_text())["scales"]
    sessions = json.loads((map_folder / "sessions.json").read_text())["sessions"]
    return [100 * abs(s["scale"] / truth[s["name"]] - 1) for s in sessions if not s["dropped"] and s["name"] in truth]


def read_tum(path):
    rows = [[float(word) for word in line.split()[:4]] for line in Path(path).read_text().splitlines() if line and line[0] != "#"]
    return [row[0] for row in rows], [row[1:] for row in rows]


def trajectory_rmse_m(truth_path, estimate_path):
    """Of positions in the world, not aligned, with the truth interpolated to the estimate's times."""
    times, places = read_tum(truth_path)
    squares = []
    for time, place in zip(*read_tum(estimate_path)):
        after = bisect.bisect_left(times, time)
        if after == len(times) or (after == 0 and times[0] != time):
            continue  # no truth there
        before = max(after - 1, 0)
        share = (time - times[before]) / (times[after] - times[before]) if after > before else 0.0
        truth = [a + share * (b - a) for a, b in zip(places[before], places[after])]
        squares.append(math.dist(place, truth) ** 2)
    return math.sqrt(statistics.fmean(squares)) if squares else None


def evaluate(capture, map_path, tools):
    """The metrics of one map against the truth, from cmap_eval's report."""
    report_path = map_path.with_suffix(".evaluation.json")
    run([tools / "cmap_eval", capture.folder / "truth/map.ply", map_path, "--metrics", "geometry,distribution",
         "--thresholds", "0.2", "--awd-voxel", capture.awd_voxel_m, "-o", report_path, "--quiet"])
    return json.loads(report_path.read_text())["metrics"]


def map_metrics(capture, map_folder, tools):
    metrics = evaluate(capture, map_folder / "map.ply", tools)
    values = {name: metrics[name]["value"] for name in ("average_wasserstein", "chamfer", "spatial_consistency")}
    values.update({name + "@0.2": 100 * metrics[name]["per_threshold"][0]["value"] for name in ("fitness", "completeness")})
    values["awd_voxels"] = metrics["average_wasserstein"]["n_voxels"]
    return values


def session_metrics(capture, map_folder, tools):
    """Means over the sessions' own maps. Of the Chamfer distance only the way to the truth, which holds more than a session saw."""
    sessions = [evaluate(capture, path, tools) for path in sorted((map_folder / "sessions").glob("*.ply"))]

    def mean(values):
        known = [v for v in values if v is not None]
        return statistics.fmean(known) if known else None

    return {"session_average_wasserstein": mean(m["average_wasserstein"]["value"] for m in sessions),
            "session_distance": mean(m["chamfer"]["estimate_to_reference"] for m in sessions),
            "session_spatial_consistency": mean(m["spatial_consistency"]["value"] for m in sessions)}


def measure(capture, map_folder, tools):
    """The row of one map: COLUMNS, and what explains them."""
    sessions = json.loads((map_folder / "sessions.json").read_text())["sessions"]
    errors = scale_errors(capture.folder, map_folder)
    rmses = [s["rmse_m"] for s in sessions if not s["dropped"] and s["rmse_m"] is not None]
    return {"scale_error_max": max(errors, default=None), "scale_error_median": statistics.median(errors) if errors else None,
            "rmse": statistics.fmean(rmses) if rmses else None, **session_metrics(capture, map_folder, tools),
            **map_metrics(capture, map_folder, tools),
            "trajectory_rmse": trajectory_rmse_m(capture.folder / "truth/trajectory.tum", map_folder / "trajectory.tum"),
            "sessions": sessions}


def result_of(capture, variant, args):
    """From OUT/results, or computed and kept there. A run that fails is a row with its reason."""
    path = args.output / "results" / capture.name / (variant.replace(" ", "_") + ".json")
    arguments = capture.recon + VARIANTS[variant]
    key = {"recon": arguments, "awd_voxel_m": capture.awd_voxel_m, "capture": capture.simulate or str(capture.folder.resolve()),
           "programs": args.programs}
    if path.exists() and (kept := json.loads(path.read_text()))["key"] == key:
        return kept
    simulate(capture, args.tools)
    map_folder = args.output / "maps" / capture.name / variant.replace(" ", "_")
    shutil.rmtree(map_folder, ignore_errors=True)
    try:
        run([args.tools / "cmap_recon", capture.folder, "-o", map_folder, *arguments, "--session-maps", "--quiet"])
        result = {"key": key, "values": measure(capture, map_folder, args.tools)}
    except RuntimeError as error:
        result = {"key": key, "failed": str(error)}
    if not args.keep_maps:
        shutil.rmtree(map_folder, ignore_errors=True)
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_suffix(".partial")
    partial.write_text(json.dumps(result, indent=1))
    partial.rename(path)
    return result


def mean_row(results):
    """Means over the captures of a scene that did not fail, and how many did."""
    values = [r["values"] for r in results if "values" in r]
    row = {}
    for name in COLUMNS:
        known = [v[name] for v in values if v[name] is not None]
        row[name] = statistics.fmean(known) if known else None
    return row, len(results) - len(values)


def markdown(table):
    """One table per scene."""
    lines = []
    for group, rows in table.items():
        count = len(next(iter(rows.values())))
        lines += ["### %s%s" % (group, ", mean of %d seeds" % count if count > 1 else ""), ""]
        lines.append("| variant | " + " | ".join("%s [%s]" % (title, unit) for title, unit, _ in COLUMNS.values()) + " |")
        lines.append("|---" * (len(COLUMNS) + 1) + "|")
        for variant, results in rows.items():
            row, failed = mean_row(results)
            cells = ["–" if row[name] is None else "%.*f" % (digits, row[name]) for name, (_, _, digits) in COLUMNS.items()]
            lines.append("| %s%s | %s |" % (variant, " (%d failed)" % failed if failed else "", " | ".join(cells)))
        lines.append("")
    return "\n".join(lines)


def write_csv(path, rows):
    """One row per capture and variant."""
    with open(path, "w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(["capture", "variant", *COLUMNS, "failed"])
        for capture, variant, result in rows:
            values = result.get("values", {})
            writer.writerow([capture, variant, *(values.get(name) for name in COLUMNS), result.get("failed", "")])


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tools", type=Path, required=True, metavar="BUILD/tools", help="folder of cmap_simulate, cmap_recon, cmap_eval")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="OUT", help="captures, results, ablation.md, ablation.csv")
    parser.add_argument("--scenes", nargs="*", choices=SCENES, default=list(SCENES), help="simulated scenes [all]; --scenes alone: none")
    parser.add_argument("--seeds", nargs="+", type=int, default=[1, 2, 3], help="of scene and noise [1 2 3]")
    parser.add_argument("--variants", nargs="+", choices=VARIANTS, default=list(VARIANTS), help="[all]")
    parser.add_argument("--full", action="store_true", help="the full presets, hours, in place of the small ones, minutes")
    parser.add_argument("--capture", nargs="+", type=Path, default=[], metavar="DIR", help="captures with truth/ of your own")
    parser.add_argument("--keep-maps", action="store_true", help="in OUT/maps")
    args = parser.parse_args()
    for name in ("cmap_simulate", "cmap_recon", "cmap_eval"):
        if not (args.tools / name).is_file():
            parser.error("no program %s" % (args.tools / name))
    args.programs = {name: sha256(args.tools / name) for name in ("cmap_recon", "cmap_eval", "cmap_simulate")}
    return args


def main():
    args = parse()
    table, rows = {}, []
    for capture in captures(args):
        for variant in args.variants:
            try:
                result = result_of(capture, variant, args)
            except RuntimeError as error:  # of the simulation: without the capture there is nothing to compare
                sys.exit("run.py: %s: %s" % (capture.name, error))
            table.setdefault(capture.group, {}).setdefault(variant, []).append(result)
            rows.append((capture.name, variant, result))
            print("%s: %s: %s" % (capture.name, variant, result.get("failed", "done")), file=sys.stderr, flush=True)
    args.output.mkdir(parents=True, exist_ok=True)
    (args.output / "ablation.md").write_text(markdown(table))
    write_csv(args.output / "ablation.csv", rows)
    print(markdown(table))


if __name__ == "__main__":
    main()

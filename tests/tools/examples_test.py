#!/usr/bin/env python3
"""Every example of the README, of the pages in docs/ and of every program's --help runs on the samples and does what is
said beside it.

The examples are taken from the texts themselves. CHECKS says of each one of the README and the pages how to see that it
does; an example that is not there fails. Long ones run on the small scene of their kind.
"""

import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "oracle"))
from ply import read_ply  # noqa: E402

SOURCE = Path(os.environ["CMAP_SOURCE_DIR"]).resolve()
TOWN = SOURCE / "data_samples/town"
NAMES = ("cmap_eval", "cmap_align", "cmap_compare", "cmap_leaderboard", "cmap_render", "cmap_simulate", "cmap_recon", "cmap_lio",
         "cmap_colorize", "cmap_convert")
PROGRAMS = {name: Path(os.environ[name.upper()]).resolve() for name in NAMES if name.upper() in os.environ}
# Seconds in place of minutes: a short street, few pixels.
QUICK = ["route.length_m=24", "truth.map_points_per_m2=5", "camera.width_px=160", "camera.height_px=120",
         "camera.focal_px=110", "predictions.width_px=70", "predictions.session_length=6", "lidar.azimuth_steps=300"]
SMALL = {"cmap_simulate town ": "cmap_simulate small_town ", "cmap_simulate aerial ": "cmap_simulate small_aerial "}


class Example:
    """A command line, and what is said of it."""

    def __init__(self, line):
        command, _, comment = line.partition(" # ")
        self.command, self.comment = command.strip(), comment.strip()
        code = re.match(r"exit (\d):", self.comment)
        self.code = int(code[1]) if code else 0

    def programs(self):
        return set(re.findall(r"cmap_\w+(?= )", self.command)) & set(NAMES)


def is_example(line):
    """The program may stand behind what it reads."""
    return line.startswith(("cmap_", "cat ")) and bool(Example(line).programs())


def examples_of_documents():
    """Of the README and the pages; what stands in several of them once."""
    examples = {}
    for page in (*sorted(SOURCE.glob("*.md")), *sorted((SOURCE / "docs").glob("*.md"))):
        for block in re.findall(r"^```sh\n(.*?)^```", page.read_text(), re.S | re.M):
            for line in filter(is_example, block.splitlines()):
                examples.setdefault(Example(line).command, Example(line))
    return list(examples.values())


def examples_of_help(program):
    text = subprocess.run([PROGRAMS[program], "--help"], capture_output=True, text=True, check=True).stdout
    block = re.search(r"^Examples?:\n((?:  .*\n)+)", text, re.M)
    return [Example(line.strip()) for line in block[1].splitlines()] if block else []


def first_program(example):
    return re.search(r"cmap_\w+(?= )", example.command)[0]


# What can be seen of an example that did what it says: each takes the finished run.
def says(*patterns):
    return lambda run: [run.test.assertRegex(run.stdout, pattern) for pattern in patterns]


def complains(pattern):
    return lambda run: run.test.assertRegex(run.stderr, pattern)


def makes(*names):
    return lambda run: [run.test.assertGreater((run.folder / name).stat().st_size, 0, name) for name in names]


def holds(*names):
    """Files that were compared, moved or drawn are pictures, pages, clouds: by their first bytes."""
    starts = {".png": b"\x89PNG", ".jpg": b"\xff\xd8", ".html": b"<!doctype html>", ".ply": b"ply\n", ".svg": b"<svg"}

    def check(run):
        for name in names:
            start = (run.folder / name).read_bytes()[:100]
            run.test.assertTrue(start.startswith(starts[Path(name).suffix]), name)

    return check


def reports(name, seen):
    return lambda run: run.test.assertTrue(seen(json.loads((run.folder / name).read_text())), run.example.command)


def transform(name, tolerance=0.5):
    """A 4x4 matrix that leaves the sample about where it is: its maps are a few centimeters apart."""

    def check(run):
        T = np.loadtxt(run.folder / name)
        run.test.assertEqual(T.shape, (4, 4))
        run.test.assertTrue(np.abs(T - np.eye(4)).max() < tolerance, T)

    return check


def again(*more, code, says=""):
    """The same command with more arguments ends with this code."""

    def check(run):
        result = run.shell(" ".join([run.example.command, *more]))
        run.test.assertEqual(result.returncode, code, result.stderr)
        run.test.assertIn(says, result.stderr)

    return check


def worse_map_fails(run):
    result = run.shell(run.example.command.replace("est.ply", "worse.ply"))
    run.test.assertEqual(result.returncode, 1, result.stderr)
    run.test.assertIn("requirement not met", result.stderr)


def stopped_run(run):
    """An earlier run that was stopped after its second stage; its stages are not computed again."""
    result = run.shell("cmap_recon capture -o map --stop-after registration")
    run.test.assertEqual(result.returncode, 0, result.stderr)


CHECKS = {
    "cmap_eval reference.ply estimate.ply": [says(r"color distance +CD ", r"Chamfer distance", r"average Wasserstein")],
    "cmap_eval reference.las estimate.pcd -o report.json": [
        reports("report.json", lambda r: [r["inputs"][m]["format"][:3] for m in ("reference", "estimate")] == ["LAS", "PCD"])
    ],
    "cmap_eval map.ply": [says("color consistency", "mean map entropy", "point spacing")],
    "cmap_eval ref.ply est.ply --levels": [says(r"(?m)^color +value +floor +chance +skill$")],
    "cmap_eval ref.ply est.ply --preset indoor": [says("CD ")],
    "cmap_eval ref.ply est.ply --config mine.json": [again("--format json > a.json", code=0), reports("a.json", lambda r: (
        r["parameters"]["lcr-radius"], r["parameters"]["lcr-tau"]) == (0.1, 0.05))],
    "cmap_eval ref.ply est.ply --metrics all --lcr-curve": [
        says("CIEDE2000", "PSNR", "mean map entropy"),
        again("--format json > a.json", code=0),
        reports("a.json", lambda r: len(r["metrics"]["local_color_recall"]["curve"]["tau"]) == 15),
    ],
    "cmap_eval ref.ply est.ply --metrics lcr_typo": [complains('"lcr_typo" is unknown(.*\n)*metrics are color_distance')],
    "cmap_eval ref.ply est.ply --require": [says("CD "), worse_map_fails],
    "cmap_eval ref.ply est.ply --figure figure.png": [holds("figure.png")],
    "cmap_eval ref.ply est.ply --html report.html": [holds("report.html")],
    "cmap_eval ref.ply est.ply --transform T_ref_est.txt": [
        again("--format json > a.json", code=0),
        reports("a.json", lambda r: r["alignment"]["T_ref_est"][0][3] == 0.01),
    ],
    "cmap_eval ref.ply est.ply --crop": [
        again("--format json > a.json", code=0),
        reports("a.json", lambda r: (len(r["parameters"]["crop"]), r["parameters"]["voxel"]) == (6, 0.05)),
    ],
    "cmap_eval ref.ply est.ply --export-errors": [holds("est_errors.ply", "ref_errors.ply")],
    "cmap_eval ref.ply est.ply --bootstrap 1000": [says(r"95 %")],
    "cmap_eval ref.ply est.ply --align gicp": [says("gicp", "before")],
    "cmap_eval ref.ply est.ply --align trajectory": [says("trajectory", "before")],
    "cmap_eval ref.ply est.ply --sensitivity": [says("off")],
    "cmap_eval ref.ply est.ply --observed auto": [says("[Oo]bserved|seen")],
    "cmap_eval ref.ply est.ply --observed-from": [says("[Oo]bserved|seen")],
    "cat est.ply | cmap_eval ref.ply - -o -": [says(r'^  "schema": "cmap.report/2",\n$')],
    "cmap_eval ref.ply est.ply --as": [says("color-map-evaluation", "cloudanalyzer", "mapeval", "open3d", "mpeg",
                                            "cloudcompare", "tanksandtemples")],
    "cmap_render reference.ply estimate.ply -o figure.png": [holds("figure.png")],
    "cmap_render ref.ply est.ply --panels lcr,distance --log": [holds("figure.png")],
    "cmap_render ref.ply est.ply --panels color-distance --range": [holds("a.png")],
    "cmap_render map.las --camera fit": [holds("map.jpg")],
    "cmap_render ref.ply est.ply --panels lcr --lcr-radius 0.1 --turntable": [makes("lcr.mp4")],
    "cmap_render ref.ply est.ply --interactive": [complains("display")],
    "cmap_align est.ply ref.ply -o T.txt && cmap_eval": [transform("T.txt"), says("overlap", "CD ")],
    "cmap_align est.ply ref.ply --method global": [
        transform("T.txt", 2.0), reports("result.json", lambda r: abs(r["scale"] - 1.0) < 0.05)
    ],
    "cmap_align est.ply ref.ply --method sim3": [transform("T.txt")],
    "cmap_align est.ply ref.ply --method tanksandtemples": [says("precision", "recall", "F ")],
    "cmap_align odometry.tum truth.tum --method trajectory": [transform("T.txt")],
    "cmap_align poses.txt truth.csv --method trajectory": [transform("T.txt")],
    "cmap_align odometry.tum truth.tum --pairing nearest": [
        says("ATE .*40 pairs, nearest"), reports("result.json", lambda r: r["ate"][0]["pairing"] == "nearest")
    ],
    "cmap_align odometry.tum truth.tum --time-offset": [transform("T.txt")],
    "cmap_align est.ply ref.ply --output-cloud": [holds("moved.ply")],
    "cmap_align est.ply ref.ply --figure": [holds("alignment.png")],
    "cmap_simulate small_town -o capture": [makes("capture/capture.json", "capture/truth/map.ply")],
    "cmap_simulate town -o capture": [makes("capture/capture.json")],
    "cmap_simulate aerial --print-options": [makes("mine.json", "capture/capture.json")],
    "cmap_recon capture --check": [says("^0 faults, 0 warnings: ")],
    "cmap_recon capture -o map": [makes(*(f"map/{n}" for n in ("map.ply", "trajectory.tum", "sessions.json", "report.json")))],
    "cmap_recon capture -o map --evaluate": [says("CD "), holds("stages.jpg"), makes("map/evaluation.json")],
    "cmap_recon capture -o indoor": [
        reports("indoor/report.json", lambda r: '"registration_voxel_m": 0.05' in json.dumps(r))
    ],
    "cmap_recon capture -o near": [reports("near/report.json", lambda r: '"fusion_max_range_m": 30' in json.dumps(r))],
    "cmap_recon capture -o prefusion": [makes("prefusion/map.ply")],
    "cmap_recon --preset paper --print-options": [makes("recon.json", "paper/map.ply")],
    "cmap_recon capture -o map --resume": [makes("map/map.ply")],
    "cmap_recon capture -o map --session-maps": [
        lambda run: run.test.assertGreater(len(list((run.folder / "map/sessions").glob("*.ply"))), 1)
    ],
    "cmap_recon capture -o session --only-session 2": [
        makes("session/sessions.json"),
        lambda run: run.test.assertFalse((run.folder / "session/map.ply").exists()),
    ],
    "cmap_lio capture -o lio": [makes("lio/trajectory.tum", "lio/map.pcd", "lio/health.json"), holds("lio.png")],
    "cmap_lio capture -o lidar_only": [makes("lidar_only/trajectory.tum")],
    "cmap_lio capture -o livox": [makes("livox/trajectory_imu.tum")],
    "cmap_lio capture -o fine": [makes("fine/scans/000000.pcd")],
    "cmap_convert drive.mcap --topics": [says(r"(?m)^lidar +3  /points  sensor_msgs/PointCloud2 \(ros1\)$")],
    "cmap_convert drive.mcap -o capture --config rig.json": [
        says("^3 scans, 3 images, 3 IMU samples, 0 poses\n"), makes("capture/capture.json", "capture/lidar/000002.pcd", "capture/imu.csv")],
    "cmap_convert drive.mcap -o part": [says("^2 scans")],
    "cmap_convert drive.mcap -o capture --config rig.json --topic": [makes("capture/images/000000.png")],
    "cmap_colorize capture -o colored.ply": [holds("colored.ply"), says(r"seen +\d+ points", "gains", "inconsistency")],
    "cmap_colorize capture -o even.ply": [holds("even.ply", "odd.ply"), says("CD ")],
    "cmap_colorize capture -o truth.ply": [holds("truth.ply"), says("CD ")],
    "cmap_colorize capture -o turned.ply": [holds("turned.ply")],
    "cmap_colorize capture --refine-extrinsic": [transform("T_lidar_camera.txt", 10.0), says("not applied")],
    "cmap_compare a.json b.json c.json": [says(r"\*", r"\+", "best")],
    "cmap_compare a.json b.json --baseline": [says(r"Better \(\+\) or worse \(-\) than a", "95 % intervals", "accuracy")],
    "cmap_compare a.json b.json --names": [
        lambda run: [run.test.assertIn(word, (run.folder / "t.tex").read_text()) for word in ("Ours", "Theirs", "\\toprule", "\\cellcolor")]
    ],
    "cmap_compare a.json b.json --figure": [holds("chart.svg")],
    "cmap_leaderboard benchmarks": [makes(*(f"leaderboard/tables.{e}" for e in ("md", "csv", "tex")), "leaderboard/index.html")],
}
BEFORE = {"cmap_recon capture -o map --resume": stopped_run}
CODES = {"cmap_render ref.ply est.ply --interactive": 2}  # no display here; cmap_render_interactive has one


def check_of(command):
    """The longest beginning that CHECKS knows."""
    known = [start for start in CHECKS if command.startswith(start)]
    return max(known, key=len) if known else None


class Run:
    """A folder of its own with the files that the examples name."""

    def __init__(self, test, example, folder, inputs):
        self.test, self.example, self.folder = test, example, folder
        for path in inputs.iterdir():
            makes_capture = "cmap_simulate" in example.command or "cmap_convert" in example.command
            if not (path.name == "capture" and makes_capture):
                (folder / path.name).symlink_to(path)
        self.start = check_of(example.command)
        if self.start in BEFORE:
            BEFORE[self.start](self)
        done = self.shell(example.command)
        self.code, self.stdout, self.stderr = done.returncode, done.stdout, done.stderr

    def shell(self, command):
        for long, short in SMALL.items():
            command = command.replace(long, short)
        environment = {**os.environ, "PATH": f"{self.folder.parent / 'programs'}:{os.environ['PATH']}"}
        environment.pop("DISPLAY", None)
        return subprocess.run(
            ["bash", "-c", command], cwd=self.folder, env=environment, capture_output=True, text=True, timeout=900
        )


def las_of(points, colors):
    """LAS 1.2, format 2, in millimeters."""
    records = np.zeros(len(points), [("xyz", "<i4", 3), ("rest", "V8"), ("rgb", "<u2", 3)])
    records["xyz"], records["rgb"] = np.rint(1000 * points), 257 * colors.astype(int)
    header = struct.pack("<4s20xBB32s32sHHHIIBHI20x", b"LASF", 1, 2, b"", b"", 1, 2024, 227, 227, 0, 2, 26, len(points))
    return header + struct.pack("<12d", 1e-3, 1e-3, 1e-3, *[0] * 9) + records.tobytes()


def pcd_of(points, colors):
    records = np.zeros(len(points), [("xyz", "<f4", 3), ("bgra", "u1", 4)])
    records["xyz"], records["bgra"][:, :3] = points, colors[:, ::-1]
    n = len(points)
    header = f"VERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH {n}\nHEIGHT 1\nPOINTS {n}\n"
    return (header + "DATA binary\n").encode() + records.tobytes()


def write_trajectories(folder):
    """A walk around the town's middle, once as odometry a few centimeters off, in every notation that is named."""
    truth, odometry, poses, csv, times = [], [], [], [], []
    for i in range(40):
        t, angle = 1403636580.0 + 0.1 * i, 0.1 * i
        radius = 4 + 0.4 * angle  # a circle looks the same at any time
        x, y, z = 8 + radius * np.cos(angle), 8 + radius * np.sin(angle), 1.5 + 0.2 * np.sin(3 * angle)
        q = f"0 0 {np.sin(angle / 2):.9f} {np.cos(angle / 2):.9f}"
        truth.append(f"{t:.3f} {x:.6f} {y:.6f} {z:.6f} {q}")
        odometry.append(f"{t:.3f} {x + 0.03:.6f} {y - 0.02:.6f} {z + 0.01:.6f} {q}")
        c, s = np.cos(angle), np.sin(angle)
        poses.append(f"{c:.9f} {-s:.9f} 0 {x:.6f} {s:.9f} {c:.9f} 0 {y:.6f} 0 0 1 {z:.6f}")
        csv.append(f"{round(10 * t)}00000000,{x:.6f},{y:.6f},{z:.6f},{np.cos(angle / 2):.9f},0,0,{np.sin(angle / 2):.9f}")
        times.append(f"{t:.3f}")
    euroc = "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []"
    files = {"truth.tum": truth, "odometry.tum": odometry, "poses.txt": poses, "truth.csv": [euroc, *csv], "times.txt": times}
    for name, lines in files.items():
        (folder / name).write_text("\n".join(lines) + "\n")


def write_recording(folder):
    """Three seconds of a LiDAR, an IMU and a camera as an MCAP file of ROS 1 messages, and what the rig is."""
    def text(value):
        return struct.pack("<I", len(value)) + value

    def record(opcode, body):
        return struct.pack("<BQ", opcode, len(body)) + body

    types = {1: (b"/points", b"sensor_msgs/PointCloud2"), 2: (b"/imu", b"sensor_msgs/Imu"), 3: (b"/left/image_raw", b"sensor_msgs/Image")}
    data = b"\x89MCAP0\r\n" + record(1, text(b"ros1") + text(b""))
    for number, (topic, kind) in types.items():
        data += record(3, struct.pack("<H", number) + text(kind) + text(b"ros1msg") + text(b""))
        data += record(4, struct.pack("<HH", number, number) + text(topic) + text(b"ros1") + struct.pack("<I", 0))
    points = np.random.default_rng(1).normal(0, 5, (50, 3)).astype("<f4").tobytes()
    fields = b"".join(text(axis) + struct.pack("<IBI", 4 * k, 7, 1) for k, axis in enumerate((b"x", b"y", b"z")))
    for second in range(3):
        header = struct.pack("<III", second, 1700000000 + second, 0) + text(b"frame")
        messages = {
            1: header + struct.pack("<III", 1, 50, 3) + fields + struct.pack("<BII", 0, 12, 600) + text(points) + b"\1",
            2: header + struct.pack("<37d", *[0] * 27, 9.8, *[0] * 9),
            3: header + struct.pack("<II", 4, 6) + text(b"bgr8") + struct.pack("<BI", 0, 18) + text(bytes(range(72))),
        }
        for number, message in messages.items():
            arrival = (1700000000 + second) * 10**9
            data += record(5, struct.pack("<HIQQ", number, second, arrival, arrival) + message)
    data += record(15, struct.pack("<I", 0)) + record(2, struct.pack("<QQI", 0, 0, 0)) + b"\x89MCAP0\r\n"
    (folder / "drive.mcap").write_bytes(data)
    unit = [[float(i == k) for k in range(4)] for i in range(4)]
    camera = {"model": "pinhole", "width": 6, "height": 4, "K": [5, 5, 2.5, 1.5]}
    rig = {"version": 1, "camera": camera, "T_imu_lidar": unit, "T_lidar_camera": unit}
    (folder / "rig.json").write_text(json.dumps(rig))


def write_inputs(folder):
    write_recording(folder)
    reference, estimate = (read_ply(TOWN / f"{name}.ply") for name in ("reference", "estimate"))
    for name in ("reference.ply", "ref.ply", "map.ply"):
        shutil.copy(TOWN / "reference.ply", folder / name)
    for name in ("estimate.ply", "est.ply"):
        shutil.copy(TOWN / "estimate.ply", folder / name)
    for name in ("reference.las", "map.las"):
        (folder / name).write_bytes(las_of(*reference))
    (folder / "estimate.pcd").write_bytes(pcd_of(*estimate))
    rng = np.random.default_rng(1)
    noisy = estimate[0] + rng.normal(0, 0.2, estimate[0].shape)
    (folder / "worse.ply").write_bytes(pcd_of(noisy, 255 - estimate[1]))
    (folder / "mine.json").write_text('{"lcr-radius": 0.25, "lcr-tau": 0.05} // mine\n')
    for name in ("T_ref_est.txt", "T0.txt"):
        (folder / name).write_text("1 0 0 0.01\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")
    (folder / "view.json").write_text('{"position_m": [-20, -20, 30], "target_m": [8, 8, 0], "up": [0, 0, 1]}')
    write_trajectories(folder)
    for link in ("data_samples", "benchmarks"):
        (folder / link).symlink_to(SOURCE / link)
    for name, estimate in (("a", "est.ply"), ("b", "worse.ply"), ("c", "ref.ply")):
        arguments = ["ref.ply", estimate, "--quiet", "-o", f"{name}.json", "--bootstrap", "50"]
        subprocess.run([PROGRAMS["cmap_eval"], *arguments], cwd=folder, check=True)


class Examples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="cmap-examples-")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.inputs = cls.folder / "inputs"
        for made in (cls.inputs, cls.folder / "programs"):
            made.mkdir()
        for name, program in PROGRAMS.items():
            (cls.folder / "programs" / name).symlink_to(program)
        write_inputs(cls.inputs)
        if {"cmap_simulate", "cmap_recon"} <= set(PROGRAMS):
            settings = [argument for setting in QUICK for argument in ("--set", setting)]
            capture = [PROGRAMS["cmap_simulate"], "small_town", *settings, "-o", cls.inputs / "capture", "--quiet"]
            subprocess.run(capture, check=True)

    def work_folder(self):
        folder = Path(tempfile.mkdtemp(dir=self.folder))
        self.addCleanup(shutil.rmtree, folder)
        return folder

    def check_all(self, programs):
        """The documents' examples that begin with one of these programs."""
        examples = [e for e in examples_of_documents() if first_program(e) in programs]
        self.assertGreater(len(examples), 0)
        for example in examples:
            with self.subTest(example.command):
                if not example.programs() <= set(PROGRAMS):
                    continue
                if ".mp4" in example.command and not shutil.which("ffmpeg"):
                    continue
                run = Run(self, example, self.work_folder(), self.inputs)
                if "cmap_render" not in PROGRAMS and run.code == 4 and "this build has no" in run.stderr:
                    continue  # a build without optional libraries says so
                self.assertIsNotNone(run.start, "this test does not say how to see what the example does")
                self.assertEqual(run.code, CODES.get(run.start, example.code), run.stderr)
                for check in CHECKS[run.start]:
                    check(run)

    def test_eval(self):
        self.check_all({"cmap_eval"})

    def test_render(self):
        self.check_all({"cmap_render"})

    def test_align(self):
        self.check_all({"cmap_align"})

    def test_compare_and_leaderboard(self):
        self.check_all({"cmap_compare", "cmap_leaderboard"})

    def test_simulate(self):
        self.check_all({"cmap_simulate"})

    def test_recon(self):
        self.check_all({"cmap_recon"})

    def test_convert(self):
        self.check_all({"cmap_convert"})
    def test_colorize(self):
        self.check_all({"cmap_colorize"})

    def test_every_program_has_a_page(self):
        """It shows how to call the program."""
        for name in NAMES:
            page = (SOURCE / f"docs/{name}.md").read_text()
            self.assertTrue(page.startswith(f"# {name}\n"), name)
            self.assertRegex(page, rf"(?m)^{name} ", name)

    def test_every_check_is_of_an_example(self):
        """What no document shows any more needs no check."""
        starts = {check_of(example.command) for example in examples_of_documents()}
        self.assertEqual(set(CHECKS) - starts, set())

    def test_the_manifest(self):
        """The page's manifest, with the published numbers that it names."""
        text = re.search(r"```json\n(.*?)```", (SOURCE / "docs/cmap_leaderboard.md").read_text(), re.S)[1]
        folder = self.work_folder()
        (folder / "board.json").write_text(text)
        shutil.copy(SOURCE / "benchmarks/leaderboard/paper.json", folder)
        command = [PROGRAMS["cmap_leaderboard"], "board.json", "--data-root", SOURCE / "data_samples", "-o", "board"]
        result = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("published", (folder / "board/tables.md").read_text())

    def test_help(self):
        """In order, in one folder, from which the repository's folders are seen as from its root."""
        for program in PROGRAMS:
            examples = examples_of_help(program)
            self.assertGreater(len(examples), 0, program)
            folder = self.work_folder()
            write_recording(folder)  # no recording is in the repository
            for example in examples:
                with self.subTest(example.command):
                    for link in ("data_samples", "benchmarks"):
                        if not (folder / link).exists():
                            (folder / link).symlink_to(SOURCE / link)
                    environment = {**os.environ, "PATH": f"{self.folder / 'programs'}:{os.environ['PATH']}"}
                    done = subprocess.run(
                        ["bash", "-c", example.command], cwd=folder, env=environment, capture_output=True, text=True, timeout=900
                    )
                    self.assertEqual(done.returncode, example.code, done.stderr)

    def test_every_program_names_what_it_needs(self):
        """What --help says of exit codes and of - is there for every program that reads a file."""
        for program in PROGRAMS:
            text = subprocess.run([PROGRAMS[program], "--help"], capture_output=True, text=True, check=True).stdout
            self.assertIn("Exit codes:", text)
            self.assertIn("130", text)


if __name__ == "__main__":
    unittest.main()

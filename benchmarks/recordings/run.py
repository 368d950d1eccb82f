#!/usr/bin/env python3
"""Makes an MCAP recording of PointCloud2 and reads it with cmap and with rosbags: points unpacked, warm, medians of CPU seconds.

usage: run.py READ_RECORDING [--gigabytes 2] [--runs 5] [--folder DIR]
By the Python of tests/recordings/make_environment.sh; READ_RECORDING is build/dev/benchmarks/recordings/read_recording. The file
has uncompressed chunks of a megabyte with checksums, scans of 30,000 points of 22 bytes as Velodyne's driver packs them.
"""
import argparse
import json
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from rosbags.rosbag2 import Reader, StoragePlugin
from rosbags.rosbag2 import Writer as Bag2
from rosbags.typesys import Stores, get_typestore

POINTS, TOPIC, TYPE = 30_000, "/velodyne_points", "sensor_msgs/msg/PointCloud2"
FIELDS = (("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("intensity", 12, 7), ("ring", 16, 4), ("time", 18, 7))
POINT = np.dtype({"names": [name for name, _, _ in FIELDS], "formats": ["<f4"] * 4 + ["<u2", "<f4"],
                  "offsets": [offset for _, offset, _ in FIELDS], "itemsize": 22})
STORE = get_typestore(Stores.ROS2_HUMBLE)


def scan(random):
    rows = np.zeros(POINTS, POINT)
    for axis in "xyz":
        rows[axis] = random.normal(0, 20, POINTS)
    rows["intensity"], rows["ring"] = random.integers(0, 256, POINTS), random.integers(0, 32, POINTS)
    rows["time"] = np.linspace(0, 0.1, POINTS)
    return rows


def message(rows, ns):
    types = STORE.types
    header = types["std_msgs/msg/Header"](types["builtin_interfaces/msg/Time"](ns // 10**9, ns % 10**9), "velodyne")
    fields = [types["sensor_msgs/msg/PointField"](name, offset, kind, 1) for name, offset, kind in FIELDS]
    data = rows.view(np.uint8).reshape(-1)
    return bytes(STORE.serialize_cdr(types[TYPE](header, 1, POINTS, fields, False, 22, 22 * POINTS, data, True), TYPE))


def make(folder, gigabytes):
    """A rosbag2 folder: rosbags' own metadata, and the file as mcap writes it, which has checksums."""
    random = np.random.default_rng(1)
    bag, rows = folder / "drive", scan(random)
    n = int(gigabytes * 1e9 / (22 * POINTS))
    with Bag2(bag, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection(TOPIC, TYPE, typestore=STORE)
        writer.write(connection, 1_700_000_000 * 10**9, message(rows, 1_700_000_000 * 10**9))
    definition = STORE.generate_msgdef(TYPE, ros_version=2)[0].encode()
    with open(bag / "drive.mcap", "wb") as stream:
        writer = McapWriter(stream, compression=CompressionType.NONE, chunk_size=1 << 20)
        writer.start(profile="ros2")
        channel = writer.register_channel(TOPIC, "cdr", writer.register_schema(TYPE, "ros2msg", definition), {"offered_qos_profiles": ""})
        for k in range(n):
            rows["x"][k % POINTS] += 1e-3
            ns = 1_700_000_000 * 10**9 + 100_000_000 * k
            writer.add_message(channel, ns, message(rows, ns), ns, k)
        writer.finish()
    metadata = (bag / "metadata.yaml").read_text()
    (bag / "metadata.yaml").write_text(metadata.replace("message_count: 1\n", f"message_count: {n}\n"))
    return bag


def peak_mb():
    """Of this program alone: getrusage would count that of whoever started it."""
    status = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in status if line.startswith("VmHWM:")) / 1024


def read_with_rosbags(bag):
    """What read_recording does: every point's values in arrays of their own, points that are none left out."""
    messages, points, total = 0, 0, 0.0
    with Reader(bag) as reader:
        for _, _, raw in reader.messages():
            cloud = STORE.deserialize_cdr(raw, TYPE)
            rows = cloud.data.view(POINT)
            xyz = np.stack([rows["x"], rows["y"], rows["z"]], 1)
            finite = np.isfinite(xyz).all(1)
            columns = [np.ascontiguousarray(rows[name]) for name in ("intensity", "ring", "time")]
            if not finite.all():
                xyz, columns = xyz[finite], [column[finite] for column in columns]
            messages, points = messages + 1, points + len(xyz)
            total += float(xyz[-1, 0]) + float(columns[2][-1])
    usage = resource.getrusage(resource.RUSAGE_SELF)
    print(json.dumps({"messages": messages, "points": points, "sum": total, "cpu_s": usage.ru_utime + usage.ru_stime,
                      "peak_mb": peak_mb()}))


def run(command):
    return json.loads(subprocess.run(list(map(str, command)), capture_output=True, text=True, check=True).stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path, metavar="READ_RECORDING")
    parser.add_argument("--gigabytes", type=float, default=2.0)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--folder", type=Path, help="where the recording is made, and stays")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="cmap-recordings-") as temporary:
        folder = args.folder or Path(temporary)
        bag = folder / "drive" if (folder / "drive").exists() else make(folder, args.gigabytes)
        size_mb = (bag / "drive.mcap").stat().st_size / 1e6
        commands = {"cmap": [args.program, bag], "rosbags 0.11.9": [sys.executable, __file__, "--read", bag]}
        found = {name: [] for name in commands}
        for k in range(args.runs + 1):  # in turn; the first is to warm up
            for name, command in commands.items():
                result = run(command)
                found[name] += [result] if k > 0 else []
        assert len({(r["messages"], r["points"]) for results in found.values() for r in results}) == 1, "not the same messages"
        print(f"| reader | CPU s (median of {args.runs}) | least to most | MB of file a CPU second | peak MB |\n|---|---|---|---|---|")
        for name, results in found.items():
            times = sorted(r["cpu_s"] for r in results)
            median = statistics.median(times)
            print(f"| {name} | {median:.2f} | {times[0]:.2f} to {times[-1]:.2f} | {size_mb / median:.0f} | {max(r['peak_mb'] for r in results):.0f} |")


if __name__ == "__main__":
    if len(sys.argv) == 3 and sys.argv[1] == "--read":
        read_with_rosbags(Path(sys.argv[2]))
    else:
        main()

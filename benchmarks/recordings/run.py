#!/usr/bin/env python3
"""Makes a recording of PointCloud2 and reads it with cmap and with rosbags: points unpacked, warm, medians of CPU seconds.

usage: run.py READ_RECORDING [--container mcap|sqlite|bag] [--gigabytes 2] [--runs 5] [--folder DIR]
By the Python of tests/recordings/make_environment.sh; READ_RECORDING is build/dev/benchmarks/recordings/read_recording. The
scans have 30,000 points of 22 bytes as Velodyne's driver packs them; an MCAP file has uncompressed chunks of a megabyte with checksums.
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
from rosbags.highlevel import AnyReader
from rosbags.rosbag1 import Writer as Bag1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Bag2
from rosbags.typesys import Stores, get_typestore

POINTS, TOPIC, TYPE = 30_000, "/velodyne_points", "sensor_msgs/msg/PointCloud2"
FIELDS = (("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("intensity", 12, 7), ("ring", 16, 4), ("time", 18, 7))
POINT = np.dtype({"names": [name for name, _, _ in FIELDS], "formats": ["<f4"] * 4 + ["<u2", "<f4"],
                  "offsets": [offset for _, offset, _ in FIELDS], "itemsize": 22})
STORE, STORE1 = get_typestore(Stores.ROS2_HUMBLE), get_typestore(Stores.ROS1_NOETIC)


def scan(random):
    rows = np.zeros(POINTS, POINT)
    for axis in "xyz":
        rows[axis] = random.normal(0, 20, POINTS)
    rows["intensity"], rows["ring"] = random.integers(0, 256, POINTS), random.integers(0, 32, POINTS)
    rows["time"] = np.linspace(0, 0.1, POINTS)
    return rows


def message(rows, ns, ros=2):
    store = STORE if ros == 2 else STORE1
    types = store.types
    number = {} if ros == 2 else {"seq": 0}
    header = types["std_msgs/msg/Header"](**number, stamp=types["builtin_interfaces/msg/Time"](ns // 10**9, ns % 10**9), frame_id="velodyne")
    fields = [types["sensor_msgs/msg/PointField"](name, offset, kind, 1) for name, offset, kind in FIELDS]
    data = rows.view(np.uint8).reshape(-1)
    cloud = types[TYPE](header, 1, POINTS, fields, False, 22, 22 * POINTS, data, True)
    return bytes(store.serialize_cdr(cloud, TYPE) if ros == 2 else store.serialize_ros1(cloud, TYPE))


def messages(gigabytes, ros=2):
    """(time in ns, bytes) of every scan."""
    rows = scan(np.random.default_rng(1))
    for k in range(int(gigabytes * 1e9 / (22 * POINTS))):
        rows["x"][k % POINTS] += 1e-3
        ns = 1_700_000_000 * 10**9 + 100_000_000 * k
        yield ns, message(rows, ns, ros)


def make_with_rosbags(writer, found, store):
    with writer:
        connection = writer.add_connection(TOPIC, TYPE, typestore=store)
        for ns, data in found:
            writer.write(connection, ns, data)


def make_mcap(bag, gigabytes):
    """A rosbag2 folder: rosbags' own metadata, and the file as mcap writes it, which has checksums."""
    n = int(gigabytes * 1e9 / (22 * POINTS))
    make_with_rosbags(Bag2(bag, version=9, storage_plugin=StoragePlugin.MCAP), messages(1e-3), STORE)
    definition = STORE.generate_msgdef(TYPE, ros_version=2)[0].encode()
    with open(bag / f"{bag.name}.mcap", "wb") as stream:
        writer = McapWriter(stream, compression=CompressionType.NONE, chunk_size=1 << 20)
        writer.start(profile="ros2")
        channel = writer.register_channel(TOPIC, "cdr", writer.register_schema(TYPE, "ros2msg", definition), {"offered_qos_profiles": ""})
        for k, (ns, data) in enumerate(messages(gigabytes)):
            writer.add_message(channel, ns, data, ns, k)
        writer.finish()
    metadata = (bag / "metadata.yaml").read_text()
    (bag / "metadata.yaml").write_text(metadata.replace("message_count: 1\n", f"message_count: {n}\n"))


def make(container, folder, gigabytes):
    bag = folder / {"mcap": "drive", "sqlite": "drive_sqlite", "bag": "drive.bag"}[container]
    if bag.exists():
        return bag
    if container == "mcap":
        make_mcap(bag, gigabytes)
    elif container == "sqlite":
        make_with_rosbags(Bag2(bag, version=9), messages(gigabytes), STORE)
    else:
        make_with_rosbags(Bag1(bag), messages(gigabytes, ros=1), STORE1)
    return bag


def peak_mb():
    """Of this program alone: getrusage would count that of whoever started it."""
    status = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in status if line.startswith("VmHWM:")) / 1024


def read_with_rosbags(bag):
    """What read_recording does: every point's values in arrays of their own, points that are none left out."""
    n, points, total = 0, 0, 0.0
    with AnyReader([bag]) as reader:
        for connection, _, raw in reader.messages():
            cloud = reader.deserialize(raw, connection.msgtype)
            rows = cloud.data.view(POINT)
            xyz = np.stack([rows["x"], rows["y"], rows["z"]], 1)
            finite = np.isfinite(xyz).all(1)
            columns = [np.ascontiguousarray(rows[name]) for name in ("intensity", "ring", "time")]
            if not finite.all():
                xyz, columns = xyz[finite], [column[finite] for column in columns]
            n, points = n + 1, points + len(xyz)
            total += float(xyz[-1, 0]) + float(columns[2][-1])
    usage = resource.getrusage(resource.RUSAGE_SELF)
    print(json.dumps({"messages": n, "points": points, "sum": total, "cpu_s": usage.ru_utime + usage.ru_stime,
                      "peak_mb": peak_mb()}))


def run(command):
    return json.loads(subprocess.run(list(map(str, command)), capture_output=True, text=True, check=True).stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path, metavar="READ_RECORDING")
    parser.add_argument("--container", choices=("mcap", "sqlite", "bag"), default="mcap")
    parser.add_argument("--gigabytes", type=float, default=2.0)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--folder", type=Path, help="where the recording is made, and stays")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="cmap-recordings-") as temporary:
        folder = args.folder or Path(temporary)
        bag = make(args.container, folder, args.gigabytes)
        size_mb = sum(path.stat().st_size for path in ([bag] if bag.is_file() else bag.iterdir())) / 1e6
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

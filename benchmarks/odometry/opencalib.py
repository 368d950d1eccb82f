#!/usr/bin/env python3
"""opencalib's five consecutive scans, registered and straightened without an IMU: opencalib.py CMAP_LIO DATA OUTPUT.

DATA is opencalib's lidar2imu/auto_calib/data. Says how far the sensor moves within a scan, what straightening changes,
and how far poses are from those that come with the scans. Needs numpy and scipy."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np

from kit_capture import write_pcd
from scans import CODES, Scans, read_pcd
from trajectories import Trajectory


def unpacked(packed, size):
    """LZF."""
    out = bytearray()
    i = 0
    while i < len(packed):
        control = packed[i]
        i += 1
        if control < 32:
            out += packed[i : i + control + 1]
            i += control + 1
            continue
        length = control >> 5
        if length == 7:
            length += packed[i]
            i += 1
        begin = len(out) - ((control & 31) << 8) - packed[i] - 1
        i += 1
        for k in range(begin, begin + length + 2):
            out.append(out[k])
    if len(out) != size:
        raise ValueError(f"{len(out)} bytes in place of {size}")
    return bytes(out)


def read_compressed(path):
    """Columns by name of a compressed PCD."""
    raw = Path(path).read_bytes()
    mark = b"DATA binary_compressed\n"
    begin = raw.index(mark) + len(mark)
    head = {line.split()[0]: line.split()[1:] for line in raw[:begin].decode().split("\n") if line}
    n_packed, n_unpacked = np.frombuffer(raw, "<u4", 2, begin)
    data = unpacked(raw[begin + 8 : begin + 8 + n_packed], n_unpacked)
    n, columns, offset = int(head["POINTS"][0]), {}, 0
    for name, kind, size in zip(head["FIELDS"], head["TYPE"], head["SIZE"]):
        columns[name] = np.frombuffer(data, CODES[kind + size], n, offset)
        offset += n * int(size)
    return columns


def make_capture(data, capture):
    (capture / "lidar").mkdir(parents=True)
    table = ["timestamp_s,file"]
    for i, path in enumerate(sorted((data / "top_center_lidar").glob("*.pcd"))):
        columns = read_compressed(path)
        positions = np.stack([columns["x"], columns["y"], columns["z"]], 1)
        finite = np.isfinite(positions).all(1) & np.isfinite(columns["timestamp"])
        stamp = columns["timestamp"][finite].min()
        write_pcd(capture / "lidar" / f"{i:06}.pcd", positions[finite], columns["timestamp"][finite] - stamp)
        table.append(f"{stamp:.6f},lidar/{i:06}.pcd")
    (capture / "lidar.csv").write_text("\n".join(table) + "\n")
    (capture / "capture.json").write_text(json.dumps({"version": 1, "T_imu_lidar": np.eye(4).tolist()}) + "\n")


def stated_positions(data, n):
    """The poses that come with the scans, in the first one's frame."""
    rows = [line.split() for line in (data / "top_center_lidar-pose.txt").read_text().split("\n") if line][:n]
    return np.array([[float(row[4]), float(row[8]), float(row[12])] for row in rows])


def main(program, data, output):
    capture = output / "opencalib"
    if not capture.exists():
        make_capture(data, capture)
    result = output / "result"
    subprocess.run([program, capture, "--output", result, "--no-imu", "--no-loops", "--scans", "--quiet", "--preset",
                    "velodyne64"], check=True)
    scans, poses = Scans(capture), Trajectory.read(result / "trajectory.tum")
    stated = stated_positions(data, len(scans))
    print("scan  duration s  moved m  by the stated pose m  points  largest change by straightening m")
    for i in range(len(scans)):
        positions, times = scans.read(i)
        straight = read_pcd(result / "scans" / f"{i:06}.pcd")[0]
        ranges = np.linalg.norm(positions, axis=1)
        kept = positions[(ranges >= 1.0) & (ranges <= 100.0)]
        change = np.linalg.norm(straight - kept, axis=1).max() if len(straight) == len(kept) else float("nan")
        moved, stated_moved = (np.linalg.norm(p[i] - p[0]) for p in (poses.positions, stated))
        print(f"{i:4}  {np.ptp(times):10.4f}  {moved:7.4f}  {stated_moved:20.4f}  {len(positions):6}  {change:.4f}")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]), Path(sys.argv[3]))

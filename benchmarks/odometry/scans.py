"""Scans of a capture folder: points and their own times. Needs numpy."""

import json
from pathlib import Path

import numpy as np

CODES = {"F4": "<f4", "F8": "<f8", "U1": "u1", "U2": "<u2", "U4": "<u4", "I1": "i1", "I2": "<i2", "I4": "<i4"}


def read_pcd(path):
    """(positions N x 3, seconds from the scan's stamp; zeros without) of a binary PCD; without what is not finite."""
    raw = Path(path).read_bytes()
    begin = raw.index(b"DATA binary\n") + len(b"DATA binary\n")
    head = {line.split()[0]: line.split()[1:] for line in raw[:begin].decode().split("\n") if line}
    types = [CODES[kind + size] for kind, size in zip(head["TYPE"], head["SIZE"])]
    table = np.frombuffer(raw[begin:], np.dtype(list(zip(head["FIELDS"], types))), int(head["POINTS"][0]))
    positions = np.stack([table["x"], table["y"], table["z"]], 1).astype(float)
    times = table["time"].astype(float) if "time" in head["FIELDS"] else np.zeros(len(table))
    finite = np.isfinite(positions).all(1)
    return positions[finite], times[finite]


class Scans:
    """Of a capture, in order."""

    def __init__(self, capture):
        self.capture = Path(capture)
        rows = [line.split(",") for line in (self.capture / "lidar.csv").read_text().split("\n")[1:] if line]
        self.stamps = np.array([float(row[0]) for row in rows])
        self.files = [self.capture / row[1].strip() for row in rows]
        self.T_imu_lidar = np.array(json.loads((self.capture / "capture.json").read_text())["T_imu_lidar"])

    def __len__(self):
        return len(self.files)

    def read(self, i):
        """(positions in the LiDAR frame, times)."""
        positions, times = read_pcd(self.files[i])
        return positions, self.stamps[i] + times

    def in_imu(self, positions):
        return positions @ self.T_imu_lidar[:3, :3].T + self.T_imu_lidar[:3, 3]

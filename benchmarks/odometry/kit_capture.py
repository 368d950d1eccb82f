#!/usr/bin/env python3
"""Makes a capture of the range images of KIT's Muehlburger Tor: kit_capture.py FOLDER CAPTURE. Needs numpy and Pillow.

A column of an image is one azimuth, measured at a time between those of timestamps_start.txt and timestamps_end.txt."""

import json
import sys
from datetime import datetime, timezone
from pathlib import Path

import numpy as np
from PIL import Image


def times(path):
    stamps = []
    for line in path.read_text().split("\n"):
        if line.strip():
            whole, fraction = line.strip().split(".")
            day = datetime.strptime(whole, "%Y-%m-%d %H:%M:%S").replace(tzinfo=timezone.utc)
            stamps.append(day.timestamp() + float("0." + fraction))
    return stamps


def elevations(path):
    rows = [line.split() for line in path.read_text().split("\n") if line.strip() and not line.startswith("#")]
    return -np.radians(np.array(rows[0][5:69], float))


def points(image, elevation, duration):
    """x y z, seconds from the first column: those that returned."""
    row, column = np.nonzero(image)
    distance = image[row, column] / 500.0
    azimuth = np.radians(180.0 - 360.0 * (column + 0.5) / image.shape[1])
    flat = distance * np.cos(elevation[row])
    p = np.stack([flat * np.cos(azimuth), flat * np.sin(azimuth), distance * np.sin(elevation[row])], 1)
    order = np.argsort(column, kind="stable")
    return p[order], duration * (column[order] + 0.5) / image.shape[1]


def write_pcd(path, p, t):
    rows = np.zeros(len(p), [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("time", "<f4")])
    rows["x"], rows["y"], rows["z"], rows["time"] = p[:, 0], p[:, 1], p[:, 2], t
    head = (f"VERSION 0.7\nFIELDS x y z time\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH {len(p)}\nHEIGHT 1\n"
            f"VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(p)}\nDATA binary\n")
    path.write_bytes(head.encode() + rows.tobytes())


def main(source, capture):
    (capture / "lidar").mkdir(parents=True)
    elevation = elevations(source / "velodyne_config.txt")
    begin, end = times(source / "timestamps_start.txt"), times(source / "timestamps_end.txt")
    table = ["timestamp_s,file"]
    for i, name in enumerate(sorted((source / "data").glob("*.png"))):
        image = np.array(Image.open(name)).astype(float)
        p, t = points(image, elevation, end[i] - begin[i])
        write_pcd(capture / "lidar" / f"{i:06}.pcd", p, t)
        table.append(f"{begin[i]:.6f},lidar/{i:06}.pcd")
    (capture / "lidar.csv").write_text("\n".join(table) + "\n")
    (capture / "capture.json").write_text(json.dumps({"version": 1, "T_imu_lidar": np.eye(4).tolist()}) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))

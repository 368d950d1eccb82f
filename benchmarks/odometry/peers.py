#!/usr/bin/env python3
"""Runs a peer on a capture: peers.py NAME CAPTURE TUM, in the environment that make_environment.sh makes.

NAME is kiss-icp, kiss-icp-raw (without deskewing), or rko-lio. Writes world_T_imu at scan ends, and prints a JSON
object with the CPU milliseconds a scan (median, all threads)."""

import json
import sys
import time

import numpy as np
from scipy.spatial.transform import Rotation

from scans import Scans


class KissIcp:
    """Poses are those of a scan's last point; their world is the first scan's LiDAR frame."""

    def __init__(self, scans, deskew):
        from kiss_icp.config.parser import load_config
        from kiss_icp.kiss_icp import KissICP

        config = load_config(None)
        config.data.deskew = deskew
        self.T_imu_lidar = scans.T_imu_lidar
        self.odometry = KissICP(config)

    def register(self, points, times):
        span = times.max() - times.min()
        share = (times - times.min()) / span if span > 0 else np.zeros_like(times)
        begin = time.process_time()
        self.odometry.register_frame(points, share)
        spent = time.process_time() - begin
        return self.T_imu_lidar @ self.odometry.last_pose @ np.linalg.inv(self.T_imu_lidar), spent


class RkoLio:
    """The base is the IMU. A scan goes in after the IMU's samples before its end."""

    def __init__(self, scans):
        from rko_lio.config import LIOConfig
        from rko_lio.lio import LIO

        self.odometry = LIO(LIOConfig())
        # It ends the process at a rotation that is orthogonal to 3e-9 only, as KITTI's is.
        self.T_imu_lidar = scans.T_imu_lidar.copy()
        self.T_imu_lidar[:3, :3] = Rotation.from_matrix(scans.T_imu_lidar[:3, :3]).as_matrix()
        self.imu = np.loadtxt(scans.capture / "imu.csv", delimiter=",", skiprows=1)
        self.next = 0

    def register(self, points, times):
        nanoseconds = np.round(times * 1e9).astype(np.int64)
        begin = time.process_time()
        while self.next < len(self.imu) and self.imu[self.next, 0] < times.max():
            row = self.imu[self.next]
            self.odometry.add_imu_measurement(row[4:7], row[1:4], int(round(row[0] * 1e9)), np.eye(4))
            self.next += 1
        self.odometry.register_scan(points, nanoseconds, self.T_imu_lidar)
        spent = time.process_time() - begin
        return self.odometry.pose(), spent


def make_peer(name, scans):
    if name == "rko-lio":
        return RkoLio(scans)
    return KissIcp(scans, deskew=name == "kiss-icp")


def main(name, capture, output):
    scans = Scans(capture)
    peer = make_peer(name, scans)
    rows, spent = [], []
    for i in range(len(scans)):
        points, times = scans.read(i)
        T, seconds = peer.register(points, times)
        rows.append([times.max(), *T[:3, 3], *Rotation.from_matrix(T[:3, :3]).as_quat()])
        spent.append(seconds)
    np.savetxt(output, np.array(rows), fmt=["%.9f"] + ["%.9g"] * 7)
    print(json.dumps({"cpu_ms": 1e3 * float(np.median(spent)), "scans": len(rows)}))


if __name__ == "__main__":
    main(*sys.argv[1:4])

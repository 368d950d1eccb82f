#!/usr/bin/env python3
"""Every message type in every container, written by rosbags and mcap, comes out of cmap_convert exactly as it went in.

usage: read_back_test.py CMAP_CONVERT
Exit 0: all does; 1: something does not; 77: no rosbags or no mcap here.
"""
import csv
import json
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

SKIPPED = 77
try:
    import numpy as np
    from drive import LIVOX, SCANS, Drive, Messages, jpeg, seconds, stamp_ns
    from writers import REFUSED, WRITERS
except ImportError as error:
    print("skipped:", error, "(tests/recordings/make_environment.sh)")
    sys.exit(SKIPPED)

UNIT = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
RIG = {"version": 1, "camera": {"model": "pinhole", "width": 6, "height": 4, "K": [5, 5, 2.5, 1.5]}, "T_imu_lidar": UNIT, "T_lidar_camera": UNIT}


def read_scan(path):
    header, body = path.read_bytes().split(b"DATA binary\n", 1)
    names = next(line for line in header.decode().splitlines() if line.startswith("FIELDS")).split()[1:]
    rows = np.frombuffer(body, np.dtype([(name, "<u2" if name == "ring" else "<f4") for name in names]))
    return np.stack([rows[axis] for axis in "xyz"], 1), rows["intensity"], rows["time"], rows["ring"]


def read_png(path):
    """Pixels of a PNG of RGB whose rows are filtered by 1 (differences to the left)."""
    data, place, packed, size = path.read_bytes(), 8, b"", None
    while place < len(data):
        length, kind = struct.unpack(">I4s", data[place:place + 8])
        body = data[place + 8:place + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[place + 8 + length:place + 12 + length])[0]
        size = struct.unpack(">II", body[:8]) if kind == b"IHDR" else size
        packed += body if kind == b"IDAT" else b""
        place += 12 + length
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(size[1], 1 + 3 * size[0])
    assert (rows[:, 0] == 1).all()
    return np.cumsum(rows[:, 1:].reshape(size[1], size[0], 3), axis=1, dtype=np.uint8)


def table(path):
    with open(path) as stream:
        return list(csv.reader(stream))[1:]


class ReadBack(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="cmap-recordings-")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.drive = Drive()
        (cls.folder / "rig.json").write_text(json.dumps(RIG))

    def convert(self, recording, capture, *topics):
        topics = [argument for topic in topics for argument in ("--topic", topic)]
        command = [PROGRAM, recording, "-o", capture, "--config", self.folder / "rig.json", "--quiet", *topics]
        return subprocess.run(command, capture_output=True, text=True)

    def check_scans(self, capture, truths):
        rows = table(capture / "lidar.csv")
        self.assertEqual([float(time) for time, _ in rows], [seconds(stamp_ns(k)) for k in range(SCANS)])
        for (_, name), truth in zip(rows, truths):
            for found, expected in zip(read_scan(capture / name), truth):
                np.testing.assert_array_equal(found, expected)

    def check_rest(self, capture, is_raw):
        rows = np.array(table(capture / "imu.csv"), float)
        times = [seconds(stamp_ns(0) + 10_000_000 * i) for i in range(len(self.drive.rate))]
        np.testing.assert_array_equal(rows, np.column_stack([times, self.drive.rate, self.drive.force]))
        poses = np.loadtxt(capture / "lio.tum")
        np.testing.assert_array_equal(poses[:, 1:4], self.drive.poses)
        np.testing.assert_allclose(poses[:, 4:], [[0, 0, 0.6, 0.8]] * 3, rtol=0, atol=1e-15)
        for k, (time, name) in enumerate(table(capture / "images.csv")):
            self.assertEqual(float(time), seconds(stamp_ns(k)))
            if is_raw:
                np.testing.assert_array_equal(read_png(capture / name), self.drive.pictures[k][:, :, ::-1])
            else:
                self.assertEqual((capture / name).read_bytes(), jpeg(k))

    def check_recording(self, recording, name):
        clouds = {f"/{kind}": [getattr(self.drive, kind)(k)[4] for k in range(SCANS)] for kind in ("velodyne", "ouster", "livox_cloud")}
        customs = {f"/{package}": [self.drive.custom(k) for k in range(SCANS)] for package in LIVOX}
        for i, (topic, truths) in enumerate({**clouds, **customs}.items()):
            with self.subTest(container=name, topic=topic):
                capture = recording.parent / f"capture{i}"
                image = ("/image", "/jpeg")[i % 2]
                done = self.convert(recording, capture, f"lidar={topic}", f"image={image}", "odometry=/odometry")
                if "this build of cmap" in done.stderr:
                    self.skipTest(done.stderr)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(done.stdout, f"{SCANS} scans, 2 images, 20 IMU samples, 3 poses\n")
                self.check_scans(capture, truths)
                self.check_rest(capture, image == "/image")

    def write(self, name, ros, write):
        folder = Path(tempfile.mkdtemp(dir=self.folder))
        return write(folder / "drive", Messages(self.drive, ros))

    def test_every_message_in_every_container(self):
        for name, (ros, write) in WRITERS.items():
            self.check_recording(self.write(name, ros, write), name)

    def test_topics_are_listed(self):
        recording = self.write("", *WRITERS["rosbags, bag"])
        listed = subprocess.run([PROGRAM, recording, "--topics"], capture_output=True, text=True).stdout
        self.assertIn("imu              20  /imu  sensor_msgs/Imu (ros1)\n", listed)
        self.assertIn("-                 1  /words  std_msgs/String (ros1)\n", listed)
        self.assertEqual(len(listed.splitlines()), 11)

    def test_what_is_not_read_is_named(self):
        for name, (writer, code, says) in REFUSED.items():
            done = self.convert(self.write(name, *writer), self.folder / "refused", "lidar=/velodyne", "image=/jpeg")
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(says, done.stderr)
            self.assertFalse((self.folder / "refused").exists())

    def test_time_begins_at_0(self):
        """A clock of a simulation. (In bags of ROS 1 what arrives at 0 is no message to ROS, which cannot write it either.)"""
        for name in ("rosbags, SQLite", "mcap, ROS 1"):
            ros, write = WRITERS[name]
            messages = Messages(self.drive, ros)
            first = messages.all()[0][2]
            shifted = [(topic, kind, ns - first, message) for topic, kind, ns, message in messages.all()]
            messages.all = lambda shifted=shifted: shifted
            recording = write(Path(tempfile.mkdtemp(dir=self.folder)) / "drive", messages)
            listed = subprocess.run([PROGRAM, recording, "--topics"], capture_output=True, text=True).stdout
            self.assertIn("imu              20  /imu", listed, name)

    def test_several_topics_of_a_kind_must_be_told_apart(self):
        done = self.convert(self.write("", *WRITERS["mcap, ROS 2"]), self.folder / "refused")
        self.assertEqual(done.returncode, 3)
        self.assertIn("which topic is the lidar's", done.stderr)


if __name__ == "__main__":
    PROGRAM = Path(sys.argv.pop(1)).resolve()
    unittest.main()

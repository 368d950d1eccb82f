"""A short drive as its sensors would say it: what is true, and each message for a ROS of either version."""
import numpy as np
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

SCANS, POINTS = 3, 200
START_S, LATE_NS = 1_700_000_000, 40_000_000  # messages arrive late
LIVOX = ("livox_ros_driver", "livox_ros_driver2", "livox_interfaces")
POINT = "uint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\nuint8 reflectivity\nuint8 tag\nuint8 line\n"
CUSTOM = "std_msgs/Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\nCustomPoint[] points\n"


def typestore(ros):
    store = get_typestore(Stores.ROS1_NOETIC if ros == 1 else Stores.ROS2_HUMBLE)
    for package in LIVOX:
        store.register({**get_types_from_msg(POINT, f"{package}/msg/CustomPoint"), **get_types_from_msg(CUSTOM, f"{package}/msg/CustomMsg")})
    return store


def stamp_ns(k):
    return START_S * 10**9 + 100_000_000 * k + 123


def seconds(ns):
    return ns // 10**9 + 1e-9 * (ns % 10**9)


class Drive:
    """Points, measurements and pictures; `expected` has what must be read back of each topic."""

    def __init__(self):
        random = np.random.default_rng(19)
        self.xyz = random.normal(0, 20, (SCANS, POINTS, 3)).astype(np.float32)
        self.intensity = random.integers(0, 256, (SCANS, POINTS)).astype(np.uint8)
        self.ring = random.integers(0, 32, (SCANS, POINTS)).astype(np.uint8)
        self.time_ns = np.sort(random.integers(0, 100_000_000, (SCANS, POINTS))).astype(np.uint32)
        self.rate, self.force = random.normal(0, 1, (20, 3)), random.normal(0, 1, (20, 3)) + [0, 0, 9.8]
        self.pictures = random.integers(0, 256, (2, 4, 6, 3)).astype(np.uint8)
        self.poses = random.normal(0, 10, (3, 3))

    def velodyne(self, k):
        """x y z intensity ring time: 22 bytes; times before the stamp, as velodyne-decoder gives them; a point that is none."""
        rows = np.zeros(POINTS, np.dtype({"names": ["xyz", "intensity", "ring", "time"], "formats": ["3<f4", "<f4", "<u2", "<f4"],
                                          "offsets": [0, 12, 16, 18], "itemsize": 22}))
        rows["xyz"], rows["intensity"], rows["ring"] = self.xyz[k], self.intensity[k], self.ring[k]
        rows["time"] = np.float32(1e-9) * self.time_ns[k].astype(np.float32) - np.float32(0.1)
        truth = (rows["xyz"][1:].copy(), rows["intensity"][1:].copy(), rows["time"][1:].copy(), rows["ring"][1:].copy())
        rows["xyz"][0] = np.nan
        fields = [("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("intensity", 12, 7), ("ring", 16, 4), ("time", 18, 7)]
        return rows.tobytes(), 22, fields, False, truth

    def ouster(self, k):
        """48 bytes with gaps, rows padded, big endian: t in nanoseconds."""
        rows = np.zeros(POINTS, np.dtype({"names": ["t", "xyz", "intensity", "ring"], "formats": [">u4", "3>f4", ">f4", "u1"],
                                          "offsets": [40, 4, 24, 33], "itemsize": 48}))
        rows["xyz"], rows["intensity"], rows["ring"], rows["t"] = self.xyz[k], self.intensity[k], self.ring[k], self.time_ns[k]
        fields = [("ring", 33, 2), ("t", 40, 6), ("z", 12, 7), ("y", 8, 7), ("x", 4, 7), ("intensity", 24, 7)]
        truth = (self.xyz[k], self.intensity[k].astype(np.float32), (1e-9 * self.time_ns[k].astype(float)).astype(np.float32),
                 self.ring[k].astype(np.uint16))
        return rows.tobytes(), 48, fields, True, truth

    def livox_cloud(self, k):
        """26 bytes: times of the clock in nanoseconds, in doubles; tags, of which two are noise."""
        rows = np.zeros(POINTS, np.dtype({"names": ["xyz", "intensity", "tag", "line", "timestamp"],
                                          "formats": ["3<f4", "<f4", "u1", "u1", "<f8"], "offsets": [0, 12, 16, 17, 18], "itemsize": 26}))
        rows["xyz"], rows["intensity"], rows["line"] = self.xyz[k], self.intensity[k], self.ring[k]
        rows["tag"][:3] = 0x10, 0x20, 0x30
        rows["timestamp"] = float(stamp_ns(k)) + self.time_ns[k]
        kept = (rows["tag"] & 0x30) <= 0x10
        times = (1e-9 * (rows["timestamp"] - float(stamp_ns(k)))).astype(np.float32)
        fields = [("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("intensity", 12, 7), ("tag", 16, 2), ("line", 17, 2), ("timestamp", 18, 8)]
        truth = (rows["xyz"][kept].copy(), rows["intensity"][kept].copy(), times[kept], rows["line"][kept].astype(np.uint16))
        return rows.tobytes(), 26, fields, False, truth

    def custom(self, k):
        kept = np.ones(POINTS, bool)
        kept[1:3] = False
        return (self.xyz[k][kept], self.intensity[k][kept].astype(np.float32),
                (1e-9 * self.time_ns[k][kept].astype(float)).astype(np.float32), self.ring[k][kept].astype(np.uint16))


class Messages:
    """(topic, type, arrival in ns, message) of a drive in the order of arrival, for one version of ROS."""

    def __init__(self, drive, ros):
        self.drive, self.ros, self.store, self.sequence = drive, ros, typestore(ros), 0
        self.types = self.store.types

    def header(self, ns):
        time = self.types["builtin_interfaces/msg/Time"](ns // 10**9, ns % 10**9)
        self.sequence += 1
        number = {"seq": self.sequence} if self.ros == 1 else {}
        return self.types["std_msgs/msg/Header"](**number, stamp=time, frame_id="some frame")

    def cloud(self, ns, data, step, fields, big_endian):
        field = self.types["sensor_msgs/msg/PointField"]
        rows, height = data, 1
        width, row_step = POINTS, len(data)
        if big_endian:  # two rows with something behind each
            half = len(data) // 2
            rows, height, width, row_step = data[:half] + b"padding" + data[half:] + b"padding", 2, POINTS // 2, half + 7
        return self.types["sensor_msgs/msg/PointCloud2"](
            self.header(ns), height, width, [field(name, offset, kind, 1) for name, offset, kind in fields], big_endian, step,
            row_step, np.frombuffer(rows, np.uint8), False)

    def custom(self, package, k):
        drive, point = self.drive, self.types[f"{package}/msg/CustomPoint"]
        tags = np.zeros(POINTS, np.uint8)
        tags[:3] = 0x10, 0x20, 0x30
        points = [point(int(drive.time_ns[k][i]), *map(float, drive.xyz[k][i]), int(drive.intensity[k][i]), int(tags[i]), int(drive.ring[k][i]))
                  for i in range(POINTS)]
        return self.types[f"{package}/msg/CustomMsg"](self.header(stamp_ns(k)), stamp_ns(k), POINTS, 1, np.zeros(3, np.uint8), points)

    def imu(self, i):
        vector, quaternion = self.types["geometry_msgs/msg/Vector3"], self.types["geometry_msgs/msg/Quaternion"]
        ns = stamp_ns(0) + 10_000_000 * i
        return ns, self.types["sensor_msgs/msg/Imu"](self.header(ns), quaternion(0, 0, 0, 1), np.zeros(9), vector(*self.drive.rate[i]),
                                                     np.ones(9), vector(*self.drive.force[i]), np.zeros(9))

    def image(self, k):
        return self.types["sensor_msgs/msg/Image"](self.header(stamp_ns(k)), 4, 6, "bgr8", 0, 18, self.drive.pictures[k].reshape(-1))

    def compressed(self, k):
        data = np.frombuffer(jpeg(k), np.uint8)
        return self.types["sensor_msgs/msg/CompressedImage"](self.header(stamp_ns(k)), "bgr8; jpeg compressed bgr8", data)

    def odometry(self, k):
        t = self.types
        pose = t["geometry_msgs/msg/Pose"](t["geometry_msgs/msg/Point"](*self.drive.poses[k]), t["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.6, 0.8))
        twist = t["geometry_msgs/msg/Twist"](t["geometry_msgs/msg/Vector3"](1, 2, 3), t["geometry_msgs/msg/Vector3"](4, 5, 6))
        return t["nav_msgs/msg/Odometry"](self.header(stamp_ns(k)), "base", t["geometry_msgs/msg/PoseWithCovariance"](pose, np.zeros(36)),
                                          t["geometry_msgs/msg/TwistWithCovariance"](twist, np.zeros(36)))

    def all(self):
        found = []
        for k in range(SCANS):
            for name in ("velodyne", "ouster", "livox_cloud"):
                data, step, fields, big, _ = getattr(self.drive, name)(k)
                found.append((f"/{name}", "sensor_msgs/msg/PointCloud2", stamp_ns(k), self.cloud(stamp_ns(k), data, step, fields, big)))
            for package in LIVOX:
                found.append((f"/{package}", f"{package}/msg/CustomMsg", stamp_ns(k), self.custom(package, k)))
            found.append(("/odometry", "nav_msgs/msg/Odometry", stamp_ns(k), self.odometry(k)))
        for i in range(len(self.drive.rate)):
            ns, message = self.imu(i)
            found.append(("/imu", "sensor_msgs/msg/Imu", ns, message))
        for k in range(len(self.drive.pictures)):
            found.append(("/image", "sensor_msgs/msg/Image", stamp_ns(k), self.image(k)))
            found.append(("/jpeg", "sensor_msgs/msg/CompressedImage", stamp_ns(k), self.compressed(k)))
        found.append(("/words", "std_msgs/msg/String", stamp_ns(1), self.types["std_msgs/msg/String"]("of no use here")))
        return sorted(((topic, kind, ns + LATE_NS, message) for topic, kind, ns, message in found), key=lambda m: m[2])

    def serialized(self, kind, message, little_endian=True):
        if self.ros == 1:
            return bytes(self.store.serialize_ros1(message, kind))
        return bytes(self.store.serialize_cdr(message, kind, little_endian=little_endian))


def jpeg(k):
    return b"\xff\xd8\xff\xe0 not decoded, " + bytes([k]) * 100

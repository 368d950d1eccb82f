"""Pairs of maps that share a part of what they show, and the pose between them.

A scene is sampled as often as asked, each time with other points. A pair is two windows of a scene: the target as it lies, the source in a
frame of its own. The same seed makes the same pairs.
"""
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import make_town  # noqa: E402

SHARES = (0.80, 0.60, 0.40, 0.25, 0.15)
TILT_DEG = 3.0


@dataclass
class Pair:
    scene: str
    share: float
    source: np.ndarray  # float32
    target: np.ndarray
    T_dst_src: np.ndarray
    voxel_m: float      # of coarse methods


class Town:
    """benchmarks/make_town.py: houses on a grid of blocks, trees, cars."""
    window_m, voxel_m, noise_m = 70.0, 1.0, 0.02
    points_per_m2 = 30.0

    def __init__(self, seed):
        self.side_m = 220.0
        self.scene = make_town.Scene(self.side_m, seed)

    def sample(self, rng, center, half_m):
        points, _, _ = make_town.sample_scene(self.scene, rng, int(self.points_per_m2 * self.side_m**2))
        return inside(points, center, half_m)


class Floor:
    """A floor of an office building: rooms of many sizes along corridors, with doors, windows and furniture."""
    side_m, window_m, voxel_m, noise_m = 64.0, 20.0, 0.3, 0.01
    points_per_m2, height_m = 60.0, 2.8

    def __init__(self, seed):
        rng = np.random.default_rng([seed, 7])
        self.faces = []  # corner, edge, edge
        s, h = self.side_m, self.height_m
        self.faces += [((0, 0, 0), (s, 0, 0), (0, s, 0)), ((0, 0, h), (s, 0, 0), (0, s, 0))]
        y = 0.0
        while y < s:  # a row of rooms on either side of a corridor
            depths = rng.uniform(4.0, 8.0, 2)
            corridor = rng.uniform(1.8, 2.6)
            for base, depth, door_y in ((y, depths[0], y + depths[0]), (y + depths[0] + corridor, depths[1], y + depths[0] + corridor)):
                self.row(rng, base, depth, door_y)
            y += depths.sum() + corridor
            self.wall((0, y), (s, y))

    def row(self, rng, y, depth, door_y):
        x = 0.0
        while x < self.side_m:
            width = rng.uniform(2.8, 9.0)
            end = min(x + width, self.side_m)
            self.wall((end, y), (end, y + depth))
            door = x + rng.uniform(0.2, max(0.3, end - x - 1.1))
            self.wall((x, door_y), (min(door, end), door_y))
            self.wall((min(door + 0.9, end), door_y), (end, door_y))
            self.faces.append(((min(door, end), door_y, 2.1), (0.9, 0, 0), (0, 0, self.height_m - 2.1)))
            for _ in range(rng.integers(1, 3 + int(width * depth / 6))):
                size = rng.uniform((0.4, 0.4, 0.4), (1.8, 1.0, 2.0))
                if rng.random() < 0.5:
                    size[:2] = size[1::-1]
                room = np.array([end - x, depth]) - size[:2] - 0.1
                if (room > 0).all():
                    self.box((x + 0.05 + rng.random() * room[0], y + 0.05 + rng.random() * room[1]), size)
            x = end

    def wall(self, a, b):
        if np.hypot(b[0] - a[0], b[1] - a[1]) > 0.05:
            self.faces.append(((a[0], a[1], 0), (b[0] - a[0], b[1] - a[1], 0), (0, 0, self.height_m)))

    def box(self, corner, size):
        c = np.array([*corner, 0.0])
        for axis in range(3):
            u, v = np.delete(np.diag(size), axis, axis=0)
            self.faces.append((c, u, v)) if axis < 2 else None
            self.faces.append((c + np.diag(size)[axis], u, v))

    def sample(self, rng, center, half_m):
        corner, u, v = (np.array([f[k] for f in self.faces], float) for k in range(3))
        area = np.linalg.norm(np.cross(u, v), axis=1)
        face = make_town.choose(rng, area, int(self.points_per_m2 * area.sum()))
        a, b = rng.random((2, len(face), 1))
        return inside(corner[face] + a * u[face] + b * v[face], center, half_m)


class Autzen:
    """An airborne map of a stadium, trees, cars and parking lots; its points are dealt out at random to the two maps."""
    side_m, window_m, voxel_m, noise_m = 300.0, 110.0, 1.5, 0.03

    def __init__(self, seed, path):
        with open(path, "rb") as stream:
            header = b""
            while not header.endswith(b"end_header\n"):
                header += stream.readline()
            n = int(header.split(b"element vertex ")[1].split()[0])
            kind = np.dtype([("p", "<f4", 3), ("c", "u1", 3)])
            points = np.frombuffer(stream.read(n * kind.itemsize), kind)["p"].astype(float)
        self.points = points - points.min(axis=0)
        self.taken = None

    def sample(self, rng, center, half_m):
        if self.taken is None:
            self.taken = rng.random(len(self.points)) < 0.5
            return inside(self.points[self.taken], center, half_m)
        rest, self.taken = self.points[~self.taken], None
        return inside(rest, center, half_m)


def inside(points, center, half_m):
    return points[(np.abs(points[:, :2] - center) < half_m).all(axis=1)].astype(float)


def rotation(axis, angle):
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    K = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def windows(rng, side_m, window_m, share):
    """Centers of two windows, the part in common of this share of either's area, both inside the scene."""
    if share > 0:
        while True:
            dx = rng.uniform(0.0, 1.0 - share)
            offset = np.array([dx, 1.0 - share / (1.0 - dx)]) * rng.choice([-1, 1], 2) * window_m
            offset = offset[::-1] if rng.random() < 0.5 else offset
            room = side_m - window_m - np.abs(offset)
            if (room > 0).all():
                break
        low = rng.random(2) * room + np.maximum(-offset, 0) + window_m / 2
        return low, low + offset
    while True:  # nothing in common
        a, b = rng.random((2, 2)) * (side_m - window_m) + window_m / 2
        if np.abs(a - b).max() > window_m:
            return a, b


def make_pair(scene, share, rng):
    target_center, source_center = windows(rng, scene.side_m, scene.window_m, share)
    target = scene.sample(rng, target_center, scene.window_m / 2)
    source = scene.sample(rng, source_center, scene.window_m / 2)
    target, source = (p + scene.noise_m * rng.standard_normal(p.shape) for p in (target, source))
    tilt = rotation([*rng.standard_normal(2), 0.0], np.radians(rng.uniform(0, TILT_DEG)))
    R = tilt @ rotation([0, 0, 1], rng.uniform(-np.pi, np.pi))
    t = rng.uniform(-1, 1, 3) * np.array([scene.window_m, scene.window_m, 5.0])
    middle = np.array([*source_center, 0.0])
    T = np.eye(4)  # target's frame from the source's
    T[:3, :3], T[:3, 3] = R.T, middle - R.T @ t
    moved = (source - middle) @ R.T + t
    return Pair(type(scene).__name__.lower(), share, moved.astype(np.float32), target.astype(np.float32), T, scene.voxel_m)


def make_pairs(seed, per_share, shares, autzen):
    """Pairs in turn of all scenes, per_share of each share."""
    kinds = [lambda: Town(seed), lambda: Floor(seed)] + ([lambda: Autzen(seed, autzen)] if autzen else [])
    made = {}
    for s, share in enumerate(shares):
        for k in range(per_share):
            which = (k + s) % len(kinds)
            if which not in made:
                made[which] = kinds[which]()
            yield make_pair(made[which], share, np.random.default_rng([seed, int(100 * share), k]))

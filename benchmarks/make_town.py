#!/usr/bin/env python3
"""Write a pair of colored maps of one synthetic town: DIR/reference.ply and DIR/estimate.ply (binary, float xyz, uchar rgb).

The scene has undulating ground, streets, houses with windows and gable roofs, trees and cars; its area grows with the number of points
(40 points per square meter of plan: 10 million points cover 500 m x 500 m). The reference is one sampling with 5 mm noise. The estimate is
another sampling with 3 cm noise and the defects of Defects, printed as JSON.
"""
import argparse
import json
import os
from dataclasses import asdict, dataclass

import numpy as np

F = np.float32
POINTS_PER_M2 = 40.0
STREET_M = 6.0
SIDEWALK_M = 1.5


@dataclass
class Defects:
    """What is wrong with the estimate; lengths in meters."""
    side: float = 0.0
    noise_sigma: float = 0.03
    color_noise_sigma_8bit: float = 4.0
    missing_share: float = 0.10           # one square hole in each of holes_per_side^2 parts of the map
    holes_per_side: int = 1
    outlier_share: float = 0.015          # of the points asked for; half near (1 m Gaussian), half in the air, 90 to 150 m up
    facade_shift: float = 0.15            # the -y facade of one house, outward
    shifted_house: int = -1
    cast_center: tuple = ()
    cast_radius: float = 0.0
    cast_gains: tuple = (1.25, 1.0, 0.75)
    blur_center: tuple = ()
    blur_radius: float = 0.0
    blur_voxel: float = 1.0               # colors replaced by their mean per voxel


class Scene:
    """Houses on a square grid of blocks, trees along the sidewalks, cars along the streets; all from one seed."""

    def __init__(self, side, seed):
        rng = np.random.default_rng([seed, 0])
        self.side, self.blocks = side, max(1, round(side / 22.0))
        self.pitch = side / self.blocks
        n = self.blocks**2
        cell = np.stack(np.divmod(np.arange(n), self.blocks), axis=1)
        room = max(self.pitch - STREET_M - 2 * SIDEWALK_M - 2.0, 2.0)
        self.half = (rng.uniform(0.55, 0.95, (n, 2)) * room / 2).astype(F)
        self.center = ((cell + 0.5) * self.pitch).astype(F)
        self.eave = rng.uniform(5.0, 16.0, n).astype(F)
        self.slope = rng.uniform(0.2, 0.6, n).astype(F)
        self.wall_color = rng.uniform((130, 110, 80), (235, 215, 190), (n, 3)).astype(F)
        self.roof_color = rng.uniform((110, 50, 35), (190, 95, 80), (n, 3)).astype(F)
        self.waves = rng.uniform((0.05, -0.1, 0, 0.15), (0.1, 0.1, 6.3, 0.5), (4, 4)).astype(F)
        self.place_trees(rng, max(2, int(side**2 / 120)))
        self.place_cars(rng, max(2, int(side**2 / 250)))

    def place_trees(self, rng, n):
        line = rng.integers(0, self.blocks, n) * self.pitch + STREET_M / 2 + SIDEWALK_M
        self.tree = np.stack([line, rng.uniform(2, self.side - 2, n)], axis=1).astype(F)
        self.crown = rng.uniform(0.9, 1.9, n).astype(F)
        self.tree_color = rng.uniform((35, 70, 20), (95, 140, 60), (n, 3)).astype(F)

    def place_cars(self, rng, n):
        lane = rng.integers(0, self.blocks, n) * self.pitch + rng.choice([-1.9, 1.9], n)
        self.car = np.stack([np.abs(lane), rng.uniform(3, self.side - 3, n)], axis=1).astype(F)
        self.car_color = rng.uniform(20, 240, (n, 3)).astype(F)

    def ground(self, x, y):
        """Height of the ground: four waves of 40 to 120 m."""
        z = np.zeros_like(x)
        for kx, ky, phase, amplitude in self.waves:
            z += amplitude * np.sin(kx * x + ky * y + phase)
        return z


def noise(u, v, wave):
    """Smooth texture in about [-1, 1] with features of size wave."""
    k = F(6.2832 / wave)
    return (np.sin(k * (u + F(0.3) * v)) * np.sin(k * (F(1.13) * v - F(0.2) * u)) + F(0.5) * np.sin(F(2.7) * k * (v + F(0.7) * u))) / F(1.5)


def shade(base, factor):
    """Colors base (n x 3 or 3) times factor (n)."""
    return np.asarray(base, F) * factor[:, None].astype(F)


def choose(rng, weights, n):
    """n indices with probabilities proportional to weights."""
    cumulative = np.cumsum(weights, dtype=np.float64)
    return np.minimum(np.searchsorted(cumulative, rng.random(n) * cumulative[-1]), len(weights) - 1)


def ground_colors(scene, x, y):
    """Asphalt with lane marks, sidewalk, or grass, by the distance from the nearest street axis."""
    along_x, along_y = (np.abs((c + scene.pitch / 2) % scene.pitch - scene.pitch / 2) for c in (x, y))
    axis = np.minimum(along_x, along_y)
    color = shade((85, 125, 55), 1 + F(0.25) * noise(x, y, 2.3) + F(0.15) * noise(x, y, 0.4))
    pavement = axis < STREET_M / 2 + SIDEWALK_M
    color[pavement] = shade((165, 160, 150), 1 + F(0.08) * noise(x, y, 0.9))[pavement]
    street = axis < STREET_M / 2
    color[street] = shade((72, 72, 76), 1 + F(0.15) * noise(x, y, 1.1))[street]
    dash = np.where(along_x < along_y, y, x) % 4 < 2
    color[(axis < 0.1) & dash] = (225, 225, 215)
    return color


def sample_top(scene, rng, n):
    """Ground and roofs: uniform in plan."""
    x, y = rng.random((2, n), F) * F(scene.side)
    z, color = scene.ground(x, y), ground_colors(scene, x, y)
    block = np.minimum((np.stack([x, y]) / scene.pitch).astype(np.int32), scene.blocks - 1)
    house = block[0] * scene.blocks + block[1]
    u, v = x - scene.center[house, 0], y - scene.center[house, 1]
    roof = np.flatnonzero((np.abs(u) < scene.half[house, 0]) & (np.abs(v) < scene.half[house, 1]))
    h, u, v = house[roof], u[roof], v[roof]
    z[roof] = house_base(scene)[h] + scene.eave[h] + scene.slope[h] * (scene.half[h, 0] - np.abs(u))
    light = np.where(u > 0, F(1.1), F(0.8))
    color[roof] = scene.roof_color[h] * (light * (1 + F(0.2) * np.sin(F(15.7) * u) + F(0.1) * noise(u, v, 1.7)))[:, None]
    return np.stack([x, y, z], axis=1), color, np.full(n, -1, np.int32)


def house_base(scene):
    """Ground height below each house's center."""
    return scene.ground(scene.center[:, 0], scene.center[:, 1])


def wall_colors(scene, house, u, v, side):
    """Plaster with courses of brick; windows of 1.2 m x 1.4 m every 2.4 m x 3 m, with frames."""
    light = np.array([0.7, 1.1, 0.85, 1.0], F)[side]
    color = scene.wall_color[house] * (light * (1 + F(0.1) * noise(u, v, 1.3) + F(0.06) * np.sin(F(25.1) * v)))[:, None]
    du, dv = np.abs(u % F(2.4) - F(1.2)), np.abs((v - 1) % F(3) - F(1.0))
    frame = (du < 0.7) & (dv < 0.8) & (v > 1)
    color[frame] = (230, 228, 220)
    glass = (du < 0.6) & (dv < 0.7) & (v > 1)
    color[glass] = shade((45, 60, 85), 1 + F(0.5) * noise(u, v, 1.9))[glass]
    return color


def sample_walls(scene, rng, n):
    """Facades: sides 0 (-x), 1 (+x), 2 (-y), 3 (+y); the last result is 4 house + side."""
    width = 2 * scene.half[:, [1, 1, 0, 0]]
    wall = choose(rng, (width * (scene.eave[:, None] + 1)).ravel(), n)
    house, side = np.divmod(wall.astype(np.int32), 4)
    u = rng.random(n, F) * width.ravel()[wall]
    v = rng.random(n, F) * (scene.eave[house] + 1) - 1
    across, out = u - width.ravel()[wall] / 2, np.where(side % 2 == 0, F(-1), F(1))
    along_y = side < 2
    x = scene.center[house, 0] + np.where(along_y, out * scene.half[house, 0], across)
    y = scene.center[house, 1] + np.where(along_y, across, out * scene.half[house, 1])
    return np.stack([x, y, house_base(scene)[house] + v], axis=1), wall_colors(scene, house, u, v, side), wall.astype(np.int32)


def sample_trees(scene, rng, n):
    """Crowns: rough spheres 4 m up; trunks: cylinders of 0.2 m."""
    tree = choose(rng, scene.crown**2, n)
    direction = rng.standard_normal((n, 3), F)
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    radius = scene.crown[tree] * (F(0.8) + F(0.2) * rng.random(n, F))
    p = direction * radius[:, None]
    color = scene.tree_color[tree] * (1 + F(0.35) * direction[:, 2] + F(0.3) * noise(p[:, 0] + p[:, 2], p[:, 1], 0.5))[:, None]
    p[:, 2] += 4
    trunk = np.flatnonzero(rng.random(n, F) < 0.08)
    angle = rng.random(len(trunk), F) * F(6.2832)
    p[trunk] = np.stack([F(0.2) * np.cos(angle), F(0.2) * np.sin(angle), rng.random(len(trunk), F) * F(3.2)], axis=1)
    color[trunk] = shade((95, 70, 45), 1 + F(0.2) * np.sin(F(9) * angle))
    x, y = scene.tree[tree].T
    return p + np.stack([x, y, scene.ground(x, y)], axis=1), color, np.full(n, -1, np.int32)


def sample_cars(scene, rng, n):
    """Boxes of 1.8 m x 4.2 m x 1.4 m without a floor, dark windows in the upper part."""
    car = rng.integers(0, len(scene.car), n)
    size = np.array([1.8, 4.2, 1.4], F)
    p = rng.random((n, 3), F)
    face = choose(rng, [size[1] * size[2]] * 2 + [size[0] * size[2]] * 2 + [size[0] * size[1]], n)
    for f, (axis, value) in enumerate([(0, 0), (0, 1), (1, 0), (1, 1), (2, 1)]):
        p[face == f, axis] = value
    light = np.array([0.8, 1.05, 0.9, 0.95, 1.15], F)[face]
    color = scene.car_color[car] * light[:, None]
    color[(face < 4) & (p[:, 2] > 0.6) & (p[:, 2] < 0.9)] = (30, 35, 45)
    x, y = scene.car[car].T
    p = (p - np.array([0.5, 0.5, 0], F)) * size
    return p + np.stack([x, y, scene.ground(x, y) + F(0.2)], axis=1), color, np.full(n, -1, np.int32)


def sample_scene(scene, rng, n):
    """n points shared among the kinds of surface by area: (points, colors 0..255 float, wall or -1)."""
    wall_area = np.sum(4 * scene.half.sum(axis=1) * (scene.eave + 1))
    area = np.array([scene.side**2, wall_area, np.sum(4 * np.pi * scene.crown**2), len(scene.car) * 24.4])
    counts = (n * area / area.sum()).astype(int)
    counts[0] += n - counts.sum()
    kinds = sample_top, sample_walls, sample_trees, sample_cars
    parts = [kind(scene, rng, count) for kind, count in zip(kinds, counts)]
    return [np.concatenate(column) for column in zip(*parts)]


def inside_disc(points, center, radius):
    return (points[:, 0] - F(center[0])) ** 2 + (points[:, 1] - F(center[1])) ** 2 < radius**2


def missing(points, d):
    """Points in the holes: squares around (0.75, 0.25) of each part of the map."""
    part = d.side / d.holes_per_side
    local = (points[:, :2] % F(part)) / F(part) - np.array([0.75, 0.25], F)
    return np.abs(local).max(axis=1) < np.sqrt(d.missing_share) / 2


def blur_colors(points, colors, voxel):
    """Each color becomes the mean of its voxel."""
    cells = np.floor(points / voxel).astype(np.int64) + 1000
    _, group, count = np.unique((cells * (1, 20000, 400000000)).sum(axis=1), return_inverse=True, return_counts=True)
    return np.stack([(np.bincount(group, colors[:, k]) / count)[group] for k in range(3)], axis=1)


def outliers(points, rng, n, side):
    """Half near: 1 m Gaussian about points of the map. Half far: 90 to 150 m up. Random colors."""
    near = points[rng.integers(0, len(points), n - n // 2)] + rng.standard_normal((n - n // 2, 3), F)
    far = rng.random((n // 2, 3), F) * np.array([side, side, 60], F) + np.array([0, 0, 90], F)
    return np.concatenate([near, far]), rng.random((n, 3), F) * 255


def make_reference(scene, rng, n):
    points, colors, _ = sample_scene(scene, rng, n)
    return points + F(0.005) * rng.standard_normal((n, 3), F), colors + F(2) * rng.standard_normal((n, 3), F)


def make_estimate(scene, rng, n, d):
    points, colors, wall = sample_scene(scene, rng, n)
    points[wall == 4 * d.shifted_house + 2, 1] -= F(d.facade_shift)
    keep = ~missing(points, d)
    points, colors = points[keep], colors[keep]
    cast = inside_disc(points, d.cast_center, d.cast_radius)
    colors[cast] *= np.array(d.cast_gains, F)
    blur = inside_disc(points, d.blur_center, d.blur_radius)
    colors[blur] = blur_colors(points[blur], colors[blur], d.blur_voxel)
    points += F(d.noise_sigma) * rng.standard_normal(points.shape, F)
    colors += F(d.color_noise_sigma_8bit) * rng.standard_normal(points.shape, F)
    extra, extra_colors = outliers(points, rng, round(d.outlier_share * n), d.side)
    return np.concatenate([points, extra]), np.concatenate([colors, extra_colors])


def plan_defects(scene):
    """Where the defects are: cast lower left, hole lower right, shifted facade upper left, blur upper right."""
    s = scene.side
    house = int(np.argmin(np.abs(scene.center - np.array([0.25 * s, 0.75 * s], F)).sum(axis=1)))
    return Defects(side=s, holes_per_side=max(1, round(s / 100)), shifted_house=house, cast_center=(0.25 * s, 0.25 * s),
                   cast_radius=0.15 * s, blur_center=(0.75 * s, 0.75 * s), blur_radius=0.15 * s)


def tile_order(points, side):
    """Order by 10 m tiles, back and forth, and by 2 m cells in each tile."""
    tiles = int(side / 10) + 1
    cell = np.clip(points[:, :2] / 2, 0, 5 * tiles - 1).astype(np.int32)
    tile, sub = cell // 5, cell % 5
    column = np.where(tile[:, 1] % 2 == 0, tile[:, 0], tiles - 1 - tile[:, 0])
    key = (tile[:, 1] * tiles + column) * 25 + sub[:, 1] * 5 + sub[:, 0]
    return np.argsort(key.astype(np.uint16) if 25 * tiles**2 < 65536 else key, kind="stable")


def write_ply(path, points, colors):
    vertices = np.empty(len(points), [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("red", "u1"), ("green", "u1"), ("blue", "u1")])
    for k, name in enumerate("xyz"):
        vertices[name] = points[:, k]
    for k, name in enumerate(("red", "green", "blue")):
        vertices[name] = np.clip(np.rint(colors[:, k]), 0, 255)
    fields = "".join("property float %s\n" % n for n in "xyz") + "".join("property uchar %s\n" % n for n in ("red", "green", "blue"))
    with open(path, "wb") as stream:
        header = "ply\nformat binary_little_endian 1.0\nelement vertex %d\n%send_header\n" % (len(points), fields)
        stream.write(header.encode("ascii"))
        vertices.tofile(stream)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, required=True, help="points of the reference; the estimate has about 0.92 times as many")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", required=True, help="folder to write to")
    parser.add_argument("--shuffle", action="store_true", help="random order in place of tile order")
    parser.add_argument("--spread", type=float, metavar="M", help="side of the map in meters in place of the one by density")
    args = parser.parse_args()
    side = args.spread or float(np.sqrt(args.points / POINTS_PER_M2))
    scene = Scene(side, args.seed)
    defects = plan_defects(scene)
    os.makedirs(args.out, exist_ok=True)
    for stream, name in ((1, "reference"), (2, "estimate")):
        rng = np.random.default_rng([args.seed, stream])
        cloud = make_reference(scene, rng, args.points) if stream == 1 else make_estimate(scene, rng, args.points, defects)
        order = rng.permutation(len(cloud[0])) if args.shuffle else tile_order(cloud[0], side)
        write_ply(os.path.join(args.out, name + ".ply"), cloud[0][order], cloud[1][order])
    print(json.dumps(asdict(defects), indent=1))


if __name__ == "__main__":
    main()

"""The planted defects: each makes an exact estimate worse by a size that grows."""
from dataclasses import dataclass

import numpy as np

import scenes
from neighbors import cell_keys, nearest, neighborhood_means

SIDEWARD = np.array([1, 1, 0]) / np.sqrt(2)


@dataclass
class Defect:
    """What is done in which sizes."""
    make: callable  # points, colors, size, random numbers -> points, colors, of which those above 1 are cut when they are written
    sizes: list
    unit: str
    title: str


def half(points):
    """The points of the farther half along x."""
    return points[:, 0] > (points[:, 0].min() + points[:, 0].max()) / 2


def shuffled(points, colors, size, rng):
    """A permutation within cubes of that edge, which begin anywhere."""
    keys = cell_keys(points + rng.uniform(0, size, 3), size)
    before = np.lexsort((rng.random(len(keys)), keys))
    made = np.empty_like(colors)
    made[np.argsort(keys, kind="stable")] = colors[before]
    return points, made


def one_color(points, colors, size, rng):
    """The mean color, of that share of the points."""
    return points, np.where((rng.random(len(points)) < size / 100)[:, None], colors.mean(axis=0), colors)


def color_noise(points, colors, size, rng):
    """Of that sigma on each channel of 0 to 1."""
    return points, colors + size * rng.standard_normal(colors.shape)


def blurred(points, colors, size, rng):
    """The mean within about that radius."""
    return points, neighborhood_means(points, colors, size)


def exposure(points, colors, size, rng):
    """One half brighter."""
    return points, np.where(half(points)[:, None], colors * (1 + size / 100), colors)


def bleeding(points, colors, size, rng):
    """The color of the point that far aside, so that colors spill over borders."""
    return points, colors[nearest(points, points + size * SIDEWARD, 1.01 * size)]


def geometric_noise(points, colors, size, rng):
    """Of that sigma on each coordinate."""
    return points + size * rng.standard_normal(points.shape), colors


def double_wall(points, colors, size, rng):
    """One half a second time, that far aside."""
    copied = half(points)
    return np.concatenate([points, points[copied] + size * SIDEWARD]), np.concatenate([colors, colors[copied]])


def holes(points, colors, size, rng):
    """One square hole in each quarter of the plan."""
    low, extent = points[:, :2].min(axis=0), np.ptp(points[:, :2], axis=0)
    place = (points[:, :2] - low) / extent % 0.5 - 0.25
    keep = np.abs(place).max(axis=1) > np.sqrt(size / 100) / 4
    return points[keep], colors[keep]


def drift(points, colors, size, rng):
    """Bends the map along x, by the size at its far end."""
    x = (points[:, :1] - points[:, 0].min()) / np.ptp(points[:, 0])
    return points + size * x**2 * np.array([0, 1, 0]), colors


def thinned(points, colors, size, rng):
    """That many times fewer points."""
    keep = rng.permutation(len(points))[:int(len(points) / size)]
    return points[keep], colors[keep]


def densified_by(jitter_m):
    """Copies of every point, with this jitter in space."""

    def make(points, colors, size, rng):
        copies = [points] + [points + jitter_m * rng.standard_normal(points.shape) for _ in range(int(size) - 1)]
        return np.concatenate(copies), np.tile(colors, (int(size), 1))

    return make


LENGTHS = [0.01, 0.02, 0.05, 0.1, 0.2]


def planted(scene):
    """All of them by id, with the lengths of that scene."""
    length_factor = scenes.SCENES[scene].length_factor
    lengths = [round(length_factor * size, 3) for size in LENGTHS]
    far = [0.1, 0.2, 0.5, 1, 2, 5]
    return {
        "shuffled": Defect(shuffled, far, "m", "colors shuffled"),
        "one_color": Defect(one_color, [10, 20, 40, 70, 100], "%", "one color"),
        "color_noise": Defect(color_noise, [0.02, 0.05, 0.1, 0.2, 0.4], "RGB", "color noise"),
        "blurred": Defect(blurred, far[:-1], "m", "colors blurred"),
        "exposure": Defect(exposure, [5, 10, 20, 30, 40], "%", "exposure step"),
        "bleeding": Defect(bleeding, lengths, "m", "color bleeding"),
        "noise": Defect(geometric_noise, lengths, "m", "geometric noise"),
        "double_wall": Defect(double_wall, lengths, "m", "double walls"),
        "drift": Defect(drift, lengths, "m", "drift"),
        "holes": Defect(holes, [2, 5, 10, 20, 40], "%", "holes"),
        "thinned": Defect(thinned, [2, 4, 8, 16], "times", "thinned"),
        "densified": Defect(densified_by(0.02 * length_factor), [2, 4, 8], "times", "densified"),
    }

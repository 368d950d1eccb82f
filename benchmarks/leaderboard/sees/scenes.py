"""The scenes of the experiment: a furnished room made here and a street of benchmarks/make_town.py.

A scene is sampled as often as asked, each time with other points: (points n x 3 in meters, colors n x 3 in [0, 1], both double).
"""
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import make_town  # noqa: E402

NOISE_M = 0.003  # of every sampled point, across and along the surface


@dataclass
class Scene:
    """How many points there are on it, how far its defects reach, and how its maps are evaluated."""
    sample: callable
    points: int
    length_factor: float  # defects in meters are this many times those of the room
    preset: str
    lcr_radius_m: float   # the preset's
    threshold_m: float    # that of accuracy, fitness, completeness and F-score which is shown
    has_entropy: bool     # whether points have ten neighbors within 0.1 m


# Name, corner, two edges (m), color, and how the color varies: the size of its features (m), how much, and the width of planks or books.
ROOM = [
    ("floor", (0, 0, 0), (4, 0, 0), (0, 3.2, 0), (0.52, 0.36, 0.22), 0.30, 0.15, 0.15),
    ("ceiling", (0, 0, 2.4), (4, 0, 0), (0, 3.2, 0), (0.88, 0.87, 0.84), 1.50, 0.04, 0.0),
    ("wall", (0, 0, 0), (0, 3.2, 0), (0, 0, 2.4), (0.80, 0.76, 0.66), 0.50, 0.06, 0.0),
    ("wall", (4, 0, 0), (0, 3.2, 0), (0, 0, 2.4), (0.62, 0.70, 0.72), 0.50, 0.06, 0.0),
    ("wall", (0, 0, 0), (4, 0, 0), (0, 0, 2.4), (0.80, 0.76, 0.66), 0.50, 0.06, 0.0),
    ("wall", (0, 3.2, 0), (4, 0, 0), (0, 0, 2.4), (0.74, 0.70, 0.62), 0.40, 0.10, 0.0),
    ("rug", (1.2, 0.8, 0.01), (1.8, 0, 0), (0, 1.3, 0), (0.62, 0.14, 0.12), 0.12, 0.45, 0.0),
    ("picture", (0.8, 0.01, 1.2), (0.9, 0, 0), (0, 0, 0.7), (0.25, 0.45, 0.70), 0.15, 0.60, 0.0),
    ("picture", (2.3, 0.01, 1.1), (0.6, 0, 0), (0, 0, 0.8), (0.75, 0.60, 0.15), 0.10, 0.60, 0.0),
    ("window", (3.99, 0.9, 1.0), (0, 1.4, 0), (0, 0, 1.1), (0.93, 0.96, 0.98), 0.80, 0.05, 0.0),
    ("books", (0.6, 2.9, 0.1), (2.4, 0, 0), (0, 0, 0.5), (0.45, 0.40, 0.38), 0.08, 0.20, 0.04),
    ("books", (0.6, 2.9, 0.7), (2.4, 0, 0), (0, 0, 0.5), (0.40, 0.36, 0.42), 0.08, 0.20, 0.05),
    ("shelf", (0.6, 2.9, 1.25), (2.4, 0, 0), (0, 0.3, 0), (0.45, 0.30, 0.18), 0.30, 0.15, 0.0),
]
BOXES = [
    ("sofa", (0.05, 0.5, 0.0), (0.8, 1.8, 0.45), (0.20, 0.30, 0.26), 0.06, 0.15),
    ("sofa's back", (0.05, 0.5, 0.45), (0.25, 1.8, 0.4), (0.20, 0.30, 0.26), 0.06, 0.15),
    ("table", (1.7, 1.2, 0.38), (0.9, 0.6, 0.05), (0.72, 0.55, 0.36), 0.20, 0.15),
    ("cabinet", (3.45, 2.3, 0.0), (0.5, 0.8, 1.1), (0.86, 0.85, 0.83), 0.40, 0.05),
    ("lamp", (3.55, 2.5, 1.1), (0.2, 0.2, 0.35), (0.95, 0.80, 0.45), 0.20, 0.10),
]


def faces(corner, size):
    """Corner and edges of the six sides of a box."""
    corner, edges = np.array(corner, float), np.diag(size)
    for axis in range(3):
        u, v = np.delete(edges, axis, axis=0)
        yield corner, u, v
        yield corner + edges[axis], u, v


def rectangles():
    """All of the room, as ROOM has them; the sides of a box differ in light."""
    made = list(ROOM)
    for name, corner, size, color, wave, strength in BOXES:
        for light, (at, u, v) in zip((0.7, 1.0, 0.8, 0.9, 0.6, 1.1), faces(corner, size)):
            made.append((name, at, u, v, np.multiply(color, light), wave, strength, 0.0))
    return made


def strip_colors(u, width, seed):
    """One color for each plank or book, around 1."""
    strip = np.floor(u / width).astype(int)
    return np.random.default_rng(seed).uniform(0.6, 1.5, (strip.max() + 1, 3))[strip]


def sample_room(rng, n):
    """n points, uniform over the area of all rectangles."""
    parts, points, colors = rectangles(), [], []
    areas = [np.linalg.norm(np.cross(u, v)) for _, _, u, v, *_ in parts]
    chosen = make_town.choose(rng, areas, n)
    for k, (_, corner, u, v, color, wave, strength, width) in enumerate(parts):
        a, b = rng.random((2, np.sum(chosen == k)))
        points.append(corner + np.outer(a, u) + np.outer(b, v))
        along, across = a * np.linalg.norm(u), b * np.linalg.norm(v)
        tint = strip_colors(along, width, k) if width else 1.0
        shade = 1 + strength * make_town.noise(along, across, wave) + 0.1 * make_town.noise(along, across, 3.0)
        colors.append(np.array(color) * shade[:, None] * tint)
    return with_noise(rng, np.concatenate(points), np.concatenate(colors))


def with_noise(rng, points, colors):
    """What a good sensor adds, in any order."""
    order = rng.permutation(len(points))
    points = points[order] + NOISE_M * rng.standard_normal(points.shape)
    return points, np.clip(colors[order] + 0.01 * rng.standard_normal(colors.shape), 0, 1)


def sample_street(rng, n):
    """Four blocks of a town, 40 points a square meter of plan."""
    town = make_town.Scene(float(np.sqrt(n / make_town.POINTS_PER_M2)), seed=2)
    points, colors, _ = make_town.sample_scene(town, rng, n)
    return with_noise(rng, points.astype(float), colors / 255.0)


SCENES = {
    "room": Scene(sample_room, 50000, 1.0, "indoor", 0.05, 0.02, True),
    "street": Scene(sample_street, 50000, 5.0, "outdoor", 0.25, 0.1, False),
}


def sample(name, seed, what, share=1.0):
    """One sampling: what is 1 for the reference, 2 for the estimate; share of the scene's points, for quick versions."""
    scene = SCENES[name]
    return scene.sample(np.random.default_rng([seed, what]), int(scene.points * share))


def write(path, points, colors):
    """As binary PLY with colors of 8 bit."""
    make_town.write_ply(path, points, 255 * colors)

#!/usr/bin/env python3
"""A map before and after its loops were closed, from above and as a slice through its walls.

    benchmarks/loops/pictures.py FOLDER     # with before.ply and after.ply of loops_hall_benchmark

Makes FOLDER/plan.png (all of it) and FOLDER/walls.png (places where walls were double, 1 cm a pixel). Needs numpy and Pillow.
"""
import argparse
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw


def read_points(path):
    """Of a binary PLY with float x y z alone."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    return np.frombuffer(data, np.float32, offset=end).reshape(-1, 3)


def density(points, low, high, pixel_m):
    """Points per pixel as a gray picture, dark where there are many; y is up."""
    size = np.ceil((high - low) / pixel_m).astype(int)
    index = np.floor((points[:, :2] - low) / pixel_m).astype(int)
    index = index[((index >= 0) & (index < size)).all(axis=1)]
    counts = np.zeros((size[1], size[0]))
    np.add.at(counts, (size[1] - 1 - index[:, 1], index[:, 0]), 1.0)
    bright = np.percentile(counts[counts > 0], 98) if counts.any() else 1.0
    return Image.fromarray((255 * (1 - np.minimum(counts / bright, 1) ** 0.5)).astype(np.uint8))


def side_by_side(pictures, names, scale=1):
    gap, title = 12, 22
    pictures = [p.resize((p.width * scale, p.height * scale), Image.NEAREST) for p in pictures]
    out = Image.new("L", (sum(p.width for p in pictures) + gap * (len(pictures) - 1), pictures[0].height + title), 255)
    x = 0
    for picture, name in zip(pictures, names):
        out.paste(picture, (x, title))
        ImageDraw.Draw(out).text((x + 4, 5), name, fill=0)
        x += picture.width + gap
    return out


def double_walls(before, after, slab, side_m=2.0, n=4):
    """Squares where closing the loops took most of the occupied 2 cm cells away."""
    def cells(points):
        fine = np.unique(np.floor(points[slab(points)][:, :2] / 0.02).astype(int), axis=0)
        squares, counts = np.unique(np.floor(fine * 0.02 / side_m).astype(int), axis=0, return_counts=True)
        return {tuple(s): c for s, c in zip(squares, counts)}

    old, new = cells(before), cells(after)
    gain = sorted(((old[s] - new.get(s, 0)) / old[s] * old[s] ** 0.5, s) for s in old if old[s] > 400)
    return [np.array(s) * side_m for _, s in reversed(gain[-n:])]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    before, after = (read_points(folder / f"{name}.ply") for name in ("before", "after"))
    low, high = np.percentile(after[:, :2], [0.5, 99.5], axis=0)

    def slab(points):  # walls and columns, no floor
        return (points[:, 2] > 0.0) & (points[:, 2] < 2.5)

    plan = [density(p[slab(p)], low, high, 0.05) for p in (before, after)]
    side_by_side(plan, ["before", "after"]).save(folder / "plan.png")
    rows = []
    for corner in double_walls(before, after, slab):
        pictures = [density(p[slab(p)], corner, corner + 2.0, 0.01) for p in (before, after)]
        at = f"2 m at x {corner[0]:.0f}, y {corner[1]:.0f}"
        rows.append(side_by_side(pictures, [f"before: {at}", "after"], 2))
    out = Image.new("L", (rows[0].width, sum(r.height for r in rows)), 255)
    for i, row in enumerate(rows):
        out.paste(row, (0, i * rows[0].height))
    out.save(folder / "walls.png")


main()

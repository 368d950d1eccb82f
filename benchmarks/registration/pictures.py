#!/usr/bin/env python3
"""The pictures of docs/cmap_align.md: what a determined, an ambiguous and an unsupported alignment look like.

    benchmarks/registration/pictures.py build/release/tools/cmap_align FOLDER
"""
import argparse
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from scenes import Town, inside, make_pair, rotation


def equal_houses(rng):
    """A row of equal houses on flat ground, 96 m by 40 m."""
    ground = np.column_stack([rng.uniform(0, 96, 30_000), rng.uniform(0, 40, 30_000), np.zeros(30_000)])
    parts = [ground]
    for west in np.arange(4.0, 96.0, 12.0):
        n = 4000
        u, v = rng.random((2, n))
        side = rng.integers(0, 5, n)
        x = np.select([side == 0, side == 1], [0.0, 8.0], 8.0 * u)
        y = np.select([side == 2, side == 3], [0.0, 12.0], np.where(side < 2, 12.0 * u, 12.0 * v))
        z = np.where(side == 4, 6.0, 6.0 * v)
        parts.append(np.column_stack([west + x, 14.0 + y, z]))
    return np.concatenate(parts) + 0.02 * rng.standard_normal((sum(map(len, parts)), 3))


def row_of_houses():
    """The target shows six houses, the source three of them."""
    rng = np.random.default_rng(3)
    target = inside(equal_houses(rng), [48.0, 20.0], np.array([36.0, 20.0]))
    source = inside(equal_houses(rng), [42.0, 20.0], np.array([18.0, 20.0]))
    moved = (source - [42.0, 20.0, 0.0]) @ rotation([0, 0, 1], 1.0).T + [10.0, 5.0, 1.0]
    return moved.astype(np.float32), target.astype(np.float32)


def town(share, seed):
    pair = make_pair(Town(seed), share, np.random.default_rng(seed))
    return pair.source, pair.target


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("folder", type=Path)
    args = parser.parse_args()
    pairs = {"determined": town(0.4, 5), "ambiguous": row_of_houses(), "unsupported": town(0.0, 5)}
    for verdict, (source, target) in pairs.items():
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            np.save(folder / "source.npy", source)
            np.save(folder / "target.npy", target)
            subprocess.run([args.program.resolve(), folder / "source.npy", folder / "target.npy", "--method", "global",
                            "--allow-unconverged", "--figure", args.folder.resolve() / f"alignment_{verdict}.jpg"], check=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""The modules stand as the picture of docs/ARCHITECTURE.md has them: each includes public headers of modules below it, or before
it on its floor, and private headers of its own folder. CTest sets CMAP_SOURCE_DIR."""

import os
import re
import unittest
from pathlib import Path

SOURCE = Path(os.environ["CMAP_SOURCE_DIR"]).resolve()
CODE = (".hpp", ".cpp", ".inl", ".in")


def floors():
    """The picture's modules: floor and place on it by name."""
    picture = (SOURCE / "docs/ARCHITECTURE.md").read_text().split("```")[1]
    found, floor = {}, None
    for line in picture.splitlines():
        if number := re.match(r"(?: floor|      ) (\d) ", line):
            floor = int(number[1])
        if floor is not None and (name := re.match(r"^.{10}([a-z]+) ", line)):
            found[name[1]] = (floor, len(found))
    return found


def includes(folder, pattern):
    """Files of the folder and what they include."""
    for path in sorted(folder.rglob("*")):
        if path.suffix in CODE:
            for header in re.findall(pattern, path.read_text(), re.M):
                yield path.relative_to(SOURCE), header


class Structure(unittest.TestCase):
    def setUp(self):
        self.floors = floors()

    def test_every_module_is_in_the_picture(self):
        modules = {folder.name for folder in (SOURCE / "lib").iterdir() if folder.is_dir()}
        self.assertEqual(modules, set(self.floors))

    def may_include(self, module, other):
        (floor, place), (other_floor, other_place) = self.floors[module], self.floors[other]
        return module == other or other_floor < floor or (other_floor == floor and other_place < place)

    def test_includes_go_down(self):
        for module in self.floors:
            for folder in (SOURCE / "lib" / module, SOURCE / "include/cmap" / module):
                for path, other in includes(folder, r'^#include "cmap/(\w+)/'):
                    self.assertTrue(self.may_include(module, other), f"{path} includes a header of {other}")

    def test_private_headers_are_of_the_own_module(self):
        for module in self.floors:
            for path, header in includes(SOURCE / "lib" / module, r'^#include "(?!cmap/)([^"]+)"'):
                places = (SOURCE / "lib" / module / header, (SOURCE / path).parent / header)
                self.assertTrue(any(place.exists() for place in places), f"{path} includes {header}")

    def test_public_headers_include_public_ones(self):
        for path, header in includes(SOURCE / "include", r'^#include "([^"]+)"'):
            made = ("cmap/core/version.hpp", "cmap/metrics/catalog.hpp")  # by CMake
            self.assertTrue((SOURCE / "include" / header).exists() or header in made, f"{path} includes {header}")


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""cmap_render --interactive in an X server without a screen, by mouse and keys; CTest sets CMAP_RENDER and
CMAP_SOURCE_DIR. Skipped where Xvfb or xdotool is missing."""

import os
import shutil
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np

from cmap_eval_testing import TOWN

PROGRAM = Path(os.environ["CMAP_RENDER"]).resolve()
WIDTH, HEIGHT = 800, 600
PATIENCE_S = 60


def screen(frame_buffer):
    """Rows x columns x (blue, green, red) of Xvfb's screen, a file of the X Window Dump format."""
    data = frame_buffer.read_bytes()
    header = np.frombuffer(data, ">u4", 25)
    size, width, height, bits, bytes_per_line, n_colors = (int(header[i]) for i in (0, 4, 5, 11, 12, 19))
    assert bits == 32
    rows = np.frombuffer(data, np.uint8, height * bytes_per_line, size + 12 * n_colors)
    return rows.reshape(height, bytes_per_line)[:, : 4 * width].reshape(height, width, 4)[:, :, :3].astype(int)


@unittest.skipUnless(shutil.which("Xvfb") and shutil.which("xdotool"), "needs Xvfb and xdotool")
class Interactive(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        read, write = os.pipe()
        server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-fbdir", self.folder, "-screen", "0", f"{WIDTH}x{HEIGHT}x24"],
            pass_fds=[write],
            stderr=subprocess.DEVNULL,
        )
        self.addCleanup(server.wait)
        self.addCleanup(server.terminate)
        os.close(write)
        with os.fdopen(read) as pipe:
            # For sanitizers: the software renderer leaks some bytes where Mesa unloads it.
            self.environment = {**os.environ, "DISPLAY": f":{pipe.readline().strip()}", "ASAN_OPTIONS": "detect_leaks=0"}

    def open(self, *arguments):
        maps = TOWN / "reference.ply", TOWN / "estimate.ply"
        self.viewer = subprocess.Popen(
            [PROGRAM, *maps, "--interactive", "--quiet", "--size", f"{WIDTH}x{HEIGHT}", *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env=self.environment,
            cwd=self.folder,
        )
        self.addCleanup(self.viewer.communicate)
        self.addCleanup(self.viewer.kill)

    def screen(self):
        return screen(self.folder / "Xvfb_screen0")

    def do(self, *arguments):
        subprocess.run(["xdotool", *map(str, arguments)], env=self.environment, check=True, capture_output=True)

    def wait_for(self, what, is_so):
        """Until is_so(screen) holds and the screen has come to rest."""
        deadline = time.monotonic() + PATIENCE_S
        before = self.screen()
        while time.monotonic() < deadline:
            self.assertIsNone(self.viewer.poll(), "the viewer has ended")
            time.sleep(0.4)
            now = self.screen()
            if is_so(now) and np.array_equal(now, before):
                return now
            before = now
        self.fail(f"waited for {what} in vain")

    def wait_for_change(self, before, what):
        return self.wait_for(what, lambda now: not np.array_equal(now, before))

    def test_layers_points_and_the_end(self):
        self.open()
        middle = (slice(HEIGHT // 4, 3 * HEIGHT // 4), slice(WIDTH // 4, 3 * WIDTH // 4))
        first = self.wait_for("the map", lambda now: now[middle].std() > 20)
        self.do("mousemove", WIDTH // 2, HEIGHT // 2, "key", "3")
        recall = self.wait_for_change(first, "another layer")
        # Recalled points are blue (0, 114, 178), whatever their shade; red and blue exchanged they would be orange.
        blue, _, red = recall[middle].reshape(-1, 3).T
        self.assertGreater(np.mean(blue > red + 50), 0.2)
        self.do("key", "1")
        again = self.wait_for("the first layer", lambda now: np.array_equal(now, first))
        self.do("mousedown", 1, "mousemove_relative", 80, 20, "mouseup", 1)
        turned = self.wait_for_change(again, "a turned map")
        self.do("key", "r")
        self.wait_for("the first view", lambda now: np.array_equal(now, first))
        self.do("mousemove", WIDTH // 2, HEIGHT // 2, "click", 1)
        self.wait_for_change(first, "a point's values")
        self.do("key", "h")
        self.wait_for_change(turned, "help")
        self.do("key", "q")
        out, err = self.viewer.communicate(timeout=PATIENCE_S)
        self.assertEqual((self.viewer.returncode, err), (0, ""))
        lines = out.splitlines()
        self.assertEqual(lines[0], "point of the reference")
        x, y, _ = (float(lines[1].split()[i]) for i in (1, 3, 5))
        self.assertTrue(0 < x < 40 and 0 < y < 40, "in the middle of the town")
        self.assertIn("local color recall: ", lines[-1])

    def test_points_by_opengl(self):
        """Its context and the window's do not meet."""
        self.open("--renderer", "gl")
        first = self.wait_for("the map", lambda now: now.std() > 20)
        self.do("mousemove", WIDTH // 2, HEIGHT // 2, "mousedown", 1, "mousemove_relative", 80, 20, "mouseup", 1)
        self.wait_for_change(first, "a turned map")
        self.do("key", "q")
        self.assertEqual(self.viewer.wait(timeout=PATIENCE_S), 0)

    def test_saves_the_picture(self):
        self.open()
        self.wait_for("the map", lambda now: now.std() > 20)
        for number in (1, 2):
            self.do("key", "s")
            self.wait_for("a saved picture", lambda now: (self.folder / f"cmap_view_{number}.png").exists())
        self.assertEqual(*((self.folder / f"cmap_view_{n}.png").read_bytes() for n in (1, 2)))


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""cmap_render and cmap_eval --figure as a user runs them; CTest sets CMAP_RENDER, CMAP_EVAL and CMAP_SOURCE_DIR."""

import hashlib
import os
import shutil
import struct
import subprocess
import tempfile
import unittest
import zlib
from pathlib import Path

import numpy as np

from cmap_eval_testing import INPUT, PROGRAM as EVAL, SOURCE, TOWN, UNSUPPORTED, USAGE, hashes, ply

PROGRAM = Path(os.environ["CMAP_RENDER"]).resolve()
REFERENCE, ESTIMATE = TOWN / "reference.ply", TOWN / "estimate.ply"


def decoded(png):
    """Rows x columns x 4 of an 8-bit RGBA PNG, by the specification (PNG 3, 9.2: the five filters)."""
    width, height, bits, color, *_, interlaced = struct.unpack(">IIBBBBB", png[16:29])
    assert (bits, color, interlaced) == (8, 6, 0)
    chunks, place = b"", 8
    while place < len(png):
        length, kind = struct.unpack(">I4s", png[place : place + 8])
        chunks += png[place + 8 : place + 8 + length] if kind == b"IDAT" else b""
        place += length + 12
    rows = np.frombuffer(zlib.decompress(chunks), np.uint8).reshape(height, 1 + 4 * width)
    above = np.zeros(4 * width, np.int64)
    pixels = np.zeros((height, 4 * width), np.int64)
    for y, (kind, *bytes_) in enumerate(rows.tolist()):
        row = pixels[y]
        for x, value in enumerate(bytes_):
            left, upper = (row[x - 4] if x >= 4 else 0), above[x]
            corner = above[x - 4] if x >= 4 else 0
            paeth = min((left, upper, corner), key=lambda v: abs(left + upper - corner - v))
            row[x] = (value + (0, left, upper, (left + upper) // 2, paeth)[kind]) % 256
        above = row
    return pixels.reshape(height, width, 4)


class Render(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.picture = self.folder / "figure.png"

    def run_program(self, *arguments, program=PROGRAM, **variables):
        environment = {name: value for name, value in os.environ.items() if name != "DISPLAY"} | variables
        return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, env=environment)

    def draw(self, *arguments):
        result = self.run_program(*arguments, "-o", self.picture)
        self.assertEqual((result.returncode, result.stderr, result.stdout), (0, "", ""))
        return self.picture.read_bytes()

    def refused(self, code, says, *arguments, program=PROGRAM, **variables):
        result = self.run_program(*arguments, program=program, **variables)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertIn(says, result.stderr)
        self.assertNotIn("internal error", result.stderr)
        self.assertFalse(list(self.folder.glob("*.png")) + list(self.folder.glob(".*")))

    def test_inputs_are_never_overwritten(self):
        copy = self.folder / "map.jpg"
        copy.write_bytes(REFERENCE.read_bytes())
        before = hashes(self.folder)
        self.refused(USAGE, f"{copy}: would overwrite {copy}", copy, "-o", copy)
        self.assertEqual(hashes(self.folder), before)

    def test_the_options_of_a_layer_s_metric(self):
        """With a radius of 1 m more of the town is recalled than with 2 cm: other pictures."""
        wide, narrow = (
            self.draw(REFERENCE, ESTIMATE, "--panels", "lcr", "--lcr-radius", radius, "--size", "480x320")
            for radius in (1, 0.02)
        )
        self.assertNotEqual(wide, narrow)
        self.picture.unlink()
        self.refused(USAGE, "--lcr-tau: 0 must be above 0", REFERENCE, ESTIMATE, "-o", self.picture, "--lcr-tau", "0")

    def test_a_pair_without_a_display(self):
        png = self.draw(REFERENCE, ESTIMATE, "--quiet")
        self.assertEqual(png[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(struct.unpack(">II", png[16:24]), (1600, 1000))

    def test_the_same_bytes_for_any_number_of_threads(self):
        digests = {hashlib.sha256(self.draw(REFERENCE, ESTIMATE, "--threads", n)).hexdigest() for n in (1, 2, 2)}
        self.assertEqual(len(digests), 1)

    def test_the_town_looks_as_it_did(self):
        """Regression: the picture was looked at when it was stored. Versions of FreeType smooth letters differently, by
        up to 0.1 of 255 over the picture; red and blue exchanged are above 3."""
        stored = decoded((SOURCE / "tests/render/town_480x320.png").read_bytes())
        drawn = decoded(self.draw(REFERENCE, ESTIMATE, "--size", "480x320"))
        self.assertLess(np.abs(drawn - stored).mean(), 0.5)
        self.assertGreater(np.abs(drawn[:, :, [2, 1, 0, 3]] - stored).mean(), 3.0)

    def need_gl(self):
        result = self.run_program(REFERENCE, "-o", self.folder / "probe.png", "--renderer", "gl", "--size", "200x200")
        if result.returncode != 0:
            self.assertEqual(result.returncode, USAGE, result.stderr)
            self.skipTest(result.stderr.strip())
        (self.folder / "probe.png").unlink()
        return result.stderr

    def test_opengl_draws_the_same_picture(self):
        """Same squares, colors and letters. GPUs may round the place of a point in a thousand differently (llvmpipe:
        none); red and blue exchanged are above 3 of 255."""
        self.assertIn("cmap_render: draws by ", self.need_gl())
        by_splatter = decoded(self.draw(REFERENCE, ESTIMATE, "--size", "480x320"))
        by_gl = decoded(self.draw(REFERENCE, ESTIMATE, "--size", "480x320", "--renderer", "gl", "--quiet"))
        self.assertLess(np.abs(by_gl - by_splatter).mean(), 0.1)
        self.assertGreater(np.abs(by_gl[:, :, [2, 1, 0, 3]] - by_splatter).mean(), 3.0)

    def test_no_opengl(self):
        self.need_gl()
        nowhere = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent"}
        self.refused(
            USAGE, "no OpenGL device: EGL finds neither", REFERENCE, "-o", self.picture, "--renderer", "gl", **nowhere
        )

    def test_no_display(self):
        self.need_gl()
        for says, display in (("DISPLAY is not set", {}), ("display :9876 cannot be opened", {"DISPLAY": ":9876"})):
            self.refused(USAGE, says, REFERENCE, "--interactive", **display)

    def test_one_map(self):
        png = self.draw(REFERENCE, "--camera", "top", "--orthographic", "--size", "640x480", "--background", "transparent")
        self.assertEqual(struct.unpack(">II", png[16:24]), (640, 480))

    def test_pictures_name_files_and_no_folders(self):
        pictures = set()
        for name in ("ann", "a much longer home"):
            (self.folder / name).mkdir()
            copy = self.folder / name / "map.ply"
            copy.write_bytes(REFERENCE.read_bytes())
            pictures.add(self.draw(copy, "--size", "480x320"))
        self.assertEqual(len(pictures), 1)

    def test_jpeg(self):
        self.picture = self.folder / "figure.jpg"
        self.assertEqual(self.draw(REFERENCE)[:3], b"\xff\xd8\xff")

    def test_tiff(self):
        self.picture = self.folder / "figure.tif"
        self.assertEqual(self.draw(REFERENCE, "--size", "320x240")[:4], b"II*\0")

    def turn(self, name, *arguments):
        result = self.run_program(
            REFERENCE, ESTIMATE, "--size", "480x321", "--frames", "3", "--turntable", self.folder / name, *arguments
        )
        self.assertEqual((result.returncode, result.stderr, result.stdout), (0, "", ""))
        return self.folder / name

    def test_a_turntable_of_frames(self):
        frames = sorted(self.turn("turn").iterdir())
        self.assertEqual([frame.name for frame in frames], [f"frame_{i:04}.png" for i in range(3)])
        self.assertEqual(len({frame.read_bytes() for frame in frames}), 3)
        self.refused(USAGE, "turn: exists already", REFERENCE, "--turntable", self.folder / "turn")

    @unittest.skipUnless(shutil.which("ffmpeg"), "no ffmpeg")
    def test_videos(self):
        self.assertEqual(self.turn("turn.mp4").read_bytes()[4:8], b"ftyp")
        self.assertEqual(self.turn("turn.gif").read_bytes()[:6], b"GIF89a")
        for name in ("turn.mp4", "turn.gif"):
            again = self.turn(f"again_{name}", "--threads", 1)
            self.assertEqual((self.folder / name).read_bytes(), again.read_bytes(), "the same for any number of threads")
            frames = subprocess.run(
                ["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of", "csv=p=0", again],
                capture_output=True,
                text=True,
            )
            self.assertEqual(frames.stdout.strip(" ,\n"), "3")

    def test_turntables_that_cannot_be(self):
        for says, name in (
            ("turn.avi: a turntable is a video", "turn.avi"),
            ("none/turn: cannot be written", "none/turn"),
        ):
            self.refused(USAGE, says, REFERENCE, "--frames", 2, "--turntable", self.folder / name)
        result = subprocess.run(
            [PROGRAM, REFERENCE, "--turntable", self.folder / "turn.mp4"], capture_output=True, text=True, env={"PATH": "/none"}
        )
        self.assertEqual(result.returncode, USAGE)
        self.assertIn("apt-get install ffmpeg", result.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_wrong_usage(self):
        out = ("-o", self.picture)
        for says, *arguments in (
            ("--output is required", REFERENCE),
            ("none of top, oblique", REFERENCE, *out, "--camera", "back"),
            ("is not WIDTHxHEIGHT", REFERENCE, *out, "--size", "640"),
            ("is no picture", REFERENCE, *out, "--size", "0x480"),
            ("too large", REFERENCE, *out, "--size", "100000x480"),
            ("none of white", REFERENCE, *out, "--background", "red"),
            ("none of viridis", REFERENCE, *out, "--color-map", "jet"),
            ("LOW must be below HIGH", REFERENCE, ESTIMATE, *out, "--range", "1,0"),
            ("need a second map", REFERENCE, *out, "--panels", "lcr"),
            ('--renderer: "vulkan" is none of splat, gl', REFERENCE, *out, "--renderer", "vulkan"),
            ("key s saves pictures", REFERENCE, *out, "--interactive"),
            ('layer "colour" is unknown', REFERENCE, ESTIMATE, *out, "--panels", "colour"),
            ("figure.bmp: pictures are .png, .jpg or .tif", REFERENCE, "-o", self.folder / "figure.bmp"),
            ("none/figure.png: cannot be written", REFERENCE, "-o", self.folder / "none/figure.png"),
        ):
            with self.subTest(says):
                self.refused(USAGE, says, *arguments)

    def test_a_camera_file(self):
        camera = self.folder / "camera.json"
        camera.write_text('{"position_m": [0, -50, 50], "target_m": [10, 10, 0]}')
        self.draw(REFERENCE, "--camera", camera)
        self.picture.unlink()
        camera.write_text('{"position_m": [0, -50, 50], "target_m": [10, 10, 0], "zoom": 2}')
        self.refused(USAGE, f'{camera}: unknown key "zoom"', REFERENCE, "-o", self.picture, "--camera", camera)

    def test_the_figure_of_an_evaluation(self):
        png = self.draw(REFERENCE, ESTIMATE)
        result = self.run_program(REFERENCE, ESTIMATE, "--figure", self.picture, "--quiet", program=EVAL)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(self.picture.read_bytes(), png)

    def test_figures_that_cannot_be(self):
        for says, path in (
            ("pictures are .png, .jpg or .tif", self.folder / "figure.gif"),
            ("cannot be written", self.folder / "none/figure.png"),
        ):
            self.refused(USAGE, says, REFERENCE, ESTIMATE, "--figure", path, program=EVAL)

    def test_missing_map(self):
        self.refused(INPUT, "none.ply", self.folder / "none.ply", "-o", self.picture)

    def test_no_color(self):
        plain = self.folder / "plain.ply"
        plain.write_text(ply([(1, 2, 3)]))
        self.refused(UNSUPPORTED, "layer lcr", REFERENCE, plain, "-o", self.picture, "--panels", "lcr")
        self.draw(plain)
        self.draw(REFERENCE, plain)


if __name__ == "__main__":
    unittest.main()

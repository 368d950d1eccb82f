#!/usr/bin/env python3
"""When the table shows what its numbers are worth: in terminals that are wide enough, and where it is asked for."""

import fcntl
import os
import pty
import re
import struct
import subprocess
import termios
import unittest

from cmap_eval_testing import DONE, PROGRAM, TOWN, CmapEval

PAIR = (TOWN / "reference.ply", TOWN / "estimate.ply")
HEADING = r"(?m)^color +value +floor +chance +skill$"
WIDE = 130


class Levels(CmapEval):
    def in_terminal(self, columns, *arguments, environment=None):
        """What a terminal of that many columns shows."""
        shown, terminal = pty.openpty()
        fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("4H", 24, columns, 0, 0))
        variables = {key: value for key, value in os.environ.items() if key != "COLUMNS"}
        command = [PROGRAM, *PAIR, *arguments]
        with subprocess.Popen(command, stdout=terminal, env={**variables, **(environment or {})}) as run:
            os.close(terminal)
            text = b""
            while block := self.read(shown):
                text += block
        os.close(shown)
        self.assertEqual(run.returncode, DONE)
        return text.decode().replace("\r\n", "\n")

    def read(self, shown):
        try:
            return os.read(shown, 1 << 16)
        except OSError:  # the end of a terminal
            return b""

    def in_pipe(self, *arguments, **options):
        result = self.run_program(*PAIR, *arguments, **options)
        self.assertEqual(result.returncode, DONE, result.stderr.decode())
        return result.stdout.decode()

    def test_a_wide_terminal_shows_them(self):
        self.assertRegex(self.in_terminal(WIDE), HEADING)
        narrow = self.in_terminal(WIDE - 1)
        self.assertNotRegex(narrow, HEADING)
        self.assertEqual(narrow, self.in_pipe(), "as before")

    def test_asked_for_they_are_shown_everywhere(self):
        for text in (self.in_terminal(80, "--levels"), self.in_pipe("--levels")):
            self.assertRegex(text, HEADING)

    def test_columns_says_how_wide_a_terminal_is(self):
        self.assertRegex(self.in_terminal(80, environment={"COLUMNS": "200"}), HEADING)
        self.assertNotRegex(self.in_terminal(200, environment={"COLUMNS": "80"}), HEADING)
        for no_number in ("", "wide", "200x", "-1"):
            self.assertRegex(self.in_terminal(200, environment={"COLUMNS": no_number}), HEADING, no_number)
        self.assertNotRegex(self.in_pipe(environment={"COLUMNS": "200"}), HEADING, "a pipe has no width")

    def test_rows_keep_to_the_width(self):
        for columns in (WIDE, 150, 200):
            rows = re.split(r"\n(?:levels without a value|warnings)\n", self.in_terminal(columns))[0].splitlines()[2:]
            self.assertIn("  RMSE ", "\n".join(rows))
            self.assertLessEqual(max(map(len, rows)), columns)

    def test_without_levels_there_are_none_to_show(self):
        self.assertNotRegex(self.in_pipe("--levels", "--no-levels"), HEADING)

    def test_a_map_alone(self):
        result = self.run_program(PAIR[0], "--levels")
        self.assertEqual(result.returncode, DONE, result.stderr.decode())
        self.assertIn("point spacing", result.stdout.decode())


if __name__ == "__main__":
    unittest.main()

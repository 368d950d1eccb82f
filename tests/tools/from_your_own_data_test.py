#!/usr/bin/env python3
"""docs/FROM_YOUR_OWN_DATA.md, done to the letter on small data of a simulated drive: its commands and its calibration
are taken from the page. CTest sets CMAP_RECON, CMAP_SIMULATE and CMAP_SOURCE_DIR."""

import json
import os
import re
import shutil
import subprocess
import unittest
from pathlib import Path

import numpy as np
from recon_testing import PROGRAM, CaptureCase

SOURCE = Path(os.environ["CMAP_SOURCE_DIR"]).resolve()
PAGE = (SOURCE / "docs" / "FROM_YOUR_OWN_DATA.md").read_text()


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


class FromYourOwnData(CaptureCase):
    def setUp(self):
        super().setUp()
        self.mine = self.folder / "mine"
        (self.mine / "scans").mkdir(parents=True)
        shutil.copy(self.capture / "lio.tum", self.mine / "odometry.tum")
        for row in (self.capture / "lidar.csv").read_text().splitlines()[1:]:
            time, file = row.split(",")
            shutil.copy(self.capture / file, self.mine / "scans" / f"{float(time):.6f}.pcd")
        for k, name in enumerate("abc"):
            self.own_session(k, name)
        shutil.rmtree(self.capture)

    def own_session(self, k, name):
        """As VGGT's demo saves it: float planes, a trailing 1; and a list of the pictures, as of TUM's sets."""
        arrays = {path.stem: np.load(path) for path in self.session(k).glob("*.npy")}
        arrays["images"] = (arrays["images"].astype(np.float32) / 255).transpose(0, 3, 1, 2)
        arrays["depth"] = arrays["depth"][..., None]
        np.savez(self.mine / f"{name}.npz", **arrays)
        rows = [row.split(",") for row in (self.session(k) / "frames.csv").read_text().splitlines()[1:]]
        listed = "".join(f"{row[1]} {row[2]}\n" for row in rows)
        (self.mine / f"{name}.txt").write_text("# timestamp filename\n" + listed)

    def run_as_written(self, command):
        environment = {**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}"}
        result = subprocess.run(["sh", "-c", command], cwd=self.folder, env=environment, capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, command + result.stdout + result.stderr)
        return result

    def test_as_written(self):
        commands, (calibration,) = blocks("sh"), blocks("json")
        self.assertLessEqual(len(commands), 4)
        for command in commands[:-1]:
            self.assertEqual(command.count("\n"), 1, "a command is one line")
            self.run_as_written(command)
        (self.capture / "capture.json").write_text(calibration)
        check = re.search(r"`(cmap_recon capture --check)`", PAGE).group(1)
        self.assertEqual(self.run_as_written(check).stdout,
                         "0 faults, 0 warnings: 3 sessions of 18 frames, 85 poses, 84 scans, 0 pictures\n")
        self.assertEqual(self.run_as_written(commands[-1]).stderr, "")
        sessions = json.loads((self.folder / "map/sessions.json").read_text())["sessions"]
        self.assertEqual([session["name"] for session in sessions], ["a.npz", "b.npz", "c.npz"])
        for k, session in enumerate(sessions):
            self.assertLess(abs(np.log(session["scale"] / self.truth[f"session_{k:04}"])), 0.06)
        found = np.loadtxt(self.folder / "map/trajectory.tum")
        truth = np.loadtxt(self.simulated / "truth/trajectory.tum")
        self.assertEqual(len(found), 14, "18 frames, of which two pairs are shared")
        for axis in (1, 2, 3):
            error = found[:, axis] - np.interp(found[:, 0], truth[:, 0], truth[:, axis])
            self.assertLess(np.abs(error).max(), 0.5)
        self.assertTrue((self.folder / "map/map.ply").read_bytes().startswith(b"ply"))

    def test_the_readme_leads_there(self):
        self.assertIn("(docs/FROM_YOUR_OWN_DATA.md)", (SOURCE / "README.md").read_text())


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env bash
# kiss-icp 1.3.0: any scan's times are stretched to a whole period before its motion is taken out.
# The earliest time counts as the start and the latest as the end, whatever they are. At 10 m/s and 10 scans a second half a turn (the
# rest lost, or cut off by a range filter upstream) is moved by 1 m where it moved by 0.5 m, and one point with a late time leaves all
# others almost as distorted as they were, shifted by up to the whole motion.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 kiss-icp==1.3.0
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
from kiss_icp.config import load_config
from kiss_icp.preprocess import get_preprocessor

preprocessor = get_preprocessor(load_config(None))
motion = np.eye(4)
motion[0, 3] = 1.0
wall = np.tile([10.0, 0, 0], (5, 1))

def moved(times):
    """How far each point of the wall is moved along x, in meters."""
    return np.asarray(preprocessor.preprocess(wall, np.array(times), motion))[:, 0] - 10

cases = {
    "whole turn": ([0.0, 0.025, 0.05, 0.075, 0.1], [-1, -0.75, -0.5, -0.25, 0]),
    "first half": ([0.0, 0.0125, 0.025, 0.0375, 0.05], [-1, -0.75, -0.5, -0.25, 0]),
    "one late point": ([0.0, 0.025, 0.05, 0.075, 1.0], [-1, -0.975, -0.95, -0.925, 0]),
}
for name, (times, expected) in cases.items():
    print("%s, times %s s: moved by %s m" % (name, times, moved(times).round(4).tolist()))
    assert np.allclose(moved(times), expected)
PYTHON

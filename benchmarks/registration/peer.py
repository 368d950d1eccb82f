"""Registers DIR/source.npy onto DIR/target.npy with KISS-Matcher; writes the transform, CPU seconds of its call, and its inliers to
DIR/peer.json.

Run in an environment of its own: python3 -m venv peer && peer/bin/pip install kiss-matcher==1.0.2 numpy
"""
import json
import sys
import time
from pathlib import Path

import kiss_matcher
import numpy as np

folder, voxel_m = Path(sys.argv[1]), float(sys.argv[2])
source, target = (np.load(folder / name).astype(np.float64) for name in ("source.npy", "target.npy"))
shift = target.mean(axis=0)
matcher = kiss_matcher.KISSMatcher(kiss_matcher.KISSMatcherConfig(voxel_m))
a, b = source.astype(np.float32), (target - shift).astype(np.float32)
start = time.process_time()
found = matcher.estimate(a, b)
cpu_s = time.process_time() - start
T = np.eye(4)
T[:3, :3], T[:3, 3] = np.array(found.rotation), np.array(found.translation).ravel() + shift
result = {"T": T.tolist(), "cpu_s": cpu_s, "inliers": matcher.get_num_final_inliers()}
(folder / "peer.json").write_text(json.dumps(result))

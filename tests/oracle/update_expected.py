#!/usr/bin/env python3
"""Recompute the metrics and sampled levels of data_samples/**/expected.json from the clouds beside it and the options in it.

usage: update_expected.py [SAMPLE...]     all of them, or those named: town, micro/ties
"""
import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from oracle import evaluate  # noqa: E402

SAMPLES = Path(__file__).resolve().parents[2] / "data_samples"


def main():
    np.seterr(divide="raise", invalid="raise")
    named = [SAMPLES / name / "expected.json" for name in sys.argv[1:]]
    for path in named or sorted(SAMPLES.rglob("expected.json")):
        options = json.loads(path.read_text())["options"]
        found = evaluate(path.parent / "reference.ply", path.parent / "estimate.ply", options)
        path.write_text(json.dumps({**found, "options": options}, indent=1, allow_nan=False) + "\n")
        print(path.relative_to(SAMPLES))


if __name__ == "__main__":
    main()

#!/usr/bin/env bash
# evo 1.38.1: more noise on a trajectory, less relative error.
# With a distance in meters the pairs of poses are spaced along the estimate, not along the reference (pairs_from_reference is off).
# Noise makes the estimate's path longer, so that "10 m" are fewer true meters. A drive of 200 m whose scale is 3 % too large: 0.29 m
# a "10 m" pair; the same with 5 cm of noise on each axis: 0.16 m. Paired along the reference it is 0.30 and 0.31 m or more.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 evo==1.38.1
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
from evo.core.metrics import RPE, PoseRelation, Unit
from evo.core.trajectory import PosePath3D

def path(positions):
    return PosePath3D(positions_xyz=positions, orientations_quat_wxyz=np.tile([1.0, 0, 0, 0], (len(positions), 1)))

def relative_error(reference, estimate, **options):
    metric = RPE(PoseRelation.translation_part, delta=10, delta_unit=Unit.meters, **options)
    metric.process_data((path(reference), path(estimate)))
    return len(metric.error), metric.error.mean()

random = np.random.default_rng(1)
reference = np.zeros((4001, 3))
reference[:, 0] = 0.05 * np.arange(4001)
smooth = 1.03 * reference
noisy = smooth + random.normal(0, 0.05, smooth.shape)
means = {}
for name, estimate in (("smooth", smooth), ("noisy", noisy)):
    for along in (False, True):
        pairs, means[name, along] = relative_error(reference, estimate, pairs_from_reference=along)
        print("%s, pairs along the %s: %d pairs, mean %.3f m" % (name, "reference" if along else "estimate", pairs, means[name, along]))
assert relative_error(reference, noisy)[1] == means["noisy", False], "pairs run along the estimate unless asked"
assert means["noisy", False] < 0.65 * means["smooth", False]
assert means["noisy", True] > means["smooth", True] > 0.29
PYTHON

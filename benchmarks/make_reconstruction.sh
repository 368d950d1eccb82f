#!/usr/bin/env bash
# Makes data_samples/street: a simulated street and its reconstruction. Usage: make_reconstruction.sh BUILD/tools OUT
set -euo pipefail
tools=$1 out=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$tools/cmap_simulate" small_town -o "$scratch/capture" --quiet --set predictions.max_depth_m=30 \
  --set camera.rate_hz=4 --set truth.map_points_per_m2=30 --set truth.map_max_distance_m=30
"$tools/cmap_recon" "$scratch/capture" -o "$scratch/map" --quiet --set fusion_voxel_m=0.18
mkdir -p "$out"
# The reference as a scanner has it, with 5 mm of noise: the entropy of exact planes is that of rounding. Colors as bytes.
python3 - "$(dirname "$0")/../tests/oracle" "$scratch" "$out" <<'PY'
import sys
import numpy as np
sys.path.insert(0, sys.argv[1])
from ply import read_ply, write_ply
scratch, out = sys.argv[2:]
points, colors = read_ply(scratch + "/capture/truth/map.ply")
write_ply(out + "/reference.ply", points + np.random.default_rng(1).normal(0, 0.005, points.shape), (255 * colors).round())
points, colors = read_ply(scratch + "/map/map.ply")
write_ply(out + "/estimate.ply", points, (255 * colors).round())
PY

#!/usr/bin/env bash
# The tables of the LiDAR-VGGT paper from a folder of maps (README.md says which), computed beside published.
# Usage: benchmarks/leaderboard/reproduce.sh MAPS [OUTPUT]     OUTPUT: leaderboard/; CMAP_LEADERBOARD: the program
# Maps that are not there show as missing; run it again when they are, what is done stays.
set -euo pipefail

if (($# < 1 || $# > 2)); then
  sed -n '2,4s/^# //p' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=${CMAP_LEADERBOARD:-$here/../../build/release/tools/cmap_leaderboard}
if ! command -v "$program" >/dev/null; then
  echo "reproduce.sh: no program $program: build it (cmake --preset release && cmake --build --preset release), or set CMAP_LEADERBOARD" >&2
  exit 2
fi
exec "$program" "$here/lidar_vggt.json" --data-root "$1" -o "${2:-leaderboard}"

#!/usr/bin/env bash
# Makes the Python environment of the cross table (2.5 GB, minutes) and says which of Debian's programs are missing.
# Usage: tests/writers/make_environment.sh FOLDER
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
"$here/../make_python_environment.sh" "$here" "${1:?usage: make_environment.sh FOLDER}"
for program in pcl_pcd2ply:pcl-tools CloudCompare:cloudcompare xvfb-run:xvfb; do
  command -v "${program%%:*}" >/dev/null || echo "no ${program%%:*}: apt-get install --no-install-recommends ${program##*:}"
done

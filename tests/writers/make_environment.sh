#!/usr/bin/env bash
# Makes the Python environment of the cross table (2.5 GB, minutes) and says which of Debian's programs are missing.
# Usage: tests/writers/make_environment.sh FOLDER
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=${1:?usage: make_environment.sh FOLDER}

if [[ ! -e $folder/complete ]]; then
  rm -rf "$folder"
  python3 -m venv "$folder"
  "$folder/bin/pip" install --quiet --disable-pip-version-check --requirement "$here/requirements.txt" --constraint "$here/constraints.txt"
  touch "$folder/complete"
fi
for program in pcl_pcd2ply:pcl-tools CloudCompare:cloudcompare xvfb-run:xvfb; do
  command -v "${program%%:*}" >/dev/null || echo "no ${program%%:*}: apt-get install --no-install-recommends ${program##*:}"
done

#!/usr/bin/env bash
# Makes the Python environment with evo (300 MB, a minute).
# Usage: tests/evo/make_environment.sh FOLDER
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=${1:?usage: make_environment.sh FOLDER}

if [[ ! -e $folder/complete ]]; then
  rm -rf "$folder"
  python3 -m venv "$folder"
  "$folder/bin/pip" install --quiet --disable-pip-version-check --requirement "$here/requirements.txt" --constraint "$here/constraints.txt"
  touch "$folder/complete"
fi

#!/usr/bin/env bash
# Makes a Python environment of what a test's requirements.txt and constraints.txt say; one that is complete stays.
# Usage: tests/make_python_environment.sh FOLDER-OF-THE-TEST FOLDER
set -euo pipefail
test=${1:?usage: make_python_environment.sh FOLDER-OF-THE-TEST FOLDER}
folder=${2:?usage: make_python_environment.sh FOLDER-OF-THE-TEST FOLDER}

[[ ! -e $folder/complete ]] || exit 0
rm -rf "$folder"
python3 -m venv "$folder"
"$folder/bin/pip" install --quiet --disable-pip-version-check --requirement "$test/requirements.txt" --constraint "$test/constraints.txt"
touch "$folder/complete"

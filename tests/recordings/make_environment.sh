#!/usr/bin/env bash
# Makes the Python environment with the writers of recordings (150 MB, a minute).
# Usage: tests/recordings/make_environment.sh FOLDER
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
"$here/../make_python_environment.sh" "$here" "${1:?usage: make_environment.sh FOLDER}"

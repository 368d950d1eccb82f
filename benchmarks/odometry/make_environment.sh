#!/usr/bin/env bash
# Makes the Python environment with kiss-icp and rko-lio (300 MB, a minute).
# Usage: benchmarks/odometry/make_environment.sh FOLDER
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
"$here/../../tests/make_python_environment.sh" "$here" "${1:?usage: make_environment.sh FOLDER}"

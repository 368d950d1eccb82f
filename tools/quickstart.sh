#!/usr/bin/env bash
# From a fresh clone to the first evaluation: builds cmap_eval and runs it on the sample town.
# Usage: tools/quickstart.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=build/quickstart

tools/install_dependencies.sh
echo "Building cmap_eval in $build"
tools/quietly.sh cmake --preset release -B "$build" -DCMAP_BUILD_TESTS=OFF -DCMAKE_RUNTIME_OUTPUT_DIRECTORY="$PWD/$build/bin"
tools/quietly.sh cmake --build "$build" --target cmap_eval --parallel "$(nproc)"

"$build/bin/cmap_eval" data_samples/town/reference.ply data_samples/town/estimate.ply -o "$build/report.json"
echo "Report: $PWD/$build/report.json"

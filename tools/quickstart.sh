#!/usr/bin/env bash
# From a fresh clone to the first evaluation: builds the programs and runs them on the sample town.
# Usage: tools/quickstart.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=build/quickstart

tools/install_dependencies.sh
echo "Building in $build"
tools/quietly.sh cmake --preset release -B "$build" -DCMAP_BUILD_TESTS=OFF -DCMAKE_RUNTIME_OUTPUT_DIRECTORY="$PWD/$build/bin"
tools/quietly.sh cmake --build "$build" --parallel "$(nproc)"

maps=(data_samples/town/reference.ply data_samples/town/estimate.ply)
"$build/bin/cmap_eval" "${maps[@]}" -o "$build/report.json" --html "$build/report.html" --figure "$build/figure.png"
echo "Report:  $PWD/$build/report.json"
echo "Picture: $PWD/$build/figure.png"
echo "Page:    $PWD/$build/report.html"

#!/usr/bin/env bash
# From a fresh clone to the first evaluation: builds cmap_eval and runs it on the sample town.
# Usage: tools/quickstart.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=build/quickstart

tools/install_dependencies.sh
echo "Building cmap_eval in $build"
tools/quietly.sh cmake --preset minimal -B "$build" -DCMAP_BUILD_TESTS=OFF -DCMAKE_RUNTIME_OUTPUT_DIRECTORY="$PWD/$build/bin"
tools/quietly.sh cmake --build "$build" --parallel "$(nproc)" --target cmap_eval

maps=(data_samples/town/reference.ply data_samples/town/estimate.ply)
"$build/bin/cmap_eval" "${maps[@]}" -o "$build/report.json" --html "$build/report.html"
cat <<END
Program: $PWD/$build/bin/cmap_eval
Report:  $PWD/$build/report.json
Page:    $PWD/$build/report.html   (open it in a browser: both maps, curves, where the errors are)

All programs, with pictures (cmap_render, --figure), cmap_simulate and cmap_recon:
  tools/install_dependencies.sh --all && cmake --preset release -DCMAP_BUILD_TESTS=OFF && cmake --build --preset release
END

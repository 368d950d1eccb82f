#!/usr/bin/env bash
# Installs what is missing, builds cmap (preset "release") and runs every test.
# Usage: tools/test.sh [CTEST-ARGUMENT...]     for example: tools/test.sh -R core/
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/install_dependencies.sh --all --tests
echo "Configuring build/release"
tools/quietly.sh cmake --preset release -DCMAP_BUILD_WEB=ON
echo "Building build/release"
tools/quietly.sh cmake --build --preset release --parallel "$(nproc)"
exec ctest --preset release --no-tests=error --output-on-failure --parallel "$(nproc)" "$@"

#!/usr/bin/env bash
# Installs the Debian and Ubuntu packages that cmap is built from, as far as they are missing.
# Usage: tools/install_dependencies.sh [--all] [--tests] [--benchmarks]
#   (nothing)      what cmap_eval, cmap_align, cmap_compare and cmap_leaderboard need
#   --all          also what pictures, recordings, cmap_simulate and cmap_recon need
#   --tests        also what the tests need: GoogleTest, Python, ffmpeg, node and npm, a browser, OpenGL in software
#   --benchmarks   also what the speed benchmarks need: Google Benchmark and the libraries compared with
set -euo pipefail
tools=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

packages=(
  g++ cmake ninja-build
  libeigen3-dev libfmt-dev libtbb-dev libssl-dev nlohmann-json3-dev libcli11-dev
  zlib1g-dev liblzf-dev liblz4-dev libflann-dev
)
for argument in "$@"; do
  case "$argument" in
    --all)
      packages+=(libvtk9-dev libopencv-imgproc-dev libopencv-imgcodecs-dev fonts-dejavu-core help2man
        libegl-dev libgl-dev libx11-dev libembree-dev libceres-dev libsqlite3-dev libzstd-dev
        librosbag-storage-dev)
      ;;
    --tests)
      packages+=(libgtest-dev libgmock-dev python3 python3-numpy python3-scipy python3-jsonschema libopencv-calib3d-dev ffmpeg chromium
        libgl1-mesa-dri libegl-mesa0 xvfb xdotool)
      # Node's own packages bring npm with them and exclude Debian's.
      command -v npm >/dev/null || packages+=(nodejs npm)
      ;;
    --benchmarks) packages+=(libbenchmark-dev libnanoflann-dev libpcl-dev) ;;
    -h | --help) sed -n '2,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
    *) echo "install_dependencies.sh: unknown argument '$argument'; see --help" >&2; exit 2 ;;
  esac
done

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  echo "install_dependencies.sh: no apt-get here; install the equivalents of: ${packages[*]}" >&2
  exit 1
fi

is_installed() { [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]; }

missing=()
for package in "${packages[@]}"; do
  is_installed "$package" || missing+=("$package")
done
if ((${#missing[@]} == 0)); then exit 0; fi

as_root=(env)
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    echo "install_dependencies.sh: neither root nor sudo; as root, run: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo env)
fi

apt_get() {
  "$tools/quietly.sh" "${as_root[@]}" DEBIAN_FRONTEND=noninteractive \
    apt-get --yes -o Acquire::Retries=3 -o DPkg::Lock::Timeout=300 "$@"
}

echo "Installing ${missing[*]}"
apt_get update
apt_get install --no-install-recommends "${missing[@]}"

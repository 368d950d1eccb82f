#!/usr/bin/env bash
# PCL 1.13.0 (Debian 12's pcl-tools 1.13.0+dfsg-3): pcl_pcd2ply writes more than its header says.
# From a PCD whose rgb is of type U, the header names red green blue, and every row has a fourth byte: the file is one byte a vertex
# longer than declared, and all rows but the first are read shifted. With the same colors as type F the file is right.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
if ! dpkg-query --show --showformat='${Version}\n' pcl-tools 2>/dev/null | grep -qx '1.13.0+dfsg-3'; then
  apt-get update --quiet=2
  DEBIAN_FRONTEND=noninteractive apt-get install --yes --quiet=2 --no-install-recommends pcl-tools=1.13.0+dfsg-3 >/dev/null
fi

write_pcd() {  # TYPE: two points, rgb packed as 200 100 50
  printf 'VERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F %s\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n' "$1"
  printf 'POINTS 2\nDATA binary\n'
  printf '\0\0\200\077\0\0\0\100\0\0\100\100\062\144\310\0%.0s' 1 2
}

for type in F U; do
  write_pcd "$type" > input.pcd
  pcl_pcd2ply -format 1 -use_camera 0 input.pcd output.ply > log.txt 2>&1
  python3 - "$type" <<'PYTHON'
import sys

SIZES = {"float": 4, "uchar": 1, "int": 4, "double": 8}
header, end, body = open("output.ply", "rb").read().partition(b"end_header\n")
count, declared = 0, 0
for words in (line.split() for line in header.decode().splitlines()):
    if words[0] == "element":
        count = int(words[2])
    elif words[0] == "property":
        declared += count * SIZES[words[1]]
print("rgb of type %s: %d bytes declared, %d written" % (sys.argv[1], declared, len(body)))
sys.exit(len(body) - declared != (2 if sys.argv[1] == "U" else 0))
PYTHON
done

#!/usr/bin/env bash
# pypcd4 1.5.1: an ASCII PCD of packed colors is black. The color is kept as the bits of a float near 1e-38 and printed with ten decimals.
# Binary and compressed files keep it; reading the ASCII file back gives (0, 0, 0) without a word.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 pypcd4==1.5.1
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
from pypcd4 import Encoding, PointCloud

colors = np.array([[200, 100, 50]], np.uint8)
cloud = PointCloud.from_xyzrgb_points(np.column_stack([np.array([[1, 2, 3]], np.float32), PointCloud.encode_rgb(colors)]))
for encoding in (Encoding.BINARY, Encoding.BINARY_COMPRESSED, Encoding.ASCII):
    cloud.save("point.pcd", encoding=encoding)
    back = PointCloud.decode_rgb(PointCloud.from_path("point.pcd").numpy(("rgb",)))[0].tolist()
    print(encoding.value, back)
    assert back == ([0, 0, 0] if encoding == Encoding.ASCII else [200, 100, 50])
row = open("point.pcd").read().split("DATA ascii\n")[1].split()
print(" ".join(row))
assert row[3] == "0.0000000000"
PYTHON

#!/usr/bin/env bash
# pyntcloud 0.3.1: to_file() turns the double coordinates of the cloud in memory, and of the DataFrame that it was made of, into float.
# At UTM the northing of both moves by up to 0.25 m. Text formats also leave out every column but x y z.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 pandas==2.3.3 pyntcloud==0.3.1
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import pandas
from pyntcloud import PyntCloud

table = pandas.DataFrame({"x": [465123.2], "y": [4649776.7], "z": [132.1], "red": [10], "green": [20], "blue": [30]})
cloud = PyntCloud(table)
assert table.y[0] == 4649776.7 and cloud.points.y[0] == 4649776.7
cloud.to_file("cloud.csv")
print("after saving: y = %s in the cloud, %s in the caller's table, type %s" % (cloud.points.y[0], table.y[0], table.y.dtype))
print(open("cloud.csv").read().strip())
assert table.y.dtype == "float32" and float(table.y[0]) == 4649776.5 == float(cloud.points.y[0])
assert open("cloud.csv").readline().strip() == ",x,y,z"
PYTHON

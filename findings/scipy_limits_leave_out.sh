#!/usr/bin/env bash
# scipy 1.17.1 and pykdtree 1.4.3: query() leaves out a neighbor at exactly distance_upper_bound; query_ball_point() counts it.
# Both pages say "within". On maps of a grid whole rows lie at the limit: a floor of 1/16 m steps that is 1/16 m too high has a recall
# of 0 at the limit 1/16 m by query(), of 1 by query_ball_point() and scikit-learn 1.9.1.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/environment"
"$folder/environment/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 pykdtree==1.4.3 scikit-learn==1.9.1 scipy==1.17.1
cd "$folder"
"$folder/environment/bin/python" - <<'PYTHON'
import numpy as np
import pykdtree.kdtree
import scipy.spatial
from sklearn.neighbors import NearestNeighbors

step = 1 / 16
reference = np.stack(np.meshgrid(np.arange(20) * step, np.arange(20) * step, [0.0]), axis=-1).reshape(-1, 3)
estimate = reference + [0, 0, step]
tree = scipy.spatial.KDTree(estimate)
found = {
    "scipy KDTree.query": np.isfinite(tree.query(reference, distance_upper_bound=step)[0]),
    "pykdtree KDTree.query": np.isfinite(pykdtree.kdtree.KDTree(estimate).query(reference, distance_upper_bound=step)[0]),
    "scipy KDTree.query_ball_point": tree.query_ball_point(reference, step, return_length=True) > 0,
    "scikit-learn radius_neighbors": np.array([len(near) > 0 for near in
                                               NearestNeighbors(radius=step).fit(estimate).radius_neighbors(reference)[1]]),
    "distance of query <= limit": tree.query(reference)[0] <= step,
}
for name, within in found.items():
    print("%s: recall %.2f" % (name, within.mean()))
    assert within.mean() == (0 if name.endswith("KDTree.query") else 1)
PYTHON

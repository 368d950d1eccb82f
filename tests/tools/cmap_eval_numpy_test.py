#!/usr/bin/env python3
"""Arrays as NumPy writes them, evaluated by cmap_eval: the numbers are those that NumPy and SciPy give for them."""

import unittest

from cmap_eval_testing import CmapEval, ply

try:
    import numpy as np
    from scipy.spatial import cKDTree
except ImportError:
    np = None

N_FRAMES, HEIGHT, WIDTH = 2, 5, 6
N = N_FRAMES * HEIGHT * WIDTH


def expected(reference, reference_rgb, estimate, estimate_rgb):
    """Chamfer distance, root mean square and color distance, straight from METRICS."""
    to_reference, nearest = cKDTree(reference).query(estimate)
    to_estimate, back = cKDTree(estimate).query(reference)
    values = {"chamfer": to_reference.mean() + to_estimate.mean()}
    if estimate_rgb is not None:
        there = np.linalg.norm(estimate_rgb - reference_rgb[nearest], axis=1).mean()
        back = np.linalg.norm(reference_rgb - estimate_rgb[back], axis=1).mean()
        values["color_distance"] = (there + back) / 2
    return values


@unittest.skipIf(np is None, "no numpy or scipy (apt-get install python3-numpy python3-scipy)")
class NumpyArrays(CmapEval):
    def setUp(self):
        super().setUp()
        random = np.random.default_rng(7)
        self.xyz = random.uniform(-3, 3, (N, 3)).astype(np.float32).astype(float)
        self.rgb = random.integers(0, 256, (N, 3)).astype(np.uint8)
        self.xyz[3] += 0.25
        truth = self.xyz + random.normal(0, 0.02, (N, 3))
        truth_rgb = random.integers(0, 256, (N, 3))
        self.truth, self.truth_rgb = truth, truth_rgb / 255
        rows = [[*map(repr, map(float, p)), *c] for p, c in zip(truth, truth_rgb)]
        header = ply([]).replace("float", "double").replace("vertex 0", f"vertex {N}")
        header = header.replace("end_header", "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header")
        self.reference = self.input("truth.ply", header + "".join(" ".join(map(str, row)) + "\n" for row in rows))

    def check(self, path, colored, tolerance=1e-9, xyz=None):
        report = self.evaluate(self.reference, path, "--metrics", "default" if not colored else "default,color_distance")
        xyz = self.xyz if xyz is None else xyz
        for name, value in expected(self.truth, self.truth_rgb, xyz, self.rgb / 255 if colored else None).items():
            self.assertAlmostEqual(report["metrics"][name]["value"], value, delta=tolerance * max(1, value) + 1e-7, msg=path)
        if not colored:
            self.assertIsNone(report["metrics"]["color_distance"]["value"])
        return " ".join(w["message"] for w in report["warnings"])

    def npy(self, array):
        path = self.inputs / "map.npy"
        np.save(path, array)
        return path

    def npz(self, compressed=False, **arrays):
        path = self.inputs / "map.npz"
        (np.savez_compressed if compressed else np.savez)(path, **arrays)
        return path

    def test_types_orders_and_byte_orders(self):
        for dtype in "<f4", "<f8", ">f4", ">f8":
            for order in "C", "F":
                self.check(self.npy(self.xyz.astype(dtype, order=order)), False)
        half = self.xyz.astype(np.float16)
        for dtype in "<f2", ">f2":
            self.check(self.npy(half.astype(dtype)), False, xyz=half.astype(float))
        self.assertIn("transposed", self.check(self.npy(np.ascontiguousarray(self.xyz.T)), False))
        self.check(self.npy(self.xyz.reshape(N_FRAMES, HEIGHT, WIDTH, 3)), False)
        for dtype in "<i2", ">i4", "<i8":
            whole = np.round(self.xyz * 10).astype(dtype)
            self.assertIn("integers", self.check(self.npy(whole), False, xyz=whole.astype(float)))

    def test_columns(self):
        self.assertIn("column", self.check(self.npy(np.c_[self.xyz, np.arange(N)]), False))
        self.check(self.npy(np.c_[self.xyz, self.rgb]), True)
        self.check(self.npy(np.c_[self.xyz, self.rgb / 255]), True)
        self.check(self.npy(np.c_[self.xyz, self.rgb / 255].astype(">f4", order="F")), True, 1e-6)
        normals = np.random.default_rng(1).normal(size=(N, 3))
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        self.assertIn("normal", self.check(self.npy(np.c_[self.xyz, normals]), False))
        self.check(self.npy(np.c_[self.xyz, normals, self.rgb]), True)

    def test_records(self):
        for position, color in ("<f4", "u1"), ("<f8", "<u2"), (">f4", ">i4"), (">f8", "<f4"):
            scale = 257 if color == "<u2" else 1
            for names in (*"xyz", "red", "green", "blue"), (*"XYZ", *"RGB"):
                for align in False, True:
                    fields = [(name, position if i < 3 else color) for i, name in enumerate(names)]
                    records = np.zeros(N, np.dtype([("id", "u1"), *fields, ("label", "S3")], align=align))
                    for i, name in enumerate(names):
                        records[name] = self.xyz[:, i] if i < 3 else self.rgb[:, i - 3].astype(int) * scale
                    self.check(self.npy(records), True)
        parts = np.zeros(N, [("xyz", "<f4", (3,)), ("normal", "<f4", (3,)), ("rgb", "u1", (3,))])
        parts["xyz"], parts["rgb"] = self.xyz, self.rgb
        self.assertIn("normal", self.check(self.npy(parts), True))

    def test_archives(self):
        frames = (N_FRAMES, HEIGHT, WIDTH, 3)
        images = (self.rgb / 255).astype(np.float32).reshape(frames)
        conf = np.ones((N_FRAMES, HEIGHT, WIDTH))
        for compressed in False, True:
            self.check(self.npz(compressed, points=self.xyz, colors=self.rgb), True)
            self.check(self.npz(compressed, positions=self.xyz, colors=self.rgb / 255), True)
            self.check(self.npz(compressed, xyz=np.asfortranarray(self.xyz), rgb=self.rgb.astype(">i4", order="F")), True)
            points = self.xyz.astype(np.float32).reshape(frames)
            told = self.check(self.npz(compressed, world_points=points, images=images.transpose(0, 3, 1, 2), conf=conf), True, 1e-6)
            self.assertIn("not used: conf", told)
            batch = {"world_points": points[None], "images": images.transpose(0, 3, 1, 2)[None]}
            self.assertIn("batch", self.check(self.npz(compressed, **batch), True, 1e-6))
            self.check(self.npz(compressed, points=points, images=images, conf=conf[..., None]), True, 1e-6)
        columns = {"x": self.xyz[:, 0], "y": self.xyz[:, 1], "z": self.xyz[:, 2]}
        self.check(self.npz(**columns, red=self.rgb[:, 0], green=self.rgb[:, 1], blue=self.rgb[:, 2]), True)
        keep = np.arange(N) % 3 != 1
        self.check(self.npz(pointcloud=points.reshape(-1, WIDTH, 3), mask=keep.reshape(-1, WIDTH)), False, xyz=self.xyz[keep])
        with self.assertRaisesRegex(AssertionError, "pickled"):
            self.check(self.npy(np.array({"points": self.xyz}, dtype=object)), False)

    def test_refusals(self):
        raw = np.zeros(4, [("X", "<i4"), ("Y", "<i4"), ("Z", "<i4"), ("intensity", "<u2")])
        self.refused_map("raw.npy", self.npy(raw).read_bytes(), "scale")
        self.refused_map("pose.npy", self.npy(np.eye(4)).read_bytes(), "4x4 transform")
        self.refused_map("count.npz", self.npz(points=self.xyz, colors=self.rgb[1:]).read_bytes(), f"({N - 1}, 3)", "points")
        self.refused_map("batch.npz", self.npz(world_points=np.zeros((2, 1, 2, 2, 3))).read_bytes(), "batch")


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""What cmap_eval refuses: exit codes, messages, and that nothing is left on the disk."""

import os
import resource
import shlex
import struct
import subprocess
import time
import unittest

from cmap_eval_testing import (
    PROGRAM,
    SANITIZED,
    TOWN,
    USAGE,
    INPUT,
    UNSUPPORTED,
    ply,
    binary_ply,
    pcd,
    las,
    POINTS,
    CmapEval,
)


class BadMaps(CmapEval):
    def test_alignments_that_cannot_be(self):
        line = self.input("line.ply", ply([(0.1 * i, 0, 0) for i in range(200)]))
        far = self.input("far.ply", ply([(1000 + i % 7, i % 5, i % 3) for i in range(200)]))
        near = self.input("near.ply", ply([(i % 7, i % 5, i % 3) for i in range(200)]))
        skewed = self.input("skewed.txt", "1 0.5 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")
        early = self.input("early.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n")
        late = self.input("late.tum", "100 0 0 0 0 0 0 1\n101 1 0 0 0 0 0 1\n")
        self.refused(UNSUPPORTED, "rotation about", line, line, "--align", "icp")
        self.refused(UNSUPPORTED, "no overlap", near, far, "--align", "gicp", "--align-voxel", "0.5")
        self.refused(INPUT, skewed.name, near, near, "--align", "icp", "--initial", skewed)
        self.refused(USAGE, "is none of none, icp", near, near, "--align", "ndt")
        self.refused(USAGE, "--initial needs an --align", near, near, "--initial", skewed)
        self.refused(USAGE, "--align trajectory needs", near, near, "--align", "trajectory")
        self.refused(USAGE, "--align trajectory needs", near, near, "--ref-trajectory", early)
        trajectories = ("--ref-trajectory", early, "--est-trajectory", late)
        self.refused(UNSUPPORTED, "time", near, near, "--align", "trajectory", *trajectories)

    def test_one_point_too_far_to_count_voxels(self):
        fields = ("x", "y", "z", "red", "green", "blue")
        near = [(0.1 * (i % 20), 0.1 * (i // 20), 0, 0.25, 0.5, 0.001 * i) for i in range(400)]
        reference = self.input("near.ply", ply(near, fields))
        for far in ((-7e8, 0, 0), (0, 9e8, 0), (6e8, 6e8, 6e8)):
            stray = self.input("stray.ply", ply(near[:100] + [(*far, 0.25, 0.5, 0.75)] + near[100:], fields))
            says = [f"{stray}: point 101 of 401, at (", "far to count voxels"]
            self.refused(INPUT, says, reference, stray)
            self.refused(INPUT, says, stray, reference)

    def test_missing(self):
        self.refused(INPUT, ["none.ply: no such file"], self.inputs / "none.ply", self.estimate)
        self.refused(INPUT, ["none.ply: no such file"], self.reference, self.inputs / "none.ply")

    def test_a_folder(self):
        self.refused(INPUT, [f"{self.inputs}: is a folder"], self.inputs, self.estimate)

    def test_unreadable(self):
        secret = self.input("secret.ply", ply(POINTS))
        secret.chmod(0)
        self.refused(
            INPUT, [f"{secret}: cannot be opened: Permission denied"], secret, self.estimate, **self.as_nobody()
        )

    def test_empty(self):
        for name in ("empty.ply", "empty.pcd", "empty.las", "empty.xyz"):
            self.refused_map(name, "", "the file is empty")

    def test_unknown_format(self):
        self.refused_map("random.dat", bytes(range(256)), "is of no known format; PLY, PCD, LAS")
        self.refused_map("random.bin", bytes(range(256)), "neither KITTI .bin")
        self.refused_map("image.png", b"\x89PNG\r\n\x1a\n" + bytes(64), "PLY, PCD, LAS")
        self.refused_map("letter.txt", "Dear all,\nhere is the map.\n", "line 2", "'here' is not a number")

    def test_truncated_header(self):
        self.refused_map(
            "a.ply", ply(POINTS).partition("end_header")[0], "line 6", "truncated: the file ends before 'end_header'"
        )
        self.refused_map(
            "a.pcd", pcd(POINTS).partition(b"POINTS")[0], "line 7", "truncated: the file ends before the line DATA"
        )
        self.refused_map("a.las", las(POINTS)[:100], "truncated", "byte")

    def test_truncated_body(self):
        self.refused_map("ascii.ply", ply(POINTS[:2], count=3), "truncated: 3 points", "byte")
        self.refused_map(
            "rows.ply",
            ply([(0.25, 0.25, 0.25), (1, 1, 1)], count=3),
            "line 9",
            "truncated: the file ends after 2 of 3 points",
        )
        self.refused_map("cut.ply", ply([(0.25, 0.25, 0.25), (1, 1, 1)])[:-3], "line 9", "ends before the value of 'z'")
        self.refused_map("binary.ply", binary_ply(POINTS)[:-1], "truncated: 3 points", "byte")
        self.refused_map("binary.pcd", pcd(POINTS)[:-1], "truncated", "byte")
        self.refused_map("points.las", las(POINTS)[:-1], "truncated", "byte")

    def test_absurd_counts_do_not_allocate(self):
        maps = {
            "ascii.ply": ply(POINTS, count=10**15),
            "binary.ply": binary_ply(POINTS, count=10**15),
            "huge.ply": binary_ply(POINTS, count=10**30),
            "a.pcd": pcd(POINTS, count=10**15),
            "a.las": las(POINTS, count=2**32 - 1),
            "list.ply": binary_ply([])
            .replace(b"vertex 0", b"vertex 1")
            .replace(b"end_", b"property list uint int a\nend_")
            + struct.pack("<3fI", 0, 0, 0, 2**32 - 1),
        }
        for name, content in maps.items():
            with self.subTest(name):
                path = self.input(name, content)
                start = time.monotonic()
                self.refused(INPUT, f"{path}: ", path, self.estimate, preexec_fn=self.limit_memory)
                self.assertLess(time.monotonic() - start, 10)

    @staticmethod
    def limit_memory():
        if not SANITIZED:  # sanitizers reserve terabytes of addresses
            resource.setrlimit(resource.RLIMIT_AS, (2**30, 2**30))

    def test_wrong_types(self):
        self.refused_map("type.ply", ply(POINTS, kind="decimal"), "line 4", "unknown property type 'decimal'")
        self.refused_map("string.ply", ply([(0, 0, "here")]), "line 8", "'z': 'here' is not a number")
        self.refused_map("half.ply", ply([(0, 0, 0.5)], kind="int"), "line 8", "'0.5' is not of type int")
        self.refused_map(
            "red.ply",
            ply([(0, 0, 0, 1, -2, 3)], ["x", "y", "z", "red", "green", "blue"], "int"),
            "point 1: green = -2, but colors are not negative",
        )
        self.refused_map("list.ply", ply([]).replace("float z", "list uchar float z"), "'z' is not a single number")
        self.refused_map("type.pcd", pcd(POINTS).replace(b"TYPE F F F", b"TYPE F F Q"), "'z' has unknown TYPE Q")
        self.refused_map("a.xyz", "1 2 3\n4 five 6\n", "line 2", "'five' is not a number")

    def test_missing_coordinate(self):
        self.refused_map("flat.ply", ply([(0, 0)], "xy"), "no field 'z'")

    def test_nothing_finite(self):
        bad = [("nan",) * 3, ("inf", 0, 0), (0, "-inf", 0)]
        self.refused_map("nan.ply", ply(bad), "none of its 3 points is finite")
        self.refused_map("nan.pcd", pcd([tuple(map(float, row)) for row in bad]), "none of its 3 points is finite")
        self.refused_map("nan.xyz", "nan nan nan\n", "none of its 1 points is finite")

    def test_no_points(self):
        self.refused_map("none.ply", ply([]), "holds no points")
        self.refused_map("none.pcd", pcd([]), "holds no points")
        self.refused_map("none.las", las([]), "holds no points")
        self.refused_map("none.xyz", "# only a comment\n", "holds no line of numbers")

    def test_absurd_coordinates(self):
        self.refused_map("far.ply", ply([(0, 0, 1e30)]), "1 left out: no return")

    def test_bad_transform(self):
        for content, says in (
            ("1 2 3", "16"),
            ("", "empty"),
            ("0 " * 16, "0 0 0 1"),
            ("2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "rotation"),
            ("x", "number"),
        ):
            matrix = self.input("T.txt", content)
            self.refused(INPUT, [f"{matrix}: ", says], self.reference, self.estimate, "--transform", matrix)
        self.refused(
            INPUT, "none.txt: no such file", self.reference, self.estimate, "--transform", self.inputs / "none.txt"
        )

    def test_a_crop_that_leaves_nothing(self):
        self.refused(
            UNSUPPORTED,
            "crop: no point of the reference is inside",
            self.reference,
            self.estimate,
            "--crop",
            "90,90,90,91,91,91",
        )


class BadUsage(CmapEval):
    def refused_options(self, says, *options, **how):
        self.refused(USAGE, says, self.reference, self.estimate, *options, **how)

    def test_wrong_arguments(self):
        self.refused(USAGE, ["REF", "--help"])
        self.refused(USAGE, "needs two maps", self.reference)  # for its point errors
        self.refused_options("--lcr-radus", "--lcr-radus", "1")
        self.refused_options("third.ply", "third.ply")
        self.refused_options("--lcr-radius", "--lcr-radius", "1", "--lcr-radius", "2")
        self.refused_options(["--threads", "0"], "--threads", "0")
        self.refused_options(["--format", "xml"], "--format", "xml")

    def test_wrong_values(self):
        for option, value, says in (
            ("--lcr-radius", "-1", "must be above 0"),
            ("--lcr-radius", "wide", '"wide" is not a number'),
            ("--lcr-radius", "", "is not a number"),
            ("--lcr-radius", "inf", "inf"),
            ("--thresholds", "0.1,-0.2", "must be above 0"),
            ("--thresholds", "", "is not a list of numbers"),
            ("--awd-min-points", "1", "is not a whole number"),
            ("--metrics", "colour", '"colour" is unknown'),
            ("--metrics", "", "names no metric"),
            ("--crop", "1,2,3", "is not xmin,ymin"),
            ("--as", "pcl", '"pcl" is unknown'),
            ("--index", "octree", '"octree" is none of bvh, flann'),
            ("--ccs-singletons", "ignore", '"ignore" is none of zero, exclude, refuse'),
            ("--ccs-voxel", "1e-12", "too small"),
            ("--voxel", "0", "must be above 0"),
        ):
            with self.subTest(f"{option} {value}"):
                self.refused_options([option[2:], says], option, value)

    def test_empty_names_of_files(self):
        """An unset variable of a script must not pass for "no such option"."""
        for option in ("--config", "--preset", "--transform"):
            with self.subTest(option):
                self.refused_options(option[2:], option, "")
        self.expect_refusal(self.run_program(self.reference, self.estimate, "-o", ""), USAGE, "output")

    def test_wrong_configurations(self):
        for content, says in (
            ('{"lcr_radius": 1}', 'unknown key "lcr_radius"'),
            ('{"lcr-radius": -1}', "lcr-radius: -1 must be above 0"),
            ('{"lcr-radius": "1"}', 'lcr-radius: "1" is not a number'),
            ("[]", "JSON object"),
            ("", "line 1"),
            ('{"voxel": 1', "line 1"),
        ):
            config = self.input("config.json", content)
            self.refused_options([f"{config}: ", says], "--config", config)
        self.refused_options("none.json: ", "--config", self.inputs / "none.json")
        self.refused_options(f"{self.inputs}: ", "--config", self.inputs)
        self.refused_options(['"urban" is unknown', "paper, indoor, outdoor, aerial, mapeval"], "--preset", "urban")

    def test_wrong_requirements(self):
        for requirement, says in (
            ("lidar>=1", 'unknown metric "lidar"'),
            ("LCR=1", "expected METRIC"),
            ("accuracy<=1", "accuracy@0.2"),
            ("accuracy@7<=1", "7 m is not among the thresholds"),
            ("mme<=1", "mean_map_entropy is not computed"),
            ("chamfer.median<=1", "chamfer has no number median"),
            ("", "expected METRIC"),
        ):
            with self.subTest(requirement):
                self.refused_options([f'require "{requirement}"', says], "--require", requirement)

    def test_unknown_instruction_set(self):
        self.refused_options(["CMAP_SIMD=mmx", "plain, sse2, avx2 or avx512"], environment={"CMAP_SIMD": "mmx"})


class BadOutputs(CmapEval):
    def outputs_of(self, path):
        return (("-o", path), ("--export-errors", path), ("--export-reference-errors", path))

    def test_a_folder_that_is_missing(self):
        path = self.outputs / "none/out"
        for output in self.outputs_of(path):
            result = self.run_program(self.reference, self.estimate, *output)
            self.expect_refusal(result, USAGE, f"{path}: cannot be written: No such file or directory")

    def test_it_is_noticed_before_the_work(self):
        missing = self.folder / "missing.ply"  # noticed later
        for output in self.outputs_of(self.outputs / "none/out"):
            self.expect_refusal(self.run_program(missing, missing, *output), USAGE, "cannot be written")

    def test_point_errors_are_ply(self):
        for option in ("--export-errors", "--export-reference-errors"):
            result = self.run_program(self.reference, self.estimate, option, self.outputs / "errors.csv")
            self.expect_refusal(result, USAGE, "errors.csv: point errors are written as PLY")

    def test_a_folder_in_place_of_a_file(self):
        for output in self.outputs_of(self.folder):
            self.expect_refusal(self.run_program(self.reference, self.estimate, *output), USAGE, "Is a directory")

    def test_a_folder_that_is_read_only(self):
        how = self.as_nobody()
        self.outputs.chmod(0o555)
        for output in self.outputs_of(self.outputs / "out"):
            self.expect_refusal(
                self.run_program(self.reference, self.estimate, *output, **how),
                USAGE,
                "out: cannot be written: Permission denied",
            )

    def test_a_full_device(self):
        for output in self.outputs_of("/dev/full"):
            result = self.run_program(self.reference, self.estimate, *output)
            self.expect_refusal(result, USAGE, "/dev/full: cannot be written: No space left on device")

    def test_stdout_is_full(self):
        for options in ((), ("--format", "json")):
            with self.subTest(options), open("/dev/full", "wb") as full:
                result = self.run_program(self.reference, self.estimate, "-o", self.json, *options, stdout=full)
                self.expect_refusal(result, USAGE, "No space left on device")

    def test_a_file_that_may_not_grow(self):
        """The town's errors take a megabyte; half of it may be written."""

        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (500_000, 500_000))  # Python ignores SIGXFSZ

        for output in self.outputs_of(self.errors)[1:]:
            result = self.run_program(
                TOWN / "reference.ply", TOWN / "estimate.ply", *output, preexec_fn=limit, restore_signals=False
            )
            self.expect_refusal(result, USAGE, "errors.ply: cannot be written: File too large")

    def test_a_full_disk(self):
        """A file system of 64 kB, mounted for the run alone."""
        alone = ["unshare", "--map-root-user", "--mount", "bash", "-c"]
        mount = f"mount -t tmpfs -o size=64k tmpfs {shlex.quote(str(self.outputs))} && "
        if subprocess.run([*alone, mount + "true"], stderr=subprocess.DEVNULL).returncode != 0:
            self.skipTest("no file system can be mounted here")
        for output in self.outputs_of(self.errors)[1:]:
            command = shlex.join(map(str, [PROGRAM, TOWN / "reference.ply", TOWN / "estimate.ply", *output]))
            look = f"{command}; code=$?; ls -A {shlex.quote(str(self.outputs))} >&2; exit $code"
            result = self.run_program(mount + look, program=alone)
            self.expect_refusal(result, USAGE, "errors.ply: cannot be written: No space left on device")
            self.assertNotIn("errors.ply", result.stderr.decode().splitlines()[1:], "seen inside the mount")
            self.assertEqual(len(result.stderr.decode().splitlines()), 1, "nothing is left in the mount")

    def test_one_output_that_fails_takes_the_others_with_it(self):
        others = ["--export-errors", self.errors, "--export-reference-errors", self.outputs / "reference.ply"]
        result = self.run_program(self.reference, self.estimate, *others, "-o", "/dev/full")
        self.expect_refusal(result, USAGE, "/dev/full")
        result = self.run_program(self.reference, self.estimate, "-o", self.json, "--export-errors", "/dev/full")
        self.expect_refusal(result, USAGE, "/dev/full")

    def test_old_files_survive_a_run_that_fails(self):
        old = {self.errors: b"old errors", self.json: b"old report"}
        for path, content in old.items():
            path.write_bytes(content)
        for outputs in (
            ["--export-errors", self.errors, "-o", "/dev/full"],
            ["-o", self.json, "--export-errors", "/dev/full"],
        ):
            result = self.run_program(self.reference, self.estimate, *outputs)
            self.assertEqual(result.returncode, USAGE)
            self.assertEqual({path: path.read_bytes() for path in self.outputs.iterdir()}, old)

    def test_an_input_is_no_output(self):
        link, hard_link = self.inputs / "link.ply", self.inputs / "hard_link.ply"
        link.symlink_to(self.reference.name)
        os.link(self.estimate, hard_link)
        config = self.input("config.json", "{}")
        matrix = self.input("T.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1")
        originals = {path: path.read_bytes() for path in (self.reference, self.estimate, config, matrix)}
        for path in (
            self.reference,
            self.estimate,
            link,
            hard_link,
            config,
            matrix,
            self.inputs / "../inputs/estimate.ply",
        ):
            for output in self.outputs_of(path):
                with self.subTest(output):
                    for name, content in originals.items():
                        name.write_bytes(content)
                    result = self.run_program(
                        self.reference, self.estimate, "--config", config, "--transform", matrix, *output
                    )
                    self.expect_refusal(result, USAGE, str(path))

    def test_two_outputs_have_two_names(self):
        for first, second in ((0, 1), (1, 2), (0, 2)):
            outputs = self.outputs_of(self.errors)
            with self.subTest((first, second)):
                result = self.run_program(self.reference, self.estimate, *outputs[first], *outputs[second])
                left = os.listdir(self.outputs)
                self.errors.unlink(missing_ok=True)
                self.assertEqual(left, [])
                self.expect_refusal(result, USAGE, str(self.errors))


if __name__ == "__main__":
    unittest.main()

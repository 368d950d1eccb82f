#!/usr/bin/env python3
"""The absolute trajectory errors of cmap_align, with evo's pairing, against evo's own: equal to 1e-9 of themselves.

usage: trajectories_test.py CMAP_ALIGN [--table]
Paths of our own, made like published ones; where they are there also CMAP_DATA_DIR's trajectories and those of evo's own
tests in CMAP_EVO_DATA (test/data of its repository). Exit 0: all agree; 1: some do not; 77: no evo here.
"""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

SKIPPED = 77
try:
    import numpy as np
    from evo.core import metrics, sync, trajectory
    from evo.tools import file_interface
except ImportError as error:
    print("skipped:", error, "(tests/evo/make_environment.sh)")
    sys.exit(SKIPPED)

RELATIVE = 1e-9   # sums in another order, over up to 1e4 poses at up to 1e3 m
ABSOLUTE_M = 1e-12


def path_at(t):
    """A room's worth of walking, turning and stopping."""
    return np.stack([2 * np.cos(0.4 * t) + 0.3 * np.sin(2.1 * t), 1.5 * np.sin(0.7 * t), 0.2 * np.sin(1.3 * t)], 1)


def estimate_of(t, scale, noise_m, seed):
    random = np.random.default_rng(seed)
    c, s = np.cos(0.8), np.sin(0.8)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    return scale * (path_at(t) + random.normal(0, noise_m, (len(t), 3))) @ turn.T + [3, -1, 0.5]


def write_tum(path, times, positions):
    rows = ("%.6f %.9f %.9f %.9f 0 0 0 1" % (t, *p) for t, p in zip(times, positions))
    path.write_text("# timestamp tx ty tz qx qy qz qw\n" + "\n".join(rows) + "\n")


def write_euroc(path, times, positions):
    rows = ("%d,%.9f,%.9f,%.9f,1,0,0,0,0,0,0,0,0,0,0,0,0" % (round(t * 1e9), *p) for t, p in zip(times, positions))
    path.write_text("#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], "
                    "v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1], b_w_RS_S_y [rad s^-1], "
                    "b_w_RS_S_z [rad s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], b_a_RS_S_z [m s^-2]\n" + "\n".join(rows) + "\n")


def jittered(start, stop, step, jitter, seed):
    t = np.arange(start, stop, step)
    return np.sort(t + np.random.default_rng(seed).uniform(-jitter, jitter, len(t)))


def made_pairs(folder):
    """(name, estimate, truth, offset of their clocks) of paths like published ones."""
    def pair(name, est_times, est, true_times, true, write=write_tum, offset=0.0):
        a, b = folder / (name + "_est.txt"), folder / (name + "_true" + (".csv" if write is write_euroc else ".txt"))
        write_tum(a, est_times, est)
        write(b, true_times, true)
        return name, a, b, offset

    epoch = 1311868163.0
    dense, sparse = epoch + jittered(0, 60, 0.01, 0.002, 1), epoch + jittered(5, 50, 1 / 30, 0.002, 2)
    true = path_at(dense - epoch)
    repeated = np.insert(dense, 2000, dense[2000])     # as in the published truth of fr2_desk: one time, two poses
    repeated_true = np.insert(true, 2000, true[2000] + [0.02, -0.01, 0.005], 0)
    hole = np.r_[0:2500, 3600:len(repeated)]           # and 11 s without a pose
    estimate = estimate_of(sparse - epoch, 2.2, 0.01, 3)
    yield pair("tum", sparse, estimate, repeated[hole], repeated_true[hole])
    rounded = np.round(sparse, 2)                      # stamps that were rounded when logged
    rounded[100:110] = np.repeat(rounded[100:110:2], 2)
    yield pair("euroc", rounded, estimate, dense, true, write_euroc)
    slow, fast = epoch + jittered(0, 60, 1.0, 0.004, 4), epoch + jittered(0, 60, 0.1, 0.004, 5)
    yield pair("1_against_10_hz", slow, estimate_of(slow - epoch, 1.0, 0.02, 6), fast, path_at(fast - epoch))
    yield pair("10_against_1_hz", fast, estimate_of(fast - epoch, 1.0, 0.02, 7), slow, path_at(slow - epoch))
    yield pair("other_clock", sparse - 0.3, estimate, dense, true, offset=0.3)
    yield pair("as_many", fast, estimate_of(fast - epoch, 0.9, 0.02, 8), fast + 0.003, path_at(fast - epoch))


def found_pairs():
    data, theirs = os.environ.get("CMAP_DATA_DIR"), os.environ.get("CMAP_EVO_DATA")
    if data:
        viral = Path(data) / "fastlivo2_ntu_viral"
        for name in ("eee", "nya", "sbs"):
            yield name, viral / f"{name}_01_prism.txt", viral / f"{name}_01_gt.txt", 0.0
    if theirs:
        folder = Path(theirs)
        for estimate, truth in (("fr2_desk_ORB", "fr2_desk_groundtruth"), ("fr2_desk_ORB_kf_mono", "fr2_desk_groundtruth"),
                                ("freiburg1_xyz-rgbdslam", "freiburg1_xyz-groundtruth"),
                                ("freiburg1_xyz-ORB_kf_mono", "freiburg1_xyz-groundtruth")):
            yield estimate, folder / (estimate + ".txt"), folder / (truth + ".txt"), 0.0
        yield "V102", folder / "V102.txt", folder / "V102_groundtruth.csv", 0.0


def by_evo(estimate_path, truth_path, offset, with_scale):
    read = file_interface.read_euroc_csv_trajectory if truth_path.suffix == ".csv" else file_interface.read_tum_trajectory_file
    estimate = file_interface.read_tum_trajectory_file(estimate_path)
    truth, estimate = sync.associate_trajectories(read(truth_path), estimate, offset_2=offset)
    estimate.align(truth, correct_scale=with_scale)
    error = metrics.APE(metrics.PoseRelation.translation_part)
    error.process_data((truth, estimate))
    return error.get_statistic(metrics.StatisticsType.rmse), truth.num_poses


def by_cmap(program, estimate_path, truth_path, offset, with_scale, folder):
    output = folder / "result.json"
    subprocess.run([program, estimate_path, truth_path, "--method", "trajectory", "--fit", "sim3" if with_scale else "se3",
                    "--pairing", "nearest", "--time-offset", repr(offset), "--allow-unconverged", "--json", output, "--quiet"], check=True)
    errors = {row["pairing"]: row for row in json.loads(output.read_text())["ate"]}
    return errors["nearest"]["rmse_m"], errors["nearest"]["n_pairs"], errors.get("interpolated", {}).get("rmse_m")


def main():
    program, show = sys.argv[1], "--table" in sys.argv[2:]
    failed, n = 0, 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for title, estimate, truth, offset in [*made_pairs(folder), *found_pairs()]:
            for with_scale in (False, True):
                theirs, n_theirs = by_evo(estimate, truth, offset, with_scale)
                ours, n_ours, interpolated = by_cmap(program, estimate, truth, offset, with_scale, folder)
                agrees = n_ours == n_theirs and abs(ours - theirs) <= ABSOLUTE_M + RELATIVE * theirs
                n += 1
                failed += not agrees
                if show or not agrees:
                    print(f"{title:26} {'sim3' if with_scale else 'se3':4} evo {theirs:.12g} ({n_theirs}), cmap_align {ours:.12g} "
                          f"({n_ours}), {ours / theirs - 1:+.1e}; interpolated {interpolated}")
    print(f"{n - failed} of {n} errors are evo's")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

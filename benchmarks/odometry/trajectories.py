"""Trajectories of TUM files, and how far one is from the truth. Needs numpy and scipy."""

import numpy as np
from scipy.spatial.transform import Rotation, Slerp


class Trajectory:
    """world_T_body by increasing time."""

    def __init__(self, rows):
        rows = rows[np.argsort(rows[:, 0], kind="stable")]
        rows = rows[np.append(True, np.diff(rows[:, 0]) > 0)]
        self.times = rows[:, 0]
        self.positions = rows[:, 1:4]
        self.rotations = Rotation.from_quat(rows[:, 4:8])

    @staticmethod
    def read(path):
        return Trajectory(np.loadtxt(path, ndmin=2))

    def at(self, times, slack_s=2e-3):
        """(positions, rotations) in between; times up to `slack_s` outside count as the end's. Raises ValueError."""
        if times.min() < self.times[0] - slack_s or times.max() > self.times[-1] + slack_s:
            raise ValueError(f"{times.min():.4f} to {times.max():.4f} s of {self.times[0]:.4f} to {self.times[-1]:.4f}")
        times = np.clip(times, self.times[0], self.times[-1])
        positions = np.stack([np.interp(times, self.times, self.positions[:, k]) for k in range(3)], 1)
        return positions, Slerp(self.times, self.rotations)(times)

    def covers(self, times, slack_s=2e-3):
        return (times >= self.times[0] - slack_s) & (times <= self.times[-1] + slack_s)


class Comparison:
    """An estimate's poses beside the truth at the same times; those that the truth does not cover are left out."""

    def __init__(self, estimate, truth, skip=0):
        keep = truth.covers(estimate.times)
        keep[:skip] = False
        self.times = estimate.times[keep]
        self.positions, self.rotations = estimate.positions[keep], estimate.rotations[keep]
        self.true_positions, self.true_rotations = truth.at(self.times)
        steps = np.linalg.norm(np.diff(self.true_positions, axis=0), axis=1)
        self.way_m = np.append(0.0, np.cumsum(steps))

    @property
    def length_m(self):
        return self.way_m[-1]

    def errors_between(self, i, j):
        """Of the motions from poses i to poses j, in the frame of j: (m, degrees)."""
        shift = self.rotations[i].inv().apply(self.positions[j] - self.positions[i])
        turn = self.rotations[i].inv() * self.rotations[j]
        true_shift = self.true_rotations[i].inv().apply(self.true_positions[j] - self.true_positions[i])
        true_turn = self.true_rotations[i].inv() * self.true_rotations[j]
        return np.linalg.norm(shift - true_shift, axis=1), np.degrees((true_turn.inv() * turn).magnitude())

    def relative_error(self, lengths_m):
        """KITTI's: the mean over all starts and lengths of the error after so much way: (%, degrees a meter)."""
        shares, turns = [], []
        for length in lengths_m:
            last = np.searchsorted(self.way_m, self.way_m + length)
            first = np.nonzero(last < len(self.way_m))[0]
            if len(first) == 0:
                continue
            shift, turn = self.errors_between(first, last[first])
            shares.append(100.0 * shift / length)
            turns.append(turn / length)
        if not shares:
            return float("nan"), float("nan")
        return float(np.concatenate(shares).mean()), float(np.concatenate(turns).mean())

    def end_to_end(self):
        """Of the whole way: (% of it, degrees)."""
        shift, turn = self.errors_between(np.array([0]), np.array([len(self.times) - 1]))
        return 100.0 * float(shift[0]) / self.length_m, float(turn[0])

    def attitude_deg(self):
        """Of every pose in the world."""
        return np.degrees((self.true_rotations.inv() * self.rotations).magnitude())

    def position_m(self):
        """Of every pose in the world."""
        return np.linalg.norm(self.positions - self.true_positions, axis=1)

"""How well a trajectory straightens scans. Needs numpy and scipy.

Trajectory errors hardly see it; surfaces that face the motion do."""

import numpy as np
from scipy.spatial import cKDTree


def to_scan_end(trajectory, positions_imu, times):
    """Points as seen at the scan's last time."""
    end = np.array([times.max()])
    place, rotation = trajectory.at(times, slack_s=0.2)
    end_place, end_rotation = trajectory.at(end, slack_s=0.2)
    world = rotation.apply(positions_imu) + place
    return end_rotation[0].inv().apply(world - end_place[0])


def errors_m(scans, estimate, truth, every=10, stride=20):
    """Distances of straightened points to where they truly are, both at the scan's end; scans that both cover."""
    errors = []
    for i in range(0, len(scans), every):
        positions, times = scans.read(i)
        if len(times) == 0 or not (estimate.covers(times).all() and truth.covers(times).all()):
            continue
        some = np.append(np.arange(0, len(times) - 1, stride), len(times) - 1)
        p, t = scans.in_imu(positions[some]), times[some]
        errors.append(np.linalg.norm(to_scan_end(estimate, p, t) - to_scan_end(truth, p, t), axis=1))
    return np.concatenate(errors)


def in_world(scans, trajectory, i, mode):
    """Points of scan i by the poses at their own times, all at the scan's end (`without`), or back to front."""
    positions, times = scans.read(i)
    if mode == "without":
        times = np.full_like(times, times.max())
    elif mode == "reversed":
        times = times.min() + (times.max() - times)
    place, rotation = trajectory.at(times, slack_s=0.2)
    return rotation.apply(scans.in_imu(positions)) + place, place.mean(0)


def facing_distances_m(scans, trajectory, mode="with", apart=10, every=5):
    """Distances of points to planes of the scan `apart` later, of surfaces that face the motion within 37 degrees."""
    found = []
    for i in range(0, len(scans) - apart, every):
        points, place = in_world(scans, trajectory, i, mode)
        later, later_place = in_world(scans, trajectory, i + apart, mode)
        motion = later_place - place
        if np.linalg.norm(motion) < 0.5:
            continue
        distances, neighbors = cKDTree(later).query(points, k=10, distance_upper_bound=1.0)
        near = np.isfinite(distances[:, -1])
        patches = later[neighbors[near]]
        centers = patches.mean(1)
        spread = patches - centers[:, None]
        variances, axes = np.linalg.eigh(np.einsum("nki,nkj->nij", spread, spread) / 10.0)
        normals = axes[:, :, 0]
        flat = (np.sqrt(np.maximum(0.0, variances[:, 0])) < 0.05) & (variances[:, 1] > 9.0 * variances[:, 0])
        facing = np.abs(normals @ (motion / np.linalg.norm(motion))) > 0.8
        found.append(np.abs(((points[near] - centers) * normals).sum(1))[flat & facing])
    return np.concatenate(found) if found else np.array([])

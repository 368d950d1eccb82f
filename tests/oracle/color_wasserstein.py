"""Color Wasserstein distance (CW): per voxel the 2-Wasserstein distance of the two Gaussians of RGB."""
from color import is_colored
from geometry import mean
from grids import Grid, band, phases, rows_by_voxel
from structure import wasserstein


def colors_by_voxel(points, colors, grid, min_points):
    """{voxel: colors} for voxels of at least max(min_points, 2) points with a color."""
    colored = is_colored(colors)
    return rows_by_voxel(points[colored], colors[colored], grid, max(min_points, 2))


def mean_distance(a, b):
    """Mean of W over the voxels of both, null without one; their number; the points of each in them."""
    shared = sorted(a.keys() & b.keys())
    return mean([wasserstein(a[k], b[k]) for k in shared]), len(shared), sum(len(a[k]) for k in shared), sum(len(b[k]) for k in shared)


def evaluate_grid(est, est_color, ref, ref_color, grid, min_points):
    """Value, number of voxels and the share of each map's colored points in them, on one grid."""
    value, n, n_est, n_ref = mean_distance(colors_by_voxel(est, est_color, grid, min_points),
                                           colors_by_voxel(ref, ref_color, grid, min_points))
    return {"value": value, "n_voxels": n, "share_estimate": n_est / max(1, is_colored(est_color).sum()),
            "share_reference": n_ref / max(1, is_colored(ref_color).sum())}


def color_wasserstein(est, est_color, ref, ref_color, voxel_m, min_points, n_grids):
    """CW on the grid at the world's origin and, unless n_grids is 1, over its phases."""
    record = evaluate_grid(est, est_color, ref, ref_color, Grid(voxel_m), min_points)
    if n_grids > 1:
        others = phases(voxel_m, n_grids)[1:]
        record["phases"] = band([record["value"]] + [evaluate_grid(est, est_color, ref, ref_color, grid, min_points)["value"]
                                                      for grid in others])
    return record

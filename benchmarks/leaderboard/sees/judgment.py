"""Whether a metric sees a defect: from which size on it moves by more than noise, and whether it moves the right way."""
import math
from dataclasses import dataclass, field

import numpy as np

import defects
import scenes

LEAST_CHANGE = 0.005  # of the exact estimate's value: less is no change that anybody would act on


@dataclass
class Row:
    """One number of a report: of which evaluation (run.arguments), which metric, which of its parts."""
    title: str
    metric: str
    run: str = "scale"
    part: str = "value"
    threshold_m: float = None

    def record(self, runs):
        record = runs[self.run][self.metric]
        if self.threshold_m is None:
            return record
        return next(r for r in record["per_threshold"] if r["threshold_m"] == self.threshold_m)

    def value(self, runs):
        """A number, or None."""
        value = self.record(runs).get(self.part)
        return value.get("value") if isinstance(value, dict) else value

    def worse(self, runs):
        """1 where greater is worse, else -1."""
        better = "higher" if self.part == "skill" else runs[self.run][self.metric]["better"]
        return 1 if better == "lower" else -1

    def grid_noise(self, runs):
        phases = self.record(runs).get("phases") if self.part == "value" else None
        return phases["std"] if phases and phases["std"] is not None else 0.0


def groups(scene):
    """What is shown: the paper's color metrics, other ones of color, geometry."""
    own = scenes.SCENES[scene]
    at, named, near = {"threshold_m": own.threshold_m}, "@%g" % own.threshold_m, "LCR, %g m" % own.lcr_radius_m
    paper = [Row("CD", "color_distance"), Row("CF", "color_fidelity"), Row("LCR, 0.5 m", "local_color_recall", "paper"),
             Row("CCS, 0.1 m", "color_consistency", "paper")]
    color = [Row(near, "local_color_recall"), Row("CW", "color_wasserstein"), Row("CIEDE2000", "delta_e"),
             Row("median CD", "median_color_distance"), Row("exposure-free CD", "color_distance_exposure_free"), Row("PSNR", "color_psnr"),
             Row("skill of CD", "color_distance", part="skill"), Row("skill of " + near, "local_color_recall", part="skill"),
             Row("skill of CW", "color_wasserstein", part="skill")]
    geometry = [Row("Chamfer", "chamfer"), Row("RMSE", "rmse"), Row("accuracy" + named, "accuracy", **at),
                Row("fitness" + named, "fitness", **at), Row("completeness" + named, "completeness", **at),
                Row("F-score" + named, "f_score", **at), Row("Hausdorff", "hausdorff"), Row("AWD", "average_wasserstein"),
                Row("SCS", "spatial_consistency")] + [Row("MME", "mean_map_entropy")] * own.has_entropy
    return [paper, color, geometry]


def rows(scene):
    return [row for group in groups(scene) for row in group]


@dataclass
class Cell:
    """One metric and one defect. Changes are of each size, greater is worse; None where there is no value."""
    sizes: list
    changes: list
    signs: list = field(default_factory=list)  # of each size: 1 worse than the noise, as it should, -1 better, 0 neither

    def first(self, sign):
        """The smallest size at which the score moves that way, or None."""
        return next((size for size, s in zip(self.sizes, self.signs) if s == sign), None)


def noise(row, exact):
    """Spread of the exact estimates of all samplings, the grid's phases, or LEAST_CHANGE: the largest."""
    values = [row.value(runs) for runs in exact]
    if None in values:
        return math.inf
    return max(np.ptp(values), np.mean([row.grid_noise(runs) for runs in exact]), LEAST_CHANGE * abs(np.mean(values)))


def change(row, runs, exact):
    value, before = row.value(runs), row.value(exact)
    return None if value is None or before is None else row.worse(exact) * (value - before)


def judge_cell(row, seeds, defect, sizes):
    """A size is seen where the changes of all samplings go the same way by more than the noise."""
    exact = [measured["exact", 0] for measured in seeds]
    least, cell = noise(row, exact), Cell(sizes, [])
    for size in sizes:
        changes = [change(row, measured[defect, size], before) for measured, before in zip(seeds, exact)]
        known = None not in changes
        cell.changes.append(float(np.mean(changes)) if known else None)
        cell.signs.append(int(known and min(changes) > least) - int(known and max(changes) < -least))
    return cell


def judge(scene, by_seed):
    """(title of the row, defect) -> Cell."""
    seeds = list(by_seed.values())
    found = {}
    for row in rows(scene):
        for name in defects.planted(scene):
            sizes = [size for defect, size in seeds[0] if defect == name]
            found[row.title, name] = judge_cell(row, seeds, name, sizes)
    return found


def markdown(scene, found):
    """Rows of metrics: the size from which each defect is seen."""
    planted = defects.planted(scene)
    lines = ["| | " + " | ".join("%s [%s]" % (d.title, d.unit) for d in planted.values()) + " |", "|---" * (len(planted) + 1) + "|"]
    for row in rows(scene):
        lines.append("| %s | %s |" % (row.title, " | ".join(words(found[row.title, name]) for name in planted)))
    return "\n".join(lines)


def words(cell):
    """"0.1", "**wrong: 0.1**", both, or that there is nothing."""
    if all(c is None for c in cell.changes):
        return "no value"
    right, wrong = cell.first(1), cell.first(-1)
    parts = ["%g" % right] if right is not None else []
    parts += ["**wrong: %g**" % wrong] if wrong is not None else []
    return ", ".join(parts) or "–"

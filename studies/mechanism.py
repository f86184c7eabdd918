"""Figures 3 to 6 have one layout: the cell in space, the course of the PNC, and its flow at three times."""

import matplotlib.pyplot as plt
import numpy as np

from drawing import draw_course, draw_plane, draw_space, draw_tension_key
from study import centring_time, mean_over, minutes, rotation_time, seed_labels


def draw_mechanism(study, runs, title, paper):
    """The picture of one mechanism, with what the paper says of it; the space and flow of the first run. Returns its tables
    of observables."""
    tables = [study.observe(run) for run in runs]
    figure = plt.figure(figsize=(12, 7), constrained_layout=True)
    figure.suptitle(f"{title}, {study.options.fibers} microtubules")
    grid = figure.add_gridspec(2, 6)
    times = study.times(runs[0])
    background = figure.add_subplot(grid[0, :3], facecolor="0.25", xticks=[], yticks=[])
    stamp = draw_space(figure.add_subplot(grid[0, :3], projection="3d"), runs[0], times[-1])
    draw_tension_key(background, 1.0)
    background.text(0.02, 0.04, stamp, color="white", transform=background.transAxes, fontsize=9)
    draw_course(figure.add_subplot(grid[0, 3:]), tables, seed_labels(runs), paper)
    for i, part in enumerate((0.08, 0.5, 1.0)):
        with study.flow(runs[0], part * times[-1]) as flow:
            draw_plane(figure.add_subplot(grid[1, 2 * i:2 * i + 2]), flow)
    return figure, tables


def record_course(study, tables, centring, rotation):
    """Centring and rotation times of every seed beside the paper's words."""
    for name, measure, paper in (("time to within 2 um of the centre", lambda table: centring_time(table, 2.0), centring),
                                 ("time to within 1 um of the centre", centring_time, centring),
                                 ("time to align within 10 degrees", rotation_time, rotation)):
        study.record(name, paper, ", ".join(minutes(measure(table), table) for table in tables))
    for name, column, unit in (("position at the end", "pnc_x", "um"), ("angle at the end", "pnc_angle", "degrees")):
        study.record(name, "", ", ".join(f"{table[column][-1]:.1f} {unit}" for table in tables),
                     f"after {tables[0]['time'][-1] / 60:.1f} min")


def record_shape(study, tables):
    """How the fibers are loaded and bent, and what the flow looks like from afar."""
    for name, column in (("mean tension (pN)", "tension_mean"), ("root mean square curvature (1/um)", "curvature_mean"),
                         ("puller index", "puller_index")):
        study.record(name, "", spread([mean_over(table, column, 1.0) for table in tables]))


def spread(values, digits=3):
    """'1.23' or '1.23 +- 0.05' over seeds."""
    values = np.array(values, dtype=float)
    if len(values) == 1:
        return f"{values[0]:.{digits}g}"
    return f"{values.mean():.{digits}g} +- {values.std(ddof=1):.2g}"

#!/usr/bin/env python3
"""Figure 2: drag of the PNC against the number of microtubules at three levels of interaction, and its flow when pulled
and turned, with and without microtubules."""

import csv
import json
import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import LogFormatter

from drawing import draw_plane
from study import SCENES, Study

LEVELS = {"local": ("tab:green", "s"), "open": ("tab:blue", "o"), "confined": ("tab:red", "^")}
LOADS = {"pulled": {"body__pnc__force": [-10.0, 0.0, 0.0]},
         "turned": {"body__pnc__force": [0.0, 0.0, 0.0], "body__pnc__torque": [0.0, 0.0, 50.0]}}


def measure_drag(study, scene):
    """Rows of drag.csv; more points are added to a table that is there."""
    folder = study.folder / "runs" / f"drag-{scene.stem}{'-quick' if study.options.quick else ''}"
    if not study.options.drawing_only:
        settings = {"drag.fiber_counts": [0, 24, 48] if study.options.quick else [0, 100, 300, 600, 1200]}
        if study.options.quick:
            settings |= {"drag.settling_time": 0.1, "drag.duration": 0.1, "run.accuracy": 1e-2}
        study.asterflow("drag", scene, "-o", folder,
                        *[word for key, value in settings.items() for word in ("--set", f"{key}={json.dumps(value)}")])
    elif not (folder / "drag.csv").exists():
        sys.exit(f"{study.figure}: {folder} has not been run: leave out --drawing-only")
    with open(folder / "drag.csv", newline="") as file:
        return list(csv.DictReader(file))


def draw_drag(axis, rows, motion, effective_sphere):
    for level, (color, marker) in LEVELS.items():
        chosen = [row for row in rows if row["level"] == level]
        axis.errorbar([int(row["fibers"]) for row in chosen], [float(row[f"{motion}_drag"]) for row in chosen],
                      [float(row[f"{motion}_spread"]) for row in chosen], color=color, marker=marker, capsize=2, label=level)
    axis.axhline(effective_sphere, color="black", linewidth=0.8, label="sphere of twice the radius")
    axis.margins(y=0.25)
    axis.set(yscale="log", ylim=(0.8, None), xlabel="microtubules", ylabel="relative drag", title=motion)
    axis.grid(alpha=0.3, which="both")
    for part in (axis.yaxis.set_major_formatter, axis.yaxis.set_minor_formatter):
        part(LogFormatter(minor_thresholds=(2, 0.5)))


def record_drag(study, rows):
    most = max(int(row["fibers"]) for row in rows)
    for motion in ("translation", "rotation"):
        drag = {(row["level"], int(row["fibers"])): float(row[f"{motion}_drag"]) for row in rows}
        papers = (6.0, 6.0) if motion == "translation" else ("much smaller than for translation", "")
        for name, value, paper in (("confined / open", drag["confined", most] / drag["open", most], papers[0]),
                                   ("confined / confined without microtubules", drag["confined", most] / drag["confined", 0], papers[1]),
                                   ("local / confined", drag["local", most] / drag["confined", most], "several")):
            study.record(f"{motion}, {most} microtubules: {name}", paper, float(f"{value:.3g}"))
        for level in LEVELS:
            curve = np.array([value for (of, _), value in sorted(drag.items()) if of == level])
            study.record(f"{motion}, {level}: grows with their number", "yes", "yes" if (np.diff(curve) > 0).all() else "no")


def main():
    study = Study("figure02", __doc__)
    rows = measure_drag(study, SCENES / "figure2_demo.toml")
    picture, axes = plt.subplots(2, 3, figsize=(15, 8), constrained_layout=True)
    draw_drag(axes[0, 0], rows, "translation", 2.0)
    draw_drag(axes[1, 0], rows, "rotation", 8.0)
    axes[0, 0].legend(fontsize=8, ncol=2)
    record_drag(study, rows)
    with_fibers = study.options.fibers
    for (title, load), axis_row in zip(LOADS.items(), axes):
        for fibers, axis in zip((with_fibers, 0), axis_row[1:]):
            study.options.fibers = fibers
            run = study.run(f"figure02-{title}", "figure2.toml", 5.0, **load)
            with study.flow(run, study.times(run)[-1]) as flow:
                draw_plane(axis, flow)
            axis.set_title(f"{title}, {fibers} microtubules")
    study.options.fibers = with_fibers
    study.finish(picture)


if __name__ == "__main__":
    main()

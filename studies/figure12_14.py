#!/usr/bin/env python3
"""Figures 12 to 14: pushing without sliding for turnover times 3, 5 and 10 s. Shapes of the fibers, course of the PNC,
forces at the ends."""

import matplotlib.pyplot as plt
import numpy as np

from drawing import draw_course, draw_plane
from pushing import TURNOVER_TIMES, draw_end_forces, no_sliding_runs, record_end_forces
from study import Study, centring_time, first_time, mean_over, minutes, rotation_time, seed_labels

PAPER = {3: (15, 3.0, (14.8, 14.3, 0.97)), 5: (8, 3.5, (19.3, 17.7, 0.92)), 10: (8, 1.6, (23.3, 19.3, 0.82))}

study = Study("figure12_14", __doc__)
picture, axes = plt.subplots(3, 3, figsize=(13, 10), constrained_layout=True)
for (plane, course, forces), turnover_time in zip(axes.T, TURNOVER_TIMES):
    runs = no_sliding_runs(study, turnover_time)
    tables = [study.observe(run) for run in runs]
    with study.flow(runs[0], study.times(runs[0])[-1]) as flow:
        draw_plane(plane, flow)
    plane.set_title(f"turnover time {turnover_time} s, {study.options.fibers} microtubules")
    name, (paper_minutes, ratio, force) = f"turnover {turnover_time} s", PAPER[turnover_time]
    centring = f"{paper_minutes} min"
    draw_course(course, tables, seed_labels(runs), f"centres in {centring}, aligns in {paper_minutes * ratio:.0f} min")
    draw_end_forces(forces, tables, force)
    times = np.array([(centring_time(t, 2.0), rotation_time(t)) for t in tables])
    study.record(f"{name}: time to within 2 um of the centre", centring, ", ".join(minutes(c, t) for (c, _), t in zip(times, tables)))
    study.record(f"{name}: time to pass the centre", centring, ", ".join(minutes(first_time(t["time"], t["pnc_x"] <= 0), t) for t in tables))
    study.record(f"{name}: time to align within 10 degrees", "", ", ".join(minutes(r, t) for (_, r), t in zip(times, tables)))
    study.record(f"{name}: rotation time over that to 2 um", ratio, float(f"{np.nanmean(times[:, 1] / times[:, 0]):.3g}")
                 if np.isfinite(times).all(axis=1).any() else "not reached")
    study.record(f"{name}: position at {tables[0]['time'][-1] / 60:.1f} min", "", f"{np.mean([t['pnc_x'][-1] for t in tables]):.2f} um")
    study.record(f"{name}: curvature (1/um)", "grows with turnover time",
                 float(f"{np.mean([mean_over(t, 'curvature_mean', 20.0) for t in tables]):.3g}"))
    record_end_forces(study, name, tables, force)
study.finish(picture)

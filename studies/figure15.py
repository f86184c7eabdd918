#!/usr/bin/env python3
"""Figure 15: flows of pushing without sliding, early, turned and centred, for turnover times 10 and 5 s: alike."""

import matplotlib.pyplot as plt
import numpy as np

from drawing import draw_plane
from pushing import no_sliding_runs
from study import Study, mean_over, rotation_time

study = Study("figure15", __doc__)
picture, axes = plt.subplots(3, 2, figsize=(9, 8.5), constrained_layout=True)
for column, turnover_time in zip(axes.T, (10, 5)):
    run = no_sliding_runs(study, turnover_time)[0]
    table = study.observe(run)
    end = table["time"][-1]
    stages = (min(60.0, 0.1 * end), rotation_time(table), end)
    for axis, time in zip(column, stages):
        with study.flow(run, time if np.isfinite(time) else 0.5 * end) as flow:
            draw_plane(axis, flow)
    column[0].set_title(f"turnover time {turnover_time} s, {study.options.fibers} microtubules")
    study.record(f"turnover {turnover_time} s: mean fluid speed (um/s)", "alike", float(f"{mean_over(table, 'fluid_speed_mean', 20.0):.3g}"))
    study.record(f"turnover {turnover_time} s: fluid speed over PNC speed", "of order 1",
                 float(f"{mean_over(table, 'fluid_speed_mean', 20.0) / mean_over(table, 'pnc_speed', 20.0):.3g}"))
study.finish(picture)

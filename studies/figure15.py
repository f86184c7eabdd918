#!/usr/bin/env python3
"""Figure 15: flows of pushing without sliding, early, centred and turned, for turnover times 10 and 5 s: alike."""

import matplotlib.pyplot as plt

from drawing import draw_plane
from pushing import no_sliding_runs
from study import Study, mean_over

study = Study("figure15", __doc__)
picture, axes = plt.subplots(3, 2, figsize=(9, 8.5), constrained_layout=True)
for column, turnover_time in zip(axes.T, (10, 5)):
    run = no_sliding_runs(study, turnover_time)[0]
    table = study.observe(run)
    for axis, part in zip(column, (0.08, 0.5, 1.0)):
        with study.flow(run, part * study.times(run)[-1]) as flow:
            draw_plane(axis, flow)
    column[0].set_title(f"turnover time {turnover_time} s, {study.options.fibers} microtubules")
    study.record(f"turnover {turnover_time} s: mean fluid speed (um/s)", "alike", float(f"{mean_over(table, 'fluid_speed_mean', 20.0):.3g}"))
    study.record(f"turnover {turnover_time} s: fluid speed over PNC speed", "of order 1",
                 float(f"{mean_over(table, 'fluid_speed_mean', 20.0) / mean_over(table, 'pnc_speed', 20.0):.3g}"))
study.finish(picture)

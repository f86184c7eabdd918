#!/usr/bin/env python3
"""Figure 11: total forces on the plus and minus ends of fibers at the cortex, free sliding against no sliding."""

import matplotlib.pyplot as plt

from pushing import draw_end_forces, no_sliding_runs, record_end_forces
from study import Study

PAPER = {"free sliding": (18.0, 14.0, 0.75), "no sliding": (48.0, 44.0, 0.92)}

study = Study("figure11", __doc__)
runs = {"free sliding": study.runs("pushing_free_sliding", "pushing_free_sliding.toml", 2400.0),
        "no sliding": no_sliding_runs(study, 5)}
picture, axes = plt.subplots(1, 2, figsize=(11, 4), constrained_layout=True, sharey=True)
for axis, (name, folders) in zip(axes, runs.items()):
    tables = [study.observe(run) for run in folders]
    draw_end_forces(axis, tables, PAPER[name])
    axis.set_xlabel(f"time (min): {name}, {study.options.fibers} microtubules")
    record_end_forces(study, name, tables, PAPER[name])
study.finish(picture)

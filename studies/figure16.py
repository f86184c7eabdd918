#!/usr/bin/env python3
"""Figure 16: cortical pulling with twice the sites, or twice the rate of detachment: aligns, but does not centre."""

import matplotlib.pyplot as plt

from drawing import draw_course
from mechanism import record_course
from study import Study, seed_labels

CASES = {"100 sites": ("cortical_pulling", {}, "centres"),
         "200 sites": ("cortical_pulling-sites200", {"cortical_pulling__sites": 200}, "starts, then goes back"),
         "detachment doubled": ("cortical_pulling-detaching2", {"cortical_pulling__residence_time": 10.0}, "does not centre")}

study = Study("figure16", __doc__)
picture, axes = plt.subplots(1, 3, figsize=(14, 4), constrained_layout=True)
for axis, (name, (run_name, changes, centring)) in zip(axes, CASES.items()):
    runs = study.runs(run_name, "cortical_pulling.toml", 3600.0, **changes)
    tables = [study.observe(run) for run in runs]
    draw_course(axis, tables, seed_labels(runs))
    axis.set_title(f"{name}, {study.options.fibers} microtubules\npaper: {centring}", fontsize=9)
    before = len(study.records)
    record_course(study, tables, centring, "aligns")
    for record in study.records[before:]:
        record["quantity"] = f"{name}: {record['quantity']}"
study.finish(picture)

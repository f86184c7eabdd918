#!/usr/bin/env python3
"""Figure 6: cytoplasmic pulling. It centres and aligns the PNC; the flow on the anterior side opposes the motion, and
after centring the fluid is much faster than the PNC."""

import numpy as np

from mechanism import draw_mechanism, record_course, record_shape, spread
from study import Study, centring_time, drift_speed, mean_over

study = Study("figure06", __doc__)
runs = study.runs("cytoplasmic_pulling", "cytoplasmic_pulling.toml", 900.0)
picture, tables = draw_mechanism(study, runs, "cytoplasmic pulling", "centres in about 5 min and aligns")
record_course(study, tables, "about 5 min", "with the centring")
record_shape(study, tables)
for name, column in (("among the anterior fibers", "flow_in_anterior_asters_x"), ("beside the PNC", "flow_anterior_x")):
    early = [(mean_over(t, column, 1.0, 120.0), mean_over(t, "pnc_velocity_x", 1.0, 120.0)) for t in tables]
    study.record(f"anterior flow {name} over PNC velocity", "negative: opposes the motion", spread([u / v for u, v in early]))
study.record("mean flow along the fibers (um/s)", "negative: towards the centrosomes",
             spread([mean_over(t, "flow_along_fibers", 1.0) for t in tables]))
centred = [np.nan_to_num(centring_time(t), nan=0.8 * t["time"][-1]) for t in tables]
fluid_speed = [mean_over(t, "fluid_speed_mean", c) for t, c in zip(tables, centred)]
study.record("fluid speed over PNC speed when centred", "much larger than 1",
             spread([u / mean_over(t, "pnc_speed", c) for u, t, c in zip(fluid_speed, tables, centred)]))
study.record("the same, of its way in half a minute", "much larger than 1",
             spread([u / drift_speed(t, 30.0, c) for u, t, c in zip(fluid_speed, tables, centred)]))
study.record("PNC speed while centring (um/s)", "0.065", spread([mean_over(t, "pnc_speed", 1.0, 120.0) for t in tables]))
study.finish(picture)

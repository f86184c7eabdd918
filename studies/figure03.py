#!/usr/bin/env python3
"""Figure 3: cortical pulling. It centres and aligns the PNC together, with straight fibers under extension."""

from mechanism import draw_mechanism, record_course, record_shape, spread
from study import Study, mean_over

study = Study("figure03", __doc__)
runs = study.runs("cortical_pulling", "cortical_pulling.toml", 3600.0)
picture, tables = draw_mechanism(study, runs, "cortical pulling", "centres and aligns together")
record_course(study, tables, "centres", "aligns, with the centring")
study.record("captured fibers at the end", "about 32 on each side",
             spread([mean_over(t, "fibers_captured", t["time"][-1] - 300.0) for t in tables]))
record_shape(study, tables)
study.finish(picture)

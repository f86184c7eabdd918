#!/usr/bin/env python3
"""Figure 4: cortical pushing with free sliding. It centres the PNC but does not turn it in reasonable time."""

from mechanism import draw_mechanism, record_course, record_shape
from study import Study

study = Study("figure04", __doc__)
runs = study.runs("pushing_free_sliding", "pushing_free_sliding.toml", 2400.0)
picture, tables = draw_mechanism(study, runs, "cortical pushing, free sliding", "centres, does not align within 40 min")
record_course(study, tables, "centres", "not within 40 min")
record_shape(study, tables)
study.finish(picture)

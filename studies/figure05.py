#!/usr/bin/env python3
"""Figure 5: cortical pushing without sliding, turnover time 5 s. It centres the PNC, then turns it; fibers buckle."""

from mechanism import draw_mechanism, record_course, record_shape
from pushing import no_sliding_runs
from study import Study

study = Study("figure05", __doc__)
picture, tables = draw_mechanism(study, no_sliding_runs(study, 5), "cortical pushing, no sliding",
                                 "centres in about 8 min, aligns in 3.5 times that")
record_course(study, tables, "about 8 min", "3.5 times the centring time")
record_shape(study, tables)
study.finish(picture)

"""Runs and pictures of cortical pushing that several figures share: turnover times, forces at the ends of the fibers."""

import numpy as np

from drawing import SEED_STYLES
from study import mean_over

TURNOVER_TIMES = (3, 5, 10)  # s, 1 / f_min


def no_sliding_runs(study, turnover_time):
    """Runs of the no-sliding model with that turnover time (s) at the cortex."""
    rate = {3: 0.33, 5: 0.2, 10: 0.1}[turnover_time]
    return study.runs(f"pushing_no_sliding-tau{turnover_time}", "pushing_no_sliding.toml", 2400.0,
                      pushing__minimal_catastrophe_rate=rate)


def draw_end_forces(axis, tables, paper):
    """Total force on plus ends (red) and minus ends (blue) of the fibers at the cortex against minutes, of every seed; its
    means over time and seeds, and the `paper`'s (plus ends, minus ends, ratio)."""
    for table, style in zip(tables, SEED_STYLES):
        for column, color, label in (("plus_end_force", "tab:red", "plus ends"), ("minus_end_force", "tab:blue", "minus ends")):
            axis.plot(table["time"] / 60, table[column], style, color=color, linewidth=0.9, label=label if table is tables[0] else None)
    axis.set_title("mean plus, minus: {:.3g}, {:.3g} pN ({:.2f}), net {:.3g}, {:.3g}\npaper: {:g}, {:g} pN ({:g})".format(
        *end_forces(tables), *end_forces(tables, kind="net_")[:2], *paper), fontsize=9)
    axis.set(xlabel="time (min)", ylabel="total force (pN)")
    axis.legend(fontsize=8)


def end_forces(tables, settling=20.0, kind=""):
    """Means over time and seeds: plus ends (pN), minus ends (pN), and the ratio of the means. `kind`: "" for the sum of
    the magnitudes, "net_" for the magnitude of the vector sum."""
    plus, minus = (np.mean([mean_over(t, f"{kind}{column}", min(settling, t["time"][-1] / 2)) for t in tables])
                   for column in ("plus_end_force", "minus_end_force"))
    return plus, minus, minus / plus if plus > 0 else float("nan")


def record_end_forces(study, name, tables, paper):
    """`paper`: plus ends, minus ends, ratio. It does not say whether these are sums of magnitudes or net forces."""
    for quantity, theirs, ours, net in zip(("plus-end force (pN)", "minus-end force (pN)", "minus / plus"), paper,
                                           end_forces(tables), end_forces(tables, kind="net_")):
        note = f"net {net:.3g}" if np.isfinite(net) else ""
        if study.options.fibers != 600 and "/" not in quantity:
            note += f"; {study.options.fibers} microtubules, paper 600"
        study.record(f"{name}: {quantity}", theirs, float(f"{ours:.3g}"), note)

#!/usr/bin/env python3
"""Picture of the observables of a run against time.

    plot_observables.py OBSERVABLES.csv LENGTHS.csv PICTURE.png

Both tables are written by `asterflow observe`; docs/observables.md lists their columns.
"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

# title, unit, {column: label}; a column is left out where the table lacks it or it is not a number throughout.
PANELS = (
    ("position of the first body", "um", {"_x": "x", "_y": "y", "_z": "z"}),
    ("angle of its axis to x", "degrees", {"_angle": None}),
    ("speeds", "um/s", {"_speed": "body", "fluid_speed_mean": "fluid, mean", "fluid_speed_largest": "fluid, largest"}),
    ("its turning", "rad/s", {"_angular_speed": None}),
    ("fluid, mean speed over the body's", "", {"fluid_speed_ratio": None}),
    ("plus ends", "fibers", {"fibers_growing": "growing", "fibers_shrinking": "shrinking",
                             "fibers_pushing": "pushing", "fibers_captured": "captured"}),
    ("forces at the ends", "pN", {"plus_end_force": "plus ends", "minus_end_force": "minus ends",
                                  "net_plus_end_force": "plus ends, net", "net_minus_end_force": "minus ends, net"}),
    ("forces at the ends, minus over plus", "", {"end_force_ratio": None}),
    ("tension", "pN", {"tension_least": "least", "tension_mean": "mean", "tension_largest": "largest"}),
    ("curvature", "1/um", {"curvature_mean": "root mean square", "curvature_largest": "largest"}),
    ("energy", "pN um", {"elastic_energy": "elastic"}),
    ("work per time", "pN um/s", {"motor_power": "motors", "tip_power": "plus ends", "body_power": "loads on bodies"}),
    ("force on the fluid", "pN", {"net_force_x": "x", "net_force_y": "y", "net_force_z": "z"}),
    ("torque on the fluid about the origin", "pN um", {"net_torque_x": "x", "net_torque_y": "y", "net_torque_z": "z"}),
    ("force that moves the first body", "pN", {"_force_x": "x", "_force_y": "y", "_force_z": "z"}),
    ("torque that turns it", "pN um", {"_torque_x": "x", "_torque_y": "y", "_torque_z": "z"}),
    ("first moment of the forces", "pN um", {f"force_moment_{ij}": ij for ij in ("xx", "yy", "zz", "xy", "xz", "yz")}),
    ("puller index", "", {"puller_index": None}),
    ("flow along x beside the body", "um/s", {"flow_anterior_x": "anterior (-x)", "flow_posterior_x": "posterior (+x)"}),
    ("flow beside the fibers", "um/s", {"flow_along_fibers": "along them", "flow_in_anterior_asters_x": "along x, anterior"}),
    ("slip between the nodes, relative", "", {"no_slip_residual": None}),
)


def read_table(path):
    """Columns [n_time] by name."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return dict(zip(rows[0], np.array(rows[1:], dtype=float).T))


def curves(table, body, columns):
    """Values [n_time] and label of the columns that have any."""
    for column, label in columns.items():
        values = table.get(body + column if column.startswith("_") else column)
        if values is not None and np.isfinite(values).any():
            yield values, label


def draw_panel(axis, table, body, panel):
    title, unit, columns = panel
    for values, label in curves(table, body, columns):
        axis.plot(table["time"], values, label=label, linewidth=1.2)
    axis.set(title=title, xlabel="time (s)", ylabel=unit)
    axis.grid(alpha=0.3)
    if len(axis.get_legend_handles_labels()[0]) > 1:
        axis.legend(fontsize=7)


def draw_lengths(axis, table):
    lower = np.array([float(name[5:]) for name in table if name != "time"])
    fractions = np.array([table[name] for name in table if name != "time"])
    used = np.flatnonzero(fractions.any(axis=1))
    top = used[-1] + 2 if len(used) else 2
    axis.stairs(fractions[:top, 0], np.append(lower, 2 * lower[-1] - lower[-2])[: top + 1], label="first", color="0.6")
    axis.stairs(fractions[:top].mean(axis=1), np.append(lower, 2 * lower[-1] - lower[-2])[: top + 1], label="mean of all states")
    axis.set(title="lengths of the fibers", xlabel="um", ylabel="fraction")
    axis.legend(fontsize=7)


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    table, lengths = read_table(sys.argv[1]), read_table(sys.argv[2])
    bodies = [name[:-2] for name in table if name.endswith("_x") and f"{name[:-2]}_speed" in table]
    body = bodies[0] if bodies else ""
    panels = [panel for panel in PANELS if any(curves(table, body, panel[2]))]
    n_row = len(panels) // 5 + 1  # with the lengths
    figure, axes = plt.subplots(n_row, 5, figsize=(20, 3 * n_row), constrained_layout=True)
    axes = axes.ravel()
    for axis, panel in zip(axes, panels):
        draw_panel(axis, table, body, panel)
    draw_lengths(axes[len(panels)], lengths)
    for axis in axes[len(panels) + 1:]:
        axis.remove()
    figure.savefig(sys.argv[3], dpi=90)


if __name__ == "__main__":
    main()

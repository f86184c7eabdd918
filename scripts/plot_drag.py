#!/usr/bin/env python3
"""Picture of a drag study: translational and rotational drag over that of the bare sphere, against the number of
fibers, for each level of interactions [the paper's Figure 2a].

    plot_drag.py DRAG.csv PICTURE.png

DRAG.csv is written by `asterflow drag`.
"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

STYLE = {"local": ("tab:green", "s"), "open": ("tab:blue", "o"), "confined": ("tab:red", "^")}
PANELS = (("translation", 2.0, r"$F \,/\, 6\pi\mu a U$"), ("rotation", 8.0, r"$T \,/\, 8\pi\mu a^3 \Omega$"))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1], newline="") as file:
        rows = list(csv.DictReader(file))
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.5), constrained_layout=True)
    for axis, (motion, effective_sphere, label) in zip(axes, PANELS):
        for level, (color, marker) in STYLE.items():
            chosen = [row for row in rows if row["level"] == level]
            count = [int(row["fibers"]) for row in chosen]
            drag = [float(row[f"{motion}_drag"]) for row in chosen]
            error = [float(row.get(f"{motion}_spread") or 0) for row in chosen]
            if chosen:
                axis.errorbar(count, drag, yerr=error, color=color, marker=marker, capsize=2, label=level)
        axis.axhline(effective_sphere, color="black", linewidth=0.8, label="sphere of twice the radius")
        axis.set(yscale="log", xlabel="number of fibers", ylabel=label, title=motion)
        axis.grid(alpha=0.3, which="both")
    axes[0].legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncol=2)
    figure.savefig(sys.argv[2], dpi=160)


if __name__ == "__main__":
    main()

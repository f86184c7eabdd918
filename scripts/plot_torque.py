#!/usr/bin/env python3
"""Picture of the torque instability: angular velocity of the body against the angle of its axis [the paper's Figure
10b]. Lines: ever more fibers; dots: the fibers of the scene.

    plot_torque.py TORQUE.csv PICTURE.png

TORQUE.csv is written by `asterflow torque`.
"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

LAWS = {"free_sliding": ("tab:blue", "along the normal (free sliding)"),
        "no_sliding": ("tab:red", "along the fiber (no sliding)")}


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1], newline="") as file:
        rows = list(csv.DictReader(file))
    angles = [float(row["angle_degrees"]) for row in rows]
    figure, axis = plt.subplots(figsize=(6.5, 4.5), constrained_layout=True)
    for law, (color, label) in LAWS.items():
        axis.plot(angles, [float(row[law]) for row in rows], color=color, label=label)
        axis.plot(angles, [float(row[f"{law}_of_fibers"]) for row in rows], ".", color=color, markersize=3)
    axis.axhline(0.0, color="black", linewidth=0.8)
    axis.set(xlabel="angle of the intercentrosomal axis (degrees)", ylabel=r"$\Omega / \Omega_0$",
             xticks=range(-90, 91, 30), title="turning by cortical pushing")
    axis.grid(alpha=0.3)
    axis.legend()
    figure.savefig(sys.argv[2], dpi=140)


if __name__ == "__main__":
    main()

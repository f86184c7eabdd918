#!/usr/bin/env python3
"""Figure 10: the torque instability. Straight fibers that push the cortex turn the PNC away from 90 degrees, towards 0."""

import csv

import matplotlib.pyplot as plt
import numpy as np

from study import SCENES, Study

study = Study("figure10", __doc__)
folder = study.folder / "runs" / "torque"
if not (folder / "torque.csv").exists():
    study.asterflow("torque", SCENES / "torque_instability.toml", "-o", folder)
with open(folder / "torque.csv", newline="") as file:
    rows = list(csv.reader(file))
table = dict(zip(rows[0], np.array(rows[1:], dtype=float).T))
angle = table["angle_degrees"]
picture, axis = plt.subplots(figsize=(6.5, 4.2), constrained_layout=True)
for law, color in (("free_sliding", "tab:blue"), ("no_sliding", "tab:red")):
    curve = table[law]
    axis.plot(angle, curve, color=color, label=law.replace("_", " "))
    axis.plot(angle, curve / np.abs(curve).max() * np.abs(table["free_sliding"]).max(), "--", color=color, linewidth=0.7)
    slopes = np.gradient(curve, np.radians(angle))[[0, len(angle) // 2, -1]]
    study.record(f"{law}: zero at -90, 0, 90 degrees", "yes", "yes" if np.abs(curve[[0, len(angle) // 2, -1]]).max() < 1e-12 else "no")
    study.record(f"{law}: growth rates there over Omega_0", "+, -, +", ", ".join(f"{slope:+.3g}" for slope in slopes))
ratio = np.abs(table["free_sliding"]).max() / np.abs(table["no_sliding"]).max()
study.record("largest rate, free sliding over no sliding", "quantitatively close", float(f"{ratio:.3g}"),
             "the prefactors lambda_1, lambda_2 are free; scaled to one height the curves coincide")
axis.axhline(0, color="black", linewidth=0.7)
axis.set(xlabel="angle of the intercentrosomal axis (degrees)", ylabel=r"$\Omega/\Omega_0$", xticks=range(-90, 91, 30),
         title="dashed: scaled to one height")
axis.legend()
study.finish(picture)

#!/usr/bin/env python3
"""Picture of a plane of flow: speed in colour, streamlines, fibers coloured by tension (red: compression, blue:
extension), outlines of bodies and periphery.

    plot_flow.py FLOW.h5 PICTURE.png

FLOW.h5 is written by `asterflow flow`; src/command/plane_flow.hpp lists its content.
"""

import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection

MANY_FIBERS = 150  # beyond this only what is near the plane is drawn
SLAB = 3.0  # um, half its thickness


def fiber_segments(file, axes, normal, offset):
    """Segments [n, 2, 2] of the fibers in the plane of the picture, and the tension [n] in each."""
    first = file["fiber/first"][:]
    position = file["fiber/position"][:]
    tension = file["fiber/tension"][:]
    inner = np.ones(len(position), dtype=bool)  # nodes that have a next one on the same fiber
    inner[first[1:] - 1] = False
    start = np.flatnonzero(inner)
    segments = np.stack([position[start][:, axes], position[start + 1][:, axes]], axis=1)
    strength = (tension[start] + tension[start + 1]) / 2
    if len(first) - 1 > MANY_FIBERS:
        near = np.abs((position[start, normal] + position[start + 1, normal]) / 2 - offset) < SLAB
        segments, strength = segments[near], strength[near]
    return segments, strength


def continued(field, steps=2):
    """The field [ny, nx], its points without a value next to others filled with the mean of these, `steps` points deep."""
    for _ in range(steps):
        padded = np.pad(field, 1, constant_values=np.nan)
        around = np.stack([padded[i : i + field.shape[0], j : j + field.shape[1]] for i in range(3) for j in range(3)])
        known = np.isfinite(around)
        mean = np.where(known, around, 0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
        field = np.where(np.isnan(field) & known.any(axis=0), mean, field)
    return np.ma.masked_invalid(field)


def draw_flow(file, axis, figure):
    first, second = file["first"][:], file["second"][:]
    names = file["axes"][()].decode().split()
    axes = ["xyz".index(name) for name in names]
    normal = 3 - sum(axes)
    plane = file["plane"][()].decode()
    velocity = file["velocity"][:][..., axes]
    speed = np.hypot(velocity[..., 0], velocity[..., 1])
    finite = speed[np.isfinite(speed)]
    top = np.quantile(finite, 0.995) if finite.size and finite.max() > 0 else 1.0

    image = axis.pcolormesh(first, second, continued(speed), cmap="viridis", vmin=0, vmax=top, shading="gouraud", rasterized=True)
    figure.colorbar(image, ax=axis, label="speed in the plane (um/s)", shrink=0.75, pad=0.02)
    if finite.size and finite.max() > 0:
        blank = np.ma.masked_invalid(velocity)
        axis.streamplot(first, second, blank[..., 0], blank[..., 1], color=(1, 1, 1, 0.4), linewidth=0.6, arrowsize=0.7,
                        density=1.6)  # fainter than fibers without tension
    if "fiber" in file:
        segments, tension = fiber_segments(file, axes, normal, float(plane.split("=")[1]))
        limit = max(np.quantile(np.abs(tension), 0.98) if len(tension) else 0.0, 1e-12)
        lines = LineCollection(segments, cmap="RdBu", linewidths=1.2)
        lines.set_array(tension)
        lines.set_clim(-limit, limit)
        axis.add_collection(lines)
        figure.colorbar(lines, ax=axis, label="tension of fibers (pN)", shrink=0.75, pad=0.02)
    for name, color in (("periphery_distance", "black"), ("body_distance", "black")):
        if name in file:
            distance = file[name][:]
            hidden, shade = ([-1e9, 0], "0.75") if name == "body_distance" else ([0, 1e9], "white")
            axis.contourf(first, second, distance, levels=hidden, colors=[shade], zorder=2.4)
            if distance.min() < 0 < distance.max():  # else the plane misses it
                axis.contour(first, second, distance, levels=[0], colors=color, linewidths=1.4, zorder=3)
    axis.set(xlim=(first[0], first[-1]), ylim=(second[0], second[-1]), aspect="equal", xlabel=f"{names[0]} (um)",
             ylabel=f"{names[1]} (um)", title=f"{plane.replace('=', ' = ')} um, t = {file['time'][()]:.4g} s")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with h5py.File(sys.argv[1]) as file:
        width, height = np.ptp(file["first"][:]), np.ptp(file["second"][:])
        tall = min(max(7.5 * height / width + 1.0, 3.5), 8.5)
        wide = min(max((tall - 1.0) * width / height + 2.5, 4.5), 10.0)
        figure, axis = plt.subplots(figsize=(wide, tall), constrained_layout=True)
        draw_flow(file, axis, figure)
        figure.savefig(sys.argv[2], dpi=160)


if __name__ == "__main__":
    main()

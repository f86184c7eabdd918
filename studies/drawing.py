"""Pictures that several figures share: a plane through the cell as in the paper's snapshots, a view in three dimensions,
position and angle of the PNC against time."""

import sys
from pathlib import Path

import h5py
import numpy as np
from matplotlib.collections import LineCollection
from mpl_toolkits.mplot3d.art3d import Line3DCollection

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
from plot_flow import fiber_segments

SEED_STYLES = ("-", "--", ":")


def time_stamp(seconds):
    return f"{int(seconds // 60):02d}:{int(seconds % 60):02d}"


def draw_tension_key(axis, limit):
    """In the upper left corner of a dark picture of fibers."""
    key = axis.inset_axes([0.025, 0.94, 0.13, 0.025])
    key.imshow(np.linspace(-limit, limit, 64)[None], cmap="RdBu", aspect="auto", extent=(-limit, limit, 0, 1))
    key.set(xticks=[-limit, limit], yticks=[])
    key.set_xticklabels([f"{-limit:g}", f"{limit:g} pN"], color="white", fontsize=6)
    key.tick_params(length=0, pad=1)


def draw_plane(axis, flow, limit=1.0):
    """Plane z = 0 of a flow file: streamlines, fibers coloured by tension from red (compression, -limit pN) over white to
    blue (extension), PNC and cortex, time in minutes:seconds."""
    first, second = flow["first"][:], flow["second"][:]
    velocity = np.ma.masked_invalid(flow["velocity"][:][..., :2])
    speed = np.hypot(velocity[..., 0], velocity[..., 1])
    top = float(np.quantile(speed.compressed(), 0.99)) if speed.count() else 1.0
    axis.set_facecolor("0.25")
    inside = flow["body_distance"][:] < 0
    shown = np.ma.array(velocity, mask=velocity.mask | inside[..., None])
    if top > 0:
        axis.streamplot(first, second, shown[..., 0], shown[..., 1], color="gold", linewidth=1.4 * speed.filled(0) / top + 0.2,
                        arrowsize=0.6, density=1.1, zorder=2)
    if "fiber" in flow:
        segments, tension = fiber_segments(flow, [0, 1], 2, 0.0)
        lines = LineCollection(segments, cmap="RdBu", linewidths=0.5, zorder=1)
        lines.set_array(tension)
        lines.set_clim(-limit, limit)
        axis.add_collection(lines)
        draw_tension_key(axis, limit)
    axis.contourf(first, second, flow["body_distance"][:], levels=[-1e9, 0], colors=["0.85"], zorder=3)
    if "periphery_distance" in flow:
        axis.contour(first, second, flow["periphery_distance"][:], levels=[0], colors="white", linewidths=1.2, zorder=3)
    axis.text(0.02, 0.04, time_stamp(flow["time"][()]), color="white", transform=axis.transAxes, fontsize=9)
    axis.text(0.98, 0.04, f"up to {top:.2g} um/s", color="gold", transform=axis.transAxes, fontsize=7, ha="right")
    axis.set(xlim=(first[0], first[-1]), ylim=(second[0], second[-1]), aspect="equal", xticks=[], yticks=[])


def draw_space(axis, run, time, semi_axes=(25.0, 15.0, 15.0), radius=5.0, limit=1.0):
    """Three-dimensional view of the state next to `time` (s): fibers coloured by tension, PNC, cortex as a net. For a dark
    background. Returns the time stamp."""
    with h5py.File(run / "trajectory.h5") as file:
        index = int(np.argmin(np.abs(file["time"][:] - time)))
        frame = file[f"frames/{index:06d}"]
        stamp = frame["time"][()]
        first, position, tension = frame["fiber/first"][:], frame["fiber/position"][:], frame["fiber/tension"][:]
        centre = frame["body/position"][0]
    starts = np.setdiff1d(np.arange(len(position) - 1), first[1:] - 1)
    lines = Line3DCollection(np.stack([position[starts], position[starts + 1]], axis=1), cmap="RdBu", linewidths=0.6)
    lines.set_array(tension[starts])
    lines.set_clim(-limit, limit)
    axis.add_collection(lines)
    u, v = np.mgrid[0:2 * np.pi:25j, 0:np.pi:13j]
    sphere = np.array([np.cos(v), np.sin(v) * np.cos(u), np.sin(v) * np.sin(u)])
    axis.plot_wireframe(*(sphere * np.reshape(semi_axes, (3, 1, 1))), color="white", linewidth=0.2)
    axis.plot_surface(*(sphere * radius + np.reshape(centre, (3, 1, 1))), color="0.8")
    axis.set(xlim=(-25, 25), ylim=(-15, 15), zlim=(-15, 15))
    axis.view_init(elev=18, azim=-75)
    axis.set_box_aspect((50, 30, 30), zoom=1.75)
    axis.set_axis_off()
    axis.patch.set_visible(False)
    for part in axis.collections:
        part.set_clip_on(False)  # the cell is longer than the square that it is given
    return time_stamp(stamp)


def draw_course(axis, tables, labels, paper="", colors=("tab:blue", "tab:red")):
    """Position along x (left) and angle of the intercentrosomal axis (right) of several runs against minutes; what the paper
    says of them."""
    right = axis.twinx()
    for i, table in enumerate(tables):
        style = SEED_STYLES[i % len(SEED_STYLES)]
        axis.plot(table["time"] / 60, table["pnc_x"], style, color=colors[0], label=labels[i])
        right.plot(table["time"] / 60, table["pnc_angle"], style, color=colors[1])
    axis.axhline(0.0, color="0.7", linewidth=0.8)
    axis.set(xlabel="time (min)", ylim=(-2, 11))
    axis.set_ylabel("position along AP (um)", color=colors[0])
    right.set(ylim=(0, 95), yticks=range(0, 91, 30))
    right.set_ylabel("angle to AP (degrees)", color=colors[1])
    axis.legend(fontsize=7)
    if paper:
        axis.set_title(f"paper: {paper}", fontsize=9)

#!/usr/bin/env python3
"""Why a run of pushing turns: torque of the plus ends about the PNC, where it comes from, and how fast the angle grows.

    studies/turning.py RUN [RUN ...]        folders of runs of pushing_no_sliding.toml

theta is the angle by which the intercentrosomal axis has left the plane across the cell, towards the anterior-posterior
axis x. While it is small, d theta / dt = g theta + chance. Torques are those that raise theta, means over the turn: from
the last state in which the axis is more than `--from` degrees from x to the first below `--to` degrees. With F on a plus
end at r from the PNC's centre, c the place of its centrosome from there,
    straight  c x (-|F| b)              the same force along b, the direction in which the fiber leaves its centrosome
    tilt      r x (F . p) p - straight  p from the minus to the plus end: the fiber has been left behind
    sideways  r x (F - (F . p) p)       the fiber is bent
and their sum is the whole torque."""

import argparse
from pathlib import Path

import h5py
import numpy as np

PUSHING = 3  # fiber/tip_state (docs/trajectory.md)
CENTROSOME = np.array([0.0, 5.0, 0.0])  # um, of the first aster, in the frame of the PNC


def rotation_matrix(quaternion):
    w, v = quaternion[0], quaternion[1:]
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


def units(vectors):
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def torques(frame):
    """theta (rad), angular velocity (rad/s), torques straight, tilt, sideways (pN um) and sum of forces (pN) of a state."""
    body, fiber = frame["body"], frame["fiber"]
    rotation, centre = rotation_matrix(body["orientation"][0]), body["position"][0]
    axis = rotation @ units(CENTROSOME[None])[0]
    raising = np.cross(axis, [np.sign(axis[0]) or 1.0, 0.0, 0.0])  # turns the axis to the closer pole
    raising /= np.linalg.norm(raising)
    pushes = fiber["tip_state"][:] == PUSHING
    first_aster = (np.arange(len(pushes)) < len(pushes) // 2)[pushes, None]
    force, minus = fiber["plus_end_force"][:][pushes], fiber["minus_end"][:][pushes] - centre
    plus = fiber["plus_end"][:][pushes] - centre
    centrosome = np.where(first_aster, 1.0, -1.0) * (rotation @ CENTROSOME)
    chord, size = units(plus - minus), np.linalg.norm(force, axis=1, keepdims=True)
    along = np.sum(force * chord, axis=1, keepdims=True) * chord
    about = [np.cross(arm, push).sum(axis=0) @ raising for arm, push in
             ((centrosome, -size * units(minus - centrosome)), (plus, along), (plus, force - along))]
    theta = np.arcsin(np.clip(abs(axis[0]), 0, 1))
    return theta, body["angular_velocity"][0] @ raising, about[0], about[1] - about[0], about[2], size.sum()


def growth(times, theta, largest=0.6):
    """g (1/s) and its standard error by least squares, until theta (rad, signed) is first beyond `largest`; that time (s)."""
    beyond = np.flatnonzero(np.abs(theta) > largest)
    last = beyond[0] if len(beyond) else len(theta) - 1
    now, change, step = theta[2:last], np.diff(theta)[2:last], np.diff(times)[2:last]
    weight = np.sum(now**2 * step)
    rate = np.sum(now * change) / weight
    noise = np.sum((change - rate * now * step)**2) / np.sum(step)  # rad^2/s
    return rate, np.sqrt(noise / weight), times[last]


def report(run, start_angle, end_angle):
    with h5py.File(run / "trajectory.h5") as file:
        frames = [file["frames"][name] for name in sorted(file["frames"])]
        times = np.array([frame["time"][()] for frame in frames])
        x = np.array([frame["body/position"][0][0] for frame in frames])
        axis = np.array([rotation_matrix(frame["body/orientation"][0]) @ CENTROSOME for frame in frames]) / 5.0
        rows = np.array([torques(frame) for frame in frames])
    rate, error, end = growth(times, np.arcsin(np.clip(axis[:, 0], -1, 1)))
    before = times <= end
    centring = (x[0] - x[before][-1]) / end / x[before].mean()
    print(f"{run}: g = {1e3 * rate:.1f} +- {1e3 * error:.1f} e-3/s to {end:.0f} s, "
          f"while -(dx/dt) / x = {1e3 * centring:.2f} e-3/s")
    angle = 90 - np.degrees(rows[:, 0])
    below = np.flatnonzero(angle < end_angle)
    last = below[0] if len(below) else len(angle) - 1
    first = np.flatnonzero(angle[:last + 1] > start_angle)[-1]
    means = rows[first:last + 1].mean(axis=0)
    velocity, straight, tilt, sideways, push = means[1:]
    print(f"    {angle[first]:.0f} to {angle[last]:.0f} degrees, {times[first]:.0f} to {times[last]:.0f} s: "
          f"{1e3 * velocity:.2f} e-3 rad/s; torque {straight + tilt + sideways:.0f} = straight {straight:.0f} + tilt {tilt:.0f} "
          f"+ sideways {sideways:.0f} pN um; sum of forces {push:.0f} pN")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", type=Path, nargs="+")
    parser.add_argument("--from", type=float, default=80.0, dest="start", help="degrees")
    parser.add_argument("--to", type=float, default=50.0, dest="end", help="degrees")
    options = parser.parse_args()
    for run in options.runs:
        if not (run / "trajectory.h5").exists():
            parser.error(f"{run} is not the folder of a run")
    for run in options.runs:
        report(run, options.start, options.end)

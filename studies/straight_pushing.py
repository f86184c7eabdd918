#!/usr/bin/env python3
"""Pushing without sliding by straight microtubules, apart from asterflow: what decides whether the PNC centres or turns first?

    studies/straight_pushing.py --translation 1000 --rotation 33000 --law static --seeds 1 2 3

A rigid complex with the two asters of scenes/pushing_no_sliding.toml in its cell. Microtubules are straight, grow, shrink,
and stay where they touch the cortex until their catastrophe (Eq. 7). One in contact pushes with F along itself,
    static    F = 20.19 E / L^2   buckling load, clamped at the PNC, pinned at the cortex
    viscous   F = 7 pN            as plus ends in asterflow, whatever L
and the complex goes with force over `--translation` (pN s/um) and torque over `--rotation` (pN um s). Prints the times (min) at
which it first is within 2 um of the centre, passes the centre, and is within 10 degrees of the axis of the cell."""

import argparse

import numpy as np

from straight import MEAN_LENGTH, SHORTEST, START, angle_to_axis, asters, distance_to_cortex, turned
from study import first_time, number

RIGIDITY, STALL = 10.0, 4.4  # pN um^2, pN
VISCOUS_PUSH = 7.0  # pN


def course(seed, options, dt=0.25):
    """Times (s), x (um), angle to the x axis (degrees), sum of the pushes (pN) of one run."""
    chance, growth = np.random.default_rng(seed), options.growth
    catastrophe = growth / MEAN_LENGTH  # 1/s
    starts, directions = asters(options.fibers, options.opening)
    centre, rotation = np.array([START, 0, 0]), np.eye(3)
    length = np.minimum(chance.exponential(MEAN_LENGTH, options.fibers) + SHORTEST, 7.0)
    grows, pushes = chance.random(options.fibers) < 0.5, np.zeros(options.fibers, bool)
    held, rows = np.zeros((options.fibers, 3)), []
    for step in range(int(60 * options.minutes / dt)):
        start, direction = centre + starts @ rotation.T, directions @ rotation.T
        length = length + dt * np.where(grows, growth, np.where(pushes, 0, -growth))
        reach = distance_to_cortex(start, direction)
        meets = grows & (length >= reach)
        held[meets] = start[meets] + reach[meets, None] * direction[meets]
        grows, pushes = grows & ~meets, pushes | meets
        chord = held[pushes] - start[pushes]
        length[pushes] = np.linalg.norm(chord, axis=1)
        size = np.full(len(chord), VISCOUS_PUSH) if options.law == "viscous" else 20.19 * RIGIDITY / length[pushes]**2
        force = -size[:, None] * chord / length[pushes, None]
        turn = dt * np.cross(start[pushes] - centre, force).sum(axis=0) / options.rotation
        centre, rotation = centre + dt * force.sum(axis=0) / options.translation, turned(rotation, turn)
        rate = np.maximum(catastrophe * np.exp(size / STALL), 1 / options.turnover)  # Eq. 7
        pushes[np.flatnonzero(pushes)[chance.random(len(rate)) < 1 - np.exp(-rate * dt)]] = False
        grows &= chance.random(options.fibers) >= catastrophe * dt
        is_gone = ~grows & ~pushes & (length < SHORTEST)
        length[is_gone], grows = SHORTEST, grows | is_gone
        rows.append((step * dt, centre[0], angle_to_axis(rotation), size.sum()))
    return np.array(rows).T


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--translation", type=number(1e-9, float), default=1000.0, help="pN s/um")
    parser.add_argument("--rotation", type=number(1e-9, float), default=33000.0, help="pN um s")
    parser.add_argument("--law", choices=("static", "viscous"), default="static")
    parser.add_argument("--turnover", type=number(1e-9, float), default=5.0, help="s, 1 / f_min")
    parser.add_argument("--growth", type=number(1e-9, float), default=0.5, help="um/s, of growth and shrinkage")
    parser.add_argument("--opening", type=number(0, float), default=80.0, help="degrees")
    parser.add_argument("--fibers", type=number(2), default=600)
    parser.add_argument("--minutes", type=number(0.1, float), default=60.0)
    parser.add_argument("--seeds", type=number(0), nargs="+", default=[1, 2, 3])
    options = parser.parse_args()
    for seed in options.seeds:
        times, x, angle, push = course(seed, options)
        marks = [first_time(times, condition) / 60 for condition in (x < 2, x < 0, angle < 10)]
        print(f"seed {seed}: 2 um {marks[0]:.1f}, centre {marks[1]:.1f}, 10 degrees {marks[2]:.1f} min; "
              f"sum of pushes {push.mean():.0f} pN", flush=True)

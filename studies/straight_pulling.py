#!/usr/bin/env python3
"""Cortical pulling by straight microtubules, apart from asterflow: where does the pronuclear complex (PNC) come to rest?

    studies/straight_pulling.py --seeds 1 2 3                  # Figure 16: as given, twice the sites, half the residence time
    studies/straight_pulling.py --held 0 2 4 6 8 10            # mean force on a PNC that is held there, and what is expected

A rigid complex with the two asters of scenes/cortical_pulling.toml. Microtubules are straight, grow, shrink and turn back at
the cortex; a growing one is captured by a free site within `--reach` at `--rate` times the factor of the site (3/2 at the
posterior pole, linear to `--plane-factor` at the plane through the PNC, 1 in front of it). Held, it pulls along itself with
3 pN for `--residence` on average, its length that to the cortex; let go, it shrinks. The complex goes with force over
`--translation` (pN s/um) and torque over `--rotation` (pN um s).

Expected: a microtubule that is let go comes back to the cortex, a distance D away, after
    T(D) = (1 / V_g + 1 / V_s) l (exp(D / l) - 1),    1 / l = f_cat / V_g - f_res / V_s
on average, and the centre is stable when the share s of sites that hold one is above g / (2 + g), g = R T'(D) / T(D)
(docs/paper/capture.md). R: from the centre of the cell to the cortex, D: from there to a centrosome less."""

import argparse

import numpy as np

from straight import (CELL, CENTROSOME_RADIUS, GOLDEN_ANGLE, MEAN_LENGTH, PNC_RADIUS, SHORTEST, START, angle_to_axis, asters,
                      distance_to_cortex, turned)
from study import number

PULL, POLE_FACTOR = 3.0, 1.5  # pN, -
CORTEX = np.array([25.0, 15.0, 15.0])  # um, semi-axes of the cell
ROOM = np.array([19.0, 9.5, 9.5])  # um, semi-axes of where the centre of the PNC may be
GROWING, SHRINKING, HELD = 0, 1, 2


def cortical_sites(count, arrangement, chance):
    """Points of the cortex, uniform by area: evenly on a spiral about the long axis, or each at random; um."""
    heights = np.linspace(-1, 1, 4001)
    area = np.cumsum(np.sqrt(1 - (1 - (CORTEX[1] / CORTEX[0])**2) * heights**2))
    is_even = arrangement == "even"
    share = (np.arange(count) + 0.5) / count if is_even else chance.random(count)
    height = np.interp(share, area / area[-1], heights)
    turn = GOLDEN_ANGLE * np.arange(count) if is_even else 2 * np.pi * chance.random(count)
    around = np.sqrt(1 - height**2)
    return CORTEX * np.stack([height, around * np.cos(turn), around * np.sin(turn)], axis=1)


def site_factors(sites, plane, plane_factor):
    """Capture rate over that of the anterior side, for a dividing plane at x = `plane` (um)."""
    part = np.clip((sites[:, 0] - plane) / (CORTEX[0] - plane), 0, 1)
    return np.where(sites[:, 0] <= plane, 1.0, plane_factor + part * (POLE_FACTOR - plane_factor))


class Capture:
    """Which microtubule holds which site; -1: none."""

    def __init__(self, sites, options):
        self.sites, self.options = sites, options
        self.site = np.full(options.fibers, -1)
        self.is_taken = np.zeros(len(sites), bool)

    def capture(self, fibers, tips, plane, dt, chance):
        """Of growing fibers with these plus ends (um), those captured in dt (s)."""
        free = np.flatnonzero(~self.is_taken)
        distance2 = np.sum((tips[:, None] - self.sites[free])**2, axis=2)
        rates = self.options.rate * site_factors(self.sites[free], plane, self.options.plane_factor)
        rates = np.where(distance2 <= self.options.reach**2, rates, 0.0)  # [n_tip, n_free] 1/s
        captured = []
        for tip in np.flatnonzero(chance.random(len(tips)) < 1 - np.exp(-dt * rates.sum(axis=1))):
            rate = np.where(self.is_taken[free], 0.0, rates[tip])  # without those given in this step
            if rate.sum() == 0:
                continue
            site = free[chance.choice(len(free), p=rate / rate.sum())]
            self.is_taken[site], self.site[fibers[tip]] = True, site
            captured.append(fibers[tip])
        return captured

    def release(self, fibers):
        self.is_taken[self.site[fibers]], self.site[fibers] = False, -1


def course(seed, options, held_at=None, dt=0.25):
    """Time (s), x, distance from the axis (um), angle (degrees), held microtubules, force along x (pN) of one run. `held_at`:
    x and angle of a complex that does not move."""
    chance = np.random.default_rng(seed)
    starts, directions = asters(options.fibers, options.opening)
    capture = Capture(cortical_sites(options.sites, options.arrangement, chance), options)
    x, angle = held_at or (START, 90.0)
    centre, rotation = np.array([x, 0.0, 0.0]), turned(np.eye(3), np.radians([0.0, 0.0, angle - 90.0]))
    length = chance.exponential(MEAN_LENGTH, options.fibers) + SHORTEST
    state, rows = chance.integers(0, 2, options.fibers), []
    for step in range(int(60 * options.minutes / dt)):
        start, direction = centre + starts @ rotation.T, directions @ rotation.T
        reach = distance_to_cortex(start, direction)
        length += dt * np.where(state == GROWING, options.growth, -options.shrinkage)
        length = np.where(state == HELD, reach, np.minimum(length, reach))
        near = np.flatnonzero((state == GROWING) & (reach - length < 4 * options.reach))
        captured = capture.capture(near, start[near] + length[near, None] * direction[near], centre[0], dt, chance)
        state[captured] = HELD
        draw = chance.random(options.fibers)
        turns_back = (state == GROWING) & ((length >= reach) | (draw < dt * options.growth / MEAN_LENGTH))
        grows_again = (state == SHRINKING) & (draw < dt * options.rescue)
        let_go = (state == HELD) & (draw < dt / options.residence)
        capture.release(let_go)
        state[turns_back | let_go], state[grows_again] = SHRINKING, GROWING
        is_gone = (state == SHRINKING) & (length < SHORTEST)
        length[is_gone], state[is_gone] = SHORTEST, GROWING
        is_held = state == HELD
        force = PULL * direction[is_held]
        arm = start[is_held] + length[is_held, None] * direction[is_held] - centre
        rows.append((step * dt, centre[0], np.hypot(*centre[1:]), angle_to_axis(rotation), is_held.sum(), force[:, 0].sum()))
        if held_at is None:
            centre = centre + dt * force.sum(axis=0) / options.translation
            centre = centre / max(1.0, np.linalg.norm(centre / ROOM))
            rotation = turned(rotation, dt * np.cross(arm, force).sum(axis=0) / options.rotation)
    return np.array(rows).T


def decay_rate(options):
    """1 / l, 1/um: how fast growing plus ends die out."""
    return 1 / MEAN_LENGTH - options.rescue / options.shrinkage


def return_time(options, gap):
    """s on average until a plus end that shrinks from the cortex, `gap` (um) away from its centrosome, is back: T(D)."""
    decay = decay_rate(options)
    return (1 / options.growth + 1 / options.shrinkage) * (np.expm1(decay * gap) / decay if decay else gap)


def threshold(options, semi_axis, gap):
    """Share of sites in use above which the centre is stable towards the cortex at R = `semi_axis` (um), D = `gap` (um)."""
    slope = (1 / options.growth + 1 / options.shrinkage) * np.exp(decay_rate(options) * gap)  # T'(D), s/um
    steepness = semi_axis * slope / return_time(options, gap)
    return steepness / (2 + steepness)


def cases(options):
    """As given, twice the sites, half the residence time."""
    for name, changes in (("as given", {}), ("twice the sites", {"sites": 2 * options.sites}),
                          ("half the residence time", {"residence": options.residence / 2})):
        yield name, argparse.Namespace(**(vars(options) | changes))


def print_courses(options):
    for name, case in cases(options):
        for seed in case.seeds:
            times, x, off, angle, held, _ = course(seed, case)
            late = times > times[-1] - 300
            marks = " ".join(f"{x[i]:.1f}/{angle[i]:.0f}" for i in np.linspace(0, len(times) - 1, 10).astype(int)[1:])
            print(f"{name}, seed {seed}: x (um) / angle {marks}; last 5 min {x[late].mean():.1f} um, {off[late].mean():.1f} um off "
                  f"the axis, {angle[late].mean():.0f} degrees, {held[late].mean():.0f} held", flush=True)


def print_forces(options):
    gap = CELL[0] - PNC_RADIUS - CENTROSOME_RADIUS
    print(f"stable along the axis with a share above {threshold(options, CELL[0], gap):.2f}")
    for name, case in cases(options):
        for angle in (90.0, 0.0):
            words = []
            for place in case.held:
                *_, held, force = course(case.seeds[0], case, held_at=(place, angle))
                settled = slice(len(force) // 8, None)
                words.append(f"{place:g} um {force[settled].mean():.1f} pN ({held[settled].mean() / case.sites:.2f})")
            print(f"{name}, {angle:.0f} degrees: x, force (share of sites in use): {', '.join(words)}", flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sites", type=number(1), default=100)
    parser.add_argument("--arrangement", choices=("even", "random"), default="even")
    parser.add_argument("--reach", type=number(1e-9, float), default=5.0, help="um")
    parser.add_argument("--rate", type=number(1e-9, float), default=1.0, help="1/s, of capture")
    parser.add_argument("--plane-factor", type=number(0, float), default=0.5)
    parser.add_argument("--residence", type=number(1e-9, float), default=20.0, help="s")
    parser.add_argument("--rescue", type=number(0, float), default=0.02, help="1/s")
    parser.add_argument("--growth", type=number(1e-9, float), default=0.5, help="um/s")
    parser.add_argument("--shrinkage", type=number(1e-9, float), default=0.5, help="um/s")
    parser.add_argument("--opening", type=number(0, float), default=80.0, help="degrees")
    parser.add_argument("--fibers", type=number(2), default=600)
    parser.add_argument("--translation", type=number(1e-9, float), default=1000.0, help="pN s/um")
    parser.add_argument("--rotation", type=number(1e-9, float), default=30000.0, help="pN um s")
    parser.add_argument("--minutes", type=number(0.1, float), default=45.0)
    parser.add_argument("--seeds", type=number(0), nargs="+", default=[1])
    parser.add_argument("--held", type=float, nargs="+", help="um, places along the axis at which the PNC is held")
    options = parser.parse_args()
    print_forces(options) if options.held else print_courses(options)

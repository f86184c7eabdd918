"""A rigid complex with straight microtubules in its cell, apart from asterflow: what straight_pushing.py and
straight_pulling.py share. The two asters are those of the scenes of the pronuclear complex (PNC)."""

import numpy as np

CELL = np.array([24.9, 14.9, 14.9])  # um, where plus ends meet the cortex
START, PNC_RADIUS, CENTROSOME_RADIUS = 10.0, 5.0, 1.0  # um
SHORTEST, MEAN_LENGTH = 0.5, 8.0  # um
GOLDEN_ANGLE = np.pi * (3 - np.sqrt(5))


def asters(count, opening):
    """Starts relative to the centre (um) and directions of `count` fibers, evenly about y and -y up to `opening` (degrees)."""
    half = count // 2
    cosine = 1 - (1 - np.cos(np.radians(opening))) * (np.arange(half) + 0.5) / half
    sine, turn = np.sqrt(1 - cosine**2), GOLDEN_ANGLE * np.arange(half)
    upper = np.stack([sine * np.cos(turn), cosine, sine * np.sin(turn)], axis=1)
    directions = np.concatenate([upper, upper * [1, -1, 1]])
    poles = np.repeat([[0, PNC_RADIUS, 0], [0, -PNC_RADIUS, 0]], half, axis=0)
    return poles + CENTROSOME_RADIUS * directions, directions


def distance_to_cortex(start, direction):
    """um from points along unit vectors to the ellipsoid."""
    point, along = start / CELL, direction / CELL
    a, b, c = np.sum(along**2, axis=1), np.sum(point * along, axis=1), np.sum(point**2, axis=1) - 1
    return (-b + np.sqrt(np.maximum(b * b - a * c, 0))) / a


def turned(rotation, turn):
    """The rotation after a small turn (vector, rad), Rodrigues."""
    angle = np.linalg.norm(turn)
    if angle == 0:
        return rotation
    x, y, z = turn / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return (np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross) @ rotation


def angle_to_axis(rotation):
    """Degrees between the line through the centrosomes and the long axis of the cell."""
    return np.degrees(np.arccos(min(1.0, abs(rotation[0, 1]))))

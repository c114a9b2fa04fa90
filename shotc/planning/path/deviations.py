"""Where a path leaves its ideal: the generated keyframes and the chords between them, or a drawn path."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.chord import off_chord
from shotc.geom.sampling import worst_of_runs
from shotc.ir.keyframes import PlacedShot
from shotc.ir.path import CORNERS, SHARP, PathDeviation
from shotc.ir.tolerances import BOW_SHARE
from shotc.planning.free_space import FreeSpace, breaches
from shotc.planning.path.angles import KeyedPath
from shotc.planning.path.drawn import Bow, DrawnPath, drawn_path

NOTICE_M = 0.1  # metres off a generated keyframe or a drawn path, above which a deviation is reported
COMPARED_PLACES = 65  # samples between two keyframes, for the comparison with their chord
LEFT_M = 0.02  # metres off, above which a keyframe belongs to a reported run


class _Away(NamedTuple):
    """The distance of a curve from a place of its path, metres, and the s of it."""

    distance: float
    s: float
    place: Array


def deviations_of(
    space: FreeSpace, placed: PlacedShot, keyed: KeyedPath, otherwise: str
) -> tuple[PathDeviation, ...]:
    """Return the worst deviation of each run of keyframes, and the worst one between two keyframes.

    Between generated keyframes a path may bow out by a share of their distance. Of a drawn path, return the
    worst one of each cause.

    otherwise : the cause where no obstacle is near the keyframe
    """
    drawn = drawn_path(placed, keyed.s)
    if drawn is not None:
        return off_drawn(space, placed, drawn, keyed.position)
    points = np.array([k.at for k in placed.keyframes], dtype=np.float64)
    distances = np.linalg.norm(keyed.position(keyed.s) - points, axis=1)
    deviations = [
        _Away(float(distances[i]), float(keyed.s[i]), points[i])
        for i in worst_of_runs(distances, LEFT_M, NOTICE_M)
    ]
    if not any(k.placed for k in placed.keyframes):
        between = [_bowed(keyed, points, k) for k in range(len(points) - 1)]
        worst = max(between, key=lambda one: one.distance)
        if worst.distance > max([NOTICE_M, *(one.distance for one in deviations)]):
            deviations = sorted([*deviations, worst], key=lambda one: one.s)
    shot = placed.shot.id
    return tuple(
        PathDeviation(shot, one.distance, one.s, _cause(space, one.place, otherwise)) for one in deviations
    )


def off_drawn(
    space: FreeSpace, placed: PlacedShot, drawn: DrawnPath, curve: Piecewise
) -> tuple[PathDeviation, ...]:
    """Return where a curve of channels x, y, z is farthest from a drawn path, for each cause.

    A leg that is left by no more than its half-width turns at its points. Another one is led round what
    stands there, or its points are too sharp for it.
    """
    worst: dict[str, Bow] = {}
    for bow in drawn.bows(curve):
        cause = CORNERS if bow.distance <= bow.width else _beside(space, drawn, bow)
        if bow.distance > max(NOTICE_M, worst[cause].distance if cause in worst else 0.0):
            worst[cause] = bow
    return tuple(
        PathDeviation(placed.shot.id, bow.distance, bow.s, cause)
        for cause, bow in sorted(worst.items(), key=lambda one: one[1].s)
    )


def _beside(space: FreeSpace, drawn: DrawnPath, bow: Bow) -> str:
    """Return what is in the way on a leg of a drawn path."""
    share = np.linspace(0.0, 1.0, COMPARED_PLACES)[:, None]
    chord = drawn.points[bow.leg] + share * (drawn.points[bow.leg + 1] - drawn.points[bow.leg])
    met = (near[0] for point in chord if (near := breaches(space, point)))
    first = next(met, None)
    return SHARP if first is None else str(first.owner)


def _bowed(keyed: KeyedPath, points: Array, k: int) -> _Away:
    """Return where the curve bows out the most from the chord after keyframe k, and by how much."""
    s = np.linspace(keyed.s[k], keyed.s[k + 1], COMPARED_PLACES)
    flown, along = keyed.position(s), points[k + 1] - points[k]
    share = np.clip((flown - points[k]) @ along / max(float(along @ along), 1e-12), 0.0, 1.0)
    chord = points[k] + share[:, None] * along
    off = off_chord(flown, points[k], points[k + 1])
    i = int(off.argmax())
    return _Away(float(off[i]) - BOW_SHARE * float(np.linalg.norm(along)), float(s[i]), chord[i])


def _cause(space: FreeSpace, point: Array, otherwise: str) -> str:
    near = breaches(space, point)
    return str(near[0].owner) if near else otherwise

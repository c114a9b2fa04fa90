"""Transfers with bends at their ends, so that a drone turns while it flies and not on the spot.

Where ``rules.look_ahead`` keeps the heading near the course, a drone with another heading has to turn before
it flies. Alternatively it departs in a direction that is within the cone about its heading, and the path
bends from there to the old one: position and heading change together. A bend is a quintic that begins in such
a direction and joins the old path with equal first and second derivatives. The caller chooses the candidate
with the shortest total time.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import copysign, cos, sin

import numpy as np

from shotc.geom.bernstein import Piecewise, concatenate, quintic_hermite
from shotc.geom.bspline import restrict, subdivide
from shotc.geom.solid_arrays.points import distances
from shotc.geom.vec import wrapped
from shotc.planning.free_space import FreeSpace, shortfall, taper
from shotc.planning.obstacles import FreeSpaces

LENGTH_SHARES = (0.2, 0.45)  # lengths of bends over that of the transfer
LONGEST_M = 30.0  # longest bend; a drone is at full speed by then
SHARES = (0.4, 1.0)  # shares of the turn on the spot that a bend saves
LEAST_RAD = 0.02  # least turn on the spot for which a bend is tried
BEND_PIECES = 8  # pieces of a bend, for the proof of its clearances
WAY_SAMPLES = 200  # samples of a transfer, for the clearances of transfers
ROUNDING_M = 1e-6


def bent_starts(position: Piecewise, over: float) -> Iterator[Piecewise]:
    """Yield position curves with other beginnings; over : largest turn of the course there, rad."""
    if abs(over) < LEAST_RAD:
        return
    breaks = position.breaks
    rate = position.derivative()(breaks[0])
    long = float(breaks[-1] - breaks[0])
    for s in dict.fromkeys(float(breaks[0]) + min(part * long, LONGEST_M) for part in LENGTH_SHARES):
        rest = restrict(position, np.concatenate([[s], breaks[breaks > s + ROUNDING_M]]))
        joint = [position.derivative(order)(s) if order else position(s) for order in range(3)]
        for share in SHARES:
            c, n = cos(share * over), sin(share * over)
            first = np.array([c * rate[0] - n * rate[1], n * rate[0] + c * rate[1], rate[2]])
            ends = (
                np.stack(pair) for pair in zip((position(breaks[0]), first, np.zeros(3)), joint, strict=True)
            )
            bend = quintic_hermite(np.array([breaks[0], s]), *ends)
            yield concatenate([restrict(bend, subdivide(bend.breaks, BEND_PIECES)), rest])


def bent_ends(position: Piecewise, over: float) -> Iterator[Piecewise]:
    """Yield position curves with other ends; over : as in ``bent_starts``, at the end."""
    # In reverse the course is opposite, and the angle is the same.
    yield from (backwards(curve) for curve in bent_starts(backwards(position), over))


def backwards(curve: Piecewise) -> Piecewise:
    """Return a curve in reverse, over the same parameters."""
    ends = curve.breaks[0] + curve.breaks[-1]
    return Piecewise((ends - curve.breaks)[::-1], curve.ctrl[::-1, ::-1])


def over_cone(course: float, heading: float, half_angle: float) -> float:
    """Return the least angle by which a course has to turn, rad, to have a heading in the cone about it."""
    off = float(wrapped(heading - course))
    return copysign(max(0.0, abs(off) - half_angle), off)


def as_clear(spaces: FreeSpaces, curve: Piecewise, than: Piecewise) -> bool:
    """Return whether a curve is proved clear, and keeps the clearances of transfers as well as
    another one.
    """
    return bool(
        shortfall(spaces.flight, curve.ctrl).max() <= 0.0
        and _lack(spaces.transit, curve) <= max(0.0, _lack(spaces.transit, than)) + ROUNDING_M
    )


def _lack(space: FreeSpace, curve: Piecewise) -> float:
    points = curve(np.linspace(curve.start, curve.end, WAY_SAMPLES))
    (ax, ay, az), (bx, by, bz) = points[[0, -1]].tolist()
    tapered = replace(space, ends=((ax, ay, az), (bx, by, bz)))
    lacks = [
        float((taper(tapered, o).needs(points) - distances(o.part, points)).max()) for o in space.obstacles
    ]
    return max(lacks, default=0.0)

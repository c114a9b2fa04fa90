"""Ways bent at their ends, so that a drone turns while it flies and not on the spot.

Where ``rules.look_ahead`` keeps the nose near the course, a drone that looks elsewhere has to turn before it
flies. Or it leaves in a direction that it looks ahead in already, and the way bends from there to the old
one: place and heading change together. A bend is a quintic that begins in such a direction and joins the old
way with its rate and its bend. Which of them serves best is for who asks: by how long the whole way takes.
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

LENGTHS = (0.2, 0.45)  # of bends, shares of the way
LONGEST_M = 30.0  # of a bend: a drone is at full speed by then
SHARES = (0.4, 1.0)  # of the turn on the spot, that a bend saves
LEAST_RAD = 0.02  # of a turn on the spot: less is not worth a bend
PIECES = 8  # of a bend, by which it is proved clear
SAMPLES = 200  # of a way, at which clearances of transits are compared
ROUNDING_M = 1e-6


def bent_starts(position: Piecewise, over: float) -> Iterator[Piecewise]:
    """Yield a way with other beginnings; over : rad that its course there is to be turned by, at most."""
    if abs(over) < LEAST_RAD:
        return
    breaks = position.breaks
    rate = position.derivative()(breaks[0])
    long = float(breaks[-1] - breaks[0])
    for s in dict.fromkeys(float(breaks[0]) + min(part * long, LONGEST_M) for part in LENGTHS):
        rest = restrict(position, np.concatenate([[s], breaks[breaks > s + ROUNDING_M]]))
        joint = [position.derivative(order)(s) if order else position(s) for order in range(3)]
        for share in SHARES:
            c, n = cos(share * over), sin(share * over)
            first = np.array([c * rate[0] - n * rate[1], n * rate[0] + c * rate[1], rate[2]])
            ends = (
                np.stack(pair) for pair in zip((position(breaks[0]), first, np.zeros(3)), joint, strict=True)
            )
            bend = quintic_hermite(np.array([breaks[0], s]), *ends)
            yield concatenate([restrict(bend, subdivide(bend.breaks, PIECES)), rest])


def bent_ends(position: Piecewise, over: float) -> Iterator[Piecewise]:
    """Yield a way with other ends; over : as in ``bent_starts``, of its course where it ends."""
    # Backwards the course is the opposite one, and turns by as much.
    yield from (backwards(way) for way in bent_starts(backwards(position), over))


def backwards(curve: Piecewise) -> Piecewise:
    """Return a curve flown from its end to its beginning, over the same parameters."""
    ends = curve.breaks[0] + curve.breaks[-1]
    return Piecewise((ends - curve.breaks)[::-1], curve.ctrl[::-1, ::-1])


def over_cone(course: float, heading: float, half_angle: float) -> float:
    """Return by how much a course has to turn, rad, for a heading to be in the cone about it."""
    off = float(wrapped(heading - course))
    return copysign(max(0.0, abs(off) - half_angle), off)


def as_clear(spaces: FreeSpaces, way: Piecewise, than: Piecewise) -> bool:
    """Tell whether a way is proved clear, and keeps the clearances of transits as well as another one."""
    return bool(
        shortfall(spaces.flight, way.ctrl).max() <= 0.0
        and _lack(spaces.transit, way) <= max(0.0, _lack(spaces.transit, than)) + ROUNDING_M
    )


def _lack(space: FreeSpace, way: Piecewise) -> float:
    points = way(np.linspace(way.start, way.end, SAMPLES))
    (ax, ay, az), (bx, by, bz) = points[[0, -1]].tolist()
    tapered = replace(space, ends=((ax, ay, az), (bx, by, bz)))
    lacks = [
        float((taper(tapered, o).needs(points) - distances(o.part, points)).max()) for o in space.obstacles
    ]
    return max(lacks, default=0.0)

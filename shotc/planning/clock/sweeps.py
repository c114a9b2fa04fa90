"""Targets that move, as what stands for a while: each the hull of where it is meanwhile.

A way led round those is clear of them whenever in that time it is flown. It is one way more to be tried, and
the shortest beside a target that stands still until it is filmed.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from shotc.geom.solid_arrays.rings import ring
from shotc.geom.solids import Cylinder, Prism, Solid, convex_hull
from shotc.planning.clock.moving import Moving
from shotc.planning.free_space import FreeSpace, Obstacle
from shotc.planning.obstacles import FreeSpaces

STEP_S = 0.5  # seconds between the places that a hull is drawn about
STILL_M = 1e-3  # metres: less is standing
CORNERS = 8  # of the prism about a cylinder


def with_sweeps(spaces: FreeSpaces, moving: Sequence[Moving], span: tuple[float, float]) -> FreeSpaces:
    """Return free spaces in which all targets are where they are between two mission times, seconds."""
    swept = [(m, _swept(m, span)) for m in moving if not m.always]
    flight = (Obstacle(m.owner, part, m.clearance) for m, part in swept)
    transit = (Obstacle(m.owner, part, m.apart) for m, part in swept)
    return spaces._replace(flight=_with(spaces.flight, flight), transit=_with(spaces.transit, transit))


def _with(space: FreeSpace, more: Iterable[Obstacle]) -> FreeSpace:
    return replace(space, obstacles=(*space.obstacles, *more))


def _swept(what: Moving, span: tuple[float, float]) -> Solid:
    part, (begin, end) = what.part, span
    at = what.at(np.append(np.arange(begin, end, STEP_S), end))
    low, high = at.min(axis=0), at.max(axis=0)
    assert isinstance(part, Cylinder), "targets are"
    middle, bottom, top = 0.5 * (low + high), part.bottom + float(low[2]), part.top + float(high[2])
    if np.linalg.norm(high - low) < STILL_M:
        return Cylinder((float(middle[0]), float(middle[1])), part.radius + STILL_M, bottom, top)
    corners = (at[:, None, :2] + ring(part.radius, CORNERS)).reshape(-1, 2)
    return Prism(convex_hull(tuple((float(x), float(y)) for x, y in corners)), bottom, top)

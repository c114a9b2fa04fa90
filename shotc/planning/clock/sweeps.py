"""Moving targets as standing obstacles for a while: each is the hull of its places in that time.

A transfer led around these hulls is clear whenever it is flown within that time. It is one more candidate,
and the shortest one beside a target that stands until it is filmed.
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

STEP_S = 0.5  # seconds between the samples of a hull
STILL_M = 1e-3  # metres, below which a target stands
PRISM_CORNERS = 8  # corners of the prism around a cylinder


def with_sweeps(spaces: FreeSpaces, moving: Sequence[Moving], span: tuple[float, float]) -> FreeSpaces:
    """Return free spaces that exclude all places of targets between two mission times, seconds."""
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
    middle, bottom, top = 0.5 * (low + high), part.bottom + float(low[2]), part.top + float(high[2])
    if isinstance(part, Cylinder) and np.linalg.norm(high - low) < STILL_M:
        return Cylinder((float(middle[0]), float(middle[1])), part.radius + STILL_M, bottom, top)
    outline = ring(part.radius, PRISM_CORNERS) if isinstance(part, Cylinder) else np.array(part.points)
    corners = (at[:, None, :2] + outline).reshape(-1, 2)
    return Prism(convex_hull(tuple((float(x), float(y)) for x, y in corners)), bottom, top)

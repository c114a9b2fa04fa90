"""The occluders on the line of sight to a target, frame by frame: zones, terrain, scenes, targets, drones.

A line of sight goes from the camera to the target's centre. A zone that contains the centre hides it. Targets
whose bodies overlap or touch at that instant are parts of one thing and do not hide each other; nor do the
parts of a group. A drone is a ball of its radius, in flight and on its pad.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.framing import hidden
from shotc.geom.outline import entering
from shotc.geom.pieces import Mask
from shotc.geom.surface.occlusion import lines_hidden
from shotc.ir.bodies import beside_body, flying, moved, parts_of_one
from shotc.ir.hiding_surfaces import surfaces_before
from shotc.ir.mission import MissionIR
from shotc.ir.target import Target
from shotc.ir.trajectory import DroneTrajectory


def hiders(
    mission: MissionIR, others: Sequence[DroneTrajectory], target: str, eyes: Array, t: Array
) -> Iterator[tuple[str, Mask]]:
    """Yield each possible occluder of a target, with sort and name, and whether it hides it, shape (M,).

    others : flights of the drones that count; eyes : p_W of the camera at times t (M,), shape (M, 3), metres
    """
    filmed = mission.target(target)
    centres = np.array(filmed.centre) + moved(filmed, t)
    for zone in mission.opaque_zones:
        yield f"zone {zone.name}", hidden(eyes, centres, (zone.solid,))
    one = mission.one_with(target)
    for other in mission.targets:
        if other.name not in one:
            before = hidden(beside_body(other, eyes, t), beside_body(other, centres, t), (other.solid,))
            yield f"target {other.name}", before & ~parts_of_one(filmed, other, t)
    met = _entry_points(filmed, eyes, centres, t) if mission.meshes else centres
    for name, surface in surfaces_before(mission, target):
        yield name, lines_hidden(surface, eyes, met)
    for flight in others:
        ball = flying(flight.curve, t)
        yield f"drone {flight.drone}", _behind(eyes, centres, ball, mission.drone(flight.drone).radius)


def others_of(flights: Sequence[DroneTrajectory], drone: str) -> tuple[DroneTrajectory, ...]:
    """Return the flights of all drones but one."""
    return tuple(flight for flight in flights if flight.drone != drone)


def _entry_points(filmed: Target, eyes: Array, centres: Array, t: Array) -> Array:
    """Return where lines of sight enter a target, (M, 3); so a filmed building does not hide itself."""
    start, end = beside_body(filmed, eyes, t), beside_body(filmed, centres, t)
    share = np.minimum(entering(filmed.shape, filmed.centre, start, end - start), 1.0)
    return np.asarray(eyes + share[:, None] * (centres - eyes))


def _behind(eyes: Array, points: Array, ball: Array, radius: float) -> Mask:
    """Return which lines of sight cross a ball that contains neither of their ends, shape (M,)."""
    along, offset = points - eyes, ball - eyes
    square = np.maximum(np.einsum("md,md->m", along, along), 1e-300)
    share = np.clip(np.einsum("md,md->m", offset, along) / square, 0.0, 1.0)
    near = np.linalg.norm(offset - share[:, None] * along, axis=1)
    ends = np.minimum(np.linalg.norm(offset, axis=1), np.linalg.norm(ball - points, axis=1))
    return np.asarray((near < radius) & (ends >= radius))

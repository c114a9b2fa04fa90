"""How much of a target's outline is covered, instant by instant, and by what.

The outline is all that the camera sees of the target, whether that is in the picture or beyond its edge: how
much of it the frame cuts off is another question (``Frames.in_frame``). What covers it are the things that
``ir.occlusion`` names; those that touch the target at that instant are parts of one thing with it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.outline import (
    OutlineRays,
    covered_by_ball,
    covered_by_solid,
    covered_by_surface,
    outline_rays,
    share_of,
)
from shotc.geom.pieces import Mask
from shotc.geom.shapes import bodies_of
from shotc.ir.bodies import beside_body, flying, from_body, parts_of_one
from shotc.ir.hiding_surfaces import surfaces_before
from shotc.ir.mission import MissionIR
from shotc.ir.target import Target
from shotc.ir.trajectory import DroneTrajectory

FRAMES_AT_ONCE = 512
"""Frames whose rays fit the cache."""

HALF_SHARE = 0.5
"""Of an outline: in a frame that leaves less of it free the target is hidden."""


@dataclass(frozen=True, slots=True, eq=False)
class Coverage:
    """How much of a target's outline is covered in M frames.

    share : of the outline, by anything, 0 to 1, shape (M,); by : the same by each thing, by sort and name
    """

    share: Array
    by: tuple[tuple[str, Array], ...]


def coverage(
    mission: MissionIR, others: Sequence[DroneTrajectory], target: str, eyes: Array, t: Array
) -> Coverage:
    """Return how much of a target's outline is covered from eyes (M, 3) at mission times (M,).

    others : flights of the drones that count
    """
    filmed = mission.target(target)
    if _alone(mission, others):
        return Coverage(np.zeros(len(t)), ())
    parts = [
        _part(mission, others, filmed, eyes[i : i + FRAMES_AT_ONCE], t[i : i + FRAMES_AT_ONCE])
        for i in range(0, len(t), FRAMES_AT_ONCE)
    ]
    names = [name for name, _ in parts[0].by] if parts else []
    by = tuple((name, np.concatenate([part.by[k][1] for part in parts])) for k, name in enumerate(names))
    return Coverage(np.concatenate([np.empty(0), *(part.share for part in parts)]), by)


def _alone(mission: MissionIR, others: Sequence[DroneTrajectory]) -> bool:
    """Tell whether a mission has nothing that could cover its only target."""
    zones = any(zone.keep == "out" for zone in mission.zones)
    return not (zones or others or mission.meshes or mission.terrain or len(mission.targets) > 1)


def _part(
    mission: MissionIR, others: Sequence[DroneTrajectory], filmed: Target, eyes: Array, t: Array
) -> Coverage:
    beside = outline_rays(filmed.shape, filmed.centre, beside_body(filmed, eyes, t))
    rays = beside.mapped(partial(from_body, filmed, t=t))
    covered, by = np.zeros_like(rays.own), []
    for name, covers in _covers(mission, others, filmed, rays, t):
        covered |= covers
        by.append((name, share_of(rays, covers)))
    return Coverage(share_of(rays, covered), tuple(by))


def _covers(
    mission: MissionIR, others: Sequence[DroneTrajectory], filmed: Target, rays: OutlineRays, t: Array
) -> Iterator[tuple[str, Mask]]:
    """Yield what may cover a target, and which of the rays to it, (F, n, n)."""
    for zone in mission.zones:
        if zone.keep == "out":
            yield f"zone {zone.name}", covered_by_solid(rays, zone.solid)
    one = mission.one_with(filmed.name)
    for other in mission.targets:
        if other.name not in one:
            covers = _covered_by_target(rays, other, t)
            yield f"target {other.name}", covers & ~parts_of_one(filmed, other, t)[:, None, None]
    for name, surface in surfaces_before(mission, filmed.name):
        yield name, covered_by_surface(rays, surface)
    for flight in others:
        ball = flying(flight.curve, t)
        yield f"drone {flight.drone}", covered_by_ball(rays, ball, mission.drone(flight.drone).radius)


def _covered_by_target(rays: OutlineRays, other: Target, t: Array) -> Mask:
    beside = rays.mapped(partial(beside_body, other, t=t))
    out = np.zeros_like(rays.own)
    for body in bodies_of(other.shape):
        x, y, z = (np.array(other.centre) + np.array(body.offset)).tolist()
        out |= covered_by_solid(beside, body.shape.solid((x, y, z)))
    return out

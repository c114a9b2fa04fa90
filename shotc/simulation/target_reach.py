"""Where moving targets may be in the next seconds, as upright cylinders that a drone keeps clear of.

A target that the drone tracks is expected where its tracker predicts it, and may be off by SURE_DEVIATIONS.
Any other target is expected on its track. Its height is the planned one or the estimated one: the cylinder
holds both, since the estimate of a lost target sinks or rises without reason.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.bodies import centres
from shotc.ir.drone import Drone
from shotc.ir.target import Target
from shotc.plugin_api.replanner import Walls
from shotc.simulation.seen import TrackedTarget
from shotc.simulation.world import World

SURE_DEVIATIONS = 2.0
"""Standard deviations of a predicted position that are kept clear, horizontally: 86 % of all, if normal."""

TINY_M = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class TargetReach:
    """The cylinder in which a target may be at M times, in R runs; metres.

    target : its name
    axis : (M, R, 2); radius, low, high : (M, R)
    clearance : of a drone's centre from it
    """

    target: str
    axis: Array
    radius: Array
    low: Array
    high: Array
    clearance: float

    def until(self, count: int) -> TargetReach:
        """Return the same at the first times."""
        first = slice(count)
        return replace(
            self,
            axis=self.axis[first],
            radius=self.radius[first],
            low=self.low[first],
            high=self.high[first],
        )

    def lack(self, run: int, places: Array) -> Array:
        """Return the missing clearance at positions (M, 3), one for each time, shape (M,), metres.

        It is at most 0 where the clearance holds.
        """
        normal, least = self.half_spaces(run, places)
        return np.asarray(least - np.einsum("md,md->m", normal, places))

    def half_spaces(self, run: int, places: Array) -> tuple[Array, Array]:
        """Return half-spaces n . p >= d between the cylinder and positions (M, 3): n (M, 3) and d (M,).

        Each contains no point that is nearer to the cylinder than the clearance. From inside it they lead out
        by its top or by its side, whichever is nearer, and never below.
        """
        off = places[:, :2] - self.axis[:, run]
        distance = np.linalg.norm(off, axis=1)
        outward = np.where(
            distance[:, None] > TINY_M, off / np.maximum(distance, TINY_M)[:, None], [1.0, 0.0]
        )
        beside = distance - self.radius[:, run]
        above, below = places[:, 2] - self.high[:, run], self.low[:, run] - places[:, 2]
        inside = np.maximum(np.maximum(above, below), beside) <= 0.0
        by_top = inside & (above >= beside)
        side = np.where(inside, np.where(by_top, 0.0, 1.0), np.maximum(beside, 0.0))
        rise = np.where(inside, np.where(by_top, 1.0, 0.0), np.maximum(above, 0.0) - np.maximum(below, 0.0))
        length = np.hypot(side, rise)
        normal = np.column_stack([outward * (side / length)[:, None], rise / length])
        gap = np.where(inside, np.where(by_top, above, beside), length)
        return normal, np.einsum("md,md->m", normal, places) - gap + self.clearance


def reaches(
    world: World,
    drone: Drone,
    tracked: Sequence[TrackedTarget],
    times: Array,
    expected: Collection[str] = (),
) -> tuple[TargetReach, ...]:
    """Return where the moving targets of a mission may be at times (M,), seconds.

    expected : targets of which the place where they are expected counts alone
    """
    known = {each.name: each for each in tracked}
    clearance = world.mission.rules.beside_target(drone.radius)
    out = []
    for target in world.mission.targets:
        mine = known.get(target.name)
        if target.track is None and mine is None:
            continue
        reach = _expected(world, target, mine, times)
        spread = (
            0.0 if mine is None or target.name in expected else SURE_DEVIATIONS * mine.tracker.spread(times)
        )
        out.append(replace(reach, radius=reach.radius + spread, clearance=clearance))
    return tuple(out)


def with_targets(walls: Walls, reached: Sequence[TargetReach], run: int, places: Array) -> Walls:
    """Return walls with the half-spaces beside positions (M, 3) in a run, one of each target for each."""
    if not reached:
        return walls
    every = [each.half_spaces(run, places) for each in reached]
    normals, offsets = np.stack([n for n, _ in every], axis=1), np.stack([d for _, d in every], axis=1)
    if not walls.count:
        return Walls(normals, offsets)
    return Walls(
        np.concatenate([walls.normals, normals], axis=1), np.concatenate([walls.offsets, offsets], axis=1)
    )


def _expected(world: World, target: Target, known: TrackedTarget | None, times: Array) -> TargetReach:
    """Return the cylinder of a target where it is expected, without clearance."""
    count = (len(times), len(world.runs))
    planned = np.broadcast_to(centres(target, times)[:, None], (*count, 3))
    place = planned if known is None else known.tracker.ahead(times)[..., :3]
    half, z = target.height / 2, (planned[..., 2], place[..., 2])
    return TargetReach(
        target.name,
        axis=place[..., :2],
        radius=np.full(count, target.radius),
        low=np.minimum(*z) - half,
        high=np.maximum(*z) + half,
        clearance=0.0,
    )

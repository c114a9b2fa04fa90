"""The transit point: where a drone that rises vertically from its pad reaches the clearances of flight."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.solid_arrays.points import FAR_M
from shotc.geom.solid_arrays.segments import segment_distances
from shotc.ir.drone import Drone
from shotc.ir.owners import Owner
from shotc.planning.free_space import FreeSpace, bounds_slack, breaches

PAD_MARGIN_M = 0.1  # metres that the transit point keeps beyond clearances
LEAST_LIFT_M = 1.0  # metres above the pad at least
STEP_M, HIGHEST_M = 0.5, 150.0  # metres between candidate heights above a pad, and the highest
CUSTOM_LIFT_M = 3.0  # metres above the pad by default; PX4 refuses a lower take-off


@dataclass(frozen=True, slots=True)
class PadBlocked:
    """Why a drone cannot leave its pad vertically.

    owner : what stops it
    why : "above" an obstacle is above the pad, "outside" the pad is outside a fence, "beside" an obstacle is
        too near at every height, "ceiling" no height is left
    needs, has : clearance in metres; for a ceiling the lowest height of the drone's centre that the other
        rules allow, and the highest
    """

    owner: Owner
    why: Literal["above", "outside", "beside", "ceiling"]
    needs: float
    has: float


def transit_point(flight: FreeSpace, pad: FreeSpace, drone: Drone) -> Array | PadBlocked:
    """Return the point (3,) above the pad where the rules of flight hold and the column below it is free.

    It is the lowest from the default height on; if there is none, the lowest of all.
    """
    home = np.array(drone.home, dtype=np.float64)
    outside = breaches(FreeSpace((), tuple(w for w in pad.walls if w.normal[2] == 0.0), pad.discs), home)
    if outside:
        return PadBlocked(outside[0].owner, "outside", outside[0].lack, 0.0)
    half_spaces = [w.offset for w in flight.walls if w.normal[2] > 0.5]
    half_spaces += [h for g in flight.terrain[:1] for h in g.lowest(home[None, :2]).tolist()]
    lowest = max([home[2] + LEAST_LIFT_M, *(f + PAD_MARGIN_M for f in half_spaces)])
    ceiling = min(((-w.offset, w.owner) for w in pad.walls if w.normal[2] < -0.5), default=None)
    if ceiling is not None and ceiling[0] < lowest:
        return PadBlocked(ceiling[1], "ceiling", lowest, ceiling[0])
    tops = [o.part.top + o.clearance + PAD_MARGIN_M for o in flight.obstacles if o.part.top < FAR_M]
    usual = max(lowest, home[2] + CUSTOM_LIFT_M)
    tops += _beside_meshes(flight, home, usual)
    heights = [*sorted({usual, *(t for t in tops if t > usual)}), lowest]
    points = np.array([[home[0], home[1], z] for z in heights])
    inside = bounds_slack(flight, points) >= 0
    for point in points[inside]:
        over = _in_column(pad, home, point)
        if over is not None:
            return over
        if not breaches(flight, point):
            return np.asarray(point)
    near = breaches(flight, points[-1])[0]
    return PadBlocked(near.owner, "beside", near.clearance, near.clearance - near.lack)


def _beside_meshes(flight: FreeSpace, home: Array, above: float) -> list[float]:
    """Return the heights above a pad, from one on, at which the distance from meshes becomes sufficient."""
    column = above + np.arange(0.0, HIGHEST_M, STEP_M)
    points = np.column_stack([np.tile(home[:2], (len(column), 1)), column])
    free = np.ones(len(column), dtype=bool)
    for mesh in flight.meshes:
        free &= mesh.slack(points) >= PAD_MARGIN_M
    starts = free & ~np.concatenate([[True], free[:-1]])
    return [float(z) for z in column[starts]]


def _in_column(pad: FreeSpace, home: Array, top: Array) -> PadBlocked | None:
    hits = []
    for o in pad.obstacles:
        has = float(segment_distances(o.part, home[None], top[None])[0])
        if has < o.clearance - 1e-9:
            hits.append((o.part.bottom, PadBlocked(o.owner, "above", o.clearance, has)))
    for mesh in pad.meshes:
        at = home + np.linspace(0.0, 1.0, 1 + int(np.ceil((top[2] - home[2]) / STEP_M)))[:, None] * (
            top - home
        )
        if mesh.stops(home[None], top[None], 0.0)[0]:
            distance = mesh.clearance + mesh.slack(at)
            k = int(distance.argmin())
            hits.append(
                (float(at[k, 2]), PadBlocked(mesh.owner, "above", mesh.clearance, float(distance[k])))
            )
    return min(hits, key=lambda hit: hit[0])[1] if hits else None

"""Obstacles of a shot on the clock: moving targets, other drones, and everything that stands.

On each piece of a spline an obstacle's motion is approximated as linear. The deviation bound of this
approximation is added to the clearance, so that a half-space beside the linear motion also keeps clear of the
true one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask
from shotc.geom.proof import box_gap
from shotc.geom.solid_arrays.planes import gaps, separate
from shotc.geom.solid_arrays.points import support
from shotc.geom.solids import Solid, point
from shotc.geom.track_array import places
from shotc.ir.bodies import flying, standing_at
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.owners import Owner, drone_owner, target_owner
from shotc.ir.trajectory import DroneTrajectory
from shotc.ir.transits import from_target
from shotc.planning.corridor import rows_of
from shotc.planning.free_space import MARGIN_M, NO_HALF_SPACES, HalfSpaces, six
from shotc.planning.obstacles import FreeSpaces
from shotc.solvers.spline_problem import HalfSpaceRows

SAMPLES_PER_PIECE = 8  # samples of the deviation from the linear motion
REACH_M = 4.0  # metres beyond its clearance, within which an obstacle counts
TOUCH_M = 1e-3  # metres, tolerance of the distance
COMFORT_M = 0.3  # metres kept beyond a clearance where there is free space

PlacesAt = Callable[[Array], Array]
"""Positions p_W (M, 3), metres, at mission times (M,), seconds."""
POINT = point((0.0, 0.0, 0.0))


@dataclass(frozen=True, slots=True)
class Moving:
    """A convex solid that moves, and the clearance from it in metres.

    owner : as in ``ir.owners``
    part : the solid about the origin of its motion
    at : positions p_W (M, 3) at mission times (M,)
    always : whether the clearance also holds during take-off and landing
    apart : clearance on transfers, metres
    required : whether the mission states that clearance
    present : mission times between which it is there, seconds
    """

    owner: Owner
    part: Solid
    clearance: float
    at: PlacesAt
    always: bool = False
    apart: float = 0.0
    required: bool = False
    present: tuple[float, float] = (-inf, inf)

    def is_there(self, times: Array) -> Mask:
        """Return whether it is there at mission times, of any shape."""
        return np.asarray((times >= self.present[0]) & (times <= self.present[1]))


def standing(spaces: FreeSpaces) -> tuple[Moving, ...]:
    """Return the obstacles of free spaces as motions that stay at their places."""
    return tuple(
        Moving(o.owner, o.part, o.clearance, _nowhere, apart=w.clearance, required=o.owner in spaces.required)
        for o, w in zip(spaces.flight.obstacles, spaces.transit.obstacles, strict=True)
    )


def _nowhere(times: Array) -> Array:
    return np.zeros((len(times), 3))


@dataclass(frozen=True, slots=True, eq=False)
class LinearMotion:
    """A motion linearised on each piece.

    ends : positions at the ends of each piece, (P, 2, 3)
    deviation_bound : largest distance of the true motion from the linear one, (P,), metres
    wide : clearance at each control point, (P, 6), where it differs from the normal one
    """

    what: Moving
    ends: Array
    deviation_bound: Array
    wide: Array | None = None

    @property
    def needs(self) -> Array:
        """The distances needed at the control points of the pieces, shape (P, 6), metres."""
        clearance = (
            np.full((len(self.deviation_bound), 6), self.what.clearance) if self.wide is None else self.wide
        )
        return np.asarray(clearance + self.deviation_bound[:, None])

    def on(self, pieces: IntArray) -> LinearMotion:
        """Return the motion on a subset of its pieces, by their indices."""
        wide = None if self.wide is None else self.wide[pieces]
        return LinearMotion(self.what, self.ends[pieces], self.deviation_bound[pieces], wide)


def moving_targets(mission: MissionIR, drone: Drone) -> tuple[Moving, ...]:
    """Return the targets that move, each as a solid about its centre."""
    clearance = mission.rules.beside_target(drone.radius)
    motions = []
    for target in mission.targets:
        if target.track is not None:
            name, part = target_owner(target), target._replace(centre=(0.0, 0.0, 0.0)).kept_clear
            rule = from_target(mission, target.name)
            apart = clearance if rule is None else drone.radius + rule.metres + MARGIN_M
            required = rule is not None and rule.required
            at = partial(places, target.track)
            motions.append(Moving(name, part, clearance, at, apart=apart, required=required))
    return tuple(motions)


def linearised(what: Moving, breaks: Array) -> LinearMotion:
    """Linearise a motion on the pieces between breaks, shape (P + 1,), mission times in seconds."""
    share = np.linspace(0.0, 1.0, SAMPLES_PER_PIECE + 1)
    times = breaks[:-1, None] + np.diff(breaks)[:, None] * share
    at = what.at(times.ravel()).reshape(*times.shape, 3)
    ends = at[:, [0, -1]]
    linear = ends[:, :1] + share[:, None] * (ends[:, 1:] - ends[:, :1])
    # A track may have a corner between two samples, hence the factor 1.2.
    deviation_bound = np.linalg.norm(at - linear, axis=2).max(axis=1)
    return LinearMotion(what, ends, 1.2 * deviation_bound)


def sides(motions: Sequence[LinearMotion], hulls: Array) -> HalfSpaces:
    """Return a half-space for every piece and every obstacle near it; owners are indices of the motions.

    Consecutive pieces that are too near all pass on the same side.

    hulls : shape (P, m, 3), points whose convex hull contains each piece, evenly spaced in time
    """
    rows: list[HalfSpaces] = []
    for index, motion in enumerate(motions):
        relative = relative_to(motion, hulls)
        apart = box_gap(relative, motion.what.part) - motion.needs.max(axis=1)
        pieces = np.flatnonzero(apart < REACH_M)
        if len(pieces):
            near = _beside(motion.on(pieces), relative[pieces], pieces)
            rows.append(replace(near, owner=np.full(len(near.piece), index)))
    return NO_HALF_SPACES.and_also(*rows)


def _beside(motion: LinearMotion, relative: Array, pieces: IntArray) -> HalfSpaces:
    """Return half-spaces between pieces and one motion where it is near; without an owner.

    relative : hulls relative to the motion, (P, m, 3)
    pieces : their indices, (P,)
    """
    part, need = motion.what.part, motion.needs
    normal, gap = separate(part, relative)
    slack = _slack(motion, relative, normal, gap)
    for run in _runs(pieces, slack < -TOUCH_M):
        normal[run] = _way_round(part, relative[run], need[run].max(axis=1))
        gap[run] = -_push(part, relative[run], np.zeros(len(run)), normal[run])
    slack = _slack(motion, relative, normal, gap)
    near = np.flatnonzero(slack < REACH_M)
    points = np.einsum("nmd,nd->nm", relative[near], normal[near]).min(axis=1)
    keep = need[near] + np.minimum(COMFORT_M, 0.5 * np.maximum(slack[near], 0.0))[:, None]
    border = (points - gap[near])[:, None] + keep
    linear = np.linspace(0.0, 1.0, 6)[None, :, None]
    carried = motion.ends[near][:, :1] + linear * (motion.ends[near][:, 1:] - motion.ends[near][:, :1])
    offset = border + np.einsum("nmd,nd->nm", carried, normal[near])
    return HalfSpaces(pieces[near], normal[near], offset, np.zeros(len(near), dtype=np.int64))


def motion_rows(breaks: Array, planes: HalfSpaces, first: int) -> HalfSpaceRows:
    """Return half-spaces as rows of a programme.

    breaks : shape (P + 1,)
    first : index of the first motion among the owners
    """
    return rows_of(breaks, replace(planes, owner=first + planes.owner))


def _slack(motion: LinearMotion, relative: Array, normal: Array, gap: Array) -> Array:
    """Return the slack of pieces over their needed distances from planes with these normals, (P,), metres."""
    if motion.wide is None:
        return np.asarray(gap - motion.needs[:, 0])
    along = np.einsum("pmd,pd->pm", relative, normal)
    border = along.min(axis=1) - gap
    points = np.einsum("pmd,pd->pm", six(relative), normal)
    return np.asarray((points - border[:, None] - motion.needs).min(axis=1))


def shortfalls(
    motions: Sequence[LinearMotion],
    hulls: Array,
    least: float = -np.inf,
    planes: HalfSpaces = NO_HALF_SPACES,
) -> Array:
    """Return the metres by which the clearances of each piece are not proved; shape (P,), <= 0 is proved.

    hulls : shape (P, m, 3), as in ``sides``
    least : smallest value returned, metres; pieces below it are not computed
    planes : half-spaces that the pieces keep. ``separate`` finds a gap a little narrower than the widest one,
        so a piece that keeps a half-space exactly may need its normal for the proof.
    """
    worst = np.full(len(hulls), least)
    bounds = [_bound_of(motion, hulls) for motion in motions]
    # An obstacle is skipped on pieces where its bound shows that another one lacks more.
    for bound in sorted(bounds, key=lambda each: -each.most.max(initial=-np.inf)):
        pieces = np.flatnonzero(bound.most > worst)
        if len(pieces):
            gap = _plane_gaps(bound.motion.what.part, bound.relative, pieces, planes)
            lack = np.minimum(bound.most[pieces], bound.needed[pieces] - gap)
            worst[pieces] = np.maximum(worst[pieces], lack)
    return worst


class _LackBound(NamedTuple):
    """A bound on what pieces lack of the clearance from one motion.

    relative : the pieces relative to it, (P, m, 3); needed, most : the gap that is needed, and the most that
        they lack of it, metres, (P,)
    """

    motion: LinearMotion
    relative: Array
    needed: Array
    most: Array


def _bound_of(motion: LinearMotion, hulls: Array) -> _LackBound:
    relative, needed = relative_to(motion, hulls), motion.what.clearance + motion.deviation_bound
    # Boxes apart prove a gap; boxes that meet say nothing of the depth.
    box = box_gap(relative, motion.what.part)
    return _LackBound(motion, relative, needed, np.where(box > 0.0, needed - box, np.inf))


def _plane_gaps(part: Solid, relative: Array, pieces: IntArray, planes: HalfSpaces) -> Array:
    """Return gaps that planes prove between a solid and some of the pieces, metres, one for each of these.

    relative : all pieces relative to the solid, shape (P, m, 3)
    """
    _, gap = separate(part, relative[pieces])
    rows = np.flatnonzero(np.isin(planes.piece, pieces))
    piece, normal = planes.piece[rows], planes.normal[rows]
    np.maximum.at(gap, np.searchsorted(pieces, piece), gaps(part, relative[piece], normal))
    return gap


def relative_to(motion: LinearMotion, hulls: Array) -> Array:
    """Return hulls (P, m, 3), evenly spaced in time, relative to a linear motion."""
    share = np.linspace(0.0, 1.0, hulls.shape[1])[:, None]
    return np.asarray(hulls - (motion.ends[:, :1] + share * (motion.ends[:, 1:] - motion.ends[:, :1])))


def _runs(pieces: IntArray, too_near: Mask) -> list[IntArray]:
    """Return the indices of pieces that are too near, in runs with gaps of at most one piece; pieces
    : (P,).
    """
    indices = np.flatnonzero(too_near)
    if not len(indices):
        return []
    return np.split(indices, np.flatnonzero(np.diff(pieces[indices]) > 2) + 1)


def _way_round(part: Solid, relative: Array, need: Array) -> Array:
    """Return the direction in which a run of pieces leaves a solid with the smallest shift, shape (3,).

    The candidates are upwards and to either side of the course.
    """
    course = relative[-1, -1] - relative[0, 0]
    across = np.array([-course[1], course[0], 0.0])
    if np.linalg.norm(across) < 1e-6:
        across = np.array([1.0, 0.0, 0.0])
    across /= np.linalg.norm(across)
    options = [across, -across, np.array([0.0, 0.0, 1.0])]
    costs = [float(np.maximum(_push(part, relative, need, n), 0.0).sum()) for n in options]
    return options[int(np.argmin(costs))]


def _push(part: Solid, relative: Array, need: Array, normal: Array) -> Array:
    """Return how far pieces have to move along a direction to be clear, metres; negative is clear."""
    n = np.broadcast_to(normal, (len(relative), 3))
    reach = np.einsum("pmd,pd->pm", relative, n).min(axis=1)
    return np.asarray(support(part, n) + need - reach)


def other_drones(mission: MissionIR, name: str, flights: Mapping[str, DroneTrajectory]) -> tuple[Moving, ...]:
    """Return the other drones that film as moving obstacles; parked drones are part of the free space.

    name : of the drone that is planned
    flights : of the drones planned so far, by name; the others stand on their pads
    """
    parked = {drone.name for drone in mission.parked}
    motions = []
    for drone in mission.drones:
        if drone.name == name or drone.name in parked:
            continue
        flight = flights.get(drone.name)
        at = partial(standing_at, np.array(drone.home)) if flight is None else partial(flying, flight.curve)
        motions.append(Moving(drone_owner(drone), POINT, mission.rules.separation, at, always=True))
    return tuple(motions)

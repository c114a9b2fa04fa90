"""What a shot is flown clear of: targets and drones that move, and everything that stands.

On each piece of a spline its motion is taken as linear; by how much it leaves that is added to the
clearance, so that a plane beside the linear motion keeps clear of the true one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask
from shotc.geom.proof import box_gap
from shotc.geom.solid_arrays.planes import separate
from shotc.geom.solid_arrays.points import support
from shotc.geom.solids import Solid
from shotc.geom.track_array import places
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.owners import Owner, target_owner
from shotc.ir.transits import from_target
from shotc.planning.corridor import rows_of
from shotc.planning.free_space import MARGIN_M, NO_HALF_SPACES, HalfSpaces, six
from shotc.planning.obstacles import FreeSpaces
from shotc.solvers.spline_problem import HalfSpaceRows

SAMPLES_PER_PIECE = 8  # a piece, at which motion is compared with linear motion
REACH_M = 4.0  # metres beyond its clearance within which something that moves counts
TOUCH_M = 1e-3  # metres by which a proved piece may seem too near
COMFORT_M = 0.3  # metres kept beyond a clearance where there is room


@dataclass(frozen=True, slots=True)
class Moving:
    """A convex solid about the origin of a motion, kept ``clearance`` metres away from.

    owner : as in geom.corridor; at : places p_W (M, 3) at times (M,)
    always : whether it is kept away from while a drone rises from its pad or sinks to it, too
    apart : the clearance on ways between shots, metres; required : whether the mission writes that down
    """

    owner: Owner
    part: Solid
    clearance: float
    at: Callable[[Array], Array]
    always: bool = False
    apart: float = 0.0
    required: bool = False


def standing(spaces: FreeSpaces) -> tuple[Moving, ...]:
    """Return the obstacles of free spaces, as motions that stay where they are."""
    return tuple(
        Moving(o.owner, o.part, o.clearance, _nowhere, apart=w.clearance, required=o.owner in spaces.required)
        for o, w in zip(spaces.flight.obstacles, spaces.transit.obstacles, strict=True)
    )


def _nowhere(times: Array) -> Array:
    return np.zeros((len(times), 3))


@dataclass(frozen=True, slots=True, eq=False)
class LinearMotion:
    """A motion linearised on each piece: its ends (P, 2, 3), and how far at most the true one leaves it (P,).

    wide : the clearance at each control point of the pieces, (P, 6), where it is not that of all phases
    """

    what: Moving
    ends: Array
    deviation_bound: Array
    wide: Array | None = None

    @property
    def needs(self) -> Array:
        """What is needed of the distance at the control points of the pieces, shape (P, 6), metres."""
        clearance = (
            np.full((len(self.deviation_bound), 6), self.what.clearance) if self.wide is None else self.wide
        )
        return np.asarray(clearance + self.deviation_bound[:, None])

    def on(self, pieces: IntArray) -> LinearMotion:
        """Return the motion on some of its pieces, by their numbers."""
        wide = None if self.wide is None else self.wide[pieces]
        return LinearMotion(self.what, self.ends[pieces], self.deviation_bound[pieces], wide)


def moving_targets(mission: MissionIR, drone: Drone) -> tuple[Moving, ...]:
    """Return the targets that move, each a solid about its centre."""
    clearance = mission.rules.beside_target(drone.radius)
    motions = []
    for target in mission.targets:
        if target.track is not None:
            name, part = target_owner(target), target._replace(centre=(0.0, 0.0, 0.0)).kept_clear
            kept = from_target(mission, target.name)
            apart = clearance if kept is None else drone.radius + kept.metres + MARGIN_M
            required = kept is not None and kept.required
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
    # A track may have a corner between two samples: at most its neighbours' distance from the line.
    deviation_bound = np.linalg.norm(at - linear, axis=2).max(axis=1)
    return LinearMotion(what, ends, 1.2 * deviation_bound)


def sides(motions: Sequence[LinearMotion], hulls: Array) -> HalfSpaces:
    """Put a plane between every piece and everything that comes near it; owners index the motions.

    hulls : shape (P, m, 3), points whose hull holds each piece, evenly in time from its start to its end
    Where a run of pieces comes too near, all of them pass on one side.
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
    """Put planes between pieces and one motion, where it comes near; without an owner.

    relative : their hulls as the motion sees them; pieces : their numbers, (P,)
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
    """Return the half-spaces as rows of a programme.

    breaks : shape (P + 1,); first : index of the first motion among the owners
    """
    return rows_of(breaks, replace(planes, owner=first + planes.owner))


def _slack(motion: LinearMotion, relative: Array, normal: Array, gap: Array) -> Array:
    """Return by how much pieces are farther away than is needed, as planes with these normals tell, (P,)."""
    if motion.wide is None:
        return np.asarray(gap - motion.needs[:, 0])
    along = np.einsum("pmd,pd->pm", relative, normal)
    border = along.min(axis=1) - gap
    points = np.einsum("pmd,pd->pm", six(relative), normal)
    return np.asarray((points - border[:, None] - motion.needs).min(axis=1))


def shortfalls(motions: Sequence[LinearMotion], hulls: Array) -> Array:
    """Return by how much each piece fails to prove its clearances, metres; shape (P,), <= 0 is proved."""
    worst = np.full(len(hulls), -np.inf)
    seen = [(m.what.part, m.what.clearance + m.deviation_bound, relative_to(m, hulls)) for m in motions]
    most = [needed - box_gap(relative, part) for part, needed, relative in seen]
    for k in sorted(range(len(seen)), key=lambda k: -most[k].max(initial=-np.inf)):
        part, needed, relative = seen[k]
        # What is farther away than another one is short of it by less.
        pieces = np.flatnonzero(most[k] > worst)
        if len(pieces):
            _, gap = separate(part, relative[pieces])
            worst[pieces] = np.maximum(worst[pieces], needed[pieces] - gap)
    return worst


def relative_to(motion: LinearMotion, hulls: Array) -> Array:
    """Return hulls (P, m, 3), evenly in time over their pieces, as a motion sees them."""
    share = np.linspace(0.0, 1.0, hulls.shape[1])[:, None]
    return np.asarray(hulls - (motion.ends[:, :1] + share * (motion.ends[:, 1:] - motion.ends[:, :1])))


def _runs(pieces: IntArray, too_near: Mask) -> list[IntArray]:
    """Return where those too near stand among pieces (P,), in runs without a gap of more than one."""
    indices = np.flatnonzero(too_near)
    if not len(indices):
        return []
    return np.split(indices, np.flatnonzero(np.diff(pieces[indices]) > 2) + 1)


def _way_round(part: Solid, relative: Array, need: Array) -> Array:
    """Return the direction in which a run of pieces is pushed out of a solid by the least, shape (3,).

    Over it, or to either side of the way past it.
    """
    way = relative[-1, -1] - relative[0, 0]
    across = np.array([-way[1], way[0], 0.0])
    if np.linalg.norm(across) < 1e-6:
        across = np.array([1.0, 0.0, 0.0])
    across /= np.linalg.norm(across)
    options = [across, -across, np.array([0.0, 0.0, 1.0])]
    costs = [float(np.maximum(_push(part, relative, need, n), 0.0).sum()) for n in options]
    return options[int(np.argmin(costs))]


def _push(part: Solid, relative: Array, need: Array, normal: Array) -> Array:
    """Return by how much pieces have to be moved along a direction to be clear; negative is clear."""
    n = np.broadcast_to(normal, (len(relative), 3))
    reach = np.einsum("pmd,pd->pm", relative, n).min(axis=1)
    return np.asarray(support(part, n) + need - reach)

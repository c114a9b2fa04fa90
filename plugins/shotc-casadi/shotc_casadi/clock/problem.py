"""The programme of one shot on its own clock, in numbers: stages, parameters, bounds, initial guess."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.plugin_api import Piecewise
from shotc.plugin_api.refiner import Array, Drone, HalfSpaces, Mask, Near, near_at, viewpoint
from shotc_casadi.clock import weights
from shotc_casadi.clock.picture import SUBJECT
from shotc_casadi.clock.references import ClockReferences, ClockSubject, steepest
from shotc_casadi.clock.several import angles, turning_room
from shotc_casadi.clock.symbols import CONTROL_POINTS, FIELDS, PLACE_STATES, PLANE_PARAMETERS, SLACK, Sizes
from shotc_casadi.extents import EXTENT_PARAMETERS

USUAL_STAGES = 100  # of the film, if its pieces allow
SEVERAL_STAGES = 60  # the same with several subjects, whose pictures make a stage ten times as costly
COUNTS = (0, 1, 2, 3, 4, 6, 8, 12, 16)  # possible numbers of half-spaces, so that few programmes are built
FREE_M = 1.0  # metres of slack of an unused half-space: a constraint needs an interior
WEIGHTS = ("place", "jerk", "turn", "price", "hidden", "field", "touch", "picture")
UNFILMED_WEIGHT = 1e3
# Half-width of the box about the given states of both ends, SI. ``curve_of`` removes the deviation; a wider
# box takes clearances at the ends that then have to be proved in another round.
END_TOLERANCE = 1e-5
HELD_TOLERANCE = 2e-4  # half-width of the box about a keyframe's place, and about rest there, SI
SAME_S = 1e-9  # seconds


class Use(NamedTuple):
    """How much of the limits a programme may use.

    share : of each limit
    ends : half-width of the box about the given states of both ends, SI
    """

    share: float
    ends: float = END_TOLERANCE


@dataclass(frozen=True, slots=True, eq=False)
class ClockProblem:
    """One instance of the programme: N stages, N + 1 nodes.

    parameters : shape (N + 1, symbols.size(sizes))
    unit : the factor that their weights contain
    states, inputs : initial guess, shapes (N + 1, sizes.states) and (N, sizes.inputs)
    state_bounds : (lower, upper), shapes as states
    least : lower bound of each input, shape (sizes.inputs,)
    held, driven : (lower, upper) of a stage's constraints, as in symbols.stage
    """

    sizes: Sizes
    parameters: Array
    unit: float
    states: Array
    inputs: Array
    state_bounds: tuple[Array, Array]
    least: Array
    held: tuple[Array, Array]
    driven: tuple[Array, Array]

    @property
    def stages(self) -> int:
        """N."""
        return len(self.inputs)

    @property
    def units(self) -> Array:
        """Units of all inputs, shape (N, sizes.inputs); one unit of a slack costs 1 a stage."""
        units = np.ones_like(self.inputs)
        for price, k in self.sizes.slacks.items():
            units[:, k] = 1.0 / (self.length * self._each(price))
        return units

    @property
    def length(self) -> Array:
        """How long the stages are, shape (N,), seconds."""
        return self._each("length")

    def _each(self, name: str) -> Array:
        """Return a scalar parameter of all stages, shape (N,)."""
        names = list(FIELDS)
        return self.parameters[:-1, sum(FIELDS[other] for other in names[: names.index(name)])]


def breaks_of(subject: ClockSubject) -> Array:
    """Return the times of the nodes (N + 1,): the guide's breaks, with the usual number in the film."""
    breaks, leg = subject.leg.curve.breaks, subject.leg
    middle = 0.5 * (breaks[:-1] + breaks[1:])
    filmed = (middle > leg.start) & (middle < leg.end)
    usual = SEVERAL_STAGES if subject.together else USUAL_STAGES
    parts = max(1, round(usual / max(1, int(filmed.sum()))))
    counts = np.where(filmed, parts, max(1, parts // 2))
    cut = [
        np.linspace(a, b, n, endpoint=False) for a, b, n in zip(breaks[:-1], breaks[1:], counts, strict=True)
    ]
    return np.append(np.concatenate(cut), breaks[-1])


def guess(curve: Piecewise, breaks: Array, camera: Piecewise | None = None) -> tuple[Array, Array]:
    """Return states and inputs along a position curve, shapes (N + 1, 9 or 15) and (N, 4 or 5).

    breaks : the times of the nodes, shape (N + 1,)
    camera : a leg whose camera angles are appended, if the camera is part of the problem
    """
    orders = [curve, curve.derivative(1), curve.derivative(2)]
    states = np.concatenate([order(breaks)[:, :3] for order in orders], axis=1)
    length = np.diff(breaks)[:, None]
    jerk = np.diff(states[:, 6:], axis=0) / length
    if camera is None:
        return states, np.column_stack([jerk, np.full(len(jerk), 0.1)])
    turning = angles(camera, breaks)
    return np.column_stack([states, turning]), np.column_stack(
        [jerk, np.diff(turning[:, [2, 5]], axis=0) / length]
    )


def problem(
    subject: ClockSubject,
    breaks: Array,
    references: ClockReferences,
    planes: HalfSpaces,
    use: Use,
    start: tuple[Array, Array],
) -> ClockProblem:
    """Return the programme; breaks : shape (N + 1,), start : states and inputs as from ``guess``.

    The initial slack of ellipsoids is one unit each.
    """
    table = table_of(planes, len(breaks) - 1)
    count = table.shape[1]
    wind = subject.drone.limits.wind
    sizes = Sizes(
        count,
        references.sight_lines.shape[1],
        references.bodies.shape[1],
        references.subjects.shape[1],
        (references.subjects.shape[2] - SUBJECT) // EXTENT_PARAMETERS,
        any(wind),
    )
    held, driven = _row_bounds(subject.drone, sizes, use.share)
    rows = [references.sight_lines, references.bodies, references.subjects]
    flat = [row.reshape(len(breaks), -1) for row in rows]
    if sizes.windy:
        flat.append(np.tile(use.share * np.array(wind), (len(breaks), 1)))
    moves = start[1][:, : sizes.moves]
    bare = ClockProblem(
        sizes,
        np.column_stack([_parameters(subject, breaks, references), _for_nodes(table), *flat]),
        _unit(references),
        start[0],
        np.column_stack([moves, np.ones((len(moves), sizes.inputs - sizes.moves))]),
        _bounds(subject, breaks, sizes, use),
        _least_inputs(sizes),
        held,
        driven,
    )
    return replace(bare, inputs=np.column_stack([moves, bare.units[:, sizes.moves :]]))


def _least_inputs(sizes: Sizes) -> Array:
    """Return the lower bound of each input: slacks are not negative."""
    least = np.full(sizes.inputs, -inf)
    least[sizes.moves :] = 0.0
    if not sizes.subjects:
        least[SLACK] = 0.0
    return least


def _row_bounds(drone: Drone, sizes: Sizes, share: float) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Return (lower, upper) of the rows held and driven of a stage; share : used share of the limits."""
    limits = drone.limits
    speed, acceleration, jerk = (
        (share * bound) ** 2 for bound in (limits.speed, limits.usable_acceleration, limits.jerk)
    )
    low = np.zeros(sizes.limits + sizes.planes * CONTROL_POINTS + sizes.occluders + sizes.bodies)
    low[:3] = -inf, -inf, -share * limits.descent
    high = np.full_like(low, inf)
    high[:3] = jerk, speed, share * limits.climb
    return (np.full(3, -inf), np.array([speed, acceleration, 1.0])), (low, high)


def _bounds(subject: ClockSubject, breaks: Array, sizes: Sizes, use: Use) -> tuple[Array, Array]:
    """Return the bounds of all states; at both ends they are those of the guide."""
    limits, leg = subject.drone.limits, subject.leg
    low = np.full((len(breaks), sizes.states), -inf)
    high = -low
    low[:, 5], high[:, 5] = -use.share * limits.descent, use.share * limits.climb
    if sizes.subjects:
        low[:, PLACE_STATES:], high[:, PLACE_STATES:] = turning_room(subject.drone, use.share)
    camera = leg.curve if sizes.subjects else None
    rest = guess(leg.curve.channels(0, 1, 2), breaks[[0, -1]], camera)[0]
    for k, given in zip((0, -1), rest, strict=True):
        low[k], high[k] = given - use.ends, given + use.ends
    for bound in subject.bound:
        at = (breaks >= bound.start - SAME_S) & (breaks <= bound.end + SAME_S)
        low[at, :3], high[at, :3] = (
            np.array(bound.place) - HELD_TOLERANCE,
            np.array(bound.place) + HELD_TOLERANCE,
        )
        if bound.still:
            low[at, 3:9], high[at, 3:9] = -HELD_TOLERANCE, HELD_TOLERANCE
    return low, high


def _drawn_angles(pose: Near) -> Array:
    """Return reference yaw and pitch (0 if free), rad, and the weights of both, (4,)."""
    preferred = (pose.yaw, pose.pitch)
    weight = viewpoint.NEAR_WEIGHT**2
    return np.array([*(a or 0.0 for a in preferred), *(0.0 if a is None else weight for a in preferred)])


class _PlaceTerms(NamedTuple):
    """What a motion is drawn to at the nodes, before weights are shared among stages.

    ideal : places, W, metres, (N + 1, 3); place : weight of the distance from them, (N + 1,)
    leash : how that weight grows with the squared distance, 1/m^2
    angles : yaw and pitch, rad, and the weights of both, (N + 1, 4)
    """

    ideal: Array
    place: Array
    leash: float
    angles: Array


def _near_pose(
    subject: ClockSubject,
    pose: Near,
    breaks: Array,
    references: ClockReferences,
    filmed: Mask,
    usual: _PlaceTerms,
) -> _PlaceTerms:
    """Return the terms of a shot that stays near a pose while it is filmed (viewpoint Eq. 10)."""
    drawn = np.array([near_at(subject.mission, pose, float(t)) for t in breaks])
    angles = _drawn_angles(pose) * np.where(filmed, 1.0, 0.0)[:, None]
    length = np.append(np.diff(breaks), 0.0)
    angles[:, 2:] *= _unit(references) * weights.SUBJECTS_WEIGHT * _shared(length)[:, None]
    distance = np.linalg.norm(references.centres.mean(axis=1) - drawn, axis=1)
    share = viewpoint.NEAR_WEIGHT / np.maximum(distance, 1.0)
    place = np.where(filmed, weights.SUBJECTS_WEIGHT * share**2, usual.place)
    return _PlaceTerms(np.where(filmed[:, None], drawn, usual.ideal), place, 0.0, angles)


def _turn_weights(subject: ClockSubject, references: ClockReferences, filmed: Mask) -> Array:
    """Return the weights of the ray's derivatives at the nodes, shape (N + 1, 6)."""
    if not references.watches:
        return np.zeros((len(filmed), 6))
    turn = np.array(weights.TURN_WEIGHTS)
    free = references.placed and not subject.together
    return np.where(
        filmed[:, None],
        turn * subject.placed.shot.smoother ** np.array(weights.TURN_ORDERS),
        (0.0 if free else weights.UNFILMED_RAY_WEIGHT) * turn,
    )


def _parameters(subject: ClockSubject, breaks: Array, references: ClockReferences) -> Array:
    leg, n = subject.leg, len(breaks) - 1
    length = np.append(np.diff(breaks), 0.0)
    filmed = (breaks >= leg.start - 1e-9) & (breaks < leg.end - 1e-9)
    near, paid = 1.0 / references.usual**2, _unit(references)
    smoother = subject.placed.shot.smoother
    binds = _binds(subject, references)
    drone, half = subject.drone, np.tan(subject.drone.hfov / 2)
    unit = weights.SUBJECTS_WEIGHT if subject.together else binds
    kept = _PlaceTerms(
        references.ideal, binds * near * np.ones(n + 1), near / weights.LEASH_SHARE**2, np.zeros((n + 1, 4))
    )
    if subject.near is not None:
        kept = _near_pose(subject, subject.near, breaks, references, filmed, kept)
    values = {
        "length": length,
        "ideal": kept.ideal,
        "place": kept.place * _shared(np.where(filmed, 1.0, weights.UNFILMED_WEIGHT) * length),
        "leash": np.full(n + 1, kept.leash),
        "drawn": kept.angles,
        "near": references.reach**-2.0,
        "target": references.target,
        "jerk": weights.JERK_WEIGHT
        * near
        * np.where(filmed, smoother**weights.JERK_ORDER, weights.UNSEEN_WEIGHT),
        "turn": _turn_weights(subject, references, filmed),
        "steep": steepest(subject, breaks),
        "free": np.where(filmed & references.watches, 0.0, UNFILMED_WEIGHT),
        "price": np.full(n + 1, weights.PITCH_WEIGHT / references.usual),
        "hidden": np.full(n + 1, weights.HIDDEN_WEIGHT * unit),
        "field": weights.FIELD_WEIGHT * _shared(length),
        "touch": np.full(n + 1, weights.TOUCH_WEIGHT * unit),
        "picture": weights.SUBJECTS_WEIGHT * _shared(filmed * length),
        "lens": np.tile([half, half / drone.aspect], (n + 1, 1)),
    }
    values |= {name: paid * values[name] for name in WEIGHTS}
    table = [np.asarray(values[name]).reshape(n + 1, width) for name, width in FIELDS.items()]
    return np.column_stack(table)


def _unit(references: ClockReferences) -> float:
    """Return the factor on all weights for the solver.

    Without a filmed subject a jerk costs almost nothing. fatrop takes such a small curvature for zero, adds
    to the diagonal again and again, and makes little progress; the factor prevents this. With occluders the
    cost has hills between their sides, and a cost that is large against the barrier keeps the solver on the
    first side. So there the factor is 1.
    """
    if references.sight_lines.shape[1]:
        return 1.0
    return weights.UNIT_COST * references.usual**2


def _binds(subject: ClockSubject, references: ClockReferences) -> float:
    """Return the weight of the position."""
    if len(subject.framed) > 1:
        return weights.LOOSE_WEIGHT
    if not references.placed or subject.held_whole:
        return weights.PLACE_WEIGHT
    return (
        weights.YIELDING_WEIGHT
        if references.yields or references.sight_lines.shape[1]
        else weights.PLACED_WEIGHT
    )


def _shared(stages: Array) -> Array:
    """Return the duration that each node stands for: half of the stages on both sides."""
    return np.asarray(0.5 * (stages + np.append(0.0, stages[:-1])))


def table_of(planes: HalfSpaces, stages: int) -> Array:
    """Return half-spaces as parameters of the stages, shape (N, count, PLANE_PARAMETERS).

    ``count`` is the least of COUNTS that is enough for every stage; unused half-spaces hold everywhere.
    """
    order = np.argsort(planes.piece, kind="stable")
    piece = planes.piece[order]
    slot = np.arange(len(piece)) - np.searchsorted(piece, piece)
    most = int(slot.max(initial=-1)) + 1
    count = next((c for c in COUNTS if c >= most), most)
    table = np.zeros((stages, count, PLANE_PARAMETERS))
    table[:, :, 3] = -FREE_M
    first, last = planes.offset[order, :1], planes.offset[order, -1:]
    table[piece, slot] = np.hstack([planes.normal[order], first, last - first])
    return table


def _for_nodes(table: Array) -> Array:
    """Return half-spaces of stages as parameters of all nodes, shape (N + 1, count * PLANE_PARAMETERS)."""
    last = np.zeros_like(table[:1])
    last[:, :, 3] = -FREE_M
    return np.concatenate([table, last]).reshape(len(table) + 1, -1)

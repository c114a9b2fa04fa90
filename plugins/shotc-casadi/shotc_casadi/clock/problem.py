"""The programme of one shot on its own clock, in numbers: stages, parameters, bounds, a first guess."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

from shotc.plugin_api import Piecewise
from shotc.refiner_api import Array, Planes
from shotc_casadi.clock import weights
from shotc_casadi.clock.symbols import FIELDS, HIDDEN, INPUTS, PLANE, POINTS, SLACK
from shotc_casadi.clock.wishes import ClockSubject, ClockWishes, steepest

STAGES = 100  # of the film, if its pieces allow
COUNTS = (0, 1, 2, 3, 4, 6, 8, 12, 16)  # half-spaces a programme may have, so that few are built
FREE = 1.0  # metres of slack of what means nothing: a constraint needs an interior
UNFILMED = 1e3
WIDE = 5e-4  # half the width of the box about the given states of both ends, m and so on


@dataclass(frozen=True, slots=True, eq=False)
class ClockProblem:
    """One instance of the programme: N stages, N + 1 nodes.

    parameters : shape (N + 1, symbols.size(planes, screens))
    states, inputs : first guess, shapes (N + 1, STATES) and (N, INPUTS), or one more where there are screens
    state_bounds : (lower, upper), shapes as states
    held, driven : (lower, upper) of a stage's constraints, as in symbols.stage
    """

    planes: int
    screens: int
    parameters: Array
    states: Array
    inputs: Array
    state_bounds: tuple[Array, Array]
    held: tuple[Array, Array]
    driven: tuple[Array, Array]

    @property
    def stages(self) -> int:
        """N."""
        return len(self.inputs)


def breaks_of(subject: ClockSubject) -> Array:
    """Return the times of the nodes: the guide's pieces cut, in the film until there are STAGES."""
    breaks, leg = subject.leg.curve.breaks, subject.leg
    middle = 0.5 * (breaks[:-1] + breaks[1:])
    filmed = (middle > leg.start) & (middle < leg.end)
    parts = max(1, round(STAGES / max(1, int(filmed.sum()))))
    counts = np.where(filmed, parts, max(1, parts // 2))
    cut = [
        np.linspace(a, b, n, endpoint=False) for a, b, n in zip(breaks[:-1], breaks[1:], counts, strict=True)
    ]
    return np.append(np.concatenate(cut), breaks[-1])


def guess(curve: Piecewise, breaks: Array) -> tuple[Array, Array]:
    """Return states and inputs along a position curve."""
    orders = [curve, curve.derivative(1), curve.derivative(2)]
    states = np.concatenate([order(breaks)[:, :3] for order in orders], axis=1)
    inputs = np.zeros((len(breaks) - 1, INPUTS))
    inputs[:, :3] = np.diff(states[:, 6:], axis=0) / np.diff(breaks)[:, None]
    inputs[:, SLACK] = 0.1
    return states, inputs


def problem(
    subject: ClockSubject,
    breaks: Array,
    wanted: ClockWishes,
    planes: Planes,
    share: float,
    start: tuple[Array, Array],
) -> ClockProblem:
    """Return the programme; share : of each limit that is used; start : as ``guess`` returns."""
    states, inputs = start
    limits = subject.drone.limits
    low, high = np.full_like(states, -inf), np.full_like(states, inf)
    low[:, 5], high[:, 5] = -share * limits.descent, share * limits.climb
    rest = guess(subject.leg.curve.channels(0, 1, 2), breaks[[0, -1]])[0]
    for k, given in zip((0, -1), rest, strict=True):
        low[k], high[k] = given - WIDE, given + WIDE
    table, count = _half_spaces(planes, len(breaks) - 1)
    screens = wanted.past.shape[1]
    if screens:
        inputs = np.column_stack([inputs[:, :HIDDEN], np.ones(len(inputs))])
    speed, acceleration, jerk = (
        (share * bound) ** 2 for bound in (limits.speed, limits.acceleration, limits.jerk)
    )
    walls = np.zeros(count * POINTS + screens)
    driven_low = np.concatenate([[-inf, -inf, -share * limits.descent, 0.0, 0.0], walls])
    driven_high = np.concatenate([[jerk, speed, share * limits.climb, inf, inf], walls + inf])
    return ClockProblem(
        count,
        screens,
        np.column_stack([_parameters(subject, breaks, wanted), table, wanted.past.reshape(len(breaks), -1)]),
        states,
        inputs,
        (low, high),
        (np.full(2, -inf), np.array([speed, acceleration])),
        (driven_low, driven_high),
    )


def _parameters(subject: ClockSubject, breaks: Array, wanted: ClockWishes) -> Array:
    leg, n = subject.leg, len(breaks) - 1
    length = np.append(np.diff(breaks), 0.0)
    filmed = (breaks >= leg.start - 1e-9) & (breaks < leg.end - 1e-9)
    near = 1.0 / wanted.usual**2
    share = np.where(filmed, 1.0, weights.FAINT) * length
    place = 0.5 * (share + np.append(0.0, share[:-1]))
    binds = weights.PLACE
    if wanted.placed:
        binds = weights.YIELDS if wanted.yields or wanted.past.shape[1] else weights.PLACED
    turn = np.array(weights.TURN)
    turn = np.where(filmed[:, None], turn, (0.0 if wanted.placed else weights.UNWATCHED) * turn)
    values = {
        "length": length,
        "ideal": wanted.ideal,
        "place": binds * near * place,
        "leash": np.full(n + 1, near / weights.LEASH**2),
        "target": wanted.target,
        "jerk": weights.JERK * near * np.where(filmed, 1.0, weights.UNSEEN),
        "turn": turn if wanted.watches else np.zeros((n + 1, 6)),
        "steep": np.tile(steepest(subject.drone, subject.watched), (n + 1, 1)),
        "free": np.where(filmed & wanted.watches, 0.0, UNFILMED),
        "price": np.full(n + 1, weights.STEEP / wanted.usual),
        "hidden": np.full(n + 1, weights.HIDDEN * binds),
    }
    table = [np.asarray(values[name]).reshape(n + 1, width) for name, width in FIELDS.items()]
    return np.column_stack(table)


def _half_spaces(planes: Planes, stages: int) -> tuple[Array, int]:
    """Return the half-spaces as parameters, shape (N + 1, count * PLANE), and how many a stage has."""
    most = int(np.bincount(planes.piece, minlength=1).max()) if len(planes.piece) else 0
    count = next((c for c in COUNTS if c >= most), most)
    table = np.zeros((stages + 1, count, PLANE))
    table[:, :, 3] = -FREE
    filled = np.zeros(stages, dtype=np.intp)
    for k, normal, border in zip(planes.piece, planes.normal, planes.border, strict=True):
        table[k, filled[k]] = [*normal, border[0], border[1] - border[0]]
        filled[k] += 1
    return table.reshape(stages + 1, -1), count

"""The problem and the result of a heading method."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.vec import wrapped
from shotc.solvers.conic import Status

HALF_TURN_RAD = 1e-9  # rad, tolerance of half a turn, for which both directions are equally long
TURN_TOLERANCE_RAD = 1e-6  # rad, tolerance of a stated turn at its keyframe


@dataclass(frozen=True, slots=True, eq=False)
class HeadingTask:
    """Keyframes with yaws, K >= 1.

    at : shape (K,), parameters (seconds, or metres of path), increasing
    yaw : shape (K,), rad, any winding
    stated : for each of the K - 1 intervals the exact turn in rad, or None if the method chooses it
    rates : first derivative at both ends, rad per unit of ``at``
    rate, acceleration : limits of the first and the second derivative
    weight : of the squared rate relative to the squared acceleration, 1 / unit^2; ``winding`` uses it
    Raise ValueError if the shapes do not fit, an interval has no length, or a stated turn misses its yaw.
    """

    at: Array
    yaw: Array
    stated: tuple[float | None, ...] = ()
    rates: tuple[float, float] = (0.0, 0.0)
    rate: float = inf
    acceleration: float = inf
    weight: float = 0.12

    def __post_init__(self) -> None:
        """Freeze the arrays and check them."""
        at = np.ascontiguousarray(self.at, dtype=np.float64)
        yaw = np.ascontiguousarray(self.yaw, dtype=np.float64)
        if at.ndim != 1 or at.shape != yaw.shape or len(at) == 0:
            raise ValueError(f"parameters {at.shape} and yaws {yaw.shape} do not fit")
        if not (np.isfinite(at).all() and np.isfinite(yaw).all() and np.isfinite(self.rates).all()):
            raise ValueError("parameters, yaws and rates must be finite")
        if not (np.diff(at) > 0).all():
            raise ValueError("parameters must increase: an interval has no length")
        if not (self.rate > 0 and self.acceleration > 0 and 0 <= self.weight < inf):
            raise ValueError("limits must be positive and the weight not negative")
        stated = self.stated or (None,) * (len(at) - 1)
        if len(stated) != len(at) - 1:
            raise ValueError(f"{len(stated)} stated turns for {len(at) - 1} intervals")
        for turn, least in zip(stated, nearest_turns(yaw), strict=True):
            if turn is not None and abs(wrapped(turn - float(least))) > TURN_TOLERANCE_RAD:
                raise ValueError("a stated turn does not lead to its keyframe's yaw")
        at.setflags(write=False)
        yaw.setflags(write=False)
        object.__setattr__(self, "at", at)
        object.__setattr__(self, "yaw", yaw)
        object.__setattr__(self, "stated", stated)

    @property
    def excess(self) -> float:
        """Excess of the rate at the ends over its limit; above 0 no curve is feasible."""
        return max(abs(r) for r in self.rates) - self.rate


@dataclass(frozen=True, slots=True, eq=False)
class Headings:
    """The result of a method.

    status : SOLVED, or INFEASIBLE if no curve of this method keeps the limits
    angles : shape (K,), unwrapped yaws at the keyframes; without a solution those tried first
    curve : over ``at``, one channel; None without a solution, or for a single keyframe
    nodes : number of nodes that the decoder visited; 0 for methods without one
    complete : whether it is certain that no other choice of turns is cheaper; False for methods that compare
        none, and if the decoder stopped at its cap or its list ended before this was certain
    """

    status: Status
    angles: Array
    curve: Piecewise | None
    nodes: int = 0
    complete: bool = False


def nearest_turns(yaw: Array) -> Array:
    """Return the shorter turn from each yaw to the next, shape (K - 1,), in (-pi, pi]; half a turn is +pi."""
    step = np.diff(yaw)
    # Half a turn is equally far in both directions; rounding must not decide.
    return np.asarray(HALF_TURN_RAD - wrapped(HALF_TURN_RAD - step))


def raw_turns(yaw: Array) -> Array:
    """Return the turns between yaws wrapped to (-pi, pi], shape (K - 1,)."""
    return np.asarray(np.diff(-wrapped(-yaw)))


def turned(task: HeadingTask, turns: Array) -> Array:
    """Return the keyframes' angles, shape (K,), for turns (K - 1,); stated turns replace the given ones."""
    bound = [t if s is None else s for t, s in zip(turns, task.stated, strict=True)]
    return np.asarray(task.yaw[0] + np.concatenate([[0.0], np.cumsum(bound)]))

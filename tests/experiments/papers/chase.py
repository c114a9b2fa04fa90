"""The problem of the moving-target paper (Alcantara et al., Eq. 12), as it stands there.

State: position and velocity; input: acceleration, even over a step. Built from the stage derivatives and the
ray's rates that the refiner's own programme is made of.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import casadi as ca
import numpy as np
from shotc_casadi.clock.angles import rates
from shotc_casadi.derivatives import differentiated
from shotc_casadi.horizon import built
from shotc_casadi.program import SOLVER_TOLERANCE
from shotc_casadi.symbols import StageSymbols

from shotc.geom.bernstein import Array

DT = 0.1
ALTITUDE = 1e4  # weight of the squared height off that of the shot: Eq. 12 has no such term, the shot has
ACCELERATION, SPEED = 5.0, 10.0  # m/s^2 and m/s, along each axis
FIXED = 1e-6  # half the width of the box about the first state
FEASIBLE = 1e-4
STATES, WIDTH = 6, 9


class Weights(NamedTuple):
    """w1 to w4 of Eq. 12: acceleration, pitch rate, yaw rate, the state at the end; w1 and w4 as printed."""

    effort: float = 1.0
    pitch: float = 0.0
    yaw: float = 0.0
    end: float = 1.0


@dataclass(frozen=True, eq=False)
class Chase:
    """One solve.

    start : state (6,); wanted : state (6,) at the end; target : its place at the start and its velocity
    zone : centre and radius of the circle that is not flown over; height : of the shot, metres
    guess : places at the nodes, shape (N + 1, 3)
    """

    start: Array
    wanted: Array
    target: tuple[Array, Array]
    zone: tuple[float, float, float]
    height: float
    weights: Weights
    guess: Array


@dataclass(frozen=True, eq=False)
class Flight:
    """What came of it.

    states : shape (N + 1, 6); inputs : (N, 3), m/s^2; residual : of the worst constraint, its own unit
    seconds : of the solver alone
    """

    states: Array
    inputs: Array
    solved: bool
    residual: float
    iterations: int
    seconds: float


def _stage() -> StageSymbols:
    z, p = ca.SX.sym("z", WIDTH), ca.SX.sym("p", 21)
    place, v, u = z[:3], z[3:6], z[6:]
    target, moves = p[:3], p[3:6]
    effort, pitch, yaw, end, height = (p[k] for k in range(6, 11))
    wanted, zone, square = p[11:17], p[17:19], p[19]
    following = ca.vertcat(place + DT * (v + DT * u / 2), v + DT * u)
    yaw_rate, pitch_rate = rates(target - place, moves - v)
    passing = effort * ca.sumsqr(u) + pitch * pitch_rate**2 + yaw * yaw_rate**2
    node = p[20] * (place[2] - height) ** 2 + end * ca.sumsqr(z[:6] - wanted)
    # On the state that follows, so that the first one, which is given, is not bound.
    clear = ca.sumsqr(following[:2] - zone) - square
    return StageSymbols(z, p, following, node, passing, ca.SX(0, 1), clear)


@cache
def programme(steps: int, solver: str) -> Any:
    """Return the solver of all problems with so many steps."""
    return built(differentiated(_stage()), steps, solver, SOLVER_TOLERANCE, b"")  # type: ignore[arg-type]


def solve(task: Chase, solver: str = "fatrop") -> Flight:
    """Solve from the guess and its own velocities and accelerations, cold: nothing of an earlier solve."""
    n = len(task.guess) - 1
    made = programme(n, solver)
    velocities = np.gradient(task.guess, DT, axis=0)
    inner = np.hstack([task.guess, velocities, np.gradient(velocities, DT, axis=0)])
    inner[0, :6] = task.start
    low = np.tile([*[-np.inf] * 3, *[-SPEED] * 3, *[-ACCELERATION] * 3], (n + 1, 1))
    high = -low
    low[0, :6], high[0, :6] = task.start - FIXED, task.start + FIXED
    rows = np.concatenate([np.zeros(STATES), [0.0]])
    lower = np.tile(rows, n)
    upper = np.tile(np.concatenate([np.zeros(STATES), [np.inf]]), n)
    given = {
        "x0": _flat(inner),
        "p": _parameters(task, n).ravel(),
        "lbx": _flat(low),
        "ubx": _flat(high),
        "lbg": lower,
        "ubg": upper,
    }
    began = time.perf_counter()
    out = made(**given)
    seconds = time.perf_counter() - began
    x, g = np.array(out["x"]).ravel(), np.array(out["g"]).ravel()
    residual = float(np.maximum(np.maximum(lower - g, g - upper), 0.0).max())
    table = x[: n * WIDTH].reshape(n, WIDTH)
    stats = made.stats()
    solved = bool(stats["success"]) and residual < FEASIBLE
    states = np.vstack([table[:, :6], x[n * WIDTH :]])
    return Flight(states, table[:, 6:], solved, residual, int(stats["iter_count"]), seconds)


def _parameters(task: Chase, n: int) -> Array:
    at, moves = task.target
    t = DT * np.arange(n + 1)[:, None]
    x, y, radius = task.zone
    w = task.weights
    last = np.zeros((n + 1, 1))
    last[-1] = w.end
    fixed = [w.effort, w.pitch, w.yaw], [task.height, *task.wanted, x, y, radius**2]
    columns = [
        at + t * moves,
        np.tile(moves, (n + 1, 1)),
        np.tile(fixed[0], (n + 1, 1)),
        last,
        np.tile(fixed[1], (n + 1, 1)),
        np.full((n + 1, 1), ALTITUDE),
    ]
    return np.hstack(columns)


def _flat(inner: Array) -> Array:
    return np.append(inner[:-1].ravel(), inner[-1, :STATES])

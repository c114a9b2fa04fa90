"""Shots that compose subjects: Naegeli et al., Eq. 14, replanned from every measured state.

The state is position, velocity, camera yaw and camera pitch. The inputs are the acceleration and the rates of
both angles, constant over a step. The inputs of the paper are the body's roll and pitch (which stand for
horizontal acceleration), the upward velocity and the gimbal's pitch. Here all of them have the limits of the
drone and its gimbal.
"""

from __future__ import annotations

from functools import lru_cache, partial
from math import isfinite, sqrt
from typing import Any

import casadi as ca
import numpy as np

from shotc.plugin_api.replanner import (
    NEAR_WEIGHT,
    Appearance,
    Array,
    DrawnPose,
    FramingProblem,
    FramingSituation,
    Plan,
    Replan,
)
from shotc_casadi.replan.evaluation import HorizonFunctions, Prices, StageExpressions, horizon
from shotc_casadi.replan.flight import BOUND_PARAMETERS, ShotSolvers, beside, fault, sent
from shotc_casadi.replan.keeping import RowCounts, ends, rows, within
from shotc_casadi.replan.pictures import (
    COMMON_PARAMETERS,
    EACH_PARAMETERS,
    CameraSymbols,
    Symbols,
    clear,
    in_field,
    off_place,
    off_size,
    off_view,
    uncovered,
)
from shotc_casadi.replan.steps import Solver, StopRule

PRICES = Prices(lacking=(300.0, 1.0), outside=30.0, damping=0.1)  # a metre, a cover, a m/s, a squared step
FIRST, WARM = StopRule(30, 1e-3), StopRule(1, 0.0)
STATES, INPUTS = 8, 5
SHARED_PARAMETERS = (
    13  # common: weights, tan of half the fields of view, largest rates, pitch range; then the subjects
)

NEAR_PARAMETERS, NEAR_COMMON_PARAMETERS = 3, 5
"""Parameters of the reference pose, after those of the bodies.

NEAR_PARAMETERS of a stage: its position. NEAR_COMMON_PARAMETERS of all stages: yaw and pitch, and the square
roots of the weights of position, yaw and pitch.
"""

Cast = tuple[bool, ...]
"""For each body, whether it is filmed."""


class Framing:
    """Plans a shot that composes subjects (``FramingPlanner``)."""

    def __init__(self, problem: FramingProblem, stop_rule: StopRule = WARM) -> None:
        """Allocate memory; until : when a warm-started replan stops, for a finer plan than the default."""
        self._problem, self._until = problem, stop_rule
        self._flights: dict[Cast, ShotSolvers] = {}

    def replan(self, situation: FramingSituation, last: Plan | None) -> Replan:
        """Plan from the measured state: one step from the last plan, or up to 30 without one."""
        s = situation
        with np.errstate(all="ignore"):
            flight = self._flight(tuple(body.wanted is not None for body in s.subjects))
            solver, widened = flight.solver(s.place, s.velocity, s.traffic, s.walls)
            into = solver.evaluation
            into.start[6:] = s.aim
            _fill(s, into.given, into.common)
            n = len(into.given)
            start = np.zeros((n, INPUTS)) if last is None else _shifted(flight.index(s.time, last), last)
            elapsed = s.time - (0.0 if last is None else last.times[0])
            if not (into.is_finite and isfinite(elapsed) and isfinite(start.sum())):
                return fault(_given(s, last))
            walk = solver.walk(start, FIRST if last is None else self._until)
            return flight.replan_of(solver, walk, s.time, widened)

    def _flight(self, cast: Cast) -> ShotSolvers:
        if cast not in self._flights:
            problem = self._problem
            horizon_of = partial(_horizon, cast=cast, stages=problem.horizon.stages)
            self._flights[cast] = ShotSolvers(problem.keeping, problem.horizon, horizon_of, self._begin)
        return self._flights[cast]

    def _begin(self, solver: Solver) -> None:
        problem = self._problem
        solver.evaluation.common[:SHARED_PARAMETERS] = [
            *problem.weights,
            *problem.half,
            *problem.rates,
            *problem.keeping.pitch,
        ]


def _fill(s: FramingSituation, given: Array, common: Array) -> None:
    """Write the subjects and the reference pose into the parameters."""
    for i, body in enumerate(s.subjects):
        at, own = BOUND_PARAMETERS + EACH_PARAMETERS * i, SHARED_PARAMETERS + COMMON_PARAMETERS * i
        appearance = body.wanted or Appearance()
        given[:, at : at + 3], given[:, at + 3 : at + 6] = body.point[1:], body.centre[1:]
        given[:, at + 6 : at + EACH_PARAMETERS] = 0.0 if appearance.view is None else appearance.view[1:]
        common[own : own + COMMON_PARAMETERS] = [
            *(appearance.uv or (0.0, 0.0)),
            appearance.size or 1.0,
            body.diameter,
            *body.semi_axes,
            appearance.uv is not None,
            appearance.size is not None,
            appearance.view is not None,
        ]
    at, own = (
        BOUND_PARAMETERS + EACH_PARAMETERS * len(s.subjects),
        SHARED_PARAMETERS + COMMON_PARAMETERS * len(s.subjects),
    )
    given[:, at : at + NEAR_PARAMETERS], common[own : own + NEAR_COMMON_PARAMETERS] = 0.0, 0.0
    if s.near is not None:
        given[:, at : at + NEAR_PARAMETERS] = s.near.places[1:]
        common[own : own + NEAR_COMMON_PARAMETERS] = _drawn(s, s.near, common[0])


def _drawn(s: FramingSituation, near: DrawnPose, place: float) -> list[float]:
    """Return yaw, pitch and the square roots of the weights of a reference pose.

    The weights are those that find the ideal of the shot.

    place : weight of a squared half frame
    """
    middle = np.mean([body.point[0] for body in s.subjects if body.wanted is not None], axis=0)
    distance = max(float(np.linalg.norm(near.places[0] - middle)), 1.0)
    root = NEAR_WEIGHT * sqrt(place)
    turns = [0.0 if angle is None else root for angle in (near.yaw, near.pitch)]
    return [near.yaw or 0.0, near.pitch or 0.0, root / distance, *turns]


def _shifted(index: Array, last: Plan) -> Array:
    """Return the inputs of the last plan from now on, (N, 5); zero after its end."""
    aim = np.zeros((len(last.times), 2)) if last.aim is None else last.aim
    rates = np.diff(aim, axis=0) / np.diff(last.times)[:, None]
    flown = np.concatenate([np.hstack([last.accelerations, rates]), np.zeros((1, INPUTS))])
    return np.asarray(flown[index])


@lru_cache(maxsize=32)
def _horizon(of: RowCounts, cast: Cast, stages: int) -> HorizonFunctions:
    return horizon(stage(of, cast), stages, PRICES)


def stage(of: RowCounts, cast: Cast) -> StageExpressions:
    """Return one stage of the problem in symbols."""
    k = len(cast)
    x, u, y = ca.SX.sym("x", STATES), ca.SX.sym("u", INPUTS), ca.SX.sym("y", STATES)
    bodied, own = (
        BOUND_PARAMETERS + EACH_PARAMETERS * k,
        BOUND_PARAMETERS + EACH_PARAMETERS * k + NEAR_PARAMETERS,
    )
    shared_count = SHARED_PARAMETERS + COMMON_PARAMETERS * k
    p, g = ca.SX.sym("p", own + of.each), ca.SX.sym("g", shared_count + NEAR_COMMON_PARAMETERS + of.common)
    near, shared = (
        (p[bodied:own], g[shared_count : shared_count + NEAR_COMMON_PARAMETERS]),
        g[shared_count + NEAR_COMMON_PARAMETERS :],
    )
    step, most, (turn, tilt) = shared[0], shared[2], (g[9], g[10])
    bodies = [
        Symbols.of(
            p[BOUND_PARAMETERS + EACH_PARAMETERS * i : BOUND_PARAMETERS + EACH_PARAMETERS * (i + 1)],
            g[SHARED_PARAMETERS + COMMON_PARAMETERS * i : SHARED_PARAMETERS + COMMON_PARAMETERS * (i + 1)],
        )
        for i in range(k)
    ]
    camera = CameraSymbols(y[:3], y[6], y[7], g[7:9])
    a, rate = u[:3], u[3:]
    keep = [rows(of, (y[:3], y[3:6], -camera.ahead), p[own:], shared), *(clear(y[:3], b) for b in bodies)]
    allowed, firm = within(a, most)
    free, limit = ca.SX.inf(3), ca.vertcat(most, most, most, turn, tilt)
    return StageExpressions(
        x,
        u,
        y,
        p,
        g,
        allowed=ca.vertcat(allowed, ca.fmin(ca.fmax(rate, -limit[3:]), limit[3:])),
        following=ca.vertcat(
            x[:3] + step * (x[3:6] + 0.5 * step * a), x[3:6] + step * a, x[6:] + step * rate
        ),
        residuals=ca.vertcat(_residuals(camera, u, bodies, cast, g), _off_pose(camera, *near)),
        rows=(ca.vertcat(*keep), *_covers(y[:3], bodies, cast, g[3])),
        firm=firm,
        ends=ends(of, y[:3], y[3:6], shared),
        inputs=(-limit, limit),
        states=(
            ca.vertcat(-free, p[:3], -ca.inf, g[11]),
            ca.vertcat(free, p[3:BOUND_PARAMETERS], ca.inf, g[12]),
        ),
    )


def _residuals(camera: CameraSymbols, u: Any, bodies: list[Symbols], cast: Cast, g: Any) -> Any:
    place, size, view, _, field, effort, turning = ca.vertsplit(g[:7])
    residuals = [ca.sqrt(effort) * u[:3], ca.sqrt(turning) * u[3:]]
    for body, filmed in zip(bodies, cast, strict=True):
        if filmed:
            residuals.append(ca.sqrt(place) * off_place(camera, body))
            residuals.append(ca.sqrt(size) * off_size(camera, body))
            residuals.append(ca.sqrt(view) * off_view(camera, body))
        residuals.append(ca.sqrt(field) * in_field(camera.place, body))
    return ca.vertcat(*residuals)


def _off_pose(camera: CameraSymbols, place: Any, drawn: Any) -> Any:
    """Return the error of the camera against its reference pose (Naegeli et al., Eq. 10)."""
    turned = ca.vertcat(2.0 * ca.sin(0.5 * (camera.yaw - drawn[0])), camera.pitch - drawn[1])
    return ca.vertcat(drawn[2] * (camera.place - place), drawn[3:] * turned)


def _covers(place: Any, bodies: list[Symbols], cast: Cast, weight: Any) -> tuple[Any, ...]:
    """Return the rows of all pairs of a filmed subject and another body, if there are any."""
    pairs = [
        weight * uncovered(place, body, other)
        for body, filmed in zip(bodies, cast, strict=True)
        for other in bodies
        if filmed and other is not body
    ]
    return (ca.vertcat(*pairs),) if pairs else (ca.SX(0, 1),)


def _numbers(near: DrawnPose) -> list[Array]:
    return [near.places, np.array([near.yaw or 0.0, near.pitch or 0.0])]


def _given(s: FramingSituation, last: Plan | None) -> dict[str, list[Array]]:
    flown = [] if last is None else [last.times, last.accelerations]
    flown += [] if last is None or last.aim is None else [last.aim]
    views = [b.wanted.view for b in s.subjects if b.wanted is not None and b.wanted.view is not None]
    return {
        "the drone's measured state": [s.place, s.velocity, np.array(s.aim)],
        "the subjects' predicted motion": [a for b in s.subjects for a in (b.point, b.centre)],
        "a wanted view": views,
        "the pose to stay near": [] if s.near is None else _numbers(s.near),
        "a plan that was sent": sent(s.traffic),
        "a wall": beside(s.walls),
        "the last plan": flown,
        "the time": [np.array([s.time])],
    }

"""Evaluates a horizon with CasADi: two functions of all stages, made from one symbolic stage.

One function returns the cost and the violations of a motion. The other one also returns the quadratic
programme of a step from it. Calls copy no arrays.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from math import isfinite
from typing import Any, NamedTuple

import casadi as ca
import numpy as np

from shotc.plugin_api.replanner import Array
from shotc_casadi.replan.layout import Index, Pattern, Places, ProgramMatrices, layout

LARGE_LACK = 1.0
"""Metres or m/s of a violation, above which a step does not end it."""


class StageExpressions(NamedTuple):
    """One stage in symbols.

    x, u, y : state, input, and next state
    p : parameters of the stage
    g : parameters of all stages
    allowed : the nearest input that the vehicle can take, by u and g
    following : the next state, by x, u and g
    residuals : the cost is the sum of their squares; by u, y, p and g
    rows : constraints (>= 0 where they hold) by u, y, p and g, in groups; the worst one of each has a price
    firm : constraints that every allowed input meets, by u and g
    ends : additional constraints of the first group at the last stage, by y and g
    inputs, states : lower and upper bounds of u, by g, and of y, by p
    """

    x: Any
    u: Any
    y: Any
    p: Any
    g: Any
    allowed: Any
    following: Any
    residuals: Any
    rows: tuple[Any, ...]
    firm: Any
    ends: Any
    inputs: tuple[Any, Any]
    states: tuple[Any, Any]


class Prices(NamedTuple):
    """Additional costs of a step.

    lacking : of the violation of the worst row of a group at a stage, for each group
    outside : of the distance of a state from its bounds; only in the merit function
    damping : of the squared step, halved; never of the slack
    """

    lacking: tuple[float, ...]
    outside: float
    damping: float


@dataclass(frozen=True, slots=True, eq=False)
class HorizonFunctions:
    """Functions of N stages with U inputs, X states and P parameters each, and G common parameters."""

    motion: Any
    step: Any
    layout: ProgramMatrices
    prices: Prices
    stages: int
    inputs: int
    states: int


class Rollout(NamedTuple):
    """A motion: allowed inputs (N, U), the resulting states (N, X), and their cost.

    merit : cost with all prices
    worst : violation of the worst row of the first group
    """

    inputs: Array
    states: Array
    merit: float
    worst: float


def horizon(stage: StageExpressions, stages: int, prices: Prices) -> HorizonFunctions:
    """Return the functions of that many stages."""
    s, n = stage, stages
    u, x0 = ca.MX.sym("u", s.u.numel(), n), ca.MX.sym("x0", s.x.numel())
    p, g = ca.MX.sym("p", s.p.numel(), n), ca.MX.sym("g", s.g.numel())
    inputs, states = _rolled(s, n)(u, x0, g)
    cost, lack, excess = _judged(s, n)(inputs, states, p, g)
    end = _ended(s, states[:, -1], g)
    late = end.lack
    price = ca.DM(prices.lacking)
    more = ca.fmax(late - lack[0, -1], 0)
    merit = ca.sum2(cost) + ca.dot(price, ca.sum2(lack)) + price[0] * more + prices.outside * ca.sum2(excess)
    motion = [inputs, states, merit, ca.fmax(ca.mmax(lack[0, :]), late)]
    derivatives = _derived(s, n, prices.damping)
    before = ca.horzcat(x0, states[:, :-1])
    gradient, hessian, rows, row_slopes, onward, driven, low, high = derivatives.function(
        before, inputs, states, p, g
    )
    counts = tuple(each.numel() for each in s.rows)
    pattern = Pattern(*derivatives.places, end.places, counts, s.firm.numel(), s.ends.numel())
    laid = layout(pattern, n, s.u.numel(), s.x.numel())
    count, slack = n * s.x.numel(), ca.DM.zeros(len(prices.lacking), n)
    unit = _unit(prices, lack, late)
    step = [
        _in_order(laid.cost.order, [hessian]),
        _with_slack(gradient, s, ca.repmat(price, 1, n) * unit),
        _in_order(laid.motion.order, [driven, -ca.DM.ones(count), onward[:, 1:]]),
        _in_order(laid.bound.order, [row_slopes, end.slopes, _each(unit, counts, s.ends.numel())]),
        -ca.vertcat(ca.vec(rows), end.rows),
        _with_slack(low, s, slack),
        _with_slack(high, s, slack + ca.inf),
    ]
    given = [u, x0, p, g]
    functions = ca.Function("motion", given, motion), ca.Function("step", given, [*motion, *step])
    return HorizonFunctions(*functions, laid, prices, n, s.u.numel(), s.x.numel())


class Evaluation:
    """A horizon with its own memory; only one thread may use it at a time.

    The caller first writes the measured state (X,) into ``start``, and parameters into ``given`` (N, P) and
    ``common`` (G,). ``step`` writes the programme into ``programme``, where it stays until the next call: the
    values of the cost matrix, the linear cost, the values of the dynamics matrix and of the constraint matrix
    (as ``ProgramMatrices`` takes them), the lower bounds of the constraints, and the lower and upper bounds
    of the step.
    """

    def __init__(self, of: HorizonFunctions) -> None:
        """Allocate memory."""
        self.of = of
        self._inputs = np.zeros((of.stages, of.inputs))
        self.start = np.zeros(of.states)
        self.given = np.zeros((of.stages, of.motion.size1_in(2)))
        self.common = np.zeros(of.motion.numel_in(3))
        given = (self._inputs, self.start, self.given, self.common)
        self._motion = _Call(of.motion, given)
        self._step = _Call(of.step, given)
        self.programme = self._step.out[4:]

    @property
    def is_finite(self) -> bool:
        """Whether all that the caller wrote is finite."""
        return isfinite(self.start.sum() + self.given.sum() + self.common.sum())

    def motion(self, inputs: Array) -> Rollout:
        """Return the motion of inputs (N, U)."""
        return self._moved(self._motion, inputs)

    def step(self, inputs: Array) -> Rollout:
        """Return the motion of inputs (N, U), and write the programme of a step from it."""
        return self._moved(self._step, inputs)

    def _moved(self, call: _Call, inputs: Array) -> Rollout:
        self._inputs[:] = inputs
        call()
        of, (u, x, merit, worst) = self.of, call.out[:4]
        shapes = (of.stages, of.inputs), (of.stages, of.states)
        return Rollout(
            u.reshape(shapes[0]).copy(), x.reshape(shapes[1]).copy(), float(merit[0]), float(worst[0])
        )


class _Call:
    """A CasADi function that works on arrays that it keeps."""

    def __init__(self, function: Any, given: Sequence[Array]) -> None:
        self._given = given
        self._buffer, self._call = function.buffer()
        self.out = [np.zeros(function.numel_out(i)) for i in range(function.n_out())]
        for i, array in enumerate(given):
            self._buffer.set_arg(i, memoryview(array.data))
        for i, array in enumerate(self.out):
            self._buffer.set_res(i, memoryview(array.data))

    def __call__(self) -> None:
        self._call()


def _rolled(s: StageExpressions, stages: int) -> Any:
    """Return the function from inputs, measured state and common parameters to inputs and states flown."""
    following = _function("following", [s.x, s.u, s.g], [s.following])
    nearest = _function("nearest", [s.u, s.g], [s.allowed])
    u, x = ca.SX.sym("u", s.u.numel(), stages), ca.SX.sym("x", s.x.numel())
    inputs = ca.horzcat(*(nearest(u[:, k], s.g) for k in range(stages)))
    states, at = [], x
    for k in range(stages):
        at = following(at, inputs[:, k], s.g)
        states.append(at)
    return _function("rolled", [u, x, s.g], [inputs, ca.horzcat(*states)])


def _judged(s: StageExpressions, stages: int) -> Any:
    """Return the function from all stages to the cost, the violations and the excess of each stage."""
    low, high = s.states
    outside = ca.sum1(ca.fmax(s.y - high, 0) + ca.fmax(low - s.y, 0))
    one = _function(
        "judged", [s.u, s.y, s.p, s.g], [ca.sumsqr(s.residuals), ca.vertcat(*map(_lack, s.rows)), outside]
    )
    return one.map("all_judged", "serial", stages, [3], [], {})


class _Derivatives(NamedTuple):
    """The function from all stages to the values of a programme, and the places of four of these."""

    function: Any
    places: tuple[Places, Places, Places, Places]


def _derived(s: StageExpressions, stages: int, damping: float) -> _Derivatives:
    w = ca.vertcat(s.u, s.y)
    slope = ca.jacobian(s.residuals, w)
    squares = ca.triu(2 * slope.T @ slope + damping * ca.SX.eye(w.numel()))
    rows = ca.vertcat(*s.rows, s.firm)
    row_slopes = ca.jacobian(rows, w)
    onward, driven = ca.jacobian(s.following, s.x), ca.jacobian(s.following, s.u)
    bounds = [ca.vertcat(i, y) - w for i, y in zip(s.inputs, s.states, strict=True)]
    out = [
        2 * slope.T @ s.residuals,
        _values(squares),
        rows,
        _values(row_slopes),
        _values(onward),
        _values(driven),
    ]
    one = _function("derived", [s.x, s.u, s.y, s.p, s.g], [*out, *bounds])
    places = (_places(squares), _places(onward), _places(driven), _places(row_slopes))
    return _Derivatives(one.map("all_derived", "serial", stages, [4], [], {}), places)


class _End(NamedTuple):
    """Rows of the last state, their violation, the values of their derivatives and the places of these."""

    rows: Any
    lack: Any
    slopes: Any
    places: Places


def _ended(s: StageExpressions, end: Any, g: Any) -> _End:
    slopes = ca.jacobian(s.ends, s.y)
    function = _function("ended", [s.y, s.g], [s.ends, _lack(s.ends), _values(slopes)])
    rows, lack, values = function(end, g)
    return _End(rows, lack, values, _places(slopes))


def _with_slack(of: Any, s: StageExpressions, slack: Any) -> Any:
    """Return rows of inputs and states with those of the slacks between them, stage by stage."""
    return ca.vec(ca.vertcat(of[: s.u.numel(), :], slack, of[s.u.numel() :, :]))


def _unit(prices: Prices, lack: Any, late: Any) -> Any:
    """Return the units of slacks, groups by stages: what costs 1, or the violation there if it is large.

    An interior-point method starts with a dual residual equal to the price of a unit, and with slacks of a
    few units. Small violations of the current motion end at 0 in most programmes: what costs 1 then takes 7
    iterations near an obstacle, units as large as the violations take 10, and metres twice as many. Large
    violations remain for a while (a drone that is too fast), and would take thousands of small units.
    """
    least = ca.repmat(1.0 / ca.DM(prices.lacking), 1, lack.size2())
    violation = ca.vertcat(ca.horzcat(lack[0, :-1], ca.fmax(lack[0, -1], late)), lack[1:, :])
    return ca.fmax(violation * (violation > LARGE_LACK), least)


def _each(unit: Any, counts: Sequence[int], ends: int) -> Any:
    """Return the units of all rows that have a slack, stage by stage, and then of those at the end."""
    rows = ca.vertcat(*(ca.repmat(unit[group, :], many, 1) for group, many in enumerate(counts)))
    return ca.vertcat(ca.vec(rows), ca.repmat(unit[0, -1], ends, 1))


def _in_order(order: Index, parts: list[Any]) -> Any:
    return ca.MX(ca.vertcat(*map(ca.vec, parts)))[order.tolist()]


def _lack(rows: Any) -> Any:
    return reduce(ca.fmax, ca.vertsplit(-rows), ca.SX(0.0)) if rows.numel() else ca.SX(0.0)


def _values(matrix: Any) -> Any:
    return ca.SX(ca.Sparsity.dense(matrix.nnz(), 1), matrix.nz[:]) if matrix.nnz() else ca.SX(0, 1)


def _places(matrix: Any) -> Places:
    row, column = matrix.sparsity().get_triplet()
    return np.array(row, dtype=np.int64), np.array(column, dtype=np.int64)


def _function(name: str, given: list[Any], out: list[Any]) -> Any:
    return ca.Function(name, given, [ca.densify(each) for each in out], {"cse": True})

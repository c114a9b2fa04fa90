"""A horizon by CasADi: one stage in symbols, made into two functions of all stages, called without copies.

One gives what a motion costs and lacks, the other its derivatives besides, laid out as the quadratic
programme takes them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from math import isfinite
from typing import Any, NamedTuple

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from shotc.plugin_api.replanner import Array

Index = NDArray[np.int64]


class Stage(NamedTuple):
    """One stage in symbols.

    x, u, y : state, input, and the state they lead to; p : parameters of the stage; g : those of all stages
    allowed : the nearest input that the vehicle takes, by u and g
    following : the next state, by x and u
    residuals : whose squares are the cost, by u, y, p and g
    rows : what is not negative where it is kept, by u, y, p and g; the worst one of a stage is priced
    ends : the same of the last stage alone, by y and g
    low, high : bounds of y, by p
    """

    x: Any
    u: Any
    y: Any
    p: Any
    g: Any
    allowed: Any
    following: Any
    residuals: Any
    rows: Any
    ends: Any
    low: Any
    high: Any


class Pattern(NamedTuple):
    """Rows and columns of the nonzeros of a stage's matrices, in the order of their values.

    hessian : of the upper triangle, by input and next state; onward, driven : of the next state, by the state
    and by the input; kept : of the rows, by input and next state; ends : of those of the end, by the state
    rows : how many of each stage; last : how many at the end
    """

    hessian: tuple[Index, Index]
    onward: tuple[Index, Index]
    driven: tuple[Index, Index]
    kept: tuple[Index, Index]
    ends: tuple[Index, Index]
    rows: int
    last: int


@dataclass(frozen=True, slots=True, eq=False)
class Horizon:
    """Functions of N stages with U inputs, X states, P parameters each and G of them all."""

    motion: Any
    slopes: Any
    pattern: Pattern
    stages: int
    inputs: int
    states: int


class Motion(NamedTuple):
    """Inputs (N, U) that the vehicle takes, the states (N, X) that they lead to, and what these cost.

    lack : of the worst row of every stage, added up; worst : of all; excess : beyond bounds, added up
    """

    inputs: Array
    states: Array
    cost: float
    lack: float
    worst: float
    excess: float


class Slopes(NamedTuple):
    """Derivatives about a motion; what is not the gradient holds the nonzeros of a ``Pattern``.

    gradient : of the cost, by input and next state, (N, U + X); hessian : of the squares, (N, H)
    rows : (N, R), and kept : their derivatives, (N, K); onward, driven : of the motion, (N, A) and (N, B)
    ends, kept_ends : the rows of the end, (E,), and their derivatives, (L,)
    """

    gradient: Array
    hessian: Array
    rows: Array
    kept: Array
    onward: Array
    driven: Array
    ends: Array
    kept_ends: Array


def horizon(stage: Stage, stages: int, damping: float) -> Horizon:
    """Return the functions of so many stages; damping : added to the diagonal of the Hessian."""
    s, n = stage, stages
    w = ca.vertcat(s.u, s.y)
    slope = ca.jacobian(s.residuals, w)
    hessian = ca.triu(2 * slope.T @ slope + damping * ca.SX.eye(w.numel()))
    kept, onward = ca.jacobian(s.rows, w), ca.jacobian(s.following, s.x)
    driven, ends = ca.jacobian(s.following, s.u), ca.jacobian(s.ends, s.y)
    outside = ca.fmax(s.y - s.high, 0) + ca.fmax(s.low - s.y, 0)
    given = [s.u, s.y, s.p, s.g]
    judged = [ca.sumsqr(s.residuals), _lack(s.rows), ca.sum1(outside)]
    told = [2 * slope.T @ s.residuals, _values(hessian), s.rows, _values(kept)]
    moved = [_values(onward), _values(driven)]
    value = _mapped("value", given, judged, n, [3])
    derived = _mapped("derived", [s.x, *given], [*told, *moved], n, [4])
    end = _function("end", [s.y, s.g], [s.ends, _values(ends), _lack(s.ends)])
    rolled = _rolled(stage, n)
    u, x0 = ca.MX.sym("u", s.u.numel(), n), ca.MX.sym("x0", s.x.numel())
    p, g = ca.MX.sym("p", s.p.numel(), n), ca.MX.sym("g", s.g.numel())
    inputs, states = rolled(u, x0, g)
    cost, lack, excess = value(inputs, states, p, g)
    last, kept_ends, late = end(states[:, -1], g)
    worst = ca.fmax(lack[-1], late)
    total = ca.sum2(lack) + worst - lack[-1]
    numbers = ca.vertcat(ca.sum2(cost), total, ca.fmax(ca.mmax(lack), late), ca.sum2(excess))
    motion = [inputs, states, numbers]
    before = ca.horzcat(x0, states[:, :-1])
    slopes = derived(before, inputs, states, p, g)
    pattern = Pattern(
        _places(hessian),
        _places(onward),
        _places(driven),
        _places(kept),
        _places(ends),
        s.rows.numel(),
        s.ends.numel(),
    )
    return Horizon(
        ca.Function("motion", [u, x0, p, g], motion),
        ca.Function("slopes", [u, x0, p, g], [*motion, *slopes, last, kept_ends]),
        pattern,
        n,
        s.u.numel(),
        s.x.numel(),
    )


class Evaluation:
    """A horizon with memory of its own; one thread may use it at a time.

    Whoever calls writes the measured state (X,) into ``start``, parameters into ``given`` (N, P) and
    ``common`` (G,) first.
    """

    def __init__(self, of: Horizon) -> None:
        """Take memory."""
        self.of = of
        self._inputs = np.zeros((of.stages, of.inputs))
        self.start = np.zeros(of.states)
        self.given = np.zeros((of.stages, of.motion.size1_in(2)))
        self.common = np.zeros(of.motion.numel_in(3))
        given = (self._inputs, self.start, self.given, self.common)
        self._motion, self._move = _buffered(of.motion, given)
        self._slopes, self._derive = _buffered(of.slopes, given)

    @property
    def is_finite(self) -> bool:
        """Whether all that was written is."""
        return isfinite(self.start.sum() + self.given.sum() + self.common.sum())

    def motion(self, inputs: Array) -> Motion:
        """Return the motion of inputs (N, U)."""
        self._inputs[:] = inputs
        self._move()
        return self._moved(self._motion)

    def slopes(self, inputs: Array) -> tuple[Motion, Slopes]:
        """Return the motion with its derivatives, which the next call writes over."""
        self._inputs[:] = inputs
        self._derive()
        n = self.of.stages
        slopes = [each.reshape(n, -1) for each in self._slopes[3:9]]
        return self._moved(self._slopes), Slopes(*slopes, *self._slopes[9:])

    def _moved(self, out: list[Array]) -> Motion:
        of = self.of
        inputs = out[0].reshape(of.stages, of.inputs).copy()
        return Motion(inputs, out[1].reshape(of.stages, of.states).copy(), *out[2].tolist())


def _rolled(stage: Stage, stages: int) -> Any:
    s = stage
    step = _function("step", [s.x, s.u, s.g], [s.following])
    nearest = _function("nearest", [s.u, s.g], [s.allowed])
    u, x, g = (ca.SX.sym(name, of.numel(), k) for name, of, k in
               (("u", s.u, stages), ("x", s.x, 1), ("g", s.g, 1)))  # fmt: skip
    inputs = ca.horzcat(*(nearest(u[:, k], g) for k in range(stages)))
    states, at = [], x
    for k in range(stages):
        at = step(at, inputs[:, k], g)
        states.append(at)
    return _function("rolled", [u, x, g], [inputs, ca.horzcat(*states)])


def _lack(rows: Any) -> Any:
    return reduce(ca.fmax, ca.vertsplit(-rows), ca.SX(0.0)) if rows.numel() else ca.SX(0.0)


def _values(matrix: Any) -> Any:
    return ca.SX(ca.Sparsity.dense(matrix.nnz(), 1), matrix.nz[:]) if matrix.nnz() else ca.SX(0, 1)


def _places(matrix: Any) -> tuple[Index, Index]:
    row, column = matrix.sparsity().get_triplet()
    return np.array(row, dtype=np.int64), np.array(column, dtype=np.int64)


def _mapped(name: str, given: list[Any], out: list[Any], stages: int, common: list[int]) -> Any:
    return _function(name, given, out).map(f"{name}s", "serial", stages, common, [], {})


def _function(name: str, given: list[Any], out: list[Any]) -> Any:
    return ca.Function(name, given, [ca.densify(each) for each in out], {"cse": True})


def _buffered(function: Any, given: tuple[Array, ...]) -> tuple[list[Array], Any]:
    buffer, call = function.buffer()
    out = [np.zeros(function.numel_out(i)) for i in range(function.n_out())]
    for i, array in enumerate(given):
        buffer.set_arg(i, memoryview(array.data))
    for i, array in enumerate(out):
        buffer.set_res(i, memoryview(array.data))
    # The buffer and the arrays live as long as the call.
    return out, _Call(buffer, call)


class _Call:
    def __init__(self, buffer: Any, call: Any) -> None:
        self._buffer, self._call = buffer, call

    def __call__(self) -> None:
        self._call()

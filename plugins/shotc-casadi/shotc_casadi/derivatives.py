"""The derivatives of the programme: those of one stage, mapped over the horizon.

CasADi derives one stage symbolically, once. The nonzeros go directly into the sparse matrices of the
programme. This takes a tenth of a second; to differentiate the whole programme takes seconds.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from shotc_casadi.conditions import Visibility
from shotc_casadi.symbols import StageSymbols, stage

Index = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Derived:
    """Functions of one stage and of the last node, and their derivatives as the solvers need them.

    rows, last_rows : next state and constraints of a stage; constraints of the last node
    states, inputs, size : number of states, inputs and parameters of a stage
    bound, last_bound : number of constraints of a stage and of the last node
    """

    cost: Any
    last_cost: Any
    rows: Any
    last_rows: Any
    gradient: Any
    last_gradient: Any
    first_jacobian: Any
    jacobian: Any
    last_jacobian: Any
    hessian: Any
    last_hessian: Any
    bound: int
    last_bound: int
    states: int
    inputs: int
    size: int

    @property
    def width(self) -> int:
        """Number of unknowns of a stage."""
        return self.states + self.inputs


class _Horizon(NamedTuple):
    """The symbols of a programme, one column a stage: unknowns and parameters, and those of the last node."""

    z: Any
    end: Any
    given: Any
    last: Any


def laid_out(d: Derived, solver: str, stages: int, x: Any, p: Any) -> dict[str, Any]:
    """Return the derivatives of the programme, by the names that CasADi's solvers use."""
    wide = d.width
    z, end = ca.reshape(x[: stages * wide], wide, stages), x[stages * wide :]
    given = ca.reshape(p, p.numel() // (stages + 1), stages + 1)
    over = _Horizon(z, end, given[:, :stages], given[:, stages])
    lam_f, lam_g = ca.MX.sym("lam_f"), ca.MX.sym("lam_g", stages * (d.states + d.bound) + d.last_bound)

    slopes, curvature = _lagrangian(d, stages, over, lam_f, lam_g)
    g, jacobian = _constraints(d, stages, over)
    total, gradient = _costs(d, stages, over)
    functions = [ca.Function("nlp_jac_g", [x, p], [g, jacobian], ["x", "p"], ["g", "jac_g_x"])]
    names, multiplied = ["x", "p", "lam_f", "lam_g"], [x, p, lam_f, lam_g]
    if solver == "fatrop":
        twice, outputs = [slopes, curvature], ["grad_gamma_x", "hess_gamma_x_x"]
        functions += [
            ca.Function("nlp_grad_f", [x, p], [gradient], ["x", "p"], ["grad_f_x"]),
            ca.Function("nlp_hess_l", multiplied, twice, names, outputs),
        ]
    else:
        functions += [
            ca.Function("nlp_grad_f", [x, p], [total, gradient], ["x", "p"], ["f", "grad_f_x"]),
            ca.Function("nlp_hess_l", multiplied, [ca.triu(curvature)], names, ["triu_hess_gamma_x_x"]),
        ]
    return {f.name(): f for f in functions}


def _lagrangian(d: Derived, stages: int, over: _Horizon, lam_f: Any, lam_g: Any) -> tuple[Any, Any]:
    """Return the gradient of the Lagrangian and its Hessian."""
    states, high = d.states, d.states + d.bound
    lam = ca.reshape(lam_g[: stages * high], high, stages)
    costate, weights = lam[:states, :], ca.repmat(lam_f, 1, stages)
    slope, blocks = d.hessian.map(stages)(over.z, over.given, weights, costate, lam[states:, :])
    end_slope, end_block = d.last_hessian(over.end, over.last, lam_f, lam_g[stages * high :])
    curvature = ca.MX(_block_diagonal(d, stages), ca.vertcat(blocks.nz[:], end_block.nz[:]))
    before = ca.vertcat(ca.horzcat(ca.MX(states, 1), costate[:, :-1]), ca.MX(d.inputs, stages))
    return ca.vertcat(ca.vec(slope + before), end_slope + costate[:, -1]), curvature


def _constraints(d: Derived, stages: int, over: _Horizon) -> tuple[Any, Any]:
    """Return all constraints and their Jacobian."""
    z, states = over.z, d.states
    gap0, bound0, first = d.first_jacobian(z[:, 0], over.given[:, 0])
    gaps, bounds, rest = d.jacobian.map(stages - 1)(z[:, 1:], over.given[:, 1:])
    end_bound, end_rows = d.last_jacobian(over.end, over.last)
    jacobian = ca.MX(_staircase(d, stages), ca.vertcat(first.nz[:], rest.nz[:], end_rows.nz[:]))
    following = ca.horzcat(z[:states, 1:], over.end)
    rows = ca.vertcat(following - ca.horzcat(gap0, gaps), ca.horzcat(bound0, bounds))
    return ca.vertcat(ca.vec(rows), end_bound), jacobian


def _costs(d: Derived, stages: int, over: _Horizon) -> tuple[Any, Any]:
    """Return the cost and its gradient."""
    value, gradient = d.gradient.map(stages)(over.z, over.given)
    end_value, end_gradient = d.last_gradient(over.end, over.last)
    return ca.sum2(value) + end_value, ca.vertcat(ca.vec(gradient), end_gradient)


@lru_cache(maxsize=16)
def derived(
    visibility: Visibility, planes: int, extents: int = 0, windy: bool = False, zooms: bool = False
) -> Derived:
    """Return the functions of one stage with ``planes`` half-spaces; other arguments as in ``stage``."""
    return differentiated(stage(visibility, planes, extents, windy, zooms))


def differentiated(s: StageSymbols) -> Derived:
    """Return the functions of a stage; the first entries of ``z`` are its state."""
    states = s.following.numel()
    inputs = s.z.numel() - states
    x = s.z[:states]
    cost, end_cost, bound = s.cost, s.end_cost, ca.vertcat(s.held, s.driven)
    weight, costate = ca.SX.sym("weight"), ca.SX.sym("costate", states)
    force, held_force = ca.SX.sym("force", bound.numel()), ca.SX.sym("force", s.held.numel())
    exact = weight * (s.node + s.passing) - ca.dot(costate, s.following) + ca.dot(force, bound)
    end_exact = weight * s.node + ca.dot(held_force, s.held)
    roots, end_roots = ca.vertcat(s.node_roots, s.passing_roots), s.node_roots
    own = ca.vertcat(-ca.jacobian(s.following, s.z), ca.jacobian(bound, s.z))
    end_own = ca.jacobian(s.held, x)
    joint = ca.horzcat(ca.SX.eye(states), ca.SX(states, inputs))

    def function(name: str, inputs: list[Any], outputs: list[Any]) -> Any:
        return ca.Function(name, inputs, outputs, {"cse": True})

    return Derived(
        cost=function("cost", [s.z, s.p], [cost]),
        last_cost=function("last_cost", [x, s.p], [end_cost]),
        rows=function("rows", [s.z, s.p], [s.following, bound]),
        last_rows=function("last_rows", [x, s.p], [s.held]),
        gradient=function("gradient", [s.z, s.p], [cost, ca.gradient(cost, s.z)]),
        last_gradient=function("last_gradient", [x, s.p], [end_cost, ca.gradient(end_cost, x)]),
        first_jacobian=function("first_jacobian", [s.z, s.p], [s.following, bound, own]),
        jacobian=function("jacobian", [s.z, s.p], [s.following, bound, ca.vertcat(joint, own)]),
        last_jacobian=function("last_jacobian", [x, s.p], [s.held, ca.vertcat(ca.SX.eye(states), end_own)]),
        hessian=function("hessian", [s.z, s.p, weight, costate, force], _curved(exact, roots, weight, s.z)),
        last_hessian=function(
            "last_hessian", [x, s.p, weight, held_force], _curved(end_exact, end_roots, weight, x)
        ),
        bound=bound.numel(),
        last_bound=s.held.numel(),
        states=states,
        inputs=inputs,
        size=s.p.numel(),
    )


def _curved(exact: Any, roots: Any, weight: Any, at: Any) -> list[Any]:
    """Return the gradient of a Lagrangian and its Hessian: exact for ``exact``, Gauss-Newton for ``roots``.

    roots : the squares of this column, times the weight, are the rest of the Lagrangian
    """
    curvature, slope = ca.hessian(exact, at)
    if not roots.numel():
        return [slope, curvature]
    slopes = ca.jacobian(roots, at)
    # Symbols do not show that this is symmetric: every entry would be computed twice.
    squares = ca.triu2symm(ca.triu(slopes.T @ slopes))
    return [slope + 2 * weight * (slopes.T @ roots), curvature + 2 * weight * squares]


def _block_diagonal(d: Derived, stages: int) -> Any:
    states, wide = d.states, d.width
    rows, columns = _repeated(d.hessian.sparsity_out(1), range(stages), wide, wide)
    end = _triplets(d.last_hessian.sparsity_out(1))
    side = stages * wide + states
    rows, columns = np.append(rows, end[0] + stages * wide), np.append(columns, end[1] + stages * wide)
    return ca.Sparsity.triplet(side, side, rows.tolist(), columns.tolist())


def _staircase(d: Derived, stages: int) -> Any:
    """Return the sparsity of the constraints' Jacobian.

    The columns of a stage contain the coupling to the stage before, then the stage's own dynamics and bounds.
    The nonzeros of ``jacobian`` have that order.
    """
    states, wide = d.states, d.width
    high = states + d.bound
    first = _triplets(d.first_jacobian.sparsity_out(2))
    rows, columns = _repeated(d.jacobian.sparsity_out(2), range(1, stages), high, wide, (states, high))
    end = _triplets(d.last_jacobian.sparsity_out(1))
    end_rows = np.where(end[0] < states, (stages - 1) * high, stages * high - states) + end[0]
    return ca.Sparsity.triplet(
        stages * high + d.last_bound,
        stages * wide + states,
        np.concatenate([first[0], rows, end_rows]).tolist(),
        np.concatenate([first[1], columns, end[1] + stages * wide]).tolist(),
    )


def _repeated(
    block: Any, at: range, high: int, wide: int, lift: tuple[int, int] = (0, 0)
) -> tuple[Index, Index]:
    """Return rows and columns of a block that is repeated down a diagonal.

    lift : how many first rows of the block are moved up, and by how many rows
    """
    first, by = lift
    row, column = _triplets(block)
    if by:
        row = np.where(row < first, row - by, row - first)
    k = np.array(at)[:, None]
    return (row + k * high).ravel(), (column + k * wide).ravel()


def _triplets(sparsity: Any) -> tuple[Index, Index]:
    row, column = sparsity.get_triplet()
    return np.array(row, dtype=np.int64), np.array(column, dtype=np.int64)

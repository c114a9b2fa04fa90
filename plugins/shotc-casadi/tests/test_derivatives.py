"""The derivatives handed to the solvers are CasADi's own of the same programme, written out plainly."""

from __future__ import annotations

from functools import cache
from itertools import product

import casadi as ca
import numpy as np
import pytest
from shotc_casadi.clock import symbols as clock
from shotc_casadi.derivatives import derived, differentiated, laid_out
from shotc_casadi.symbols import INPUTS, LENS, STATES, size, stage

N = 3
KINDS = [
    *product(("none", "points", "silhouette", "clock"), (0, 2)),
    ("beside", 1),
    ("together", 2),
    ("zooming", 1),
]
CLOCKS = {"clock": (), "beside": (0, 2), "together": (1, 1, 2)}


@cache
def made(kind, planes):
    """A stage of a shot with keyframes, or of one on its own clock, beside ellipsoids or of two subjects."""
    if kind == "zooming":
        return stage("silhouette", planes, 0, windy=True, zooms=True)
    return clock.stage(clock.Sizes(planes, *CLOCKS[kind])) if kind in CLOCKS else stage(kind, planes)


def sizes(s):
    """How many states, unknowns and parameters a stage has."""
    return s.following.numel(), s.z.numel(), s.p.numel()


@cache
def plain(kind, planes):
    """Cost, constraints and their derivatives by CasADi on one expression graph, stage after stage."""
    s = made(kind, planes)
    states, width, each = sizes(s)
    roots = ca.vertcat(s.node_roots, s.passing_roots)
    of = ca.Function(
        "stage",
        [s.z, s.p],
        [s.node + s.passing, s.following, ca.vertcat(s.held, s.driven), roots],
    )
    last = ca.Function("last", [s.z, s.p], [s.node, s.held, s.node_roots])
    x, p = ca.MX.sym("x", N * width + states), ca.MX.sym("p", (N + 1) * each)
    cost, rows, squared = 0, [], []
    for k in range(N):
        z, following = x[k * width : (k + 1) * width], x[(k + 1) * width : (k + 1) * width + states]
        value, end, bound, root = of(z, p[k * each : (k + 1) * each])
        cost += value
        rows += [following - end, bound]
        squared.append(root)
    value, bound, root = last(ca.vertcat(x[N * width :], ca.MX(width - states, 1)), p[N * each :])
    cost, g, squared = cost + value, ca.vertcat(*rows, bound), ca.vertcat(*squared, root)
    lam_f, lam_g = ca.MX.sym("lam_f"), ca.MX.sym("lam_g", g.numel())
    whole, slopes = cost + ca.sumsqr(squared), ca.jacobian(squared, x)
    # Squares count by their slopes: Gauss and Newton.
    curvature = ca.hessian(lam_f * cost + ca.dot(lam_g, g), x)[0] + 2 * lam_f * (slopes.T @ slopes)
    slope = ca.gradient(lam_f * whole + ca.dot(lam_g, g), x)
    return ca.Function(
        "plain",
        [x, p, lam_f, lam_g],
        [whole, ca.gradient(whole, x), g, ca.jacobian(g, x), slope, curvature],
    )


def point(seed, s, kind):
    """A random point: a target in the neighbourhood, mostly in the frame; everything weighs."""
    states, width, each = sizes(s)
    draw = np.random.default_rng(seed)
    x = draw.normal(0, 1, N * width + states)
    if kind == "zooming":  # fields of view are above zero
        x[LENS::width] = draw.uniform(0.3, 1.5, N + 1)
    p = draw.uniform(0.2, 1.5, ((N + 1), each))
    first = 1 if kind in CLOCKS else 0  # after the length of a stage, which is above zero
    p[:, first : first + 3] += draw.normal(0, 3, 3)
    held, driven = s.held.numel(), s.driven.numel()
    return x, p.ravel(), draw.normal(), draw.normal(0, 1, N * (states + held + driven) + held)


def close(ours, theirs):
    a, b = np.array(ca.DM(ours).full()), np.array(ca.DM(theirs).full())
    assert a.shape == b.shape
    assert a == pytest.approx(b, rel=1e-9, abs=1e-9 * (1 + np.abs(b).max()))


@pytest.mark.long
@pytest.mark.parametrize(("kind", "planes"), KINDS)
def test_what_the_solvers_get_is_what_casadi_derives(kind, planes):
    reference, s = plain(kind, planes), made(kind, planes)
    states, width, each = sizes(s)
    x, p = ca.MX.sym("x", N * width + states), ca.MX.sym("p", (N + 1) * each)
    fatrop, ipopt = (laid_out(differentiated(s), solver, N, x, p) for solver in ("fatrop", "ipopt"))
    for seed in range(2):
        at = point(seed, s, kind)
        cost, gradient, g, jacobian, slope, curvature = reference(*at)
        for given in (fatrop, ipopt):
            value, matrix = given["nlp_jac_g"](*at[:2])
            close(value, g)
            close(matrix, jacobian)
        close(fatrop["nlp_grad_f"](*at[:2]), gradient)
        value, ours = ipopt["nlp_grad_f"](*at[:2])
        close(value, cost)
        close(ours, gradient)
        ours, whole = fatrop["nlp_hess_l"](*at)
        close(ours, slope)
        close(whole, curvature)
        close(ipopt["nlp_hess_l"](*at), ca.triu(curvature))
        assert np.abs(np.array(curvature)).max() > 1e-3


def test_only_what_may_be_nonzero_is_laid_out():
    found = laid_out(
        derived("silhouette", 2),
        "fatrop",
        N,
        ca.MX.sym("x", N * (STATES + INPUTS) + STATES),
        ca.MX.sym("p", (N + 1) * size(2)),
    )
    for name, out in (("nlp_jac_g", 1), ("nlp_hess_l", 1)):
        ours = found[name].sparsity_out(out)
        assert ours.nnz() < 0.35 * ours.numel()

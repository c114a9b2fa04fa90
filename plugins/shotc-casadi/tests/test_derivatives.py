"""The derivatives handed to the solvers are CasADi's own of the same programme, written out plainly."""

from __future__ import annotations

from functools import cache

import casadi as ca
import numpy as np
import pytest
from shotc_casadi.derivatives import derived, laid_out
from shotc_casadi.symbols import INPUTS, STATES, WIDTH, size, stage

N = 3


@cache
def plain(visibility, planes):
    """Cost, constraints and their derivatives by CasADi on one expression graph, stage after stage."""
    s = stage(visibility, planes)
    of = ca.Function("stage", [s.z, s.p], [s.node + s.passing, s.following, ca.vertcat(s.held, s.driven)])
    last = ca.Function("last", [s.z, s.p], [s.node, s.held])
    x, p = ca.MX.sym("x", N * WIDTH + STATES), ca.MX.sym("p", (N + 1) * size(planes))
    cost, rows = 0, []
    for k in range(N):
        z, following = x[k * WIDTH : (k + 1) * WIDTH], x[(k + 1) * WIDTH : (k + 1) * WIDTH + STATES]
        value, end, bound = of(z, p[k * size(planes) : (k + 1) * size(planes)])
        cost += value
        rows += [following - end, bound]
    value, bound = last(ca.vertcat(x[N * WIDTH :], ca.MX(INPUTS, 1)), p[N * size(planes) :])
    cost, g = cost + value, ca.vertcat(*rows, bound)
    lam_f, lam_g = ca.MX.sym("lam_f"), ca.MX.sym("lam_g", g.numel())
    curvature, slope = ca.hessian(lam_f * cost + ca.dot(lam_g, g), x)
    return ca.Function(
        "plain",
        [x, p, lam_f, lam_g],
        [cost, ca.gradient(cost, x), g, ca.jacobian(g, x), slope, curvature],
    )


def point(seed, planes):
    """A random point: a target in the neighbourhood, mostly in the frame; everything weighs."""
    draw = np.random.default_rng(seed)
    x = draw.normal(0, 1, N * WIDTH + STATES)
    p = draw.uniform(0.2, 1.5, ((N + 1), size(planes)))
    p[:, :3] += draw.normal(0, 3, 3)
    rows = N * (STATES + 3 + planes) + 2 + planes
    return x, p.ravel(), draw.normal(), draw.normal(0, 1, rows)


def close(ours, theirs):
    a, b = np.array(ca.DM(ours).full()), np.array(ca.DM(theirs).full())
    assert a.shape == b.shape
    assert a == pytest.approx(b, rel=1e-9, abs=1e-9 * (1 + np.abs(b).max()))


@pytest.mark.parametrize("planes", [0, 2])
@pytest.mark.parametrize("visibility", ["none", "points", "silhouette"])
def test_what_the_solvers_get_is_what_casadi_derives(visibility, planes):
    reference, d = plain(visibility, planes), derived(visibility, planes)
    x, p = ca.MX.sym("x", N * WIDTH + STATES), ca.MX.sym("p", (N + 1) * size(planes))
    fatrop, ipopt = (laid_out(d, solver, N, x, p) for solver in ("fatrop", "ipopt"))
    for seed in range(4):
        at = point(seed, planes)
        cost, gradient, g, jacobian, slope, curvature = reference(*at)
        for made in (fatrop, ipopt):
            value, matrix = made["nlp_jac_g"](*at[:2])
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
    made = laid_out(
        derived("silhouette", 2),
        "fatrop",
        N,
        ca.MX.sym("x", N * WIDTH + STATES),
        ca.MX.sym("p", (N + 1) * size(2)),
    )
    for name, out in (("nlp_jac_g", 1), ("nlp_hess_l", 1)):
        ours = made[name].sparsity_out(out)
        assert ours.nnz() < 0.35 * ours.numel()

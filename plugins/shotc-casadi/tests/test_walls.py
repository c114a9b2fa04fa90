"""The room about a path as half-spaces."""

from __future__ import annotations

import numpy as np
import pytest
from shotc_casadi.margins import Margins
from shotc_casadi.walls import COUNTS, FREE_M, half_spaces

from shotc.geom.solid_arrays.points import support
from tests.support.path_scenes import free, mission, shot
from tests.support.records import replace as changed
from tests.support.refiner_scenes import nodes_of, subject, walled


def test_every_half_space_holds_at_its_node_and_parts_it_from_something():
    of, nodes = walled(), nodes_of(walled(), 60)
    planes = half_spaces(of.space, of.leg.curve, nodes, Margins())
    assert planes.shape[1] in COUNTS[1:]
    p = of.leg.curve(nodes.s)[:, :3]
    real = np.linalg.norm(planes[:, :, :3], axis=2) > 0
    assert real.any(axis=1).sum() > 10
    assert np.linalg.norm(planes[real][:, :3], axis=1) == pytest.approx(1.0)
    slack = np.einsum("kmd,kd->km", planes[:, :, :3], p) - planes[:, :, 3]
    assert slack.min() >= 0.0
    assert (slack[~real] == -FREE_M).all()
    for k, row in zip(*np.nonzero(real), strict=True):
        n, b = planes[k, row, :3], planes[k, row, 3]
        beyond = [b - float(support(o.part, n[None])[0]) - o.clearance for o in of.space.obstacles]
        walls = [b - w.offset for w in of.space.walls if np.allclose(n, w.normal)]
        # One obstacle with its clearance lies wholly beyond the plane.
        assert max(beyond + walls) >= -1e-6


def test_points_of_an_obstacle_break_the_planes_near_it():
    of, nodes = walled(), nodes_of(walled(), 60)
    planes = half_spaces(of.space, of.leg.curve, nodes, Margins())
    p = of.leg.curve(nodes.s)[:, :3]
    k = int(np.linalg.norm(p[:, :2] - [31.0, -40.0], axis=1).argmin())
    inside = np.array([[x, y, z] for x in (28, 31, 34) for y in (-50, -44, -38) for z in (1.0, 20.0, 39.0)])
    slack = inside @ planes[k, :, :3].T - planes[k, :, 3]
    assert slack.min(axis=1).max() <= 0.0


def test_where_nothing_stands_there_is_no_half_space():
    of = subject(
        changed(mission(targets=()), rules=changed(mission().rules, ground_clearance=0.0)),
        shot([free(0, (0, -50, 40)), free(1, (40, -50, 40)), free(2, (60, -20, 40))]),
    )
    assert half_spaces(of.space, of.leg.curve, nodes_of(of), Margins()).shape == (25, 0, 4)

"""Boxes and groups as the refiners' formulas have them, against the exact shapes."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin, tan

import casadi as ca
import numpy as np
import pytest
from shotc_casadi.clock import outline
from shotc_casadi.extents import EXTENT_PARAMETERS, Extent, between, count_of, extents_of
from shotc_casadi.symbols import FIELDS, STATES, size, stage

from shotc.geom.camera import View, frustum_margins, view
from shotc.geom.shapes import BoxShape, CylinderShape, GroupShape, Part, TargetShape, bodies_of

HFOV, ASPECT = 1.2, 16 / 9
HALF = tan(HFOV / 2)


def drawn(seed: int) -> tuple[TargetShape, View, tuple[float, float, float], tuple[float, float]]:
    """A box or a group, and a camera that looks at it, nearly: its view, the offset, and yaw and pitch."""
    rng = np.random.default_rng(seed)

    def box() -> BoxShape:
        yaw = rng.uniform(0, 2 * pi)
        return BoxShape(*rng.uniform(0.5, 8, 3), (cos(yaw), sin(yaw)))

    parts = (
        Part((0.0, 0.0, 0.0), box()),
        Part(tuple(rng.uniform(-4, 4, 3)), CylinderShape(*rng.uniform(0.5, 4, 2))),
    )
    shape: TargetShape = (
        box() if seed % 2 else GroupShape((*parts, Part(tuple(rng.uniform(-4, 4, 3)), box())))
    )
    around, above, far = rng.uniform(0, 2 * pi), rng.uniform(-1.2, 1.2), rng.uniform(18, 60)
    away = far * np.array([cos(around) * cos(above), sin(around) * cos(above), sin(above)])
    yaw, pitch = atan2(-away[1], -away[0]) + rng.uniform(-0.4, 0.4), -above + rng.uniform(-0.2, 0.2)
    return shape, view(yaw, pitch, HFOV, ASPECT), (-away[0], -away[1], -away[2]), (yaw, pitch)


def rows(shape: TargetShape) -> np.ndarray:
    return extents_of(shape, len(bodies_of(shape)), 1)[0]


@pytest.mark.parametrize("seed", range(40))
def test_the_smooth_outline_is_next_to_the_exact_one(seed: int) -> None:
    shape, camera, offset, _ = drawn(seed)
    bodies = [Extent.of(ca.DM(row)) for row in rows(shape)]
    seen = outline.outline_of(camera, ca.DM(offset), hypot(*offset), bodies)
    exact = shape.bounds(camera, offset)
    found = [float(edge) for edge in (seen.left, seen.right, seen.low, seen.high)]
    # Rounded off outwards, by as little as nobody sees.
    assert found == pytest.approx(exact, abs=6e-3 * (1 + max(map(abs, exact))))


@pytest.mark.parametrize("seed", range(40))
def test_the_hinge_is_that_of_the_exact_margins(seed: int) -> None:
    shape, camera, offset, aim = drawn(seed)
    extents = len(bodies_of(shape))
    made = stage("silhouette", 0, extents)
    values = dict.fromkeys(FIELDS, 0.0) | {
        "centre": offset,
        "half_width": HALF,
        "half_height": HALF / ASPECT,
        "inside": 0.03,
        "visibility": 1.0,
    }
    z = np.zeros(made.z.numel())
    z[9], z[12] = aim
    flat = [np.broadcast_to(np.asarray(values[name], float), (n,)) for name, n in FIELDS.items()]
    p = np.concatenate([*flat, rows(shape).ravel()])
    assert len(p) == size(0, extents)
    hinge = float(ca.Function("node", [made.z, made.p], [made.node])(z, p))
    halves = np.array([HALF, HALF, HALF / ASPECT, HALF / ASPECT])
    expected = 0.0
    for part in bodies_of(shape):
        there = tuple(np.add(offset, part.offset))
        margins = np.array(frustum_margins(camera, there, part.shape)) * np.hypot(1, halves) / halves
        expected += float((np.maximum(0.0, 0.03 - margins / hypot(*offset)) ** 2).sum())
    assert hinge == pytest.approx(expected, rel=2e-2, abs=1e-5)
    assert STATES == 16


def test_between_two_targets_each_body_goes_from_one_to_the_other() -> None:
    box, pole = BoxShape(6.0, 2.0, 3.0, (1.0, 0.0)), CylinderShape(0.5, 8.0)
    first, second = extents_of(box, 1, 1), extents_of(pole, 1, 1)
    way = between(first, second, np.array([[0.0], [0.5], [1.0]]))
    assert way.shape == (3, 1, EXTENT_PARAMETERS)
    assert way[0] == pytest.approx(first[0])
    assert way[2] == pytest.approx(second[0])
    assert way[1, 0] == pytest.approx([0, 0, 0, 0.25, 5.5, 1.5, 0, 0, 0.5])


def test_a_box_that_is_told_the_other_way_round_stays_as_it_is() -> None:
    box = BoxShape(6.0, 2.0, 3.0, (0.6, 0.8))
    back = box.facing((-0.6, -0.8))
    way = between(extents_of(box, 1, 1), extents_of(back, 1, 1), np.array([[0.5]]))
    assert way[0] == pytest.approx(extents_of(box, 1, 1)[0])


def test_cylinders_alone_need_no_bodies() -> None:
    assert count_of([CylinderShape(1.0, 2.0), CylinderShape(3.0, 4.0)]) == 0
    assert count_of([CylinderShape(1.0, 2.0), BoxShape(1.0, 2.0, 3.0)]) == 1

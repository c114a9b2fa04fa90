"""Separating planes: what a normal and its gap prove, for one point outside, and for one inside."""

from __future__ import annotations

from math import cos, pi

import numpy as np
import pytest

from shotc.geom import solids
from shotc.geom.solid_arrays.planes import separate
from shotc.geom.solid_arrays.points import support
from shotc.geom.solids import Cylinder, Prism, Solid

ROUND = Cylinder((3.0, -4.0), 6.0, -5.0, 8.0)
SQUARE = Prism(((-10.0, -9.0), (10.0, -9.0), (10.0, 9.0), (-10.0, 9.0)), -5.0, 8.0)


def points(low: tuple[float, ...], high: tuple[float, ...], count: int = 200) -> np.ndarray:
    return np.random.default_rng(5).uniform(low, high, (count, 3))


@pytest.mark.parametrize("solid", [ROUND, SQUARE])
def test_the_gap_of_a_point_outside_is_its_distance(solid: Solid) -> None:
    p = points((-40.0, -40.0, -40.0), (40.0, 40.0, 40.0))
    far = np.array([solids.distance(solid, tuple(each)) for each in p])
    normals, gap = separate(solid, p[far > 0.1, None])
    assert np.linalg.norm(normals, axis=1) == pytest.approx(1.0)
    assert gap == pytest.approx(far[far > 0.1], rel=1e-6)


def test_a_point_in_a_box_leaves_by_the_nearest_side_or_the_top() -> None:
    p = points((-10.0, -9.0, -5.0), (10.0, 9.0, 8.0))
    ways = np.column_stack([10.0 - np.abs(p[:, 0]), 9.0 - np.abs(p[:, 1]), 8.0 - p[:, 2]])
    normals, gap = separate(SQUARE, p[:, None])
    assert -gap == pytest.approx(ways.min(axis=1), abs=1e-9)
    assert np.abs(normals).argmax(axis=1).tolist() == ways.argmin(axis=1).tolist()
    assert np.linalg.norm(normals, axis=1) == pytest.approx(1.0)


def test_a_point_in_a_cylinder_leaves_by_its_side_or_top_within_an_eighth_of_a_turn() -> None:
    p = points((-3.0, -10.0, -5.0), (9.0, 2.0, 8.0))
    out = np.hypot(p[:, 0] - 3.0, p[:, 1] + 4.0)
    p, out = p[out < 6.0], out[out < 6.0]
    normals, gap = separate(ROUND, p[:, None])
    assert np.linalg.norm(normals, axis=1) == pytest.approx(1.0)
    assert (-gap >= np.minimum(6.0 - out, 8.0 - p[:, 2]) - 1e-9).all()
    assert (-gap <= np.minimum(6.0 - out * cos(pi / 8), 8.0 - p[:, 2]) + 1e-9).all()


@pytest.mark.parametrize("solid", [ROUND, SQUARE])
@pytest.mark.parametrize("count", [2, 6])
def test_a_gap_is_that_of_the_nearest_point_of_a_set_along_its_normal(solid: Solid, count: int) -> None:
    middles = points((-40.0, -40.0, -40.0), (40.0, 40.0, 40.0), 60)
    hulls = middles[:, None] + 4.0 * np.random.default_rng(7).normal(size=(60, count, 3))
    normals, gap = separate(solid, hulls)
    least = np.einsum("nmd,nd->nm", hulls, normals).min(axis=1)
    assert gap == pytest.approx(least - support(solid, normals))
    assert (gap > 0.0).any()


def around(foot: np.ndarray, normal: np.ndarray, far: float, rng: np.random.Generator) -> np.ndarray:
    """Return five points whose hull is as far from a solid as a plane through its point ``foot`` says.

    Three of them are in the plane at that distance, unevenly round the foot; two are farther.
    """
    one = np.cross(normal, [0.3, -0.5, 0.8])
    one /= np.linalg.norm(one)
    other = np.cross(normal, one)
    turn = rng.uniform(0.0, 2.0 * pi) + np.array([0.0, 2.0, 4.2])
    reach = rng.uniform(0.2, 2.0, 3) * far
    at = foot + far * normal + reach[:, None] * (np.cos(turn)[:, None] * one + np.sin(turn)[:, None] * other)
    beyond = at[:2] + rng.uniform(0.1, 3.0, (2, 1)) * far * normal + rng.normal(size=(2, 3))
    beyond += np.maximum(0.0, far - (beyond - foot) @ normal)[:, None] * normal
    return np.concatenate([at, beyond])


@pytest.mark.parametrize("solid", [ROUND, SQUARE])
def test_a_gap_is_within_a_few_per_cent_of_the_distance_of_a_hull(solid: Solid) -> None:
    """The nearest point of the solid is at its upper rim, or a corner, and the normal points outward."""
    rng = np.random.default_rng(3)
    hulls, expected = [], []
    for _ in range(60):
        turn, rise = rng.uniform(0.1, pi / 2 - 0.1, 2)
        normal = np.array([cos(turn) * cos(rise), np.sin(turn) * cos(rise), np.sin(rise)])
        edge = np.array([3.0 + 6.0 * cos(turn), -4.0 + 6.0 * np.sin(turn), 8.0])
        foot = edge if isinstance(solid, Cylinder) else np.array([10.0, 9.0, 8.0])
        expected.append(rng.uniform(0.2, 15.0))
        hulls.append(around(foot, normal, expected[-1], rng))
    _, gap = separate(solid, np.array(hulls))
    share = gap / np.array(expected)
    assert (share <= 1.0 + 1e-9).all()
    assert share.min() > 0.97
    assert np.median(share) > 0.999

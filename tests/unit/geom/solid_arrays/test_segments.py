"""Segments and solids against many points of each segment."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.solid_arrays.points import signed_distance
from shotc.geom.solid_arrays.segments import blocks, nearest_on_segments, segment_distances, within
from shotc.geom.solids import Cylinder, Solid, box

MAST = Cylinder((1.0, -2.0), 5.0, 0.0, 10.0)
HOUSE = box((2.0, 1.0, 4.0), (8.0, 5.0, 8.0), 0.4)
SHARES = np.linspace(0.0, 1.0, 501)


def drawn(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return segments, every fourth one upright and every fourth one level."""
    random = np.random.default_rng(seed)
    a, b = random.uniform([-9.0, -9.0, -4.0], [9.0, 9.0, 14.0], (2, 40, 3))
    b[::4, :2] = a[::4, :2]
    b[1::4, 2] = a[1::4, 2]
    return a, b


def sampled(solid: Solid, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return signed distances (N, 501) along segments."""
    points = a[:, None] + SHARES[:, None] * (b - a)[:, None]
    return signed_distance(solid, points.reshape(-1, 3)).reshape(len(a), -1)


@pytest.mark.parametrize("solid", [MAST, HOUSE])
def test_a_line_is_inside_from_where_it_enters_to_where_it_leaves(solid: Solid) -> None:
    a, b = drawn(1)
    inside = sampled(solid, a, b) <= 0.0
    enter, leave = within(solid, a, b - a)
    share = np.maximum(np.minimum(leave, 1.0) - np.maximum(enter, 0.0), 0.0)
    assert share == pytest.approx(inside.mean(axis=1), abs=5e-3)
    some = inside.any(axis=1)
    assert 10 < some.sum() < 38
    assert np.maximum(enter, 0.0)[some] == pytest.approx(SHARES[inside.argmax(axis=1)[some]], abs=3e-3)
    long = inside.sum(axis=1) > 2
    assert blocks(solid, a[long], b[long]).all()
    assert not blocks(solid, a[~some], b[~some]).any()


@pytest.mark.parametrize(
    ("x", "high", "low", "blocked"),
    [
        (5.95, 50.0, -5.0, True),
        (6.05, 50.0, -5.0, False),  # beside the wall
        (1.0, 50.0, 10.5, False),  # above the roof
        (1.0, -0.5, -9.0, False),  # below the floor
        (1.0, 9.0, 2.0, True),  # all within
    ],
)
def test_an_upright_line_is_blocked_where_the_solid_is(x: float, high: float, low: float, blocked) -> None:
    top, foot = np.array([[x, -2.0, high]]), np.array([[x, -2.0, low]])
    assert blocks(MAST, top, foot)[0] == blocked
    assert blocks(MAST, foot, top)[0] == blocked


@pytest.mark.parametrize("solid", [MAST, HOUSE])
def test_a_segment_is_as_near_as_its_nearest_point(solid: Solid) -> None:
    a, b = drawn(2)
    nearest = np.maximum(sampled(solid, a, b).min(axis=1), 0.0)
    found = segment_distances(solid, a, b)
    assert found == pytest.approx(nearest, abs=0.05)
    assert (found <= nearest + 1e-9).all()
    points = nearest_on_segments(solid, a, b)
    assert np.maximum(signed_distance(solid, points), 0.0) == pytest.approx(found, abs=1e-6)


@pytest.mark.parametrize("scale", [1e-4, 1e3])
def test_the_nearest_point_of_a_segment_is_the_same_in_every_unit(scale: float) -> None:
    a, b = drawn(3)
    small = Cylinder((scale * 1.0, scale * -2.0), scale * 5.0, 0.0, scale * 10.0)
    found, scaled = nearest_on_segments(MAST, a, b), nearest_on_segments(small, scale * a, scale * b)
    far = segment_distances(MAST, a, b)
    assert np.abs(scaled / scale - found)[far > 0.0].max() < 1e-5

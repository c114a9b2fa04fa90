"""Tracks: which of them go one way."""

from __future__ import annotations

from math import atan2, pi

import pytest

from shotc.geom.track import Track


def track(*points: tuple[float, float], headings: tuple[float, ...] = (), after=(0.0, 0.0)) -> Track:
    """Return a track by these places, ten seconds from one to the next."""
    times = tuple(10.0 * k for k in range(len(points)))
    return Track(times, tuple((*p, 1.0) for p in points), headings, (*after, 0.0))


@pytest.mark.parametrize(
    ("way", "straight"),
    [
        (track((0, 0), (10, 5), (30, 15)), True),
        (track((0, 0), (10, 5), (10, 5), (30, 15)), True),  # it rests on its way
        (track((0, 0), (10, 0), (20, 8)), False),  # a bend of less than a quarter turn
        (track((0, 0), (10, 0), (11, 8)), False),
        (track((0, 0), (10, 5), (4, 2)), False),  # there and back
        (track((0, 0), after=(2, 1)), True),
        (track((0, 0), (10, 5), after=(2, 1)), True),
        (track((0, 0), (10, 5), after=(2, -1)), False),
        (track((0, 0), (10, 5), after=(-2, -1)), False),
        (track((0, 0)), False),  # it goes nowhere
        (track((0, 0), (10, 5), headings=(0.3, 0.31)), True),
        (track((0, 0), (10, 5), headings=(0.3, 0.3 + pi / 90)), False),  # it turns as it goes
    ],
)
def test_straight_is_what_goes_one_way_and_faces_that_way(way: Track, straight: bool) -> None:
    assert way.straight is straight


@pytest.mark.parametrize("way", [(0.0, 10.0), (-7.0, 0.0)])
def test_a_target_that_stands_looks_where_it_went_last_or_will_go_first(way: tuple[float, float]) -> None:
    x, y = way
    stands = Track((0.0, 20.0, 40.0, 60.0), ((0.0, 0.0, 5.0), (0.0, 0.0, 5.0), (x, y, 5.0), (x, y, 5.0)))
    for time in (5.0, 30.0, 55.0):
        assert stands.heading(time) == pytest.approx(atan2(y, x))

"""Flights changed after they were written: the same places at other times, the same pictures at the same."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.phases import Phase
from shotc.show.assignment.changed import block_at, earlier, ends_of, later_home, on_arcs
from shotc.show.geom.arcs import Gaps
from shotc.show.geom.windows import windows
from shotc.show.solvers.arc_move import ArcMove, fastest_arc
from tests.support.show_plans import fleet, flight

FLIGHT = flight(fleet())
"""Stands in its pictures from 16 s to 20 s and from 26 s to 28 s, then flies home for 18 s."""

SHOWN = np.array([*np.linspace(16.0, 20.0, 9), *np.linspace(26.0, 28.0, 5)])


def at(flown: FleetTrajectory, times: Array | list[float]) -> Array:
    return places(flown.breaks, flown.coef, np.array(times))


def whole(flown: FleetTrajectory) -> None:
    assert (np.diff(flown.breaks) > 0).all()
    assert flown.coef.shape[1] == len(flown.breaks) + 2
    assert flown.phases[0].start == 0.0
    assert flown.phases[-1].end == pytest.approx(flown.breaks[-1])
    assert all(a.end == b.start for a, b in pairwise(flown.phases))


@settings(max_examples=20, deadline=None)
@given(st.floats(0.05, 90.0))
def test_a_way_home_is_flown_later_and_nothing_else(seconds: float) -> None:
    flown = later_home(FLIGHT, seconds)
    whole(flown)
    times = np.linspace(0.0, 28.0, 57)
    np.testing.assert_allclose(at(flown, times), at(FLIGHT, times), atol=1e-6)
    times = np.linspace(28.0, 46.0, 57)
    np.testing.assert_allclose(at(flown, times + seconds), at(FLIGHT, times), atol=1e-6)
    np.testing.assert_allclose(at(flown, [28.0 + 0.5 * seconds]), at(FLIGHT, [28.0]), atol=1e-6)
    assert flown.shown == FLIGHT.shown
    assert [p.start for p in flown.phases[:4]] == [0.0, 8.0, 16.0, 28.0]


@settings(max_examples=20, deadline=None)
@given(st.floats(0.05, 3.9))
def test_a_picture_is_come_to_earlier_and_stands_when_it_did(seconds: float) -> None:
    block = block_at(FLIGHT, 23.0)
    assert block is not None
    flown = earlier(FLIGHT, block, seconds)
    whole(flown)
    times = np.linspace(20.0, 26.0, 25)
    np.testing.assert_allclose(at(flown, times - seconds), at(FLIGHT, times), atol=1e-6)
    times = np.array([*np.linspace(0.0, 16.0, 9), *np.linspace(26.0, 46.0, 41)])
    np.testing.assert_allclose(at(flown, times), at(FLIGHT, times), atol=1e-6)
    np.testing.assert_allclose(at(flown, [26.0 - 0.5 * seconds]), at(FLIGHT, [26.0]), atol=1e-6)
    assert (flown.shown[0].end, flown.shown[1].start) == (pytest.approx(20.0 - seconds), 26.0)
    assert flown.phases == FLIGHT.phases


def arcs(way: tuple[Array, Array]) -> ArcMove:
    return fastest_arc(way, np.array([50.0, 10.0, 20.0]), Gaps(1.2, 1.2), fleet().limits, 1.0)


def test_another_way_home_takes_its_own_time() -> None:
    block = block_at(FLIGHT, 32.0)
    assert block is not None
    move = arcs(ends_of(FLIGHT, block.stretch))
    flown = on_arcs(FLIGHT, block, move)
    whole(flown)
    assert flown.breaks[-1] == pytest.approx(46.0 + move.duration - _lasts(block))
    np.testing.assert_allclose(at(flown, SHOWN), at(FLIGHT, SHOWN), atol=1e-6)
    assert np.abs(at(flown, [28.0 + 0.5 * move.duration]) - at(FLIGHT, [32.0])).max() > 1.0
    np.testing.assert_allclose(flown.coef[:, -1], FLIGHT.coef[:, -1])
    assert flown.phases[-1].end - flown.phases[-1].start == pytest.approx(8.0)


def test_another_way_to_a_picture_ends_when_the_first_one_did() -> None:
    block = block_at(FLIGHT, 23.0)
    assert block is not None
    move = arcs(ends_of(FLIGHT, block.stretch))
    assert 6.0 < move.duration < 9.9
    flown = on_arcs(FLIGHT, block, move)
    whole(flown)
    longer = move.duration - 6.0
    assert flown.shown[0].end == pytest.approx(20.0 - longer)
    shown = np.array([*np.linspace(16.0, 20.0 - longer, 5), *np.linspace(26.0, 28.0, 5)])
    np.testing.assert_allclose(at(flown, shown), at(FLIGHT, shown), atol=1e-6)
    assert flown.breaks[-1] == FLIGHT.breaks[-1]


def _lasts(block: object) -> float:
    way = windows(FLIGHT.coef)[-2]
    assert way == getattr(block, "stretch")  # noqa: B009
    return float(FLIGHT.breaks[way.last] - FLIGHT.breaks[way.first])


@pytest.mark.parametrize("rest", [0, 1])
def test_the_rise_goes_with_the_way_to_the_first_picture(rest: int) -> None:
    """Whether the fleet rests above its pads or not, as it does for a moment once its layers have risen."""
    flown = _risen(rest)
    end = 18.0 + 2.0 * rest
    for time in (7.0, 12.5, 13.0 + 2.0 * rest):
        block = block_at(flown, time)
        assert block is not None
        assert [(w.first, w.last) for w in block.stretches] == [(3, 6), (6 + rest, 9 + rest)]
        moved = earlier(flown, block, 5.5)
        assert (np.diff(moved.breaks) > 0.0).all()
        assert (moved.phases[0].end, moved.phases[1].end) == (6.5, end)
        np.testing.assert_allclose(at(moved, [0.4, 6.5, end - 5.0]), at(flown, [0.0, 12.0, end]), atol=1e-9)


def test_a_picture_that_stands_for_an_instant_parts_two_ways() -> None:
    """What comes to the second of them does not take the first one along."""
    flown = _risen(0)
    above = replace(flown.shown[0], start=12.0, end=12.0)
    block = block_at(replace(flown, shown=(above, *flown.shown)), 13.0)
    assert block is not None
    assert [(w.first, w.last) for w in block.stretches] == [(6, 9)]


def _risen(rest: int) -> FleetTrajectory:
    """A flight up, so many pieces of rest above the pads, and the way to the first picture."""
    pads, above, first = (FLIGHT.coef[:, k] for k in (0, 4, 10))
    legs = ((pads, 6), (above, 3 + rest), (first, 5))
    coef = np.stack([point for point, count in legs for _ in range(count)], axis=1)
    breaks = 2.0 * np.arange(12.0 + rest)
    end = float(breaks[9 + rest])
    phases = (Phase("takeoff", None, 0.0, 12.0), Phase("transit", None, 12.0, end))
    shown = (replace(FLIGHT.shown[0], start=end, end=float(breaks[-1])),)
    return replace(FLIGHT, breaks=breaks, coef=coef, phases=phases, shown=shown)

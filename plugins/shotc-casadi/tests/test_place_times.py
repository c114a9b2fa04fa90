"""When a mission wants a shot to be where, and how a motion is stretched to be there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from shotc_casadi.place_times import place_times, unhurried

from tests.support.refiner_scenes import ARC, HEAD, compiled, keyed, leg_named, path_of


@pytest.fixture(scope="module")
def leg():
    """An arc that rests at its second keyframe and has times for it and for the whole."""
    keys = (ARC[0] + ", hold: 1", ARC[1] + ", hold: 2, time: 25", ARC[2])
    return leg_named(path_of(compiled(HEAD + keyed(*keys, more="timing: {duration: 60}"), "none")))


@pytest.mark.slow
def test_times_are_without_the_holds_before(leg):
    asked = place_times(leg)
    assert asked.t.tolist() == [0.0, 24.0, 57.0]
    assert asked.s.tolist() == [leg.curve.start, leg.marks[1].s, leg.curve.end]


@pytest.mark.slow
def test_a_wait_at_the_start_is_no_flight(leg):
    first, *others = leg.marks
    waiting = replace(leg, marks=(replace(first, time=3.0), *others))
    assert place_times(waiting).t.tolist() == [0.0, 21.0, 54.0]


@pytest.mark.slow
def test_a_shot_that_lasts_on_at_its_last_keyframe_gets_there_in_time(leg):
    *others, last = leg.marks
    resting = replace(leg, marks=(*others, replace(last, time=50.0)))
    assert place_times(resting).t.tolist() == [0.0, 24.0, 47.0]


@pytest.mark.slow
def test_a_leg_without_times_has_none(leg):
    assert not place_times(unhurried(leg))
    assert place_times(leg)


@pytest.mark.slow
def test_lateness_is_of_the_worst_stretch(leg):
    asked = place_times(leg)
    s = np.union1d(np.linspace(leg.curve.start, leg.curve.end, 50), place_times(leg).s)
    t = np.interp(s, asked.s, [0.0, 30.0, 50.0])
    assert asked.lateness(s, t) == pytest.approx(30 / 24 - 1)
    assert asked.lateness(s, np.interp(s, asked.s, [0.0, 12.0, 20.0])) < 0


def test_a_stretched_motion_is_there_in_time_and_goes_on_at_its_pace(leg):
    asked = place_times(replace(leg, duration=None))
    s = np.append(np.linspace(leg.curve.start, asked.s[-1], 30), leg.curve.end)
    t = np.interp(s, [s[0], asked.s[-1], s[-1]], [0.0, 10.0, 16.0])
    kept = asked.kept(s, t, pace=0.5)
    assert np.interp(asked.s, s, kept) == pytest.approx(asked.t)
    assert kept[-1] - asked.t[-1] == pytest.approx(6.0 / 0.5)
    assert (np.diff(kept) > 0).all()

"""The bound on turning against the course itself, looked at densely."""

from math import pi

import numpy as np
import pytest

from shotc.geom.track import Track
from shotc.geom.track_array import headings
from shotc.geom.turning import turning

START, END = 0.5, 20.0


def drawn(seed: int) -> Track:
    """A track with corners, stops and turns back; every third one with headings of its own."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 15))
    times = np.sort(rng.uniform(0, 22, count)) + np.arange(count) * 1e-3
    steps = rng.normal(size=(count, 3)) * rng.choice([0.0, 0.05, 1.0, 5.0], size=(count, 1))
    points = np.cumsum(steps, axis=0)
    faced = tuple(np.cumsum(3.0 * rng.normal(size=count))) if seed % 3 == 0 else ()
    return Track(tuple(times), tuple(map(tuple, points)), faced)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "seed", [s if s < 7 else pytest.param(s, marks=(pytest.mark.slow, pytest.mark.long)) for s in range(60)]
)
def test_no_course_changes_by_more_than_is_told(seed: int) -> None:
    track = drawn(seed)
    t = np.linspace(START, END, 20_001 if seed >= 7 else 4001)
    course = headings(track, t)
    before, after = turning(track, START, END).at(t)
    assert (after >= before).all()
    assert (np.diff(before) >= -1e-9).all()
    for apart in (1, 7, 100):
        turned = np.abs((course[apart:] - course[:-apart] + pi / 2) % pi - pi / 2)
        assert (turned <= after[apart:] - before[:-apart] + 1e-7).all()


def test_a_quarter_turn_at_a_corner_is_a_quarter_turn() -> None:
    track = Track((0.0, 10.0, 20.0), ((0.0, 0.0, 0.0), (40.0, 0.0, 0.0), (40.0, 40.0, 0.0)))
    _, after = turning(track, 1.0, 19.0).at(np.array([8.9, 10.0, 11.1, 19.0]))
    assert after == pytest.approx([0.0, pi / 4, pi / 2, pi / 2], abs=1e-9)


def test_what_stops_and_goes_back_turns_by_nothing_that_a_box_shows() -> None:
    track = Track(
        (0.0, 5.0, 8.0, 13.0), ((0.0, 0.0, 0.0), (20.0, 0.0, 0.0), (20.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    )
    assert turning(track, 0.0, 13.0).after[-1] == pytest.approx(0.0, abs=1e-9)


def test_what_has_headings_turns_as_they_do_and_what_only_swings_counts_both_ways() -> None:
    way = Track((0.0, 4.0, 8.0), ((0.0, 0.0, 0.0), (9.0, 0.0, 0.0), (9.0, 9.0, 0.0)), (0.5, 1.5, 0.9))
    before, after = turning(way, 1.0, 7.0).at(np.array([1.0, 3.0, 4.0, 6.0, 7.0]))
    assert after == pytest.approx([0.0, 0.5, 0.75, 1.05, 1.2])
    assert before == pytest.approx(after)


def test_a_course_steps_where_it_stops_and_counts_before_and_after_that() -> None:
    # East, 6 s of rest, then North: the course steps once it has moved 0.1 m within the second after.
    way = Track(
        (0.0, 5.0, 11.0, 16.0), ((0.0, 0.0, 0.0), (20.0, 0.0, 0.0), (20.0, 0.0, 0.0), (20.0, 20.0, 0.0))
    )
    turned = turning(way, 0.0, 16.0)
    (k,) = np.flatnonzero(turned.after - turned.before > 0.1)
    assert turned.times[k] == pytest.approx(10.0 + 0.1 / 4.0)
    assert (turned.before[k], turned.after[k]) == (pytest.approx(0.0, abs=1e-9), pytest.approx(pi / 2))
    before, after = turned.at(turned.times[[k]])
    assert (before[0], after[0]) == (turned.before[k], turned.after[k])
    assert turned.at(turned.times[[k]] - 1e-3)[1][0] == pytest.approx(0.0, abs=1e-9)
    assert turned.at(turned.times[[k]] + 1e-3)[0][0] == pytest.approx(pi / 2)
    assert turned.at(np.array([0.0, 16.0]))[1] == pytest.approx([0.0, pi / 2])

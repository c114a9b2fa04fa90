"""When beats fall: even ones by their formula, listed ones as they are listed."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.ir.music import Music, beat_of_bar

EVEN = Music(None, 20.0, (), 0.4, 0.5, 4, ("music",))
LISTED = EVEN._replace(listed=(1.0, 1.5, 3.0), period=None, first=0.0)


@pytest.mark.parametrize(("beat", "time"), [(1, 20.4), (2, 20.9), (33, 36.4), (2.5, 21.15), (0.5, None)])
def test_even_beats_are_a_period_apart(beat: float, time: float | None) -> None:
    assert EVEN.time(beat) == (None if time is None else pytest.approx(time))


@pytest.mark.parametrize(
    ("beat", "time"), [(1, 21.0), (2, 21.5), (3, 23.0), (2.5, 22.25), (3.25, None), (4, None), (0, None)]
)
def test_listed_beats_are_as_listed_and_parts_lie_between_them(beat: float, time: float | None) -> None:
    assert LISTED.time(beat) == (None if time is None else pytest.approx(time))


@pytest.mark.slow
@given(st.floats(0.0, 50.0), st.lists(st.floats(0.01, 9.0), min_size=1, max_size=30), st.floats(0.0, 200.0))
def test_the_next_beat_is_the_first_that_is_not_before(start: float, gaps: list[float], time: float) -> None:
    listed = tuple(sum(gaps[: k + 1]) for k in range(len(gaps)))
    for music in (
        Music(None, start, listed, 0.0, None, 4, ()),
        Music(None, start, (), gaps[0], gaps[-1], 4, ()),
    ):
        beat = music.next_beat(time)
        if beat is None:
            assert start + listed[-1] < time
            continue
        at, before = music.time(beat), music.time(beat - 1)
        assert at is not None
        assert at >= time - 1e-4
        assert before is None or before < time + 1e-4


def test_bars_begin_with_their_first_beat() -> None:
    assert [beat_of_bar(bar, 1.0, 4) for bar in (1, 2, 9)] == [1, 5, 33]
    assert beat_of_bar(9, 2.5, 3) == 26.5

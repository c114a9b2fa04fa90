from dataclasses import replace
from math import pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.planning.path.unwrapping import LONGEST_KEYFRAMES, Known, TurnRules, turned
from shotc.solvers.headings import METHODS

HOW = TurnRules("winding", 6.0, 1.0, 1.5)


def known(yaws, *, groups=None, turns=None, rests=()) -> list[Known]:
    groups = groups or list(range(len(yaws)))
    turns = turns or [None] * len(yaws)
    return [
        Known(10.0 * i, y, g, t, i in rests)
        for i, (y, g, t) in enumerate(zip(yaws, groups, turns, strict=True))
    ]


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
@settings(max_examples=20, deadline=None)
@given(yaws=st.lists(st.floats(-pi, pi), min_size=2, max_size=8))
def test_shifts_are_whole_turns_and_the_first_stays(method: str, yaws: list[float]) -> None:
    found = turned(known(yaws), replace(HOW, method=method)).shifts
    assert found[0] == 0.0
    assert np.allclose(np.array(found) / (2 * pi), np.round(np.array(found) / (2 * pi)))


def test_what_is_followed_keeps_its_turn() -> None:
    # Followed from 0 to 5 rad, then free to 5.5: nothing to add. Alone, 0 to 5 would go the other way.
    assert turned(known([0.0, 5.0, 5.5 - 2 * pi], groups=[0, 0, 1]), HOW).shifts == pytest.approx(
        [0.0, 2 * pi]
    )


def test_stated_turns_move_all_that_follows() -> None:
    found = turned(known([0.0, 1.0, 1.2], turns=[None, 1.0 + 4 * pi, None]), HOW).shifts
    assert found == pytest.approx([0.0, 4 * pi, 4 * pi])


def test_more_keyframes_than_are_decided_together_are_still_joined() -> None:
    yaws = np.cumsum(np.full(3 * LONGEST_KEYFRAMES, 0.7))
    wrapped = (yaws + pi) % (2 * pi) - pi
    found = wrapped + turned(known(wrapped.tolist()), HOW).shifts
    assert np.diff(found) == pytest.approx(np.full(len(yaws) - 1, 0.7))


def test_a_rest_parts_the_choice() -> None:
    yaws = [0.0, 0.4, 0.4 + 3.3]
    on, back = turned(known(yaws), HOW).shifts, turned(known(yaws, rests=(1,)), HOW).shifts
    assert on == pytest.approx([0.0, 0.0, 0.0])
    assert back == pytest.approx([0.0, 0.0, -2 * pi])

"""What is told of a drone in a picture: what it does then, and what a preference would have cost."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from shotc.ir.phases import Phase
from shotc.ir.preference import Price, noted
from shotc.passes.verify import sighting
from shotc.passes.verify.sighting import NOTICE_M

PHASES = (
    Phase("takeoff", None, 0.0, 10.0),
    Phase("transit", None, 10.0, 20.0),
    Phase("shot", "look", 20.0, 30.0),
    Phase("return", None, 30.0, 40.0),
    Phase("land", None, 40.0, 50.0),
)


class Rising:
    """A drone that stands on its pad for 5 s, but for rounding, and flies on till 50 s."""

    start, end = 0.0, 50.0

    def __call__(self, t: float) -> np.ndarray:
        return np.array([0.0, 0.0, max(t - 5.0, 1e-15 * t)])


@pytest.mark.parametrize(
    ("time", "told"),
    [
        (4.0, "two stands on its pad then"),
        (8.0, "two is taking off then"),
        (15.0, "two is on the way to its next shot then"),
        (25.0, "two is in its shot `look` then"),
        (35.0, "two is on the way home then"),
        (45.0, "two is landing then"),
        (50.0, "two has landed then and stands on its pad"),
    ],
)
def test_what_a_drone_does_is_told_by_its_phase_and_its_place(time: float, told: str) -> None:
    other: Any = SimpleNamespace(drone="two", phases=PHASES, curve=Rising())
    assert sighting._doing(other, time) == told


def test_a_transit_that_has_not_begun_to_move_is_no_stand_on_a_pad() -> None:
    phases = (Phase("transit", None, 0.0, 10.0),)
    other: Any = SimpleNamespace(drone="two", phases=phases, curve=Rising())
    assert sighting._doing(other, 4.0) == "two is on the way to its next shot then"
    other = SimpleNamespace(drone="two", phases=(), curve=Rising())
    assert sighting._doing(other, 4.0) == "two stands on its pad all the time"


@pytest.mark.parametrize(
    ("price", "told"),
    [
        (Price(0.5 * NOTICE_M, 0.0, True), "no place near its own"),
        (Price(3.0, 0.3, False), "even a move by 3.00 m, 30 % of its distance from what it films, would not"),
        (Price(3.0, 0.3, True), "would move it by 3.00 m, 30 % of its distance from what it films"),
    ],
)
def test_the_price_of_a_preference_is_told_of_each_shot_that_gives_it_up(
    price: Price, told: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sighting, "prefers_free_pictures", lambda _: True)
    stats = (*noted("see", price), *noted("late", price))
    ir: Any = SimpleNamespace(keyframes=SimpleNamespace(mission=None), stats=stats)
    film = Phase("shot", "look", 20.0, 30.0)
    late = Phase("shot", "late", 30.0, 40.0)
    others: Any = [SimpleNamespace(phases=(*PHASES[:2], Phase("shot", "see", 25.0, 30.0), late))]
    (found,) = sighting._given_up(ir, film, others)
    assert found.startswith("the preference is given up for shot `see`")
    assert told in found

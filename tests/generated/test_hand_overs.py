"""Shots of two drones that are drawn leave each other room in the moment of a hand-over, too."""

from __future__ import annotations

import numpy as np
import pytest

from tests.support.generated.surroundings import apart
from tests.support.generated.takes import Rules, Take

RULES = Rules(1.0, 1.0, 6.0, "center")


def take(begin: float, at: float) -> Take:
    """Return a shot of five seconds from a place on the line of x."""
    return Take("a", "cam", (), {}, np.tile([at, 0.0, 5.0], (6, 1)), np.linspace(begin, begin + 5.0, 6), 5.0)


@pytest.mark.parametrize(("begin", "at", "has_room"), [(5.0, 4.0, False), (5.0, 9.0, True), (5.1, 4.0, True)])
def test_a_shot_that_begins_as_another_ends_has_a_place_of_its_own(
    begin: float, at: float, has_room: bool
) -> None:
    assert apart(take(0.0, 0.0), take(begin, at), RULES) is has_room

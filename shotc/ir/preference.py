"""What a preference may cost: the one rule for all that a mission prefers and does not require.

A preference moves a camera, from where it would be without it, by at most a share of its distance from
what it films, and crops nothing. Where that does not suffice it is given up for the whole shot, which is
planned as if it were off. Plain Python.
"""

from collections.abc import Iterable
from typing import NamedTuple

from shotc.ir.mission import MissionIR

MOST_MOVED = 0.2
"""Share of its distance from what it films that a preference moves a camera by.

The subject is then at most a fourth larger or a sixth smaller, and the view of it turns by at most
asin(0.2), 11.5 deg: less than what reads as another shot.
"""

UNWATCHED = 10.0
"""Metres that count as the distance where a shot films nothing that has a name."""

LONGEST_WAIT = 10.0
"""Seconds that a drone waits for a preference with an unfilmed way, where that makes what follows later."""

GIVEN_UP, SHARE, SUFFICES = "preference_given_up", "preference_share", "preference_suffices"
"""The statistics ``SHOT.name`` of a preference that a shot gives up, as in ``Price``."""


class Price(NamedTuple):
    """What a preference that a shot gives up would have cost.

    moved : metres from the place without it, where that is the largest share of what it may be
    share : the same over the distance from what the shot films
    suffices : whether it would have been met then
    """

    moved: float
    share: float
    suffices: bool


def prefers_free_pictures(mission: MissionIR) -> bool:
    """Tell whether drones keep out of each other's pictures only as far as the rule goes."""
    return mission.rules.visibility == "prefer"


def given_up(stats: Iterable[tuple[str, float | str]], shot: str) -> Price | None:
    """Return by the statistics of a plan what a shot gives up, None where nothing."""
    by_name = dict(stats)
    values = [by_name.get(f"{shot}.{name}") for name in (GIVEN_UP, SHARE, SUFFICES)]
    if not all(isinstance(value, float) for value in values):
        return None
    moved, share, suffices = (float(value or 0.0) for value in values)
    return Price(moved, share, suffices > 0.0)


def noted(shot: str, price: Price) -> tuple[tuple[str, float | str], ...]:
    """Return a price as statistics of a plan."""
    values = ((GIVEN_UP, price.moved), (SHARE, price.share), (SUFFICES, float(price.suffices)))
    return tuple((f"{shot}.{name}", value) for name, value in values)

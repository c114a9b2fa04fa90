"""The cost that a preference may have: one rule for everything that a mission prefers but does not require.

A preference may move a camera by at most a share of its distance from its target, and may crop nothing. If
that does not suffice, the preference is given up for the whole shot, which is then planned without it. Plain
Python.
"""

from collections.abc import Iterable
from typing import NamedTuple

from shotc.ir.mission import MissionIR

MOST_MOVED_SHARE = 0.2
"""Largest displacement of a camera by a preference, as a share of its distance from its target.

The subject is then at most a fourth larger or a sixth smaller, and its view turns by at most asin(0.2) =
11.5 deg. A viewer still sees the same shot.
"""

PICTURE_SHARE = 0.5
"""Share of the distance to its target by which a shot may leave its ideal for its picture.

It may do so for a promise about its subjects, or because something hides them.
"""

UNWATCHED_M = 10.0
"""Distance that counts for a shot without a named target, metres."""

LONGEST_WAIT_S = 10.0
"""Longest wait with a transfer for a preference, if it delays the next leg, seconds."""

GIVEN_UP, SHARE, SUFFICES = "preference_given_up", "preference_share", "preference_suffices"
"""Names of the statistics ``SHOT.name`` of a preference that a shot gives up; fields as in ``Price``."""


class Price(NamedTuple):
    """The cost of a preference that a shot gives up.

    moved : displacement that it would need, metres, where it is the largest share of the distance
    share : the same over the distance from the target
    suffices : whether this displacement would meet the preference
    """

    moved: float
    share: float
    suffices: bool


def prefers_free_pictures(mission: MissionIR) -> bool:
    """Return whether free pictures of other drones are a preference, not a requirement."""
    return mission.rules.visibility == "prefer"


def given_up(stats: Iterable[tuple[str, float | str]], shot: str) -> Price | None:
    """Return the cost of the preference that a shot gives up, from a plan's statistics; None if it gives up
    none.
    """
    by_name = dict(stats)
    values = [by_name.get(f"{shot}.{name}") for name in (GIVEN_UP, SHARE, SUFFICES)]
    if not all(isinstance(value, float) for value in values):
        return None
    moved, share, suffices = (float(value or 0.0) for value in values)
    return Price(moved, share, suffices > 0.0)


def noted(shot: str, price: Price) -> tuple[tuple[str, float | str], ...]:
    """Return a price as statistics of a plan; ``given_up`` reads them."""
    values = ((GIVEN_UP, price.moved), (SHARE, price.share), (SUFFICES, float(price.suffices)))
    return tuple((f"{shot}.{name}", value) for name, value in values)

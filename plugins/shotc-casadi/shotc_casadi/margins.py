"""Margins to the limits, so that these hold between the nodes too; they grow from round to round."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

REACH_M, FAR_M = 8.0, 200.0  # an obstacle counts up to this far beyond its clearance, m: at first, and then
SLIGHT_M = 0.2  # m of lack: less is a bend between nodes, more is an obstacle that the problem did not know
CLEARANCE_STEP_M = 0.02  # m added to the clearance that was missing
LIMIT_STEP_RATIO = 1.2  # times the share that was missing
LITTLE_SHARE = 0.02  # share of the room beyond the clearances that is kept if the picture needs room
GAIN_SHARE = 0.9  # of the error before; a round that leaves more has not helped
HOLD_WEIGHT = 1e5  # larger than all weights of the picture
HOLD_STEP_RATIO = 30.0  # growth in each round in which the convex path shows more of the targets


class Check(NamedTuple):
    """The remaining errors, the most important first.

    lack : clearance that is not proved for all s (Bernstein hulls), metres; 0 is proved
    late : share by which the fastest flight misses a time that is asked for
    hidden : share by which targets are less free than from the convex path (``covered.lost``)
    cropped : how far the target is outside the frame at most, half frames
    """

    lack: float
    late: float
    hidden: float
    cropped: float

    @property
    def holds(self) -> bool:
        """Whether no error is left."""
        return max(self) <= 0.0

    def helped(self, before: Check) -> bool:
        """Return whether any error has become clearly smaller than ``before``."""
        return any(now < GAIN_SHARE * then for now, then in zip(self, before, strict=True))


@dataclass(frozen=True, slots=True)
class Margins:
    """The margins of one round.

    clearance : metres added to the clearance from obstacles
    reach : metres beyond its clearance within which an obstacle counts
    limits : share of the drone's and the gimbal's limits to use
    comfort : share to keep of the room that the convex path has beyond its clearances
    hold : factor on the weight of the distance from the convex path
    """

    clearance: float = 0.0
    reach: float = REACH_M
    limits: float = 1.0
    comfort: float = 0.5
    hold: float = 1.0


def tighter(margins: Margins, check: Check, *, hold: bool) -> Margins:
    """Return margins that compensate what a check found; hold : keep near the convex path."""
    lacks = check.lack > 0
    known = margins.reach == FAR_M or check.lack < SLIGHT_M
    return Margins(
        clearance=margins.clearance + (check.lack + CLEARANCE_STEP_M if lacks and known else 0.0),
        reach=FAR_M if lacks else margins.reach,
        limits=margins.limits / (1.0 + LIMIT_STEP_RATIO * check.late),
        comfort=LITTLE_SHARE if check.cropped > 0 else margins.comfort,
        hold=_hold(margins, check, hold=hold),
    )


def _hold(margins: Margins, check: Check, *, hold: bool) -> float:
    """Return the factor on the weight of the distance from the convex path."""
    if hold and check.lack > 0:
        return HOLD_WEIGHT
    return min(HOLD_WEIGHT, HOLD_STEP_RATIO * margins.hold) if check.hidden > 0 else margins.hold

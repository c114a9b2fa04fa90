"""What is kept from the limits so that they hold between the nodes, too; it grows from round to round."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

REACH_M, FAR_M = 8.0, 200.0  # metres beyond its clearance within which an obstacle counts, at first and then
SLIGHT_M = 0.2  # metres lacking that are a bend between the nodes, no obstacle that the problem did not know
CLEARANCE_STEP_M = 0.02  # metres added to what was missing
LIMIT_STEP_RATIO = 1.2  # times what was missing
LITTLE_SHARE = 0.02  # share of the room beyond the clearances that is kept where the picture needs the rest
GAIN_SHARE = 0.9  # of what was open before; a round that leaves more has helped nothing
HOLD_WEIGHT = 1e5  # more than the picture is worth
HOLD_STEP_RATIO = 30.0  # times as much, round by round, where the convex path shows more of the targets


class Check(NamedTuple):
    """What is left open, the worst first.

    lack : metres by which clearance is not proved for all s (Bernstein hulls); 0 is proved
    late : share of a time asked for by which the fastest flight is too slow
    hidden : share by which targets are free less than from the convex path (``covered.lost``)
    cropped : the most that the target sticks out of the frame, half frames
    """

    lack: float
    late: float
    hidden: float
    cropped: float

    @property
    def holds(self) -> bool:
        """Whether nothing is left open."""
        return max(self) <= 0.0

    def helped(self, before: Check) -> bool:
        """Tell whether anything that was open has become notably better."""
        return any(now < GAIN_SHARE * then for now, then in zip(self, before, strict=True))


@dataclass(frozen=True, slots=True)
class Margins:
    """What is kept from the limits.

    clearance : metres kept from obstacles beyond what the convex path kept
    reach : metres beyond its clearance within which an obstacle counts
    limits : share of the drone's and the gimbal's limits that may be used
    comfort : share kept of the room that the convex path has beyond its clearances
    hold : factor on the price of leaving the convex path
    """

    clearance: float = 0.0
    reach: float = REACH_M
    limits: float = 1.0
    comfort: float = 0.5
    hold: float = 1.0


def tighter(margins: Margins, check: Check, *, hold: bool) -> Margins:
    """Return margins that make up for what a check found; hold : keep to the convex path."""
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
    """Return the factor on the price of leaving the convex path."""
    if hold and check.lack > 0:
        return HOLD_WEIGHT
    return min(HOLD_WEIGHT, HOLD_STEP_RATIO * margins.hold) if check.hidden > 0 else margins.hold

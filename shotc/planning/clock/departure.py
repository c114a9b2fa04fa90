"""The choice of a transfer and of its departure time, so that it keeps clear of everything that moves.

A drone departs as late as it can and still arrives in time; without a deadline it departs at once. If that
transfer comes too near to a target or to another drone, other departure times are tried, then transfers
around or above. On the pad, during take-off and during landing only the radius of the body counts, as in
verification.

A transfer that comes too near to a target would fail verification. It is returned only if there is no other,
not even a late one. The same holds for one that breaks a clearance of transfers that the mission states.
Where the mission states none, these clearances are a preference: a transfer that is in time keeps them if it
can, but nothing waits long for them. In the same way a transfer leaves the places free where drones that are
planned later film at fixed times.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.pieces import Mask
from shotc.geom.solid_arrays.points import distances
from shotc.geom.taper import TAPER_SLOPE, Taper
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.owners import Owner
from shotc.ir.path import MovingLeg, PathLeg
from shotc.ir.phases import PhaseName
from shotc.ir.preference import LONGEST_WAIT_S
from shotc.planning.clock.moving import Moving
from shotc.planning.clock.shot import OtherVehicles
from shotc.planning.clock.visibility import seen_on
from shotc.planning.timing.timed_leg import leg_motion

STEP_S = 0.05  # seconds between samples
COMFORT_M = 0.5  # metres beyond a clearance: twice the approach of two drones in a step
EARLY_S = 1.0  # seconds by which a drone is early, if it has the time
HASTE_SHARE = 0.9  # share of EARLY_S that is given up if something passes its place
DELAYS_S = (0.0, 2.0, 4.0, 7.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 90.0, 120.0)  # seconds of waiting
WAIT_SHARES = (1.0, 0.8, 0.6, 0.4, 0.2, 0.0)  # shares of the spare time that it waits
CLOSER_PARTS, REFINEMENTS = 20, 2  # parts of a refined step near a target, and refinements
LEAVES_S = 3.0  # seconds after a shot, in which the drone gets away from its end
PROVED_M = 1e-6  # metres
WAITED_M = 1e3  # metres, penalty for a clearance that costs too long a wait


@dataclass(frozen=True, slots=True)
class TargetConflict:
    """The place where a transfer comes too near to a target, by ``lack`` metres at mission time ``time``.

    phase : "takeoff" or "land" at the pad, "transit" elsewhere
    """

    owner: Owner
    time: float
    lack: float
    phase: PhaseName = "transit"


@dataclass(frozen=True, slots=True, eq=False)
class Transfer:
    """Unfilmed legs; the first one has its departure time.

    end : mission time at which the last leg ends, seconds
    slack : least slack over clearances, metres, with the next leg and some seconds after it
    on_way : the same until the next leg begins
    unseen : least distance out of the pictures of others, metres
    met : the target that it comes too near to, if there is one
    kept : least slack over the clearances of transfers, metres
    required : the same over those that the mission states
    """

    legs: tuple[MovingLeg, ...]
    end: float
    slack: float = inf
    on_way: float = inf
    unseen: float = inf
    met: TargetConflict | None = None
    kept: float = inf
    required: float = inf

    @property
    def clear(self) -> bool:
        """Whether it keeps its clearances from everything that moves."""
        return self.slack >= COMFORT_M and self.required >= -PROVED_M


@dataclass(frozen=True, slots=True, eq=False)
class NextLeg:
    """A leg that is flown after a transfer, at mission time ``ready`` or later."""

    leg: PathLeg
    ready: float


@dataclass(frozen=True, slots=True)
class When:
    """The time window of a transfer, mission times in seconds.

    ready : earliest departure
    deadline : of the arrival, if there is one
    stays : the drone stands at the end of the transfer at least until then
    """

    ready: float
    deadline: float | None = None
    stays: float = 0.0


def choose(
    mission: MissionIR,
    drone: Drone,
    others: OtherVehicles,
    candidates: Iterable[list[MovingLeg]],
    when: When,
    then: NextLeg | None = None,
) -> Transfer | None:
    """Return the first transfer that is in time and clear, else the best one; None if there is none.

    The best is chosen lexicographically: no target too near, then no drone too near, then the stated
    clearances of transfers, then the least delay, then the other clearances of transfers, then the slack,
    then the pictures of others. The order follows verification, which refuses what is too near. A shot that
    is late can still be put off, or be reported with its earliest start. Where a start is given, every
    transfer in time leads to the same next leg, so nothing near that leg makes a late transfer better.

    candidates : legs of each candidate, the preferred ones first
    then : the next leg, which has to be clear as well
    """
    tried: list[Transfer] = []

    def waits(transfer: Transfer) -> float:
        """Return the seconds that the next leg waits longer than with the first candidate."""
        ready = 0.0 if then is None else then.ready
        return 0.0 if when.deadline is not None else max(transfer.end, ready) - max(tried[0].end, ready)

    for legs in candidates:
        for transfer in _tries(mission, drone, others, legs, when, then):
            in_time = when.deadline is None or transfer.end <= when.deadline
            tried.append(transfer)
            fine = (
                _unseen(others, transfer, waits(transfer)) >= 0.0
                and _transfer_slack(transfer, waits(transfer)) >= -PROVED_M
            )
            if transfer.clear and fine and (in_time or len(tried) == 1):
                return transfer
        if not others.moving:
            break
    deadline = inf if when.deadline is None else when.deadline

    def worth(transfer: Transfer) -> tuple[bool, bool, float, float, bool, float, float, float]:
        late = max(0.0, transfer.end - deadline)
        lack = min(_transfer_slack(transfer, waits(transfer)), 0.0)
        unseen = _unseen(others, transfer, waits(transfer))
        required = min(transfer.required, 0.0)
        apart = transfer.slack if when.deadline is None else transfer.on_way
        return (
            transfer.met is None,
            apart >= 0.0,
            required,
            -late,
            transfer.slack >= 0.0,
            lack,
            min(transfer.slack, COMFORT_M),
            unseen,
        )

    return max(tried, key=worth, default=None)


def _transfer_slack(transfer: Transfer, waits: float) -> float:
    """Return the slack of a transfer over the clearances of transfers, metres.

    A penalty is subtracted where the next leg would wait longer for it than a preference may cost.
    """
    return transfer.kept if waits <= LONGEST_WAIT_S else min(transfer.kept, 0.0) - WAITED_M


def _unseen(others: OtherVehicles, transfer: Transfer, waits: float) -> float:
    """Return how far a transfer is out of the pictures of others, metres, where that counts; waits : as in
    ``_transfer_slack``.

    Where free pictures are only preferred, the result is 0 if the preference is met at an acceptable wait,
    else minus infinity.
    """
    if not others.visibility.preferred:
        return transfer.unseen
    return 0.0 if transfer.unseen >= 0.0 and waits <= LONGEST_WAIT_S else -inf


def _tries(
    mission: MissionIR,
    drone: Drone,
    others: OtherVehicles,
    legs: list[MovingLeg],
    when: When,
    then: NextLeg | None,
) -> Iterator[Transfer]:
    begin, deadline = when.ready, when.deadline
    curves = [motion.curve for leg in legs if (motion := leg_motion(drone, leg)) is not None]
    duration = sum(float(curve.end) for curve in curves)
    next_motion = None if then is None else leg_motion(drone, then.leg)
    film = None if next_motion is None else next_motion.curve.channels(0, 1, 2)
    spare = 0.0 if deadline is None else max(0.0, deadline - EARLY_S - begin - duration)
    shares = (
        *(share * spare for share in WAIT_SHARES),
        *((spare + HASTE_SHARE * EARLY_S,) if spare > 0.0 else ()),
    )
    delays = DELAYS_S if deadline is None else tuple(dict.fromkeys(shares))
    for delay in delays:
        leaves = begin + delay
        started = [replace(leg, start=leaves) if i == 0 else leg for i, leg in enumerate(legs)]
        if not others.moving:
            yield Transfer(tuple(started), leaves + duration)
            return
        end = max(leaves + duration, when.stays, deadline or 0.0, 0.0 if then is None else then.ready)
        course = _Course(legs, [c.channels(0, 1, 2) for c in curves], leaves, film, end)
        times = np.arange(begin, end + (0.0 if film is None else float(film.end) + LEAVES_S) + STEP_S, STEP_S)
        places, upright = course.at(times), course.upright(times)
        until_then = times <= end
        slacks = np.min(
            [_slacks(what, drone.radius, times, places, upright) for what in others.moving], axis=0
        )
        slack, on_way = float(slacks.min(initial=inf)), float(slacks[until_then].min(initial=inf))
        unseen = seen_on(drone, others.visibility, times, places)
        met = _nearest_target(others.moving, drone.radius, course, times[until_then])
        between = until_then & ~upright
        kept_from = (*others.moving, *others.later)
        apart = [(what, _apart(what, times[between], places[between])) for what in kept_from]
        required_slack = min((lack for _, lack in apart), default=inf)
        required = min((lack for what, lack in apart if what.required), default=inf)
        yield Transfer(
            tuple(started), leaves + duration, slack, on_way, unseen, met, required_slack, required
        )


@dataclass(frozen=True, slots=True, eq=False)
class _Course:
    """The position of a drone before, during and after a transfer.

    curves : positions over the time of each leg that takes time
    leaves : mission time of the departure
    film : positions of a shot on a path that it flies from mission time ``end`` on, if there is one
    """

    legs: list[MovingLeg]
    curves: Sequence[Piecewise]
    leaves: float
    film: Piecewise | None
    end: float

    def at(self, times: Array) -> Array:
        """Return positions (M, 3) at mission times (M,); the drone stands before and after."""
        places = np.tile(np.array(self.legs[0].pose[:3]), (len(times), 1))
        begin = self.leaves
        for curve in self.curves:
            _from(places, times, begin, curve)
            begin += float(curve.end)
        if self.film is not None:
            _from(places, times, self.end, self.film)
        return places

    def upright(self, times: Array) -> Mask:
        """Return whether the drone is on its pad, takes off or lands at times (M,); then only its body
        counts.
        """
        takes_off, lands = self._lifts()
        return np.asarray((times <= takes_off) | (times >= lands))

    def phase(self, t: float) -> PhaseName:
        """Return the phase at a mission time: take-off, landing, or else transit."""
        takes_off, lands = self._lifts()
        return "takeoff" if t <= takes_off else "land" if t >= lands else "transit"

    def _lifts(self) -> tuple[float, float]:
        """Return the mission times at which take-off ends and landing begins; infinite without one."""
        takes_off, lands, begin = -inf, inf, self.leaves
        for leg, curve in zip(self.legs, self.curves, strict=False):
            end = begin + float(curve.end)
            takes_off = end if leg.phase == "takeoff" else takes_off
            lands = begin if leg.phase == "land" else lands
            begin = end
        return takes_off, lands


def _from(places: Array, times: Array, begin: float, curve: Piecewise) -> None:
    """Write the positions of a curve that begins at a time into ``places``."""
    inside = times >= begin
    places[inside] = curve(np.minimum(times[inside] - begin, float(curve.end)))


def _slacks(what: Moving, radius: float, times: Array, places: Array, upright: Mask) -> Array:
    """Return the slack over the clearance from something that moves at times (M,), metres.

    radius : of the body, which is the clearance at the pad
    """
    return np.asarray(distances(what.part, places - what.at(times)) - _needs(what, radius, upright))


def _apart(what: Moving, times: Array, places: Array) -> float:
    """Return the least slack over the clearance of transfers from something that moves, metres.

    It does not taper towards an end of the transfer at which this is not there.
    """
    here = what.is_there(times)
    if what.apart <= what.clearance or not here.any():
        return inf
    beside = (places - what.at(times))[here]
    ends = beside[[i for i in (0, -1) if here[i]]]
    taper = Taper(what.apart, TAPER_SLOPE, ends, distances(what.part, ends))
    return float((distances(what.part, beside) - taper.needs(beside)).min())


def _needs(what: Moving, radius: float, upright: Mask) -> Array:
    """Return the clearance from something that moves, shape (M,), metres."""
    return np.where(upright & (not what.always), radius, what.clearance)


def _nearest_target(
    moving: Sequence[Moving], radius: float, course: _Course, times: Array
) -> TargetConflict | None:
    """Return the target that a course comes nearest to, if that is too near."""
    nearest = [_nearest(what, radius, course, times) for what in moving if not what.always]
    worst = max(nearest, key=lambda met: met.lack, default=None)
    return worst if worst is not None and worst.lack > PROVED_M else None


def _nearest(what: Moving, radius: float, course: _Course, times: Array) -> TargetConflict:
    """Return where a course is nearest to a target, with sampling refined around the minimum for
    verification.
    """
    step, most, when = STEP_S, -inf, float(times[0])
    for _ in range(1 + REFINEMENTS):
        lack = _needs(what, radius, course.upright(times)) - distances(
            what.part, course.at(times) - what.at(times)
        )
        most, when = float(lack.max()), float(times[int(lack.argmax())])
        inside = np.linspace(max(when - step, times[0]), min(when + step, times[-1]), 2 * CLOSER_PARTS + 1)
        step, times = step / CLOSER_PARTS, inside
    return TargetConflict(what.owner, when, most, course.phase(when))

"""Finds the way home of one fleet from any time of its flight, and makes its claims."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from shotc.collective.braking import FlightSpline
from shotc.geom.bernstein import Array
from shotc.geom.fleet_pieces import rates
from shotc.geom.fleet_spline import DEGREE, rest_of
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.limits import Limits
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.claims import Limit, WorstValue, held
from shotc.passes.verify.fleets.apart import from_parked, separations
from shotc.passes.verify.fleets.cameras import from_cameras
from shotc.passes.verify.fleets.flight import FleetFlight
from shotc.passes.verify.fleets.motion import motion
from shotc.passes.verify.fleets.pyro import burning_at, still_burning
from shotc.passes.verify.fleets.shape import landed
from shotc.passes.verify.fleets.space import space
from shotc.show.assignment.home import come_home
from shotc.show.assignment.moves import Mover
from shotc.show.assignment.score import FlightScore
from shotc.show.geom.windows import at_rest, windows


@dataclass(frozen=True, slots=True, eq=False)
class FleetReturn:
    """The return of one fleet from one time of its show.

    rest : time of its rest, seconds
    over : time at which it is over its pads, seconds
    down : time at which it has landed, seconds
    track : the unplanned part of its flight, with its braking or from its rest on; None if the fleet stands
        on its pads or is on its planned return
    claims : claims on that part
    waits : seconds that it waits at rest for others to pass
    """

    fleet: str
    rest: float
    over: float
    down: float
    track: FleetTrajectory | None
    claims: tuple[Claim, ...]
    waits: float = 0.0

    @property
    def holds(self) -> bool:
        """Return whether all its claims hold."""
        return all(claim.holds for claim in self.claims)


WAITS_S = (3.0, 6.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0)
"""Seconds that a fleet waits at rest for others to pass."""
NEAR_S = 1e-6
"""Seconds, below which two times count as equal."""

_Way = Callable[[int, float], FleetReturn]
"""Makes a return from the index of a break at which the fleet stops, and the time of its
departure, seconds.
"""


class Homing:
    """Finds the returns of one fleet of a plan."""

    def __init__(self, ir: TrajectoryIR, flight: FleetTrajectory) -> None:
        self.ir, self.flight, mission = ir, flight, ir.keyframes.mission
        self.fleet = mission.fleet(flight.fleet)
        self._course = FlightSpline(flight.breaks, flight.coef)
        self._mover = Mover(mission, self.fleet, advises=False)
        self._stops = at_rest(flight.coef)
        self._lifted = float(flight.breaks[windows(flight.coef)[0].first])
        self._homeward = next(phase.start for phase in flight.phases if phase.name == "return")
        # The claims are the same for all times at one stop only if nothing around it moves or burns.
        burns = any(display.pyro for display in mission.displays if display.fleet == flight.fleet)
        still = all(target.track is None for target in mission.targets)
        self._same = still and not burns and not ir.drones
        self._known: dict[tuple[_Way, int], FleetReturn] = {}

    def at(self, time: float) -> FleetReturn:
        """Return the first way home from a time whose claims hold, or else the first one tried."""
        name, end = self.flight.fleet, float(self.flight.breaks[-1])
        if time <= self._lifted:
            return FleetReturn(name, time, time, time, None, ())
        if time >= self._homeward:
            over = self.flight.phases[-1].start
            return FleetReturn(name, time, max(time, over), max(time, end), None, ())
        tried: list[FleetReturn] = []
        for fleet_return in self.ways(time):
            if fleet_return.holds:
                return fleet_return
            tried.append(fleet_return)
        # Waiting lets a camera pass and a pyrotechnic product burn out.
        if self.ir.drones or burning_at(self.ir.keyframes.mission, name, time):
            waited = (
                self.waiting(fleet_return, seconds) for seconds, fleet_return in product(WAITS_S, tried)
            )
            return next((fleet_return for fleet_return in waited if fleet_return.holds), tried[0])
        return tried[0]

    def ways(self, time: float) -> Iterator[FleetReturn]:
        """Yield the ways home from a time at which the fleet is in the air and not yet on its
        planned return.
        """
        for fleet_return in self._ways(time):
            yield replace(fleet_return, claims=(*fleet_return.claims, self._endurance(fleet_return.down)))

    def waiting(self, fleet_return: FleetReturn, seconds: float) -> FleetReturn:
        """Return a way home on which the fleet waits for some seconds at its rest."""
        track = fleet_return.track
        assert track is not None
        at = int(np.searchsorted(track.breaks, fleet_return.rest - NEAR_S))
        breaks = np.concatenate([track.breaks[: at + 1], track.breaks[at:] + seconds])
        coef = np.insert(track.coef, at + 1, track.coef[:, at], axis=1)
        phases = tuple(
            replace(p, start=p.start + seconds * (p.start > fleet_return.rest + NEAR_S), end=p.end + seconds)
            for p in track.phases
        )
        flown = self._claimed(replace(track, breaks=breaks, coef=coef, phases=phases), fleet_return.rest)
        claims = (*flown.claims, self._endurance(flown.down))
        return replace(flown, claims=claims, waits=seconds)

    def flown(self, time: float, fleet_return: FleetReturn) -> tuple[Array, Array]:
        """Return the whole flight from the time of a return on: breaks (P + 1,) and control points (n, P + 3,
        3).
        """
        if fleet_return.track is None and time <= self._lifted:  # it does not take off any more
            return np.array([time, time + 1.0]), np.repeat(self.flight.coef[:, :1], DEGREE + 1, axis=1)
        planned = rest_of(self.flight.breaks, self.flight.coef, time)
        if fleet_return.track is None:
            return planned
        if float(fleet_return.track.breaks[0]) <= time:
            return fleet_return.track.breaks, fleet_return.track.coef
        breaks, coef = planned
        count = int(np.searchsorted(breaks, fleet_return.rest)) + 1
        return (
            np.concatenate([breaks[:count], fleet_return.track.breaks[1:]]),
            np.concatenate([coef[:, : count + DEGREE - 1], fleet_return.track.coef[:, DEGREE:]], axis=1),
        )

    def _ways(self, time: float) -> Iterator[FleetReturn]:
        """Yield the ways home: from where it brakes, from its next stop, and back along its flown path."""
        breaks = self.flight.breaks
        stop = int(self._stops[np.searchsorted(breaks[self._stops], time)])
        rest = float(breaks[stop])
        before = breaks[self._stops] <= time
        standing = before.any() and stop - int(self._stops[before][-1]) == 1
        if standing:
            rest = time
        else:
            braked = self._course.braked(time, rest, self.fleet.limits)
            if braked is not None:
                score = FlightScore.after(braked.breaks, braked.coef)
                yield self._judged(score, float(braked.breaks[-1]))
        yield self._once(self._from_stop, stop, rest)
        yield self._once(self._as_it_came, stop, rest)

    def _once(self, make_return: _Way, stop: int, time: float) -> FleetReturn:
        """Return a way home from a stop; it is verified only once if nothing around it moves or burns."""
        known = self._known.get((make_return, stop))
        if known is None or not self._same:
            known = self._known[make_return, stop] = make_return(stop, time)
        return _moved(known, time)

    def _from_stop(self, stop: int, time: float) -> FleetReturn:
        """Return the direct way home from a stop."""
        return self._judged(FlightScore(self._at_stop(stop), time), time)

    def _judged(self, score: FlightScore, rest: float) -> FleetReturn:
        """Return the way home of a fleet at rest, with its claims."""
        come_home(score, self._mover)
        return self._proved(score, rest)

    def _as_it_came(self, stop: int, time: float) -> FleetReturn:
        """Return the way home back along the flown path up to a stop, which is free of standing obstacles."""
        coef, breaks = self.flight.coef, self.flight.breaks
        flown = [w for w in windows(coef) if w.last <= stop]
        score = FlightScore(self._at_stop(stop), time)
        for k, window in reversed(list(enumerate(flown))):
            if k == 0:
                score.phase("return")
            own, ctrl = window.breaks(breaks), coef[:, window.points]
            score.retrace(own, ctrl, _slower(own, ctrl, self.fleet.limits))
        score.phase("land")
        return self._proved(score, time)

    def _proved(self, score: FlightScore, rest: float) -> FleetReturn:
        return self._claimed(score.trajectory(self.flight.fleet, self.flight.lights), rest)

    def _claimed(self, track: FleetTrajectory, rest: float) -> FleetReturn:
        """Return a way home with the claims on its track."""
        over, down = track.phases[-1].start, track.phases[-1].end
        flight = FleetFlight.of(self.ir.keyframes.mission, track)
        claims = (
            *motion(flight),
            *space(flight),
            *separations([flight]),
            *from_parked(self.ir, [flight]),
            *from_cameras([flight], self.ir.drones, float(track.breaks[0])),
            *still_burning(self.ir, flight, float(track.breaks[0])),
            landed(flight),
        )
        return FleetReturn(self.flight.fleet, rest, over, down, track, claims)

    def _endurance(self, down: float) -> Claim:
        limit = Limit("endurance", self.fleet.endurance, "s", (*self.fleet.path, "endurance"))
        return held(self.fleet.name, limit, WorstValue(down - self._lifted, down, "exact"))

    def _at_stop(self, stop: int) -> Array:
        return self.flight.coef[:, stop]


def _slower(breaks: Array, coef: Array, limits: Limits) -> float:
    """Return the factor on the time of a flight that is flown backwards, where climb becomes descent."""
    up = rates(breaks, coef, 1)[..., 2]
    return max(1.0, float(up.max()) / limits.descent, -float(up.min()) / limits.climb)


def _moved(known: FleetReturn, time: float) -> FleetReturn:
    """Return the same way home, shifted to another time of rest."""
    if time == known.rest or known.track is None:
        return known
    claims = tuple(c if c.time is None else replace(c, time=c.time - known.rest + time) for c in known.claims)
    track = replace(
        known.track,
        breaks=known.track.breaks - known.rest + time,
        phases=tuple(
            replace(p, start=p.start - known.rest + time, end=p.end - known.rest + time)
            for p in known.track.phases
        ),
    )
    over, down = known.over - known.rest + time, known.down - known.rest + time
    return FleetReturn(known.fleet, time, over, down, track, claims)

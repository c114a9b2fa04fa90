"""What to change about a product that comes too near to something: a moment, drones, or a distance.

Moments and drones are searched on samples of the flight. They are proposed only if all claims of
``verify.fleets.pyro`` hold with them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.geom.pieces import Mask
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.show import Display, PyroCue, rows_of
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.fleets.burning import sampled_distances
from shotc.passes.verify.fleets.flight import FleetFlight
from shotc.passes.verify.fleets.pyro import cue_claims
from shotc.rounding import at_least, at_most

STEP_S = 0.5
"""Time between samples, and between moments that are tried."""
MOST_TRIED = 6
"""Most moments, and most choices of drones, that are proved."""
OTHERWISE = "fire it at another moment or from other drones"


def pyro_advice(ir: TrajectoryIR, claim: Claim) -> str:
    """Return the change with which a product of a broken claim keeps its distances."""
    firing = _Firing.of(ir, claim)
    moment = next(firing.moments(), None)
    drones = next(firing.drones(), None)
    remedies = []
    if moment is not None:
        remedies.append(f"write `at: {moment:g} s`")
    if drones is not None:
        remedies.append(f"fire it from `drones: [{', '.join(map(str, drones))}]`")
    clear = firing.clear()
    if clear > 0.0:
        remedies.append(f"write `clear: {clear:g} m` if the product and your permit allow that")
    if moment is None and drones is None and claim.unit == "s":
        remedies.insert(0, firing.within())
    return ", or ".join(remedies) or OTHERWISE


@dataclass(frozen=True, slots=True, eq=False)
class _Firing:
    """A cue of a display with what is around it.

    times : samples of the flight, shape (T,), s
    apart : distances of the fleet's drones from the nearest other drone there, shape (n, T), metres
    """

    ir: TrajectoryIR
    flights: Sequence[FleetFlight]
    flight: FleetFlight
    display: Display
    cue: PyroCue
    times: Array
    apart: Array

    @staticmethod
    def of(ir: TrajectoryIR, claim: Claim) -> _Firing:
        mission = ir.keyframes.mission
        display, cue = next(
            (display, cue)
            for display in mission.displays
            for cue in display.pyro
            if cue.path == claim.path[: len(cue.path)]
        )
        flights = [FleetFlight.of(mission, track) for track in ir.fleets]
        flight = next(flight for flight in flights if flight.fleet.name == display.fleet)
        aloft = flight.free()
        count = max(2, int((aloft[-1][1] - aloft[0][0]) / STEP_S) + 1)
        times = np.linspace(aloft[0][0], aloft[-1][1], count)
        return _Firing(ir, flights, flight, display, cue, times, _apart(ir.fleets, flight.track, times))

    def moments(self) -> Iterator[float]:
        """Yield moments at which the same drones could fire it, the nearest to the asked one first."""
        cue, rows = self.cue, list(rows_of(self.flight.fleet, self.cue))
        fires = self._least(rows, np.full(len(self.times), True)).min(axis=0)
        shifts = np.arange(self.times[0] - cue.ignition, self.times[-1] - cue.end, STEP_S)
        shifts = STEP_S * np.round(shifts / STEP_S)
        able = [s for s in shifts if s and self._sampled(fires, cue.ignition + s, cue.end + s)]
        for shift in sorted(able, key=abs)[:MOST_TRIED]:
            moved = cue._replace(time=round(cue.time + float(shift), 3))
            if not self._burn_others(moved, moved.drones) and self._holds(moved):
                yield moved.time

    def drones(self) -> Iterator[tuple[int, ...]]:
        """Yield as many drones that could fire it at its moment, those farthest from others first."""
        cue, numbers = self.cue, self.flight.fleet.numbers
        during = (self.times >= cue.ignition) & (self.times <= cue.end)
        if not during.any():
            return
        least = self._least(list(range(len(numbers))), during).min(axis=1)
        free = [k for k in np.argsort(-least, kind="stable") if not self._burn_others(cue, (numbers[k],))]
        able = [int(k) for k in free if least[k] >= cue.clear]
        for first in range(min(MOST_TRIED, len(able) - len(cue.drones) + 1)):
            chosen = tuple(sorted(numbers[k] for k in able[first : first + len(cue.drones)]))
            if self._holds(cue._replace(drones=chosen)):
                yield chosen

    def within(self) -> str:
        """Return when its effect may begin for it to burn in the air, in words."""
        cue, first, last = self.cue, float(self.times[0]), float(self.times[-1])
        earliest, latest = at_least(first + cue.prefire), at_most(last - cue.duration)
        return f"have it burn in the air: `at` between {earliest} s and {latest} s"

    def clear(self) -> float:
        """Return the distance that it keeps as it is, rounded down to a decimetre, metres."""
        claims = cue_claims(self.ir, self.flights, self.flight, self.display, self.cue)
        least = min((c.worst for c in claims if c.unit == "m"), default=0.0)
        return float(np.floor(10.0 * least) / 10.0) if np.isfinite(least) else 0.0

    def _least(self, rows: list[int], during: Mask) -> Array:
        """Return the least distances of some drones at some of the times, (len(rows), t), metres."""
        track = self.flight.track
        at = places(track.breaks, track.coef[rows], self.times[during])
        around = sampled_distances(self.flight, at.reshape(-1, 3)).reshape(at.shape[:2])
        if self.display.viewpoint is not None:
            around = np.minimum(around, np.linalg.norm(at - np.array(self.display.viewpoint), axis=2))
        return np.minimum(self.apart[rows][:, during], around)

    def _sampled(self, apart: Array, start: float, end: float) -> bool:
        during: Mask = (self.times >= start) & (self.times <= end)
        return bool(during.any() and apart[during].min() >= self.cue.clear)

    def _burn_others(self, cue: PyroCue, drones: Sequence[int]) -> bool:
        """Tell whether another product burns on one of some drones while a cue does."""
        others = (
            other
            for display in self.ir.keyframes.mission.displays
            if display.fleet == self.display.fleet
            for other in display.pyro
            if other.path != cue.path
        )
        return any(
            other.ignition < cue.end and cue.ignition < other.end and set(other.drones) & set(drones)
            for other in others
        )

    def _holds(self, cue: PyroCue) -> bool:
        claims = cue_claims(self.ir, self.flights, self.flight, self.display, cue)
        return all(claim.holds for claim in claims)


def _apart(fleets: Sequence[FleetTrajectory], own: FleetTrajectory, times: Array) -> Array:
    """Return the distances of a fleet's drones from the nearest other drone of all fleets, (n, T), metres."""
    distances = np.zeros((len(own.coef), len(times)))
    for k, time in enumerate(times):
        at = [places(f.breaks, f.coef, np.clip([time], f.breaks[0], f.breaks[-1]))[:, 0] for f in fleets]
        mine = at[next(i for i, fleet in enumerate(fleets) if fleet is own)]
        distances[:, k] = cKDTree(np.concatenate(at)).query(mine, k=2)[0][:, 1]
    return distances

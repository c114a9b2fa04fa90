"""bound-splines: ShowIR to ShowIR.

Takes flights whose animations may exceed the drones' limits. Gives every drone the nearest spline (in the
integral of the squared distance, *display* Sec. IV) whose velocity, acceleration and jerk are within the
limits for all t, with the same stops: the first and the last frame of an animation are reached exactly.
Drones within the limits are not changed. If no drone can fly an animation, the error names a period that is
enough.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.ir.fleet import FleetTrajectory, ShowIR
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.show import Fleet, drone_names
from shotc.rounding import at_least
from shotc.show.geom.windows import Window, windows
from shotc.show.solvers.move import least_piece, least_pieces
from shotc.show.solvers.qcqp import Bounded, DerivativeBounds, bounded, overdraft, short

CONTROL_DECIMALS = 6
"""Decimals of a metre in control points, as in ``assign-goals``."""


@dataclass(frozen=True, slots=True)
class BoundSplines:
    """The pass; it has no options."""

    name: ClassVar[str] = "bound-splines"

    def run(self, ir: ShowIR, ctx: PassContext) -> Outcome[ShowIR]:
        """Bring every fleet within its limits."""
        mission = ir.goals.keyframes.mission
        fleets, stats, faults = [], list(ir.stats), []
        for flight in ir.fleets:
            ctx.progress(f"limits of fleet {flight.fleet}")
            fitter = _Fitter(mission, mission.fleet(flight.fleet), flight)
            for window in windows(flight.coef):
                fitter.fit(window)
            faults += fitter.faults
            stats += fitter.stats()
            fleets.append(replace(flight, coef=fitter.coef))
        if faults:
            return Outcome(None, tuple(faults))
        return Outcome(replace(ir, fleets=tuple(fleets), stats=tuple(stats)))


class _Fitter:
    """Fits the windows of one fleet."""

    def __init__(self, mission: MissionIR, fleet: Fleet, flight: FleetTrajectory) -> None:
        self.mission, self.fleet, self.flight = mission, fleet, flight
        self.bounds = DerivativeBounds(fleet.limits)
        self.coef = flight.coef.copy()
        self.faults: list[Diagnostic] = []
        self.done: list[Bounded] = []

    def fit(self, window: Window) -> None:
        """Bring one window within the limits, or add a fault."""
        breaks = window.breaks(self.flight.breaks)
        reference = self.flight.coef[:, window.points]
        if not (overdraft(breaks, reference, self.bounds) > 0.0).any():
            return
        slow = self._slowest(breaks, reference)
        if slow is not None and bounded(breaks, reference[[slow]], self.bounds).failed.size:
            self.faults.append(self._too_quick(breaks, reference, slow))
            return
        result = bounded(breaks, reference, self.bounds)
        self.done.append(result)
        if len(result.failed):
            self.faults.append(self._too_quick(breaks, reference, int(result.failed[0])))
            return
        self.coef[:, window.points] = short(breaks, result.coef, self.bounds, CONTROL_DECIMALS)

    def _slowest(self, breaks: Array, reference: Array) -> int | None:
        """Return a drone that could not even fly straight from the first to the last position in time, or
        None.
        """
        displacements, pieces = reference[:, -1] - reference[:, 0], len(breaks) - 1
        least = least_pieces(pieces, displacements, self.fleet.limits)
        slow = int(np.argmax(least))
        return slow if least[slow] > np.diff(breaks).min() else None

    def _too_quick(self, breaks: Array, reference: Array, drone: int) -> Diagnostic:
        displacements = reference[:, -1] - reference[:, 0]
        period = least_piece(len(breaks) - 1, displacements, self.fleet.limits)
        distance = float(np.linalg.norm(displacements[drone]))
        return too_quick(self.mission, self.fleet, (self.flight, float(breaks[0])), (drone, distance), period)

    def stats(self) -> list[tuple[str, float | str]]:
        """Return the statistics of the fleet."""
        shift = np.linalg.norm(self.coef - self.flight.coef, axis=2)
        name = f"fleet {self.fleet.name} bound"
        return [
            (f"{name} drones", float(sum(done.changed for done in self.done))),
            (f"{name} iterations", float(max((done.iterations for done in self.done), default=0))),
            (f"{name} exact", float(sum(done.exact for done in self.done))),
            (f"{name} shift", float(shift.max())),
        ]


def too_quick(
    mission: MissionIR,
    fleet: Fleet,
    at: tuple[FleetTrajectory, float],
    who: tuple[int, float],
    period: float,
) -> Diagnostic:
    """Return D084: an animation ends too far from its start for its duration.

    at : the flight, and when the animation starts, s
    who : a drone's row and its distance from first to last frame, m
    period : a period with which every drone arrives, s
    """
    path = picture_at(mission, *at)
    enough = at_least(period)
    return Diagnostic(
        "D084",
        f"the animation is too quick for its drones: a period of {enough} s is enough",
        (mission.origins.value((*path, "period")),),
        (f"`{drone_names(fleet)[who[0]]}` goes {who[1]:.1f} m from the first frame to the last",),
        f"give it `period: {enough}`, more frames, or a smaller `height`",
    )


def picture_at(mission: MissionIR, flight: FleetTrajectory, time: float) -> KeyPath:
    """Return the path of the picture that is shown at a time or next, or else of the fleet."""
    for frame in flight.shown:
        if frame.end >= time - 1e-9:
            return mission.display(frame.display).pictures[frame.picture].path
    return mission.fleet(flight.fleet).path

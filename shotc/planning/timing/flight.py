"""Put the timed legs of one drone on mission time: phases, waits, keyframes and references."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from shotc.geom.bernstein import Piecewise, concatenate, quintic_hermite
from shotc.ir.path import ClockLeg, FramingSpan, HoldLeg, PathLeg
from shotc.ir.phases import KeyframeTime, Phase, Reference
from shotc.ir.trajectory import DroneTrajectory
from shotc.planning.timing.leg import SHORTEST_HOLD_S, LegMotion, rest
from shotc.planning.timing.profile import Profile

Array = NDArray[np.float64]

# Error of a reference over time against the one over the path, half frames, above which it gets more knots.
OFF_HALF_FRAMES = 2e-5
MOST_SPLITS = 8


@dataclass(slots=True)
class TrajectoryBuilder:
    """A drone's trajectory while it grows leg by leg."""

    drone: str
    clock: float = 0.0
    curves: list[Piecewise] = field(default_factory=list)
    phases: list[Phase] = field(default_factory=list)
    keyframes: list[KeyframeTime] = field(default_factory=list)
    framing: list[Reference] = field(default_factory=list)

    def wait(self, time: float, pose: tuple[float, ...]) -> None:
        """Hover until a mission time, as part of the transit before it or as a transit of its own.

        A drone that has not taken off waits on its pad.
        """
        if time - self.clock < SHORTEST_HOLD_S:
            return
        here = self.curves[-1].ctrl[-1, -1] if self.curves else np.array(pose)
        self.curves.append(rest(here, np.array([self.clock, time])))
        if self.phases and self.phases[-1].name == "transit":
            self.phases[-1] = Phase("transit", None, self.phases[-1].start, time)
        elif not self.phases:
            self.phases.append(Phase("takeoff", None, self.clock, time))
        else:
            self.phases.append(Phase("transit", None, self.clock, time))
        self.clock = time

    def fly(self, leg: PathLeg, motion: LegMotion) -> None:
        """Add a leg that starts now."""
        start, end = self.clock, self.clock + motion.duration
        t = start + motion.profile.t
        t[-1] = end
        self.curves.append(Piecewise(t, motion.curve.ctrl))
        if leg.phase == "takeoff" and self.phases:
            waited = self.phases.pop()
            self.phases.append(Phase("takeoff", None, waited.start, end))
        else:
            self.phases.append(Phase(leg.phase, leg.shot, start, end))
        self.clock = end
        if leg.shot is None:
            return
        for mark in leg.marks:
            at = mark.time if mark.time is not None else motion.profile.arrival(mark.s)
            self.keyframes.append(KeyframeTime(leg.shot, mark.index, start + at))
        for span in leg.framing:
            self.framing.append(_reference(leg.shot, span, leg, motion, start))

    def film(self, leg: ClockLeg) -> None:
        """Add a shot on its own clock that starts now; its run-up and run-out are transits."""
        self.curves.append(leg.curve)
        if self.phases and self.phases[-1].name == "transit":
            self.phases[-1] = Phase("transit", None, self.phases[-1].start, leg.start)
        else:
            self.phases.append(Phase("transit", None, self.clock, leg.start))
        self.phases.append(Phase("shot", leg.shot, leg.start, leg.end))
        self.phases.append(Phase("transit", None, leg.end, leg.curve.end))
        self.keyframes += leg.keyframes
        self.framing += leg.framing
        self.clock = float(leg.curve.end)

    def trajectory(self) -> DroneTrajectory:
        """Return the finished flight."""
        return DroneTrajectory(
            self.drone,
            concatenate(self.curves),
            tuple(self.phases),
            tuple(self.keyframes),
            tuple(self.framing),
        )


def _reference(shot: str, span: FramingSpan, leg: PathLeg, motion: LegMotion, clock: float) -> Reference:
    """Return a framing span over mission time; a hold at a joint of two spans belongs to the earlier one."""
    if isinstance(leg, HoldLeg):
        start, end = 0.0, motion.duration
    else:
        first = span.start <= leg.curve.start
        start = motion.profile.arrival(span.start) if first else motion.profile.departure(span.start)
        end = motion.profile.departure(span.end)
    reference = None
    if span.reference is not None and end - start >= SHORTEST_HOLD_S:
        reference = _over_time(span.reference, motion.profile, start, end)
        reference = Piecewise(clock + reference.breaks, reference.ctrl)
    return Reference(shot, span.target, clock + start, clock + end, reference)


def _over_time(reference: Piecewise, profile: Profile, start: float, end: float) -> Piecewise:
    """Return reference(s(t)) as quintics between two times, by the chain rule at sufficiently many knots."""
    inside = (profile.t > start + SHORTEST_HOLD_S) & (profile.t < end - SHORTEST_HOLD_S)
    t = np.concatenate([[start], profile.t[inside], [end]])
    motion = profile.curve()

    def place(times: Array) -> Array:
        return np.clip(motion(times)[:, 0], reference.start, reference.end)

    for _ in range(MOST_SPLITS):
        s = place(t)
        sd, sdd = (motion.derivative(k)(t)[:, :1] for k in (1, 2))
        d1, d2 = reference.derivative(1)(s), reference.derivative(2)(s)
        curve = quintic_hermite(t, reference(s), d1 * sd, d2 * sd**2 + d1 * sdd)
        between = (t[:-1, None] + np.diff(t)[:, None] * np.array([0.25, 0.5, 0.75])).ravel()
        off = np.abs(curve(between) - reference(place(between))).max(axis=1).reshape(-1, 3).max(axis=1)
        if (off <= OFF_HALF_FRAMES).all():
            break
        t = np.sort(np.concatenate([t, 0.5 * (t[1:] + t[:-1])[off > OFF_HALF_FRAMES]]))
    return curve

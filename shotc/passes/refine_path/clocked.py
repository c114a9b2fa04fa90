"""Check that refined drones on the mission's clock fly the same shots: times, ends and legs between."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from math import inf

import numpy as np

from shotc.geom.bernstein import Piecewise, state_at
from shotc.ir.drone import Drone
from shotc.ir.path import ClockLeg, FramingSpan, HoldLeg, MovingLeg, PathIR, PathLeg, TimedPath
from shotc.ir.phases import UPRIGHT, Reference
from shotc.ir.tolerances import REST_TOLERANCE
from shotc.passes.refine_path.finding import RefinerFinding
from shotc.passes.refine_path.form import SAME_PLACE_TOLERANCE, broken, changed_shot, jumps
from shotc.planning.timing.timed_leg import leg_time

JOINT_TOLERANCE = 1e-9
"""Tolerance in seconds, metres, radians and their rates: a shot joins the legs around it exactly."""

IN_TIME_S = 1e-6
"""Seconds by which the duration of a leg may change: the accuracy of a mission's clock."""

_DENSE_SAMPLES = 257


def on_clock(before: PathIR, after: PathIR) -> Iterator[RefinerFinding]:
    """Yield the faults of drones on the mission's clock; both paths have the same legs."""
    mission = before.keyframes.mission
    for old, new in zip(before.timed, after.timed, strict=True):
        drone = mission.drone(new.drone)
        for was, now in zip(old.legs, new.legs, strict=True):
            if was is now:
                continue
            if isinstance(was, ClockLeg) and isinstance(now, ClockLeg):
                yield from _shot(was, now)
            elif isinstance(was, PathLeg) and isinstance(now, PathLeg) and not _alike(was, now):
                yield from _on_path(drone, was, now)
        yield from _joints(new)


def _on_path(drone: Drone, was: PathLeg, now: PathLeg) -> Iterator[RefinerFinding]:
    """Yield the faults of a leg on a path; its angles may change, and the path of a shot may change."""
    changed = list(_as_told(was, now))
    if changed:
        what = f"the {was.phase}" if was.shot is None else f"what shot `{was.shot}` is to do"
        yield RefinerFinding("R005", f"changed {what}", (*changed, f"of `{drone.name}`"), was.shot)
        return
    if isinstance(now, MovingLeg):
        yield from jumps(now, now.curve)
    took, takes = (leg_time(drone, leg) for leg in (was, now))
    if abs(took - takes) > IN_TIME_S:
        note = f"it takes {takes:.6f} s instead of {took:.6f} s, and others are planned beside it"
        yield RefinerFinding(
            "R005", f"changed how long `{drone.name}` flies", (note, f"its {was.phase}"), was.shot
        )


def _as_told(was: PathLeg, now: PathLeg) -> Iterator[str]:
    """Yield the changes of a leg's data; a free duration may become the one that the leg takes."""
    if was.duration is None:
        now = replace(now, duration=None)
    if isinstance(was, HoldLeg) or isinstance(now, HoldLeg) or now.phase == "shot":
        yield from changed_shot(was, now)
        return
    fields = [(leg.phase, leg.pace, leg.duration, leg.start, leg.path) for leg in (was, now)]
    if fields[0] != fields[1] or len(was.stops) != len(now.stops):
        yield "its timing is another"
    elif now.phase in UPRIGHT:
        yield "its flight is another"
    elif _moved(was, now) > SAME_PLACE_TOLERANCE:
        yield f"it flies {_moved(was, now):.3g} m from where it was"


def _moved(was: MovingLeg, now: MovingLeg) -> float:
    """Return how far an unfilmed leg is from its old positions, at dense samples, metres."""
    if abs(was.curve.start - now.curve.start) + abs(was.curve.end - now.curve.end) > SAME_PLACE_TOLERANCE:
        return inf
    s = np.linspace(was.curve.start, was.curve.end, _DENSE_SAMPLES)
    return float(np.abs(was.curve(s)[:, :3] - now.curve(s)[:, :3]).max())


def _joints(flown: TimedPath) -> Iterator[RefinerFinding]:
    for a, b in pairwise(flown.legs):
        gap = float(np.abs(np.array(a.end_pose) - np.array(b.pose)).max())
        if gap > SAME_PLACE_TOLERANCE:
            name = b.shot or (b.phase if isinstance(b, PathLeg) else "")
            yield broken(
                f"{flown.drone}: `{name}` begins {gap:.3g} from where the leg before ends (m or rad)"
            )


def _shot(was: ClockLeg, now: ClockLeg) -> Iterator[RefinerFinding]:
    for fault in _changed(was, now):
        yield RefinerFinding("R005", f"changed what shot `{was.shot}` is to do", (fault,), was.shot)
    for note in _ends(was.curve, now.curve):
        yield broken(note, was.shot)
    yield from jumps(now, now.curve)


def _changed(was: ClockLeg, now: ClockLeg) -> Iterator[str]:
    """Yield the changes of a shot's data."""
    if max(abs(was.start - now.start), abs(was.end - now.end)) > JOINT_TOLERANCE or was.path != now.path:
        yield "its first or its last frame is at another time"
    if was.keyframes != now.keyframes:
        yield "its keyframes are others, or at other times"
    if len(was.framing) != len(now.framing) or not all(map(_same_span, was.framing, now.framing)):
        yield "it frames other targets, or at other places on screen"


def _same_span(a: FramingSpan | Reference, b: FramingSpan | Reference) -> bool:
    if a is b:
        return True
    times = abs(a.start - b.start) <= JOINT_TOLERANCE and abs(a.end - b.end) <= JOINT_TOLERANCE
    return times and a.target == b.target and _same_curve(a.reference, b.reference)


def _ends(was: Piecewise, now: Piecewise) -> Iterator[str]:
    """Yield how a leg deviates from the guide at the ends that its neighbours join."""
    off = max(abs(was.start - now.start), abs(was.end - now.end))
    if off > JOINT_TOLERANCE:
        yield f"its way into or out of the film takes {off:.3g} s more or less"
        return
    for name, k in (("begins", 0), ("ends", -1)):
        distance = float(np.abs(was.ctrl[k, k] - now.ctrl[k, k]).max())
        if distance > JOINT_TOLERANCE:
            yield f"it {name} {distance:.3g} from where the guide does (m or rad)"
    guide, own = (
        np.array([state_at(curve, t)[1:] for t in (curve.start, curve.end)]) for curve in (was, now)
    )
    moving = float(np.abs(own - guide).max())
    if moving > REST_TOLERANCE:
        still = "at rest" if np.abs(guide).max() <= REST_TOLERANCE else "with the guide's motion"
        yield f"it does not begin and end {still}: {moving:.3g} (m/s, rad/s, m/s^2 or rad/s^2)"


def _alike(a: PathLeg, b: PathLeg) -> bool:
    """Return whether two legs are flown in the same way."""
    fields = (a.phase, a.pose, a.marks, a.duration, a.start, a.path)
    if fields != (b.phase, b.pose, b.marks, b.duration, b.start, b.path):
        return False
    if len(a.framing) != len(b.framing) or not all(map(_same_span, a.framing, b.framing)):
        return False
    if isinstance(a, HoldLeg) or isinstance(b, HoldLeg):
        return isinstance(a, HoldLeg) and isinstance(b, HoldLeg) and a.hold == b.hold
    return (a.stops, a.pace) == (b.stops, b.pace) and _same_curve(a.curve, b.curve)


def _same_curve(a: Piecewise | None, b: Piecewise | None) -> bool:
    if a is b:
        return True
    if a is None or b is None:
        return False
    return np.array_equal(a.breaks, b.breaks) and np.array_equal(a.ctrl, b.ctrl)

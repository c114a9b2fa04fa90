"""One shot on a path: position, camera angles, body yaw, marks, stops and references."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise, concatenate
from shotc.geom.bspline import restrict
from shotc.ir.drawn import half_widths, is_drawn
from shotc.ir.drone import Drone
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.path import SIGHT, FramingSpan, HoldLeg, Mark, MovingLeg, PathDeviation, PathLeg, Stop
from shotc.planning.free_space import FreeSpace
from shotc.planning.path.angles import CameraLine, KeyedPath, UnreachableAngles, camera_line, framing_spans
from shotc.planning.path.body import BodyTask, body_line
from shotc.planning.path.deviations import deviations_of
from shotc.planning.path.filmed_ahead import Faced, ahead_in, faced
from shotc.planning.path.lines import SAME_PLACE_M, NoWay, Polyline, TooNear, line_beside, shot_line
from shotc.planning.path.position import PULL_WEIGHT, SIGHT_WEIGHT, PolylineTask, Solved, solve_stretch
from shotc.planning.path.seeing import CURVE_ROUNDS, FilmedCurve, is_led, watched_at, watched_at_keyframes
from shotc.planning.path.swings import Swing, worst_swing
from shotc.planning.path.unwrapping import turns_of
from shotc.planning.timing.deadlines import has_times
from shotc.planning.timing.timed_leg import lateness
from shotc.solvers.conic import Status
from shotc.solvers.headings import DEFAULT

BETWEEN = "what lies between its keyframes"


@dataclass(frozen=True, slots=True, eq=False)
class PlannedShot:
    """A shot's leg on its own s from 0, and the notes for its report."""

    shot: PlacedShot
    leg: PathLeg
    deviations: tuple[PathDeviation, ...]
    cuts: tuple[UnreachableAngles, ...]
    swing: Swing | None
    stats: tuple[tuple[str, float | str], ...]

    def lasting(self, seconds: float | None) -> PlannedShot:
        """Return the shot with a duration, seconds, where the mission leaves its duration free."""
        duration, leg = self.shot.shot.timing.duration, self.leg
        if duration is None and seconds is not None and isinstance(leg, MovingLeg):
            return replace(self, leg=leg.given(seconds))
        return replace(self, leg=replace(leg, duration=seconds if duration is None else duration))


@dataclass(frozen=True, slots=True, eq=False)
class Stuck:
    """A stretch whose programme has no solution; ``keyframes`` are the indices of those on it."""

    solved: Solved
    corners: Array
    keyframes: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class AngleFailure:
    """The programme of the camera angles or of the body yaw has no solution."""

    what: str
    status: Status


Failure = NoWay | TooNear | Stuck | AngleFailure


def shot_curve(
    mission: MissionIR, drone: Drone, space: FreeSpace, placed: PlacedShot, headings: str = DEFAULT
) -> PlannedShot | Failure:
    """Return a shot's geometry, or why there is none; headings : method that chooses turns."""
    line = shot_line(space, placed.keyframes, watched_at_keyframes(mission, placed))
    if not isinstance(line, Polyline):
        return line
    if line.s[-1] <= 0.0:
        return _still(placed, line)
    position = _position(space, drone, placed, line)
    if isinstance(position, Stuck):
        return position
    drawn = _Drawn(placed, line, position, headings)
    led = _led_to_see(mission, (drone, space), placed, line, position)
    if led is None:
        return _along(mission, drone, space, drawn)
    plain = _along(mission, drone, space, drawn)
    seeing = _along(mission, drone, space, drawn._replace(line=led[0], position=led[1]))
    return seeing if _serves(drone, plain, seeing) else plain


class _Drawn(NamedTuple):
    """A shot's polyline and its curve; headings : method that chooses turns."""

    placed: PlacedShot
    line: Polyline
    position: tuple[Piecewise, list[Solved]]
    headings: str


def _along(mission: MissionIR, drone: Drone, space: FreeSpace, drawn: _Drawn) -> PlannedShot | AngleFailure:
    """Return a shot along a curve, with its camera, body yaw and marks."""
    placed, line, (curve, solved), headings = drawn
    keyed = replace(_keyed(placed, line, curve), pace=placed.shot.pace, headings=headings)
    camera = camera_line(mission, drone, keyed)
    if camera.status not in {Status.SOLVED, Status.INACCURATE}:
        return AngleFailure("camera", camera.status)
    refined = restrict(curve, camera.angles.breaks)
    shot = placed.shot
    task = BodyTask(refined, camera.angles.channels(0), None, None, shot.pace * drone.limits.speed)
    ahead = ahead_in(mission, shot)
    turned = None if ahead is None else faced(drone, ahead, task, camera.angles)
    if turned is None:
        body_status, body = body_line(drone, task)
        if body_status not in {Status.SOLVED, Status.INACCURATE}:
            return AngleFailure("body", body_status)
        turned = Faced(refined, camera.angles, body)
    angles = turned.camera
    whole = stack(turned.position, angles.channels(0, 1), turned.body, angles.channels(2))
    leg = MovingLeg(
        phase="shot",
        shot=shot.id,
        curve=whole,
        stops=_stops(placed.keyframes, keyed, line),
        marks=_marks(placed, keyed),
        framing=framing_spans(keyed),
        pace=shot.pace,
        duration=shot.timing.duration,
        start=shot.timing.start,
        path=shot.path,
        smoother=shot.smoother,
    )
    return PlannedShot(
        shot=placed,
        leg=leg,
        deviations=deviations_of(space, placed, keyed, SIGHT if line.drawn is not None else BETWEEN),
        cuts=camera.cuts,
        swing=worst_swing(mission, keyed, camera),
        stats=(*_stats(placed, solved, camera, whole), *turns_of(shot.id, camera.unsolved, headings)),
    )


def _serves(drone: Drone, plain: PlannedShot | AngleFailure, led: PlannedShot | AngleFailure) -> bool:
    """Return whether a led shot is as timely as the plain one, and its camera shows as much."""
    if not isinstance(led, PlannedShot) or not isinstance(plain, PlannedShot):
        return isinstance(led, PlannedShot)
    legs = [one.leg for one in (led, plain)]
    in_time = not has_times(legs[0]) or lateness(drone, legs[0]) <= lateness(drone, legs[1])
    return in_time and len(led.cuts) <= len(plain.cuts)


def stack(*curves: Piecewise) -> Piecewise:
    """Return the channels of curves on the same breaks as one curve."""
    return Piecewise(curves[0].breaks, np.concatenate([c.ctrl for c in curves], axis=2))


def _still(placed: PlacedShot, line: Polyline) -> PlannedShot:
    first = placed.keyframes[0]
    duration = placed.shot.timing.duration
    times = _standing(placed.keyframes, duration)
    hold = duration if duration is not None else times[-1] + placed.keyframes[-1].hold
    pose = (*map(float, line.corners[0]), first.yaw, first.pitch, first.yaw, first.hfov)
    spans: tuple[FramingSpan, ...] = ()
    if first.target is not None:
        reference = None
        if first.reference is not None:
            reference = Piecewise(np.array([0.0, 1.0]), np.tile(np.array(first.reference), (1, 6, 1)))
        spans = (FramingSpan(first.target, 0.0, 0.0, reference),)
    marks = tuple(
        Mark(0.0, t, i, k.path) for i, (t, k) in enumerate(zip(times, placed.keyframes, strict=True))
    )
    shot = placed.shot
    leg = HoldLeg(shot.id, pose, hold, marks, spans, duration, shot.timing.start, shot.path)
    return PlannedShot(placed, leg, (), (), None, ())


def _standing(keyframes: tuple[PlacedKeyframe, ...], duration: float | None) -> list[float]:
    """Return when a camera that stands reaches each keyframe, seconds: in order, the last one at the end."""
    times: list[float] = []
    now = 0.0
    for k in keyframes:
        times.append(now if k.time is None else k.time)
        now = times[-1] + k.hold
    if duration is not None and len(keyframes) > 1 and keyframes[-1].time is None:
        times[-1] = max(times[-1], duration - keyframes[-1].hold)
    return times


def _position(
    space: FreeSpace, drone: Drone, placed: PlacedShot, line: Polyline
) -> tuple[Piecewise, list[Solved]] | Stuck:
    """Solve each stretch; the drone rests where the camera turns on the spot."""
    curves: list[Piecewise] = []
    solved: list[Solved] = []
    for first, last in _sections(line):
        s = line.s[first : last + 1]
        if last == first + 1 and np.linalg.norm(line.corners[last] - line.corners[first]) < SAME_PLACE_M:
            still = np.tile(line.corners[first], (1, 6, 1))
            curves.append(Piecewise(s, still))
            continue
        result = solve_stretch(space, _stretch(placed, line, first, last), drone.limits)
        if result.curve is None:
            owners = tuple(k for k in line.of[first : last + 1] if k >= 0)
            return Stuck(result, line.corners[first : last + 1], owners)
        curves.append(result.curve)
        solved.append(result)
    return concatenate(curves), solved


def _led_to_see(
    mission: MissionIR,
    who: tuple[Drone, FreeSpace],
    placed: PlacedShot,
    line: Polyline,
    position: tuple[Piecewise, list[Solved]],
) -> tuple[Polyline, tuple[Piecewise, list[Solved]]] | None:
    """Return a polyline through placed keyframes and its curve, led to where less of the targets is hidden.

    None where this does not apply, or where no better curve was found; line, position : those without it
    """
    drone, space = who
    named = dict.fromkeys(k.target for k in placed.keyframes if k.target is not None)
    # On a path drawn by its author, the points are the path itself.
    if placed.shot.kind != "keyframes" or not is_led(mission, placed.shot):
        return None
    watched = {name: watched_at(mission, name, [mission.target(name).centre]) for name in named}

    def filmed(on: Polyline, curve: Piecewise) -> FilmedCurve:
        at = on.s[[k >= 0 for k in on.of]]
        return FilmedCurve(placed.keyframes, at, curve, watched, drone.limits, placed.shot.pace)

    plain = now = best = filmed(line, position[0])
    led: tuple[Polyline, tuple[Piecewise, list[Solved]]] | None = None
    for _ in range(CURVE_ROUNDS):
        attractors = now.beside(space)
        beside = line_beside(space, placed.keyframes, attractors) if any(map(len, attractors)) else None
        led_position = _position(space, drone, placed, beside) if isinstance(beside, Polyline) else None
        if not isinstance(beside, Polyline) or led_position is None or isinstance(led_position, Stuck):
            break
        now = filmed(beside, led_position[0])
        if now.serves(plain) and now.seconds[1] < best.seconds[1]:
            best, led = now, (beside, led_position)
    return led


def _sections(line: Polyline) -> list[tuple[int, int]]:
    """Return the corner ranges between turns on the spot; repeated keyframes are left out."""
    moving = np.linalg.norm(np.diff(line.corners, axis=0), axis=1) >= SAME_PLACE_M
    sections: list[tuple[int, int]] = []
    for i, moves in enumerate(moving):
        if line.s[i + 1] <= line.s[i]:
            continue
        if moves and sections and sections[-1][1] == i and moving[i - 1]:
            sections[-1] = (sections[-1][0], i + 1)
        else:
            sections.append((i, i + 1))
    return sections


def _stretch(placed: PlacedShot, line: Polyline, first: int, last: int) -> PolylineTask:
    bound, pulled, pulled_at = [0], [], []
    for i in range(first + 1, last):
        k = line.of[i]
        if i in line.attractors:
            pulled.append(line.corners[i])
            pulled_at.append(line.s[i])
        if k < 0:
            continue
        if line.loose and not placed.keyframes[k].placed:
            pulled.append(placed.keyframes[k].at if line.drawn is None else line.drawn[k])
            pulled_at.append(line.s[i])
        else:
            bound.append(i - first)
    bound.append(last - first)
    s = line.s[first : last + 1]
    return PolylineTask(
        corners=line.corners[first : last + 1],
        s=s,
        bound=tuple(bound),
        pulled=np.array(pulled).reshape(-1, 3),
        pulled_at=np.array(pulled_at),
        pace=placed.shot.pace,
        pull=SIGHT_WEIGHT if line.attractors else PULL_WEIGHT,
        widths=_widths(placed, line, first, last),
    )


def _widths(placed: PlacedShot, line: Polyline, first: int, last: int) -> Array | None:
    """Return how far a drawn path may be left on each segment from one corner to another; None if it is free.

    A leg that leads round an obstacle is free.
    """
    if not is_drawn(placed.shot):
        return None
    own, ends = half_widths([k.at for k in placed.keyframes]), line.of[first : last + 1]
    return np.array([own[a] if a >= 0 and b >= 0 else np.inf for a, b in pairwise(ends)])


def _keyed(placed: PlacedShot, line: Polyline, curve: Piecewise) -> KeyedPath:
    """Return where on the curve each keyframe lies; for dropped ones the nearest place."""
    keyframes = placed.keyframes
    s = np.full(len(keyframes), np.nan)
    for corner, k in enumerate(line.of):
        if k >= 0:
            s[k] = line.s[corner]
    exact = [not np.isnan(value) for value in s]
    last = len(keyframes) - 1
    for k, keyframe in enumerate(keyframes):
        if not exact[k]:
            ahead = min(s[j] for j in range(k + 1, last + 1) if exact[j])
            s[k] = _nearest(curve, keyframe, float(s[k - 1]), float(ahead))
        elif line.loose and not keyframe.placed:
            exact[k] = False if k not in {0, last} else not line.moved[int(k == last)]
    for k in (0, last):
        exact[k] = exact[k] and not line.moved[int(k == last)]
    return KeyedPath(keyframes, s, tuple(exact), curve)


def _nearest(curve: Piecewise, keyframe: PlacedKeyframe, low: float, high: float) -> float:
    # Both ends are excluded, so that parameters increase.
    at = np.linspace(low, high, 66)[1:-1]
    distances = np.linalg.norm(curve(at) - np.array(keyframe.at), axis=1)
    return float(at[int(distances.argmin())])


def _stops(keyframes: tuple[PlacedKeyframe, ...], keyed: KeyedPath, line: Polyline) -> tuple[Stop, ...]:
    holds = {float(line.s[0]): 0.0, float(line.s[-1]): 0.0}
    for first, last in _sections(line):
        if np.linalg.norm(line.corners[last] - line.corners[first]) < SAME_PLACE_M and last == first + 1:
            holds.setdefault(float(line.s[first]), 0.0)
            holds.setdefault(float(line.s[last]), 0.0)
    for keyframe, s in zip(keyframes, keyed.s, strict=True):
        if keyframe.hold > 0:
            holds[float(s)] = holds.get(float(s), 0.0) + keyframe.hold
    return tuple(Stop(s, holds[s]) for s in sorted(holds))


def _marks(placed: PlacedShot, keyed: KeyedPath) -> tuple[Mark, ...]:
    return tuple(
        Mark(float(s), k.time, i, k.path)
        for i, (s, k) in enumerate(zip(keyed.s, placed.keyframes, strict=True))
    )


def _stats(
    placed: PlacedShot, solved: list[Solved], camera: CameraLine, whole: Piecewise
) -> tuple[tuple[str, float | str], ...]:
    name = placed.shot.id
    return (
        (f"{name}.length", whole.end - whole.start),
        (f"{name}.pieces", float(len(whole.ctrl))),
        (f"{name}.qp_objective", float(sum(r.objective for r in solved))),
        (f"{name}.qp_rounds", float(sum(r.rounds for r in solved))),
        (f"{name}.qp_status", next((str(r.status) for r in solved if r.status != "solved"), "solved")),
        (f"{name}.camera_fit_error", camera.error),
    )

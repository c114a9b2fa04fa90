"""Aligns a drone's flight on the clock with the mission: its camera angles, phases and framing as a track.

A shot's times come from the table's own columns, or from the mission if it fixes them. Other shots are not
aligned, and there are no claims on them. The camera is taken to be at a keyframe when it is nearest to it, in
order. No file states the reference between two keyframes, so any place between theirs is accepted.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple, cast

import numpy as np

from shotc.flightfiles.clocked import ClockedFlight
from shotc.geom.bernstein import Array, Piecewise
from shotc.importers.flights.points import BROKEN, refuse
from shotc.importers.flights.rows import BODY, CAMERA, PHASE, SHOT, DroneRows
from shotc.ir.drone import Drone
from shotc.ir.keyed import is_keyed
from shotc.ir.keyframes import KeyframeIR, PlacedKeyframe, PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, CHANNELS, HFOV
from shotc.ir.phases import UPRIGHT, KeyframeTime, Phase, PhaseName, Reference
from shotc.ir.sampling import projected, ticks
from shotc.ir.trajectory import DroneTrajectory
from shotc.passes.verify.motion import HFOV_RANGE_RAD
from shotc.planning.framing.moments import placed_at

NAMES: tuple[PhaseName, ...] = ("takeoff", "transit", "shot", "return", "land")
STEP_S = 0.1
"""Seconds between samples of a shot at which a keyframe may be passed."""


class Aligned(NamedTuple):
    """A track, and what its file states.

    from_table : whether the phases come from the table
    missing : shots of the drone that are not aligned
    looks, faces : whether the camera's angles and the body's heading are known
    """

    track: DroneTrajectory
    from_table: bool
    missing: tuple[str, ...]
    looks: bool
    faces: bool


def aligned(
    keyframes: KeyframeIR, drone: Drone, flown: ClockedFlight, upright: tuple[float, float]
) -> Aligned:
    """Return the track of a drone.

    upright : times at which it leaves the vertical over its pad and is back on it, seconds

    Raises Unread if a field of view in the table is impossible.
    """
    mission, rows = keyframes.mission, flown.rows
    curve, looks = _with_camera(drone, flown)
    from_table = None if rows is None else _table_phases(mission, rows, curve)
    phases = _by_mission(mission, drone, curve, upright) if from_table is None else from_table
    bare = DroneTrajectory(drone.name, curve, phases, (), ())
    at: list[KeyframeTime] = []
    framing: list[Reference] = []
    for phase in phases:
        placed = next((p for p in keyframes.shots if p.shot.id == phase.shot), None)
        if placed is not None and looks:
            times = _keyframe_times(placed, curve, phase)
            at += times
            framing += _framed(mission, placed, phase, (bare, times))
    track = DroneTrajectory(drone.name, curve, phases, tuple(at), tuple(framing))
    filmed = {phase.shot for phase in phases}
    own = (shot.id for shot in mission.shots if shot.drone == drone.name)
    missing = tuple(shot for shot in own if shot not in filmed)
    faces = rows is not None and rows.values(*BODY) is not None
    return Aligned(track, from_table is not None, missing, looks, faces)


def _with_camera(drone: Drone, flown: ClockedFlight) -> tuple[Piecewise, bool]:
    """Return the curve of all channels, with angles linear between rows, and whether the camera's
    are known.
    """
    curve, rows = flown.curve, flown.rows
    pose = np.zeros((*curve.ctrl.shape[:2], len(CHANNELS)))
    pose[..., :3], pose[..., HFOV] = curve.ctrl, drone.hfov
    if rows is None:
        return Piecewise(curve.breaks, pose), False
    body, camera, lens = rows.values(*BODY), rows.values(*CAMERA[:2]), lens_of(rows)
    for channel, values in (
        (BODY_YAW, None if body is None else np.unwrap(body[:, 0])),
        (CAM_YAW, None if camera is None else np.unwrap(camera[:, 0])),
        (CAM_PITCH, None if camera is None else camera[:, 1]),
        (HFOV, lens),
    ):
        if values is not None:
            lead = np.repeat(values[:1], len(curve.breaks) - len(values))
            pose[..., channel] = _straight(np.concatenate([lead, values]))
    return Piecewise(curve.breaks, pose), camera is not None


def lens_of(rows: DroneRows) -> Array | None:
    """Return the field of view of every row, rad, shape (N,); None if the table has none.

    Raises Unread if a value is outside the range of lenses.
    """
    columns = rows.values(CAMERA[2])
    if columns is None:
        return None
    low, high = HFOV_RANGE_RAD
    wrong = np.flatnonzero((columns[:, 0] < low) | (columns[:, 0] > high))
    if len(wrong):
        angle = float(np.degrees(columns[wrong[0], 0]))
        message = f"a field of view of {angle:.4g} deg is none of a lens"
        help_ = f"write `{CAMERA[2]}` in rad, from {low:.4g} to {high:.4g}"
        refuse(BROKEN, message, rows.node(int(wrong[0])), help_)
    return np.asarray(columns[:, 0])


def _straight(values: Array) -> Array:
    """Return the control points (P, 4) of straight lines through values (P + 1,)."""
    share = np.linspace(0.0, 1.0, 4)
    return np.asarray(values[:-1, None] + share * np.diff(values)[:, None])


def _table_phases(mission: MissionIR, rows: DroneRows, curve: Piecewise) -> tuple[Phase, ...] | None:
    """Return the phases in the table; None if it has none that are known here.

    A shot lasts from its first row to its last. The time between two other phases belongs to the later one if
    that is a landing, else to the earlier one.
    """
    names, shots = rows.texts(PHASE), rows.texts(SHOT)
    if names is None or shots is None or not set(names) <= set(NAMES):
        return None
    if not {shot for shot in shots if shot} <= {shot.id for shot in mission.shots}:
        return None
    each = list(zip(names, shots, strict=True))
    if any((name == "shot") != bool(shot) for name, shot in each):
        return None
    firsts = [i for i in range(len(each)) if i == 0 or each[i] != each[i - 1]]
    marks = [curve.start]
    for i in firsts[1:]:
        later = each[i][0] in ("shot", "land") and each[i - 1][0] not in UPRIGHT
        marks.append(float(rows.time[i if later else i - 1]))
    marks.append(curve.end)
    spans = zip([each[i] for i in firsts], pairwise(marks), strict=True)
    return tuple(
        Phase(cast("PhaseName", name), shot or None, a, b) for (name, shot), (a, b) in spans if b > a
    )


def _by_mission(
    mission: MissionIR, drone: Drone, curve: Piecewise, upright: tuple[float, float]
) -> tuple[Phase, ...]:
    """Return the phases of a flight with the shots whose times the mission fixes."""
    up, down = upright
    fixed = [
        (shot.timing.start, shot.timing.start + shot.timing.duration, shot.id)
        for shot in mission.shots
        if shot.drone == drone.name and shot.timing.start is not None and shot.timing.duration is not None
    ]
    marks: list[Phase] = []
    now = up
    for start, end, name in sorted(fixed):
        if start >= now and end <= down:
            marks += [Phase("transit", None, now, start), Phase("shot", name, start, end)]
            now = end
    every = (
        Phase("takeoff", None, curve.start, up),
        *marks,
        Phase("transit", None, now, down),
        Phase("land", None, down, curve.end),
    )
    return tuple(phase for phase in every if phase.end > phase.start)


def _keyframe_times(placed: PlacedShot, curve: Piecewise, phase: Phase) -> list[KeyframeTime]:
    """Return the times at which the camera passes the keyframes of a shot.

    The times are in order and minimise the sum of squared distances to the keyframes (dynamic programming
    over samples).
    """
    if placed.shot.ideal is not None or not placed.keyframes:
        return []
    count = max(2, int((phase.end - phase.start) / STEP_S) + 1)
    times = np.linspace(phase.start, phase.end, count)
    places = curve(times)[:, :3]
    squares = np.array([np.sum((places - np.array(k.at)) ** 2, axis=1) for k in placed.keyframes])
    best = squares[:1].copy()
    chosen: list[Array] = []
    for row in squares[1:]:
        least = np.minimum.accumulate(best[-1])
        at = np.maximum.accumulate(np.where(best[-1] == least, np.arange(count), 0))
        chosen.append(at)
        best = np.vstack([best, row + least])
    k = int(np.argmin(best[-1]))
    index = [k]
    for at in reversed(chosen):
        index.insert(0, int(at[index[0]]))
    return [KeyframeTime(placed.shot.id, i, float(times[k])) for i, k in enumerate(index)]


def _framed(
    mission: MissionIR,
    placed: PlacedShot,
    phase: Phase,
    flown: tuple[DroneTrajectory, Sequence[KeyframeTime]],
) -> Iterator[Reference]:
    """Yield the references of a shot: its subjects throughout, or its keyframes' targets between
    keyframes.

    On the way from one target to another the first one is framed until the middle of the time.
    """
    track, met = flown
    if placed.shot.ideal is not None:
        if not is_keyed(placed.shot):
            yield from _subjects(mission, placed_at(mission, placed, phase.start), phase)
        return
    only = placed.keyframes[0]
    if len(placed.keyframes) == 1 and only.target is not None:
        ends = np.array([phase.start, phase.end])
        line = None if only.reference is None else _line(ends, np.array([only.reference] * 2))
        yield Reference(placed.shot.id, only.target, phase.start, phase.end, line)
    for (a, one), (b, other) in pairwise(zip(placed.keyframes, met, strict=True)):
        if other.time <= one.time:
            continue
        if a.target is None or a.target != b.target:
            yield from _in_turn(placed.shot.id, (a, one), (b, other))
            continue
        line = None
        if a.reference is not None and b.reference is not None:
            times = ticks(mission.rate, one.time, other.time)
            seen = projected(mission, track, a.target, times)
            first, along = np.array(a.reference), np.subtract(b.reference, a.reference)
            off = np.stack([seen.u, seen.v], axis=1) - first
            share = np.clip(np.nan_to_num(off @ along / max(float(along @ along), 1e-12)), 0.0, 1.0)
            line = _line(times, first + share[:, None] * along)
        yield Reference(placed.shot.id, a.target, one.time, other.time, line)
    last = placed.keyframes[-1]
    if len(met) > 1 and last.target is not None:
        end = min(met[-1].time + last.hold, phase.end)
        yield Reference(placed.shot.id, last.target, met[-1].time, end, None)


def _in_turn(
    shot: str, before: tuple[PlacedKeyframe, KeyframeTime], after: tuple[PlacedKeyframe, KeyframeTime]
) -> Iterator[Reference]:
    """Yield the references between keyframes of two targets, which change in the middle of the time."""
    (a, one), (b, other) = before, after
    middle = 0.5 * (one.time + a.hold + other.time)
    if a.target is not None:
        yield Reference(shot, a.target, one.time, middle, None)
    if b.target is not None:
        yield Reference(shot, b.target, middle, other.time, None)


def _subjects(mission: MissionIR, placed: PlacedShot, phase: Phase) -> Iterator[Reference]:
    """Yield the subjects of a shot on its own clock, with the mission's reference at every tick."""
    times = ticks(mission.rate, phase.start, phase.end)
    for subject in placed.subjects:
        places = [subject.asked(float(t) - phase.start).place for t in times]
        known = None if subject.reference is None or any(place is None for place in places) else places
        line = None if known is None else _line(times, np.array(known, dtype=float))
        yield Reference(placed.shot.id, subject.target, phase.start, phase.end, line)


def _line(times: Array, values: Array) -> Piecewise:
    return Piecewise(times, np.stack([values[:-1], values[1:]], axis=1))

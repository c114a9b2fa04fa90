"""Check the camera of a shot: its direction, its turns and its lens, at keyframes and between them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import pi

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import cut
from shotc.geom.proof import ProvedExtreme, norm, sup_convex
from shotc.geom.vec import wrapped
from shotc.ir.ahead import looks_along
from shotc.ir.keyed import is_keyed
from shotc.ir.keyframes import PlacedShot
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.phases import Phase
from shotc.ir.sampling import ticks_inside
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.claims import JudgedFlight, Limit, WorstValue, bounded, claim, flown_shots, gap
from shotc.passes.verify.pictured import KeyframedSpan, spans_of
from shotc.planning.framing.moments import placed_at

LENS_RAD = 1e-3
"""Tolerance of the field of view, radians."""

TURNED_RAD = 0.2
"""Tolerance of the direction of a camera that frames nothing, radians."""

BESIDE_S = 0.5
"""Seconds before and after a keyframe over which the drone's course is measured."""

AROUND_RAD = pi / 2
"""Tolerance of a turn, radians; a whole turn more or less is another shot."""

BODY_RAD = 1e-3
"""Tolerance of the heading of a body that turns with its camera, radians."""

TURN_RATIO, TURN_RAD = 1.5, 0.35
"""Largest turn of a free body over the least one, and radians beyond it, because its curve is smooth."""

SWUNG_RAD = 0.5
"""Angle by which a camera that frames nothing may leave the range between two keyframes, radians: a curve
that is led round an obstacle or refined swings by up to 0.4 rad."""

SWING_SHARE = 0.25
"""Share of the largest turn between two keyframes of a shot by which a camera may swing beyond their range.
The curve of its angles is smooth, so a large turn makes it swing on the ways beside it, too."""


def looking(flight: JudgedFlight, ir: TrajectoryIR) -> Iterator[Claim]:
    """Yield claims that this drone's shots are filmed with the directions and lenses that they ask for."""
    for placed, phase in flown_shots(flight, ir):
        now = placed_at(flight.mission, placed, phase.start)
        if flight.drone.body == "follow-camera":
            yield _body(flight, now, phase)
        if placed.shot.ideal is not None and not is_keyed(placed.shot):
            yield from _on_clock(flight, now, phase)
            continue
        spans = spans_of(flight, now, phase)
        if spans is None or not all(phase.start <= s.start and s.end <= phase.end for s in spans):
            continue  # refused by the times of its keyframes
        times = {k.index: k.time for k in flight.track.keyframes if k.shot == placed.shot.id}
        yield from _at_keyframes(flight, now, np.array([times[i] for i in range(len(now.keyframes))]))
        yield from _between(flight, now, spans)
        if flight.drone.body == "free" and placed.shot.ideal is None:
            yield from _free_body(flight, placed, phase)


def _body(flight: JudgedFlight, placed: PlacedShot, phase: Phase) -> Claim:
    """Return the claim that the body turns with the camera, whole turns aside."""
    angles = cut(flight.track.curve.channels(CAM_YAW, BODY_YAW), phase.start, phase.end)
    apart = float(angles.ctrl[0, 0, 0] - angles.ctrl[0, 0, 1])
    around = apart - float(wrapped(apart))
    limit = Limit("body off its camera", BODY_RAD, "rad", (*flight.drone.path, "body"), shot=placed.shot.id)
    bound = sup_convex(angles, lambda c: np.abs(c[..., 0] - c[..., 1] - around), gap(BODY_RAD))
    return bounded(flight, limit, bound)


def _free_body(flight: JudgedFlight, placed: PlacedShot, phase: Phase) -> Iterator[Claim]:
    """Yield the claim that a free body turns hardly more than the gimbal's range asks for.

    A body that is led by the ends of the range alone turns least. With `look_ahead` it turns for that.
    """
    if flight.mission.rules.look_ahead is not None:
        return
    ticks = ticks_inside(flight.mission.rate, phase.start, phase.end)
    angles = flight.track.curve(np.union1d(ticks, [phase.start, phase.end]))[:, [CAM_YAW, BODY_YAW]]
    low, high = flight.drone.gimbal.yaw
    apart = angles[0, 0] - angles[0, 1]
    around = 2.0 * pi * np.round((apart - 0.5 * (low + high)) / (2.0 * pi))
    body, least = float(angles[0, 1]), 0.0
    for camera in (angles[:, 0] - around).tolist():
        led = min(max(body, camera - high), camera - low)
        body, least = led, least + abs(led - body)
    flown = float(np.abs(np.diff(angles[:, 1])).sum())
    path = (*flight.drone.path, "body")
    limit = Limit("turn of a free body", TURN_RATIO * least + TURN_RAD, "rad", path, shot=placed.shot.id)
    yield claim(flight, limit, WorstValue(flown, phase.start, "sampled"))


def _on_clock(flight: JudgedFlight, placed: PlacedShot, phase: Phase) -> Iterator[Claim]:
    """Yield claims on the lens of a shot that follows its subjects, and on its aim where that is given."""
    shot, own, ideal = placed.shot, flight.drone.hfov, placed.shot.ideal
    if not flight.drone.zooms_unasked:
        lens = cut(flight.track.curve.channels(HFOV), phase.start, phase.end)
        limit = Limit("lens off its shot", LENS_RAD, "rad", shot.path, shot=shot.id)
        yield bounded(flight, limit, sup_convex(lens, lambda c: np.abs(c[..., 0] - own), gap(LENS_RAD)))
    if ideal is not None and ideal.aim is not None:
        angles = cut(flight.track.curve.channels(CAM_YAW, CAM_PITCH), phase.start, phase.end)
        aim = np.array(ideal.aim)
        turned = float(angles.ctrl[0, 0, 0]) - aim[0]
        aim[0] += turned - float(wrapped(turned))
        limit = Limit("direction off its aim", TURNED_RAD, "rad", shot.path, shot=shot.id)
        yield bounded(flight, limit, sup_convex(angles, lambda c: norm(c - aim), gap(TURNED_RAD)))


def _at_keyframes(flight: JudgedFlight, placed: PlacedShot, t: Array) -> Iterator[Claim]:
    """Yield claims on the lens, the direction and the turns at a shot's keyframes; t : their times, (K,)."""
    keyframes, shot = placed.keyframes, placed.shot
    pose = flight.track.curve(t)
    lens = np.abs(pose[:, HFOV] - [k.hfov for k in keyframes])
    if flight.drone.zooms:
        lens = np.where([k.asks_for_lens(flight.drone.hfov) for k in keyframes], lens, 0.0)
    limit = Limit("lens off its keyframes", LENS_RAD, "rad", shot.path, shot=shot.id)
    yield _largest(flight, limit, lens, t)
    unframed = np.array([k.reference is None for k in keyframes])
    yaw = wrapped(pose[:, CAM_YAW] - [k.yaw for k in keyframes])
    if flight.mission.rules.look_ahead is not None and looks_along(shot):
        yaw = _off_course(flight, (yaw, t), flight.mission.rules.look_ahead, (t[0], t[-1]))
    pitch = pose[:, CAM_PITCH] - [k.pitch for k in keyframes]
    off_aim = np.where(unframed, np.hypot(yaw * np.cos(pose[:, CAM_PITCH]), pitch), 0.0)
    limit = replace(limit, constraint="direction off its keyframes", value=TURNED_RAD)
    yield _largest(flight, limit, off_aim, t)
    turns = np.array([np.nan if k.turn is None else k.turn for k in keyframes])
    turned = np.abs(np.diff(pose[:, CAM_YAW], prepend=pose[0, CAM_YAW]) - turns)
    limit = replace(limit, constraint="turn off its keyframes", value=AROUND_RAD)
    yield _largest(flight, limit, np.nan_to_num(turned), t)


def _between(flight: JudgedFlight, placed: PlacedShot, spans: list[KeyframedSpan]) -> Iterator[Claim]:
    """Yield claims that lens and direction stay between those of the keyframes on both sides.

    A camera that leaves a target, or turns to one, follows it up to the middle of the way, so its direction
    may leave that range. It is judged only between two keyframes that frame nothing.
    """
    shot, ways = placed.shot, [span for span in spans if span.end > span.start]
    if not ways:
        return
    if not flight.drone.zooms_unasked:
        limit = Limit("lens between keyframes", LENS_RAD, "rad", shot.path, shot=shot.id)
        beyond = (_beyond(flight, HFOV, s, (s.before.hfov, s.after.hfov), LENS_RAD) for s in ways)
        yield bounded(flight, limit, max(beyond, key=lambda bound: bound.proven))
    angles = [_angles_at(flight, span) for span in ways]
    free = [
        (span, ends)
        for span, ends in zip(ways, angles, strict=True)
        if span.before.reference is None and span.after.reference is None
    ]
    if not free or (flight.mission.rules.look_ahead is not None and looks_along(shot)):
        return
    most = SWUNG_RAD + SWING_SHARE * max(float(np.abs(b - a).max()) for a, b in angles)
    limit = Limit("direction between keyframes", most, "rad", shot.path, shot=shot.id)
    swings = (
        _beyond(flight, channel, span, (float(a), float(b)), most)
        for span, ends in free
        for channel, a, b in zip((CAM_YAW, CAM_PITCH), *ends, strict=True)
    )
    yield bounded(flight, limit, max(swings, key=lambda bound: bound.proven))


def _angles_at(flight: JudgedFlight, span: KeyframedSpan) -> Array:
    """Return yaw and pitch of the camera at both ends of a way, rad, shape (2, 2)."""
    return np.asarray(flight.track.curve(np.array([span.start, span.end]))[:, [CAM_YAW, CAM_PITCH]])


def _beyond(
    flight: JudgedFlight, channel: int, span: KeyframedSpan, ends: tuple[float, float], most: float
) -> ProvedExtreme:
    """Return a bound on how far a channel leaves the range between two values on a way; most : the limit."""
    low, high = min(ends), max(ends)

    def beyond(values: Array) -> Array:
        return np.maximum(np.maximum(low - values[..., 0], values[..., 0] - high), 0.0)

    return sup_convex(cut(flight.track.curve.channels(channel), span.start, span.end), beyond, gap(most))


def _off_course(
    flight: JudgedFlight, at: tuple[Array, Array], half_angle: float, span: tuple[float, float]
) -> Array:
    """Return how far a camera that looks along its path is outside the cone about its course, rad.

    At a keyframe the course is measured from shortly before it to shortly after it, because the drone may
    rest there.

    at : errors against the headings of its keyframes, and their times
    span : of the shot, seconds
    """
    off, t = at
    curve = flight.track.curve
    before, after = (np.clip(t + d, *span) for d in (-BESIDE_S, BESIDE_S))
    direction = curve(after)[:, :2] - curve(before)[:, :2]
    off_course = wrapped(curve(t)[:, CAM_YAW] - np.arctan2(direction[:, 1], direction[:, 0]))
    least = np.minimum(np.abs(off), np.abs(off_course))
    return np.asarray(np.maximum(least - half_angle, 0.0))


def _largest(flight: JudgedFlight, limit: Limit, value: Array, t: Array) -> Claim:
    k = int(value.argmax())
    return claim(flight, limit, WorstValue(float(value[k]), float(t[k]), "exact"))

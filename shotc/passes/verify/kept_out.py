"""Remedies that keep one drone out of another's picture: another time, another direction, another place."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import degrees

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.path import CAM_YAW, HFOV
from shotc.ir.phases import Phase
from shotc.ir.sampling import ticks
from shotc.ir.trajectory import Claim, DroneTrajectory
from shotc.passes.verify.claims import slack
from shotc.passes.verify.meeting import filming, put_off
from shotc.passes.verify.sight import CameraAndBody
from shotc.rounding import at_least

BEYOND_M, BEYOND_RAD = 0.01, 1e-3  # by which a body is out of the frame beyond what is asked
FARTHEST_M = 1000.0  # metres up to which another place is searched
PLACE_HALVINGS = 30  # bisection steps of that search
OVER_PAD_M = 0.1  # metres off the vertical over its pad
BEYOND_DEG = 0.5  # degrees that a camera is turned beyond the least angle


def kept_out(sight: CameraAndBody, claim: Claim, phase: Phase) -> Iterator[str]:
    """Yield remedies that keep the other drone of a broken claim out of the shot of a phase.

    Another time does not help where the other drone is seen on its pad as well.
    """
    mission, other = sight.mission, sight.other
    times = ticks(mission.rate, phase.start, phase.end)
    if not _pad_is_seen(sight, times, claim):
        yield from _another_time(sight, phase) if other.phases else ()
    elif not other.phases or _over_its_pad(other, times):
        yield f"move the home of `{other.drone}` out of the picture"
    turn = _turned(sight, times, phase)
    if turn:
        yield turn
    aside = _aside(sight, times, claim)
    if aside:
        yield f"film from where `{other.drone}` is {aside} in the picture"


def _pad_is_seen(sight: CameraAndBody, times: Array, claim: Claim) -> bool:
    pad = sight.other.curve(sight.other.curve.start)[:3]
    out = sight.out_at(times, np.repeat(pad[None], len(times), axis=0))
    return bool((out < claim.limit - slack(claim.limit)).any())


def _over_its_pad(other: DroneTrajectory, times: Array) -> bool:
    """Return whether a drone stands on its pad, rises from it or lands on it at all of some times."""
    off = other.curve(times)[:, :2] - other.curve(other.curve.start)[:2]
    return bool(np.hypot(*off.T).max() < OVER_PAD_M)


def _another_time(sight: CameraAndBody, phase: Phase) -> Iterator[str]:
    """Yield the remedy to film one after the other; this shot, if later, after the other drone has landed."""
    other = filming(sight.other, phase.start)
    if other is None:
        return
    if other.start >= phase.start:
        yield put_off(sight.mission, phase, (sight.other, other))
    else:
        landed = Phase(other.name, other.shot, other.start, sight.other.curve.end)
        yield put_off(sight.mission, landed, (sight.film, phase))


def _aside(sight: CameraAndBody, times: Array, claim: Claim) -> str:
    """Return the shortest way to a side or up that leads the other drone out of every frame, in words."""
    places, yaw = sight.other.curve(times)[:, :3], sight.film.curve(times)[:, CAM_YAW]
    right = np.stack([np.sin(yaw), -np.cos(yaw), np.zeros(len(yaw))], axis=1)
    ways = {
        "farther to the right": right,
        "farther to the left": -right,
        "higher": np.array([[0.0, 0.0, 1.0]]),
    }

    beyond = BEYOND_RAD if claim.unit == "rad" else BEYOND_M

    def out(way: Array, metres: float) -> bool:
        return bool((sight.out_at(times, places + metres * way) >= claim.limit + beyond).all())

    found = []
    for word, way in ways.items():
        metres = _least_that(lambda m, way=way: out(way, m), FARTHEST_M)  # type: ignore[misc]
        if metres is not None:
            found.append((metres, word))
    if not found:
        return ""
    metres, word = min(found)
    return f"{at_least(metres, 1)} m {word}"


def _least_that(fits: Callable[[float], bool], most: float) -> float | None:
    """Return the least number up to ``most`` that fits, by bisection; None where the greatest does not."""
    low, high = 0.0, most
    if not fits(high):
        return None
    for _ in range(PLACE_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if fits(middle) else (middle, high)
    return high


def _turned(sight: CameraAndBody, times: Array, phase: Phase) -> str:
    """Return how far a camera with a given heading turns away; empty for one that follows a target."""
    mission = sight.mission
    shot = mission.shot(phase.shot)
    if not shot.keyframes or any(k.aim is None or len(k.aim) != 2 for k in shot.keyframes):
        return ""
    film, away = sight.film.curve(times), sight.other.curve(times)[:, :3]
    east, north = (away - film[:, :3])[:, :2].T
    off = (np.arctan2(north, east) - film[:, CAM_YAW] + np.pi) % (2 * np.pi) - np.pi
    far = np.hypot(east, north)
    radius = sight.body.radius
    if (far <= radius).any():
        return ""
    half = film[:, HFOV] / 2 if mission.rules.half_angle is None else mission.rules.half_angle
    edge = half + np.arcsin(radius / far)
    # When the camera turns right, the picture moves left, and vice versa.
    right, left = float((edge - off).max()), float((edge + off).max())
    by = float(at_least(degrees(min(right, left)) + BEYOND_DEG, 0))
    direction = "right" if right <= left else "left"
    text = f"turn the camera of `{shot.id}` {by:.0f} deg to the {direction}"
    if len(shot.keyframes) > 1:
        return text
    heading = 90.0 - degrees(float(film[0, CAM_YAW])) + (by if direction == "right" else -by)
    return f"{text}, by `heading: {round(heading) % 360} deg`"

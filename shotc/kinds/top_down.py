"""Top-down: the camera looks straight down on the target, at rest or drifting."""

from math import atan2, hypot, inf, pi, sqrt, tan
from typing import Literal

from pydantic import Field

from shotc.diag.model import Diagnostic
from shotc.ir.mission import Beside, Composition
from shotc.ir.target import Target
from shotc.kinds.base import STILL_S, Expansion, Kind, Scene
from shotc.rounding import at_least, at_most
from shotc.spec.fields import CameraAltitude, Name, Velocity
from shotc.spec.shot import ShotBase

WATCH = Composition("top-down")
NORTH_RAD = pi / 2


class TopDownShot(ShotBase):
    """The parameters of a view from above; without drift it films for ``timing.duration``, by default 5 s."""

    kind: Literal["top-down"] = Field(description="what sort of shot it is")
    target: Name = Field(description="name of the target below the camera")
    altitude: CameraAltitude = Field(description="height of the camera over the target's foot")
    drift: Velocity | None = Field(
        default=None, description="velocity of the camera from above the target; needs timing.duration"
    )


def expand(shot: TopDownShot, scene: Scene) -> Expansion:
    """Return keyframes above the target that look straight down, the top of the picture along the drift.

    The camera tilts only if the shot itself has a composition, because this kind is for looking straight
    down.
    """
    target = scene.subject(shot.target, "target")
    if not isinstance(target, Target):
        return Expansion.of([target])
    x, y, _ = target.centre
    east, north, up = shot.drift or (0.0, 0.0, 0.0)
    duration = shot.timing.duration
    fixed = {
        "aim": (_top(shot), -pi / 2),
        "composition": shot.composition or WATCH,
    }
    drifts = hypot(east, north, up) > 0
    if drifts and duration is None:
        return Expansion.of([scene.lasting("K009", "a drift needs a duration", "drift")])
    seconds = duration or STILL_S
    above, high = shot.altitude.above, shot.altitude.first
    end = (east * seconds, north * seconds, high + up * seconds)
    if target.track is not None:
        places = [Beside(shot.target, p, above=above or "target") for p in ((0.0, 0.0, high), end)]
        beside = (scene.keyframe(b.offset, shot.target, beside=b, **fixed) for b in places)
        return Expansion.of(beside)._replace(duration=seconds)
    first = scene.raised((x, y, high), target, above)
    if not drifts:
        return Expansion.of([scene.keyframe(first, shot.target, hold=seconds, **fixed)])
    fault = _too_fast(shot, scene, target, seconds)
    if fault is not None:
        return Expansion.of([fault])
    return Expansion.of(
        scene.keyframe(at, shot.target, **fixed)
        for at in (first, scene.raised((x + end[0], y + end[1], end[2]), target, above))
    )


def _top(shot: TopDownShot) -> float:
    """Return the yaw of a camera that looks straight down: the direction of the picture's top, rad.

    It is the direction of the drift. A camera that tilts to keep its target placed has the target ahead of
    it: behind it, the gimbal would have to tilt past the vertical, and the picture would turn over.
    """
    east, north, _ = shot.drift or (0.0, 0.0, 0.0)
    if hypot(east, north) == 0.0:
        return NORTH_RAD
    return atan2(north, east) if shot.composition is None else atan2(-north, -east)


def _too_fast(shot: TopDownShot, scene: Scene, target: Target, duration: float) -> Diagnostic | None:
    """Return the fault of a drift whose mean speed no drone reaches from rest to rest, or None.

    A longer shot would drift farther, so the timing is not at fault.
    """
    east, north, up = shot.drift or (0.0, 0.0, 0.0)
    limits = scene.drone.limits
    for direction, drift, speed in (
        ("across", hypot(east, north), limits.speed_along(east, north)),
        ("up", up, limits.climb),
        ("down", -up, limits.descent),
    ):
        most = _mean_speed(speed, limits.acceleration, duration)
        if speed > 0 and drift > most:  # another check reports wind that leaves no speed
            notes = [
                f"from rest to rest in {duration:.1f} s, at up to {at_least(speed)} m/s and "
                f"{limits.acceleration:.2f} m/s^2, it averages {at_least(most)} m/s at most"
            ]
            seen = _seen(shot, scene, target) / duration if direction == "across" else most
            if seen < most:
                notes.append(f"from so high it drifts off its target at more than {at_most(seen)} m/s")
            return scene.fault(
                "K012",
                f"drone `{shot.drone}` cannot drift {drift:.2f} m/s {direction}",
                f"drift less than {at_most(min(most, seen))} m/s"
                + ("" if seen < drift else _faster(direction, drift, speed, limits.acceleration * duration)),
                "drift",
                notes=tuple(notes),
            )
    return None


def _seen(shot: TopDownShot, scene: Scene, target: Target) -> float:
    """Return the horizontal distance up to which the camera sees its target's middle, metres.

    The camera looks straight down, with the top of the picture along the drift, unless a composition tilts
    it.
    """
    if shot.composition is not None:
        return inf
    high = shot.altitude.first - scene.height_of(target, shot.altitude.above)
    return max(0.0, high) * tan(scene.drone.hfov / 2) / scene.drone.aspect


def _faster(direction: str, drift: float, speed: float, gained: float) -> str:
    """Return by how much a limit has to be raised for a drift, as a remedy; empty where no speed is enough.

    speed  : its present value along the drift, m/s
    gained : what the acceleration gains in the time of the drift, m/s
    """
    if gained <= 4.0 * drift:
        return ""
    key = {"across": "speed", "up": "climb", "down": "descent"}[direction]
    needed = 0.5 * (gained - sqrt(gained * (gained - 4.0 * drift)))  # so that _mean_speed is the drift
    return f", or raise `limits.{key}` by {at_least(needed - speed)} m/s if it flies that"


def _mean_speed(speed: float, acceleration: float, duration: float) -> float:
    """Return the largest mean speed from rest to rest, m/s."""
    if acceleration * duration <= 2 * speed:
        return acceleration * duration / 4
    return speed - speed * speed / (acceleration * duration)


KIND = Kind("top-down", "look straight down on the target", TopDownShot, expand)

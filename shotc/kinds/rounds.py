"""Ideal paths about an upright axis: rings and straight lines, sampled as keyframe positions.

Azimuth is a compass bearing from the axis (clockwise from North), rad. Altitude is a height over the shot's
reference, and is converted to z in W at the end.
"""

from __future__ import annotations

from math import atan2, ceil, cos, hypot, pi, sin

from shotc.ir.ground import Above
from shotc.ir.limits import Vec3
from shotc.ir.mission import Ideal
from shotc.ir.target import Target
from shotc.kinds.base import Expansion, Scene
from shotc.kinds.moving import evenly, timed
from shotc.spec.shot import ShotBase
from shotc.spec.words import each

Span = tuple[float, float]

LARGEST_ARC_RAD = pi / 12  # rad, largest turn between two keyframes
FEWEST_PIECES = 4  # fewest pieces of a path
MOST_PIECES = 48  # most pieces of a straight path


def bearing(axis: Vec3, azimuth: float, distance: float, altitude: float) -> Vec3:
    """Return the point at a compass bearing and a horizontal distance from an axis."""
    return (axis[0] + distance * sin(azimuth), axis[1] + distance * cos(azimuth), altitude)


def ring(axis: Vec3, start: float, sweep: float, radius: Span, altitude: Span) -> list[Vec3]:
    """Return points along a turn about an axis; radius and altitude are linear in the angle.

    start : azimuth of the first point; sweep : turn, positive counter-clockwise seen from above
    """
    pieces = max(FEWEST_PIECES, ceil(abs(sweep) / LARGEST_ARC_RAD - 1e-9))
    return [
        bearing(axis, start - sweep * t, _between(radius, t), _between(altitude, t))
        for t in (i / pieces for i in range(pieces + 1))
    ]


def line(
    axis: Vec3, azimuth: float, distance: Span, altitude: Span, height: float, least: int = FEWEST_PIECES
) -> list[Vec3]:
    """Return points along a straight line in the vertical plane of one azimuth.

    height : that the camera looks at, with the reference of altitude; points are denser where its view turns
        more
    least : fewest pieces of the line
    """
    first, last = (atan2(z - height, d) for d, z in zip(distance, altitude, strict=True))
    turn = abs(last - first)
    nearest, farthest = sorted(hypot(d, z - height) for d, z in zip(distance, altitude, strict=True))
    zoom = farthest / max(nearest, 1e-6)
    pieces = min(MOST_PIECES, max(least, ceil(turn / LARGEST_ARC_RAD), ceil(zoom)))
    return [
        bearing(axis, azimuth, _between(distance, t), _between(altitude, t))
        for t in (i / pieces for i in range(pieces + 1))
    ]


def axis_of(target: Target) -> Vec3:
    """Return the point that a ring or a line is relative to; for a moving target it is on its own axis."""
    return target.centre if target.track is None else (0.0, 0.0, target.centre[2])


def filmed(
    shot: ShotBase,
    scene: Scene,
    target: Target,
    points: list[Vec3],
    turn: str = "",
    above: Above | None = None,
) -> Expansion:
    """Return the expansion of a path along ``points`` about ``axis_of(target)`` that frames the target.

    turn : name of the parameter of the motion, if it is an angle and no pair [from, to]
    above : reference of the points' heights; None for the target's foot
    """
    if max(hypot(*(a - b for a, b in zip(p, points[0], strict=True))) for p in points) >= 1e-3:
        if target.track is not None:
            return timed(shot, scene, Ideal("target", target.name, evenly(points), above=above or "target"))
        return Expansion.of(scene.keyframe(scene.raised(p, target, above), shot.target) for p in points)
    how = (
        f"give `{turn}` an angle such as `180 deg`"
        if turn
        else "give what is to move as two different values, [from, to]"
    )
    if target.track is None:
        how += f", or {_standing(shot, scene, scene.raised(points[0], target, above))}"
    return Expansion.of([scene.fault("K010", f"nothing moves in this {shot.kind}", how, turn or "kind")])


def _standing(shot: ShotBase, scene: Scene, at: Vec3) -> str:
    """Return a help text with the keys of a still camera, and the keys that they replace."""
    place = ", ".join(f"{c + 0.0:.2f}" for c in at)
    own = [key for key in scene.written() if key not in ShotBase.model_fields]
    return f"write `kind: static, at: [{place}], look_at: {shot.target}` in place of {each(own)}"


def _between(span: Span, t: float) -> float:
    return span[0] + (span[1] - span[0]) * t

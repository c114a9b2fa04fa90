"""The distance parameters of the kinds that generate a path about a target."""

from __future__ import annotations

from math import hypot

from shotc.ir.limits import Vec3
from shotc.ir.mission import Keyframe, MissionIR, Shot

DISTANCES = {
    "orbit": "radius",
    "spiral": "radius",
    "elevator": "distance",
    "dolly": "distance",
    "dolly-zoom": "distance",
    "crane": "distance",
}
"""Name of the distance from the target's axis, by kind; each of these kinds also has `altitude`."""


FROM_ABOVE = "top-down"
"""The kind whose `altitude` is its distance: its camera stands over the target."""


def distance_key(kind: str) -> str | None:
    """Return the name of the parameter that sets how far a generated path is from its target, if any."""
    return "altitude" if kind == FROM_ABOVE else DISTANCES.get(kind)


def as_counted(mission: MissionIR, shot: Shot, altitude: str) -> str:
    """Return an altitude as it is written, with its reference where the shot has one."""
    if (*shot.path, "altitude", "above") not in mission.origins.values:
        return altitude
    return f"{{above: {shot.above}, height: {altitude}}}"


def at_distance(centre: Vec3, keyframe: Keyframe, distance: float) -> Keyframe:
    """Return a keyframe moved horizontally to a distance from the axis through ``centre``, metres."""
    x, y, z = keyframe.at
    share = distance / max(hypot(x - centre[0], y - centre[1]), 1e-9)
    return keyframe._replace(at=(centre[0] + (x - centre[0]) * share, centre[1] + (y - centre[1]) * share, z))


def distance_of(centre: Vec3, keyframe: Keyframe) -> float:
    """Return the distance of a keyframe from the vertical axis through ``centre``, metres."""
    return hypot(keyframe.at[0] - centre[0], keyframe.at[1] - centre[1])


def span(first: float, last: float) -> str:
    """Return one value, or two different ones as [from, to], as text in tenths of a metre."""
    a, b = f"{first + 0.0:.1f}", f"{last + 0.0:.1f}"
    return a if a == b else f"[{a}, {b}]"

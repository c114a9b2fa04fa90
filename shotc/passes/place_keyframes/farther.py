"""The distance from which a target fits into the frame, as a place of a keyframe or a parameter of a path."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot

from shotc.diag.model import Label
from shotc.geom.vec import Vec3
from shotc.ir.ground import counted_from
from shotc.ir.mission import Keyframe, MissionIR, Shot
from shotc.kinds.parameters import (
    DISTANCES,
    FROM_ABOVE,
    as_counted,
    at_distance,
    distance_key,
    distance_of,
    span,
)
from shotc.planning.framing.candidates import FixedCamera
from shotc.rounding import at_least, up

FARTHEST_RATIO = 50.0  # largest factor of the present distance that is tried
ABOVE_AXIS_M = 0.1  # metres from the target's axis, below which a camera is above it
NUDGE_M = 0.01  # metres added to a proposed distance

Fits = Callable[[FixedCamera], bool]


def farther(mission: MissionIR, shot: Shot, keyframe: Keyframe, setting: FixedCamera, fits: Fits) -> str:
    """Return a remedy with a place where the target fits, within ``FARTHEST_RATIO`` times as far; else empty.

    A camera placed by the user goes straight back, or horizontally where that would be too close to the
    ground. A generated path keeps its altitude, but a view from above gets another one.
    """
    if not keyframe.placed and shot.kind == FROM_ABOVE:
        return _by_altitude(mission, shot, keyframe, setting, fits)
    if not keyframe.placed and shot.kind in DISTANCES:
        return _by_parameter(mission, shot, keyframe, setting, fits)
    off_axis = hypot(*setting.offset[:2]) > ABOVE_AXIS_M
    level = off_axis and not keyframe.placed
    offset = _back(setting, fits, level=level)
    radius = mission.drone(shot.drone).radius

    def low(place: Vec3) -> bool:
        return place[2] < mission.lowest(place, radius)

    if off_axis and not level and (offset is None or low(_place(keyframe, setting, offset))):
        level, offset = True, _back(setting, fits, level=True)
    if offset is None:
        return ""
    metres, origin = hypot(*offset[: 2 if level else 3]), "axis" if level else "centre"
    far = f"{at_least(metres, 1)} m from its {origin}"
    if not keyframe.placed:
        return f"{'keep' if level else 'move to'} {far}"
    written = ", ".join(f"{round(c, 2) + 0.0:.2f}" for c in _place(keyframe, setting, offset))
    return f"move to [{written}], {far}"


def _place(keyframe: Keyframe, setting: FixedCamera, offset: Vec3) -> Vec3:
    """Return the camera's place for another offset of the target."""
    x, y, z = (p + o - q for p, o, q in zip(keyframe.at, setting.offset, offset, strict=True))
    return (x, y, z)


def parameter_label(mission: MissionIR, shot: Shot, keyframe: Keyframe) -> Label | None:
    """Return a label on the parameter that sets a generated path's distance, if its kind has one."""
    key = distance_key(shot.kind)
    return None if keyframe.placed or key is None else mission.origins.value((*shot.path, key))


def least(fits: Callable[[float], bool], low: float, high: float) -> float | None:
    """Return the least value that fits, by bisection; None where the highest does not."""
    if not fits(high):
        return None
    while high - low > 1e-3 * low:
        middle = (low + high) / 2
        if fits(middle):
            high = middle
        else:
            low = middle
    return high


def _back(setting: FixedCamera, fits: Fits, *, level: bool) -> Vec3 | None:
    """Return the least offset to the target that fits, along the line of sight or horizontally."""
    x, y, z = setting.offset

    def scaled(k: float) -> Vec3:
        return (x * k, y * k, z if level else z * k)

    k = least(lambda k: fits(setting._replace(offset=scaled(k))), 1.0, FARTHEST_RATIO)
    if k is None:
        return None
    return scaled(k + NUDGE_M / (hypot(x, y) if level else hypot(x, y, z)))


def _by_parameter(
    mission: MissionIR, shot: Shot, keyframe: Keyframe, setting: FixedCamera, fits: Fits
) -> str:
    """Return a remedy with the parameter for which the target fits at every keyframe, at its altitude."""
    assert keyframe.target is not None
    centre = mission.target(keyframe.target).centre

    def whole(k: Keyframe, distance: float) -> bool:
        x, y, z = at_distance(centre, k, distance).at
        return fits(setting._replace(offset=(centre[0] - x, centre[1] - y, centre[2] - z)))

    enough = 0.0
    for k in (keyframe, *shot.keyframes):
        now = max(enough, distance_of(centre, k))
        if not whole(k, now):
            needed = least(lambda d, k=k: whole(k, d), now, now * FARTHEST_RATIO)  # type: ignore[misc]
            if needed is None:
                return ""
            enough = needed
    enough = up(enough, 1)
    first, last = (distance_of(centre, shot.keyframes[i]) for i in (0, -1))
    if max(first, last) < enough:  # both ends are too near: keep their difference
        near = min(first, last)
        first, last = enough + first - near, enough + last - near
    written = span(max(first, enough), max(last, enough))
    return f"write `{DISTANCES[shot.kind]}: {written}`"


def _by_altitude(mission: MissionIR, shot: Shot, keyframe: Keyframe, setting: FixedCamera, fits: Fits) -> str:
    """Return a remedy with the altitude from which a view from above shows the target at every keyframe."""
    assert keyframe.target is not None
    target, (x, y, low) = mission.target(keyframe.target), shot.keyframes[0].at
    centre = target.centre

    def whole(high: float) -> bool:
        """Return whether the target fits at all keyframes, with the first so high over its centre."""
        rise = high + centre[2] - low
        places = [(k.at[0], k.at[1], k.at[2] + rise) for k in shot.keyframes]
        offsets = [(centre[0] - a, centre[1] - b, centre[2] - c) for a, b, c in places]
        return all(fits(setting._replace(offset=offset)) for offset in offsets)

    now = low - centre[2]
    enough = least(whole, now, now * FARTHEST_RATIO) if now > 0.0 else None
    if enough is None or shot.above is None:
        return ""
    counted = enough + centre[2] - counted_from(shot.above, mission.ground, (x, y), target.foot[2])
    return f"write `altitude: {as_counted(mission, shot, f'{at_least(counted, 1)}')}`"

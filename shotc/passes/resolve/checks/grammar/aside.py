"""The place at which a shot has to begin for the cut to it to look intended."""

from __future__ import annotations

from math import acos, atan2, ceil, cos, degrees, hypot, radians, sin

from shotc.geom.vec import wrapped
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR, Shot
from shotc.passes.resolve.checks.grammar.end_frames import ShotFrame

_KEYS = ("azimuth", "start_azimuth")


def to_the_side(mission: MissionIR, after: Shot, left: ShotFrame, right: ShotFrame, apart: float) -> str:
    """Return a remedy with a start at least ``apart`` rad from the view before the cut.

    The camera keeps its height and distance. Empty where these heights allow no such place, because from high
    above all sides look alike, and where the shot's kind has no key for an azimuth.
    """
    azimuth_deg = _azimuth(left.offset, right.offset, apart)
    if azimuth_deg is None:
        return ""
    azimuth = f"{azimuth_deg % 360} deg"
    if after.keyframes and after.keyframes[0].placed:
        return f"begin `{after.id}` at {_place(right, azimuth_deg)}"
    key = next((key for key in _KEYS if (*after.path, key) in mission.origins.values), None)
    if after.ideal is not None and after.kind == "framing":
        return f"begin `{after.id}` at an azimuth of {azimuth} from `{right.names[0]}`"
    return "" if key is None or after.ideal is not None else f"write `{key}: {azimuth}`"


def _azimuth(left: Vec3, right: Vec3, apart: float) -> int | None:
    """Return the azimuth of the nearer of the two sides, in whole degrees slightly beyond ``apart``.

    Two views at elevations e and f, with azimuths d apart, are acos(cos e cos f cos d + sin e sin f) apart.
    """
    across = hypot(*left[:2]) * hypot(*right[:2])
    if across < 1e-6:
        return None
    turn = (cos(apart) * hypot(*left) * hypot(*right) - left[2] * right[2]) / across
    if not -1.0 <= turn <= 1.0:
        return None
    middle, now = (degrees(atan2(x, y)) for x, y, _ in (left, right))
    turn_deg = degrees(acos(turn)) + 0.5  # so that a place rounded to centimetres is still beyond it
    azimuths = (ceil(middle + turn_deg), -ceil(turn_deg - middle))
    return min(azimuths, key=lambda candidate: abs(wrapped(radians(candidate - now))))


def _place(right: ShotFrame, azimuth: int) -> str:
    (x, y, _), (cx, cy, _) = right.offset, right.centres[0]
    far, angle = hypot(x, y), radians(azimuth)
    return f"[{cx + far * sin(angle):.2f}, {cy + far * cos(angle):.2f}, {right.eye[2]:.2f}]"

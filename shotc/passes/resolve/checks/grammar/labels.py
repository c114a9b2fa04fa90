"""Labels of film grammar warnings in the mission file."""

from __future__ import annotations

from shotc.diag.model import Label
from shotc.ir.mission import MissionIR, Shot

# Parameters that determine a camera's place, the most specific first.
_PLACING = ("side", "azimuth", "start_azimuth", "at", "points", "kind")


def placing(mission: MissionIR, shot: Shot, *, last: bool, text: str = "") -> Label:
    """Return a label on what determines the camera's place at a shot's start, or with ``last`` at its end."""
    if shot.keyframes:
        at = (*shot.keyframes[-1 if last else 0].path, "at")
        if at in mission.origins.values:
            return mission.origins.value(at, text)
    key = next(key for key in _PLACING if (*shot.path, key) in mission.origins.values or key == "kind")
    return mission.origins.value((*shot.path, key), text)


def lasting(mission: MissionIR, shot: Shot) -> Label:
    """Return a label on a shot's duration, or on its kind where it has none."""
    duration = (*shot.path, "timing", "duration")
    return mission.origins.value(duration if duration in mission.origins.values else (*shot.path, "kind"))


def framing(mission: MissionIR, shot: Shot) -> Label:
    """Return a label on what determines where a shot's camera looks."""
    keys = (key for key in ("heading", "look_at") if (*shot.path, key) in mission.origins.values)
    return mission.origins.value((*shot.path, next(keys, "kind")))

"""Whether something hides a target from a camera, as planning judges it."""

from __future__ import annotations

from shotc.ir.hidden import hidden_by_surfaces, standing_before
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR


def hidden_from(mission: MissionIR, name: str, eye: Vec3, t: float) -> bool:
    """Return whether a solid hides a target's middle or a side from a place, or a surface a part of it."""
    return any(standing_before(mission, name, eye, t)) or any(hidden_by_surfaces(mission, name, ((t, eye),)))

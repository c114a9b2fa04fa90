"""Stated turns during which the camera would lose the target that it follows."""

from __future__ import annotations

from math import degrees, pi

from shotc.diag.model import Diagnostic
from shotc.geom.vec import TURN_RAD, wrapped
from shotc.ir.keyframes import PlacedKeyframe
from shotc.ir.mission import Keyframe, MissionIR


def while_following(
    mission: MissionIR, keyframes: tuple[Keyframe, ...], placed: tuple[PlacedKeyframe, ...]
) -> list[Diagnostic]:
    """Return errors for stated turns during which the camera would lose the target that it follows."""
    diagnostics = []
    for i, after in enumerate(placed):
        before = placed[i - 1]
        if after.turn is None or before.reference is None or after.reference is None:
            continue
        follows = wrapped(after.yaw - before.yaw)
        if abs(after.turn - follows) > pi:
            diagnostics.append(_lost(mission, keyframes[i], after, follows))
    return diagnostics


def _lost(mission: MissionIR, keyframe: Keyframe, placed: PlacedKeyframe, follows: float) -> Diagnostic:
    assert placed.turn is not None
    assert keyframe.heading is not None
    path = (*keyframe.path, "heading")
    direction = degrees(keyframe.heading % TURN_RAD)
    return Diagnostic(
        "K013",
        f"the camera cannot turn by {degrees(abs(placed.turn)):.0f} deg and follow target `{placed.target}`",
        (mission.origins.value(path),),
        (f"following it from the keyframe before takes {degrees(abs(follows)):.0f} deg",),
        f"write `heading: {direction:.0f} deg`, or turn between keyframes without a target",
    )

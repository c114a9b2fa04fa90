"""How often the camera goes round between keyframes, where the author says so.

A heading within a whole turn, either way, is a direction: how the camera gets there is free. One of 360 deg
or more counts turns: it is led up to by just the turn from the number written before it.
"""

from __future__ import annotations

from math import degrees, pi

from shotc.diag.model import Diagnostic
from shotc.geom.angles import TURN, wrapped
from shotc.geom.camera import heading_of
from shotc.ir.keyframes import PlacedKeyframe
from shotc.ir.mission import Keyframe, MissionIR

ROUNDING = 1e-9


def with_turns(
    keyframes: tuple[Keyframe, ...], placed: tuple[PlacedKeyframe, ...]
) -> tuple[PlacedKeyframe, ...]:
    """Return the placed keyframes with the turns that their headings state.

    Where nothing is written before, the keyframe before counts with its heading from 0 to 360 deg. What
    composition turns the camera by is added.
    """
    done = placed[:1]
    for i in range(1, len(placed)):
        heading = keyframes[i].heading
        if heading is None or abs(heading) < TURN - ROUNDING:
            done += (placed[i],)
            continue
        before = keyframes[i - 1].heading
        written = (heading_of(placed[i - 1].yaw) if before is None else before) - heading
        step = placed[i].yaw - placed[i - 1].yaw
        done += (placed[i]._replace(turn=written + wrapped(step - written)),)
    return done


def while_following(
    mission: MissionIR, keyframes: tuple[Keyframe, ...], placed: tuple[PlacedKeyframe, ...]
) -> list[Diagnostic]:
    """Return errors for stated turns in which the camera would lose the target that it follows."""
    found = []
    for i, after in enumerate(placed):
        before = placed[i - 1]
        if after.turn is None or before.reference is None or after.reference is None:
            continue
        follows = wrapped(after.yaw - before.yaw)
        if abs(after.turn - follows) > pi:
            found.append(_lost(mission, keyframes[i], after, follows))
    return found


def _lost(mission: MissionIR, keyframe: Keyframe, placed: PlacedKeyframe, follows: float) -> Diagnostic:
    assert placed.turn is not None
    assert keyframe.heading is not None
    path = (*keyframe.path, "heading")
    direction = degrees(keyframe.heading % TURN)
    return Diagnostic(
        "K013",
        f"the camera cannot turn by {degrees(abs(placed.turn)):.0f} deg and follow target `{placed.target}`",
        (mission.origins.value(path),),
        (f"following it from the keyframe before takes {degrees(abs(follows)):.0f} deg",),
        f"write `heading: {direction:.0f} deg`, or turn between keyframes without a target",
    )

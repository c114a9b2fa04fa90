"""Whole turns of the camera between keyframes, where the author states them.

A heading within one whole turn, either way, is a direction, and the turn to it is free. A heading of 360 deg
or more states turns: the camera turns by exactly the difference from the number written before it.
"""

from __future__ import annotations

from shotc.geom.camera import heading_of
from shotc.geom.vec import TURN_RAD, wrapped
from shotc.ir.keyframes import PlacedKeyframe
from shotc.ir.mission import Keyframe

ROUNDING = 1e-9


def with_turns(
    keyframes: tuple[Keyframe, ...], placed: tuple[PlacedKeyframe, ...]
) -> tuple[PlacedKeyframe, ...]:
    """Return the placed keyframes with the turns that their headings state.

    Where no heading is written before, that of the keyframe before counts, from 0 to 360 deg. The change of
    angle due to composition is added.
    """
    turned = placed[:1]
    for i in range(1, len(placed)):
        heading = keyframes[i].heading
        if heading is None or abs(heading) < TURN_RAD - ROUNDING:
            turned += (placed[i],)
            continue
        before = keyframes[i - 1].heading
        written = (heading_of(placed[i - 1].yaw) if before is None else before) - heading
        step = placed[i].yaw - placed[i - 1].yaw
        turned += (placed[i]._replace(turn=written + wrapped(step - written)),)
    return turned

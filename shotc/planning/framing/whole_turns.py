"""How often the camera goes round between keyframes, where the author says so.

A heading within a whole turn, either way, is a direction: how the camera gets there is free. One of 360 deg
or more counts turns: it is led up to by just the turn from the number written before it.
"""

from __future__ import annotations

from shotc.geom.camera import heading_of
from shotc.geom.vec import TURN, wrapped
from shotc.ir.keyframes import PlacedKeyframe
from shotc.ir.mission import Keyframe

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

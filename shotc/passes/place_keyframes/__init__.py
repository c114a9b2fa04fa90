"""place-keyframes: MissionIR to KeyframeIR.

It takes keyframes with the angles or targets that the user gave. It gives camera angles that put each target
on the nearest place of its composition set (framing Eq. 1 and 2). The camera turns; it never moves. It
guarantees that every target with a composition is whole in the frame, within the gimbal's range.
"""

from __future__ import annotations

from typing import ClassVar

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.ir.flown_order import flown_order
from shotc.ir.keyed import is_keyed
from shotc.ir.keyframes import KeyframeIR, PlacedShot
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.passes import Outcome, PassContext
from shotc.passes.place_keyframes.faults import report, while_following
from shotc.passes.place_keyframes.keyed import place_keyed
from shotc.passes.place_keyframes.sizes import check_size
from shotc.passes.place_keyframes.subjects import place_subjects
from shotc.planning.framing.placing import Unmet, place_shot


class PlaceKeyframes:
    """The pass; it has no options."""

    name: ClassVar[str] = "place-keyframes"

    def run(self, ir: MissionIR, ctx: PassContext) -> Outcome[KeyframeIR]:
        """Place every keyframe of every shot; shots are returned in the order of flight."""
        shots: list[PlacedShot] = []
        diagnostics: list[Diagnostic] = []
        for shot in flown_order(ir.shots):
            ctx.progress(f"placing the keyframes of {shot.id}")
            if is_keyed(shot):
                moving, wrong = place_keyed(ir, shot)
                shots.append(moving)
                diagnostics += [*wrong, *_sized(ir, moving)]
                continue
            if shot.ideal is not None:
                subjects, faults = place_subjects(ir, shot)
                shots.append(PlacedShot(shot, (), subjects))
                diagnostics += [*faults, *_sized(ir, shots[-1])]
                continue
            placed, misses = place_shot(ir, shot)
            shots.append(PlacedShot(shot, placed))
            diagnostics += _sized(ir, shots[-1])
            diagnostics += _reported(ir, shot, misses)
            diagnostics += while_following(ir, shot.keyframes, placed)
        value = None if has_errors(diagnostics) else KeyframeIR(ir, tuple(shots))
        return Outcome(value, tuple(diagnostics))


def _reported(mission: MissionIR, shot: Shot, misses: tuple[Unmet, ...]) -> list[Diagnostic]:
    if not misses:
        return []
    return report(mission, shot, misses)


def _sized(mission: MissionIR, placed: PlacedShot) -> list[Diagnostic]:
    if placed.shot.size is None:
        return []
    fault = check_size(mission, placed)
    return [] if fault is None else [fault]

"""What a refined path changes about what is said: errors that are the refiner's, warnings that are over."""

from __future__ import annotations

from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.ir.mission import Shot
from shotc.ir.path import PathIR
from shotc.passes.refine_path.faults import filmed
from shotc.passes.refine_path.finding import Fault
from shotc.passes.refine_path.seat import Seat
from shotc.passes.refine_path.settle import kept, same

OF_THE_CONVEX = ("Q007",)
"""Warnings of what the convex path cannot frame; verification says it of a path that is flown instead."""


class Verdict(NamedTuple):
    """Whether the mission lets the convex path be flown instead, and what there is to say."""

    convex: bool
    diagnostics: tuple[Diagnostic, ...]


def blame(seat: Seat, paths: tuple[PathIR, PathIR], errors: tuple[Diagnostic, ...]) -> Verdict:
    """Return what becomes of a refined path that came to errors.

    paths : the convex and the refined one; errors : what later passes say of the refined one, and not of
    the convex one
    """
    before, _ = paths
    refined = _refined(paths)
    if all(shot.refine_optional for shot in refined):
        faults = [Fault(None, error) for error in errors]
        return Verdict(True, tuple(kept(before, seat, shot.id, faults) for shot in refined))
    notes = [note for error in errors for note in (error.message, *error.notes)]
    return Verdict(
        False,
        (
            Diagnostic(
                "R009",
                f"{seat.named} refined a path that can be flown to one that cannot",
                errors[0].labels,
                tuple(notes),
                f"plan with `--refiner none`, or give the refiner more room: {errors[0].help}",
            ),
        ),
    )


def still_true(paths: tuple[PathIR, PathIR], said: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
    """Return what was said, less the warnings about convex legs that are not flown; paths as in ``blame``."""
    before, _ = paths
    refined = {shot.id for shot in _refined(paths)}
    find = before.keyframes.mission.origins.key
    over = {find(k.path).span for p in before.keyframes.shots if p.shot.id in refined for k in p.keyframes}
    return tuple(d for d in said if d.code not in OF_THE_CONVEX or d.labels[0].span not in over)


def _refined(paths: tuple[PathIR, PathIR]) -> list[Shot]:
    before, after = paths
    shots = before.keyframes.mission.shots
    return [s for s in shots if not same(filmed(before, s.id), filmed(after, s.id))]

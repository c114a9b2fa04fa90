"""A refined path that a later pass refuses although the convex one can be flown: the refiner's fault."""

from __future__ import annotations

from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.ir.path import PathIR
from shotc.passes.refine_path.faults import leg_of
from shotc.passes.refine_path.finding import Fault
from shotc.passes.refine_path.seat import Seat
from shotc.passes.refine_path.settle import kept, same


class Verdict(NamedTuple):
    """Whether the mission lets the convex path be flown instead, and what there is to say."""

    convex: bool
    diagnostics: tuple[Diagnostic, ...]


def blame(seat: Seat, paths: tuple[PathIR, PathIR], errors: tuple[Diagnostic, ...]) -> Verdict:
    """Return what becomes of a refined path that came to errors.

    paths : the convex and the refined one; errors : what later passes say of the refined one, and not of
    the convex one
    """
    before, after = paths
    shots = before.keyframes.mission.shots
    refined = [s for s in shots if not same(leg_of(before, s.id), leg_of(after, s.id))]
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

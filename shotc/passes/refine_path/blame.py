"""Diagnostics that a refined path changes: errors caused by the refiner, and warnings that no longer hold.

A refiner's error also says what the convex path offers: how to keep it, or why it fails as well.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.ir.drawn import is_drawn
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.path import CORNERS, ClockDeviation, PathDeviation, PathIR, filmed
from shotc.passes.refine_path.finding import RefinerFault, shot_of
from shotc.passes.refine_path.seat import Seat
from shotc.passes.refine_path.settle import kept_convex, same
from shotc.passes.solve_path_qp.explain.on_clock import left_places
from shotc.passes.solve_path_qp.explain.path import moved

OF_THE_CONVEX = ("Q007",)
"""Warnings about framing on the convex path; verification reports on a refined path instead."""

TOO_SHORT, POSSIBLE = "T001", "the shortest possible"
"""The error of an infeasible duration, and its phrase for the least feasible one."""

KEEP = "plan with `--refiner none`, or let all shots that are refined say `refine: {optional: true}`"
OF_A_PATH = "Q006"
"""The warning about a path that leaves its ideal; a refined one leaves the lines of a drawn path by another
distance."""
OF_THE_GUIDE = "M008"
"""The warning about the deviation of a shot on its own clock; a refined shot has another deviation."""
FAMILY = "R"
NONE = "plan with `--refiner none`"


class Blame(NamedTuple):
    """Whether the mission allows the convex path instead, and the diagnostics."""

    convex: bool
    diagnostics: tuple[Diagnostic, ...]


def blame(seat: Seat, paths: tuple[PathIR, PathIR], errors: tuple[Diagnostic, ...]) -> Blame:
    """Return the verdict on a refined path that causes errors.

    paths : the convex and the refined one
    errors : those of later passes on the refined path that the convex one does not have
    """
    before, _ = paths
    refined = _refined(paths)
    if all(shot.refine_optional for shot in refined):
        faults = [RefinerFault(None, error) for error in errors]
        return Blame(True, tuple(kept_convex(before, seat, shot.id, faults) for shot in refined))
    notes = [note for error in errors for note in (error.message, *error.notes)]
    return Blame(
        False,
        (
            Diagnostic(
                "R009",
                f"{seat.named} refined a path that can be flown to one that cannot",
                errors[0].labels,
                tuple(notes),
                f"{KEEP}, or give the refiner more room: {errors[0].help}",
            ),
        ),
    )


def shortest_refined(
    seat: Seat, diagnostics: tuple[Diagnostic, ...], convex: tuple[Diagnostic, ...]
) -> tuple[Diagnostic, ...]:
    """Return the diagnostics of a refined path, with least durations marked as those of that path.

    convex : diagnostics of the convex path, which is not flown either
    """
    unrefined = {d.labels[0].span: d for d in convex if d.code == TOO_SHORT}

    def refined_time(d: Diagnostic) -> Diagnostic:
        other = unrefined.get(d.labels[0].span) if d.code == TOO_SHORT else None
        if other is None or other.message == d.message:
            return d
        return d._replace(
            message=d.message.replace(
                POSSIBLE, f"the shortest possible on the path of refiner `{seat.refiner.name}`"
            ),
            notes=(*d.notes, f"the convex path is too slow, too: {other.message}"),
        )

    return tuple(refined_time(d) for d in diagnostics)


def valid_on_refined(
    paths: tuple[PathIR, PathIR], diagnostics: tuple[Diagnostic, ...]
) -> tuple[Diagnostic, ...]:
    """Return the diagnostics without warnings about convex legs that are not flown; paths as in ``blame``.

    Where a guide left its ideal, or a drawn path its lines, and was refined, the deviation of the refined
    motion is reported instead.
    """
    before, after = paths
    mission = before.keyframes.mission
    refined = {shot.id for shot in _refined(paths)}
    find = mission.origins.key
    over = {find(k.path).span for p in before.keyframes.shots if p.shot.id in refined for k in p.keyframes}
    drawn = {
        find(p.shot.path).span: p for p in before.keyframes.shots if p.shot.id in refined and is_drawn(p.shot)
    }
    untrue = {
        id(d)
        for d in diagnostics
        if (d.code in OF_THE_CONVEX and d.labels[0].span in over)
        or (d.code == OF_THE_GUIDE and _of(mission, d) in refined)
        or (d.code == OF_A_PATH and d.labels[0].span in drawn)
    }
    guided = {_of(mission, d) for d in diagnostics if id(d) in untrue and d.code == OF_THE_GUIDE}
    on_clock = (d for d in after.deviations if isinstance(d, ClockDeviation))
    anew = left_places(mission, (d for d in on_clock if d.shot in guided))
    off_lines = (d for placed in drawn.values() for d in _off_lines(after, placed))
    return (*(d for d in diagnostics if id(d) not in untrue), *anew, *off_lines)


def _off_lines(path: PathIR, placed: PlacedShot) -> list[Diagnostic]:
    """Return the warnings of a drawn shot that leaves its lines for something else than its turns."""
    return [
        moved(path.keyframes.mission, placed, d)
        for d in path.deviations
        if d.shot == placed.shot.id and isinstance(d, PathDeviation) and d.cause != CORNERS
    ]


def _of(mission: MissionIR, diagnostic: Diagnostic) -> str | None:
    """Return the shot whose kind is the first label of a warning."""
    span = diagnostic.labels[0].span
    return next((s.id for s in mission.shots if mission.origins.value((*s.path, "kind")).span == span), None)


def _refined(paths: tuple[PathIR, PathIR]) -> list[Shot]:
    before, after = paths
    shots = before.keyframes.mission.shots
    return [s for s in shots if not same(filmed(before, s.id), filmed(after, s.id))]


def with_convex(
    path: PathIR, diagnostics: Iterable[Diagnostic], later: Iterable[Diagnostic]
) -> tuple[Diagnostic, ...]:
    """Return the diagnostics, with a note on the convex path in the refiner's errors.

    path : the convex one
    later : diagnostics of the later passes on it
    """
    against = next((d for d in later if has_errors([d])), None)
    return tuple(
        _with_convex(path, d, against) if has_errors([d]) and d.code[0] == FAMILY else d for d in diagnostics
    )


def _with_convex(path: PathIR, error: Diagnostic, against: Diagnostic | None) -> Diagnostic:
    shot = shot_of(path.keyframes.mission, error)
    whose = "the convex path" if shot is None else f"the convex path of shot `{shot}`"
    if against is not None:
        note = f"{whose} cannot be flown either: {against.code}: {against.message}"
        return error._replace(notes=(*error.notes, note), help=against.help or error.help)
    where = "all shots" if shot is None else f"shot `{shot}`"
    keep = f"let {where} fly the convex path by `refine: {{optional: true}}`, or {NONE}"
    note = f"{whose} keeps every limit and promise"
    return error._replace(notes=(*error.notes, note), help="; or ".join(filter(None, (error.help, keep))))

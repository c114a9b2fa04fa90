"""Add to a refiner's error what the convex path offers: how to keep it, or why it fails as well."""

from __future__ import annotations

from collections.abc import Iterable

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.ir.path import PathIR
from shotc.passes.refine_path.finding import shot_of

FAMILY = "R"
NONE = "plan with `--refiner none`"


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

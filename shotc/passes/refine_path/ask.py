"""Call a refiner, which may raise, take forever, or return anything."""

from __future__ import annotations

from typing import Any, NamedTuple

from shotc.diag.model import Diagnostic, Severity
from shotc.diag.plugin_faults import one_line
from shotc.diag.registry import registry, severity_of
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.path import PathIR
from shotc.passes.refine_path.child import Failed, TooSlow, refined_within
from shotc.passes.refine_path.finding import RefinerFault, RefinerFinding, error_of, own
from shotc.passes.refine_path.seat import Seat

LONGER = "give it a longer `--deadline`"


class RefinerAnswer(NamedTuple):
    """The answer of a refiner.

    path : anything; None where there is none
    faults : its errors, and ours about it
    warnings : its own
    """

    path: Any
    faults: tuple[RefinerFault, ...] = ()
    warnings: tuple[Diagnostic, ...] = ()


def ask(seat: Seat, deadline: float | None, path: PathIR, ctx: PassContext) -> RefinerAnswer:
    """Call a refiner on a path, for ``deadline`` seconds at most where one is given."""
    mission = path.keyframes.mission

    def fault(code: str, what: str, *notes: str) -> RefinerAnswer:
        return RefinerAnswer(None, (error_of(mission, seat, RefinerFinding(code, what, notes)),))

    try:
        if deadline is None or not seat.reference:
            outcome: Any = seat.refiner.refine(path, ctx)
        else:
            outcome = refined_within(deadline, seat.reference, path, ctx)
    except TooSlow:
        late = RefinerFinding("R004", f"was stopped after {deadline:g} s, its deadline", help=LONGER)
        return RefinerAnswer(None, (error_of(mission, seat, late),))
    except Failed as failed:
        return fault("R001", "failed", str(failed))
    except (Exception, SystemExit) as raised:  # noqa: BLE001  a plugin may raise anything
        return fault("R001", "failed", one_line(raised))
    if not isinstance(outcome, Outcome):
        return fault("R002", "returned no path", f"it returned a {type(outcome).__name__}, not an Outcome")
    if not _are_diagnostics(outcome.diagnostics):
        return fault("R002", "returned no path", "its diagnostics are not Diagnostics, or have unknown codes")
    errors = [d for d in outcome.diagnostics if severity_of(d) is Severity.ERROR]
    warnings = tuple(d for d in outcome.diagnostics if severity_of(d) is not Severity.ERROR)
    if outcome.value is None and not errors:
        return fault("R002", "returned no path", "it does not say why")
    return RefinerAnswer(outcome.value, tuple(own(mission, seat, d) for d in errors), warnings)


def _are_diagnostics(value: object) -> bool:
    return isinstance(value, tuple) and all(isinstance(d, Diagnostic) and d.code in registry() for d in value)

"""Call a refiner, which may raise, take forever, or return anything.

With a deadline it runs in its own process, which can be stopped at any time. The path and the answer pass
through pipes; the refiner's prints go to standard error.
"""

from __future__ import annotations

import pickle
import subprocess
from importlib.metadata import EntryPoint
from typing import Any, BinaryIO, NamedTuple

from shotc import child_process
from shotc.diag.model import Diagnostic, Severity
from shotc.diag.plugin_faults import one_line
from shotc.diag.registry import registry, severity_of
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.path import Deviation, DronePath, PathIR, TimedPath
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


class TooSlow(Exception):
    """The refiner did not answer in time."""


class Failed(Exception):
    """The refiner raised, or its process ended without an answer; the text says which."""


class _Bare(NamedTuple):
    """A PathIR without its mission, which the answer need not carry."""

    drones: tuple[DronePath, ...]
    deviations: tuple[Deviation, ...]
    stats: tuple[tuple[str, float | str], ...]
    timed: tuple[TimedPath, ...]


class _Request(NamedTuple):
    reference: str
    path: PathIR
    seed: int
    seconds: float


def refined_within(seconds: float, reference: str, path: PathIR, ctx: PassContext) -> Any:
    """Return a refiner's answer from its own process.

    If the process does not end by itself, it is killed with all its children.

    seconds : from the start of the process, including imports
    reference : module:attribute

    Raises TooSlow if there is no answer in time, and Failed if the refiner raises or the process ends without
    an answer.
    """
    data = child_process.module_path() + pickle.dumps(_Request(reference, path, ctx.seed, seconds))
    with child_process.started(__name__, answer.__name__) as process:
        try:
            answered, _ = process.communicate(data, timeout=seconds)
        except subprocess.TimeoutExpired:
            raise TooSlow from None
        finally:
            child_process.kill(process)
    return _read(answered, process.returncode, path)


def answer(orders: BinaryIO) -> None:
    """Run in the process: refine the path in ``orders`` and write the answer to standard output."""
    with child_process.answers() as out:
        order: _Request = pickle.load(orders)
        with child_process.ends_itself(order.seconds):
            out.write(child_process.answer_of(lambda: _refined(order)))


def _refined(order: _Request) -> Any:
    refiner = EntryPoint("refiner", order.reference, "").load()
    return _bare(refiner.refine(order.path, PassContext(order.seed)), order.path)


def _bare(outcome: Any, path: PathIR) -> Any:
    value = outcome.value if isinstance(outcome, Outcome) else None
    if not isinstance(value, PathIR) or value.keyframes is not path.keyframes:
        return outcome
    return outcome._replace(value=_Bare(value.drones, value.deviations, value.stats, value.timed))


def _read(answered: bytes, status: int, path: PathIR) -> Any:
    try:
        outcome, fault = pickle.loads(answered)
    except Exception:  # noqa: BLE001  half an answer, or none, may fail in any way
        raise Failed(child_process.ended(status)) from None
    if fault is not None:
        raise Failed(fault)
    if isinstance(outcome, Outcome) and isinstance(outcome.value, _Bare):
        return outcome._replace(value=PathIR(path.keyframes, *outcome.value))
    return outcome

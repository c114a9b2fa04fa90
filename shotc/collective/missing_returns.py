"""Times of a show without a return: one diagnostic for each run of times with the same cause."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import NamedTuple

from shotc.collective import Return
from shotc.diag.model import Diagnostic
from shotc.ir.measures import distinct_measures
from shotc.ir.mission import MissionIR
from shotc.ir.trajectory import Claim
from shotc.passes.verify.fleets.burning import PYRO
from shotc.passes.verify.report import limit_label, side_of
from shotc.rounding import at_least


class _Broken(NamedTuple):
    """A return, and the first claim that it breaks; None if all hold."""

    attempt: Return
    claim: Claim | None


def no_return(mission: MissionIR, returns: Sequence[Return]) -> Iterator[Diagnostic]:
    """Yield V063 for every run of consecutive times whose returns break the same limit."""
    worst = [_Broken(attempt, next(iter(attempt.broken), None)) for attempt in returns]
    for cause, row in groupby(worst, key=_cause):
        if cause is not None:
            yield _diagnostic(mission, [(attempt, claim) for attempt, claim in row if claim is not None])


def _cause(broken: _Broken) -> tuple[str, str] | None:
    return None if broken.claim is None else (broken.claim.subject, broken.claim.constraint)


def _diagnostic(mission: MissionIR, row: Sequence[tuple[Return, Claim]]) -> Diagnostic:
    attempt, claim = max(row, key=lambda broken: abs(broken[1].worst - broken[1].limit))
    reached, limit = distinct_measures(claim.worst, claim.limit, claim.unit)
    first, last = row[0][0].time, row[-1][0].time
    when = f"at {first:g} s" if len(row) == 1 else f"at {len(row)} times from {first:g} s to {last:g} s"
    who = f" ({' and '.join(f'`{name}`' for name in claim.drones)})" if claim.drones else ""
    at = "" if claim.time is None else f" at t = {claim.time:.2f} s"
    needed = f"{side_of(claim)} {limit}"
    return Diagnostic(
        "V063",
        f"fleet `{claim.subject}` has no return {when}",
        (limit_label(mission, claim, needed),),
        (
            f"the nearest to one, from {attempt.time:g} s, breaks {claim.constraint}: {reached}, {needed} is "
            f"{'allowed' if claim.upper else 'needed'}{who}{at}",
            "three ways were tried: over the pads from where it brakes, the same from its next stop, and "
            "back as it came",
        ),
        _help(claim),
    )


def _help(claim: Claim) -> str:
    lack = f"{at_least(abs(claim.worst - claim.limit))} {claim.unit}"
    if claim.constraint == "endurance":
        return f"show all until then {lack} sooner, or raise `endurance` by {lack} if the battery has it"
    if claim.constraint.startswith(PYRO):
        return f"it lacks {lack}: fire it at another moment, or show the pictures of the fleets farther apart"
    if claim.drones and claim.constraint.startswith("separation from"):
        return "put the pads of the fleets farther apart, or show their pictures one after the other"
    return f"it lacks {lack}: place its pictures or its pads elsewhere, or move what stands there"

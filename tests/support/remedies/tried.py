"""Whether a remedy does when it is written: the fault is gone, and no error has come in its place."""

from __future__ import annotations

from collections.abc import Callable

from shotc.diag.model import Diagnostic, Severity
from shotc.diag.registry import severity_of
from tests.support.remedies.apply import Remedy, remedies

Judge = Callable[[str], list[Diagnostic]]


def helps(mission: str, fault: Diagnostic, before: list[Diagnostic], judged: Judge) -> bool:
    """Tell whether a mission has a fault less, and no error that it did not have."""
    after = judged(mission)
    fewer = sum(d.code == fault.code for d in after) < sum(d.code == fault.code for d in before)
    known = {d.code for d in before}
    return fewer and not any(severity_of(d) is Severity.ERROR and d.code not in known for d in after)


def failed(text: str, judged: Judge) -> tuple[list[Remedy], list[str]]:
    """Return all remedies that a rule applies, and the texts of those that do not help."""
    before = judged(text)
    found, wrong = [], []
    for fault in before:
        for remedy in remedies(text, fault):
            found.append(remedy)
            if not any(helps(mission, fault, before, judged) for mission in remedy.missions):
                wrong.append(remedy.text)
    return found, wrong

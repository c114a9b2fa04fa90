"""Whether a remedy does when it is written: the fault is gone, and no error has come in its place."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from shotc.diag.model import Diagnostic, Severity
from shotc.diag.registry import severity_of
from tests.support.remedies.apply import Remedy, alternatives, remedies
from tests.support.remedies.by_hand import Hand, edited

Judge = Callable[[str], list[Diagnostic]]


class Tried(NamedTuple):
    """What became of the alternatives of the helps of a mission.

    wrong   : those that do not help
    untried : those for which there is neither a rule nor a choice
    """

    wrong: list[str]
    untried: list[str]


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


def tried_all(text: str, judged: Judge, hands: Sequence[Hand]) -> Tried:
    """Try every alternative of every help of a mission: by the choice for it, or else by rule."""
    before = judged(text)
    wrong, untried = [], []
    for fault in before:
        assert fault.help, f"{fault.code} has no help"
        missions = {remedy.text: remedy.missions for remedy in remedies(text, fault)}
        for said in alternatives(fault.help):
            chosen = [edited(text, hand, said) for hand in hands if hand.tells(fault.code, said)]
            ways = chosen or missions.get(said, ())
            if not ways:
                untried.append(said)
            elif not any(helps(mission, fault, before, judged) for mission in ways):
                wrong.append(said)
    return Tried(wrong, untried)

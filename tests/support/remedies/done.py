"""A mission whose help is done once by hand: the code is gone, and no error has come in its place."""

from __future__ import annotations

from typing import NamedTuple

from shotc.diag.model import Severity
from shotc.diag.registry import severity_of
from tests.support.remedies.tried import Judge


class Done(NamedTuple):
    """A mission that raises a code, what the help says, and the edits that do it."""

    code: str
    mission: str
    said: str
    edits: tuple[tuple[str, str], ...]


def assert_helps(case: Done, judged: Judge) -> None:
    (fault,) = (d for d in judged(case.mission) if d.code == case.code)
    assert case.said in (fault.help or "")
    text = case.mission
    for old, new in case.edits:
        assert old in text
        text = text.replace(old, new, 1)
    after = judged(text)
    assert case.code not in {d.code for d in after}
    assert [d for d in after if severity_of(d) is Severity.ERROR] == []

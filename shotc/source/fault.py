"""A fault in the text of a mission. The YAML reader reports faults; it does not raise."""

from collections.abc import Sequence
from typing import Any, Literal, NamedTuple, TypeVar

from shotc.source.file import Span
from shotc.source.limits import MAX_FAULTS

_Told = TypeVar("_Told", bound=Any)  # a Fault, or the Diagnostic made from one

FaultKind = Literal[
    "not-utf8",
    "control-character",
    "too-large",
    "too-deep",
    "too-many-values",
    "alias-expansion",
    "syntax",
    "tab-indentation",
    "indentation",
    "unclosed",
    "needs-quotes",
    "duplicate-key",
    "tag",
    "several-documents",
    "empty-file",
    "not-a-mapping",
    "merge-key",
    "key-not-text",
    "complex-key",
    "unknown-alias",
    "recursive-alias",
]


class Fault(NamedTuple):
    """One fault of the text.

    kind    : a ``FaultKind``
    message : states the fault, lower case, no final stop
    span    : the place to blame
    notes   : facts and numbers
    help    : the change that would make it work, or an empty string
    related : further places, each with a few words (the first of two equal keys, an opening bracket)
    """

    kind: FaultKind
    message: str
    span: Span
    notes: tuple[str, ...] = ()
    help: str = ""
    related: tuple[tuple[Span, str], ...] = ()


def shorten(text: str) -> str:
    """Return ``text`` cut to what fits into a message."""
    return text if len(text) <= 40 else text[:37] + "..."


def capped(faults: Sequence[_Told], of: str) -> tuple[_Told, ...]:
    """Return at most the first MAX_FAULTS faults. A note of the last one gives the number left out.

    faults : named tuples with ``notes``
    of     : what the faults are about, for that note
    """
    more = len(faults) - MAX_FAULTS
    if more <= 0:
        return tuple(faults)
    last = faults[MAX_FAULTS - 1]
    shortened = last._replace(notes=(*last.notes, f"{more} more faults of {of} are not shown"))
    return (*faults[: MAX_FAULTS - 1], shortened)

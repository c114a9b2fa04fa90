"""A diagnostic as a frozen value: what is wrong, where, with which numbers, and what helps."""

from enum import StrEnum
from typing import NamedTuple

from shotc.source.file import Span


class Severity(StrEnum):
    """How much a diagnostic weighs: an error rejects the mission, a warning never does."""

    ERROR = "error"
    WARNING = "warning"


class Label(NamedTuple):
    """A place in a source file with a short remark; the first label of a diagnostic is its primary one."""

    file: str
    span: Span
    text: str = ""


class Diagnostic(NamedTuple):
    """One fault, reported once. Severity and slug come from the registry by ``code``.

    message : states the fault, lower case, no final stop
    labels  : places, the primary first; empty only where no file is concerned
    notes   : facts and numbers
    help    : the change that would make it work, or an empty string
    """

    code: str
    message: str
    labels: tuple[Label, ...] = ()
    notes: tuple[str, ...] = ()
    help: str = ""

    @property
    def sort_key(self) -> tuple[str, int, int, str, str]:
        """Order by file, position, code and message."""
        if not self.labels:
            return ("", 0, 0, self.code, self.message)
        first = self.labels[0]
        return (first.file, first.span.line, first.span.column, self.code, self.message)

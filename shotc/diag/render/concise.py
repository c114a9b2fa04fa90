"""Render one diagnostic per line, for editors and grep: ``path:line:column: CODE message``.

A warning has the word "warning" before its message.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from shotc.diag.model import Diagnostic, Severity
from shotc.diag.registry import severity_of
from shotc.diag.render.common import ordered, visible
from shotc.source.file import SourceFile


def render(diagnostics: Sequence[Diagnostic], sources: Mapping[str, SourceFile]) -> str:
    """Return one line for each diagnostic."""
    return "".join(f"{_line(diagnostic)}\n" for diagnostic in ordered(diagnostics))


def _line(diagnostic: Diagnostic) -> str:
    weight = "warning: " if severity_of(diagnostic) is Severity.WARNING else ""
    said = f"{diagnostic.code} {weight}{visible(diagnostic.message)}"
    if not diagnostic.labels:
        return said
    first = diagnostic.labels[0]
    return f"{visible(first.file)}:{first.span.line}:{first.span.column}: {said}"

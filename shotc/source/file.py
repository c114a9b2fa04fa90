"""Where a piece of mission text stands: spans in lines and columns, and the files they point into."""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass
from functools import lru_cache

_LINE_END = re.compile(r"\r\n|\r|\n")


@dataclass(frozen=True, slots=True, order=True)
class Span:
    """A stretch of source text; lines and columns count code points from 1, the end is exclusive."""

    line: int
    column: int
    end_line: int
    end_column: int


WHOLE_FILE = Span(1, 1, 1, 1)


@lru_cache(maxsize=64)
def _line_starts(text: str) -> tuple[int, ...]:
    """Return the offset at which each line begins; lines end as editors see them: LF, CRLF or CR."""
    return (0, *(match.end() for match in _LINE_END.finditer(text)))


@dataclass(frozen=True, slots=True)
class SourceFile:
    """A text and the name it is shown under."""

    name: str
    text: str

    def line(self, number: int) -> str:
        """Return line ``number`` (from 1) without its line end, or an empty string past the end."""
        starts = _line_starts(self.text)
        if not 1 <= number <= len(starts):
            return ""
        end = starts[number] if number < len(starts) else len(self.text)
        return self.text[starts[number - 1] : end].rstrip("\r\n")

    def lines(self) -> list[str]:
        """Return all lines without their line ends."""
        return _LINE_END.split(self.text)

    def position(self, offset: int) -> tuple[int, int]:
        """Return line and column, from 1, of a code point offset into the text."""
        starts = _line_starts(self.text)
        line = bisect_right(starts, offset)
        return line, offset - starts[line - 1] + 1

    def point(self, offset: int) -> Span:
        """Return the span of one character, or an empty one where a line or the text ends."""
        ends = offset >= len(self.text) or self.text[offset] in "\r\n"
        return self.span(offset, offset if ends else offset + 1)

    def span(self, start: int, end: int) -> Span:
        """Return the span between two code point offsets, cut to the text; the end is exclusive."""
        first = min(start, len(self.text))
        last = min(max(start, end), len(self.text))
        return Span(*self.position(first), *self.position(last))

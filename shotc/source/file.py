"""Positions in mission text: spans in lines and columns, and their files."""

import re
from bisect import bisect_right
from collections.abc import Hashable, Iterator, Mapping
from typing import Final, NamedTuple, TypeVar

_LINE_END = re.compile(r"\r\n|\r|\n")
KeyPath = tuple[str | int, ...]
"""Keys of mappings and indices of lists, from the top of a mission."""
Offsets = tuple[int, int]
"""First code point of a part of the text, and the one after its last."""
_Key = TypeVar("_Key", bound=Hashable)


class Span(NamedTuple):
    """A part of source text; lines and columns are in code points from 1, the end is exclusive."""

    line: int
    column: int
    end_line: int
    end_column: int


WHOLE_FILE = Span(1, 1, 1, 1)


def _position(starts: tuple[int, ...], offset: int) -> tuple[int, int]:
    line = bisect_right(starts, offset)
    return line, offset - starts[line - 1] + 1


class SourceFile:
    """A text and its name in messages; line ends are those of editors: LF, CRLF or CR."""

    def __init__(self, name: str, text: str) -> None:
        self.name: Final = name
        self.text: Final = text
        # The start offset of each line.
        self._starts: Final = (0, *(match.end() for match in _LINE_END.finditer(text)))

    def line(self, number: int) -> str:
        """Return line ``number`` (from 1) without its line end, or an empty string past the end."""
        starts = self._starts
        if not 1 <= number <= len(starts):
            return ""
        end = starts[number] if number < len(starts) else len(self.text)
        return self.text[starts[number - 1] : end].rstrip("\r\n")

    def lines(self) -> list[str]:
        """Return all lines without their line ends."""
        return _LINE_END.split(self.text)

    def position(self, offset: int) -> tuple[int, int]:
        """Return line and column, from 1, of a code point offset into the text."""
        return _position(self._starts, offset)

    def point(self, offset: int) -> Span:
        """Return the span of one character, or an empty span at the end of a line or of the text."""
        ends = offset >= len(self.text) or self.text[offset] in "\r\n"
        return self.span(offset, offset if ends else offset + 1)

    def span(self, start: int, end: int) -> Span:
        """Return the span between two code point offsets, clipped to the text; the end is exclusive."""
        starts, length = self._starts, len(self.text)
        first = min(start, length)
        line, column = _position(starts, first)
        last = min(max(start, end), length)
        if line == len(starts) or last < starts[line]:  # most spans lie in one line
            return Span(line, column, line, column + last - first)
        return Span(line, column, *_position(starts, last))


class Spans(Mapping[_Key, Span]):
    """Spans of a text, each computed at its first use, because a text without faults needs few."""

    def __init__(self, file: SourceFile, offsets: Mapping[_Key, Offsets]) -> None:
        self._file = file
        self._offsets = offsets

    def __getitem__(self, key: _Key) -> Span:
        return self._file.span(*self._offsets[key])

    def __iter__(self) -> Iterator[_Key]:
        return iter(self._offsets)

    def __len__(self) -> int:
        return len(self._offsets)

    def __contains__(self, key: object) -> bool:
        return key in self._offsets

"""Lines end where editors end them, and offsets become lines and columns."""

from __future__ import annotations

import pytest

from shotc.source.file import SourceFile, Span


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_lines(end: str) -> None:
    file = SourceFile("m", f"ab{end}{end}cd")
    assert [file.line(n) for n in range(5)] == ["", "ab", "", "cd", ""]
    assert file.lines() == ["ab", "", "cd"]


def test_other_separators_end_no_line() -> None:
    assert SourceFile("m", "a\x0bb\x0cc\x85d\u2028e").lines() == ["a\x0bb\x0cc\x85d\u2028e"]


def test_positions() -> None:
    file = SourceFile("m", "é😀\nb")
    assert [file.position(offset) for offset in range(5)] == [(1, 1), (1, 2), (1, 3), (2, 1), (2, 2)]
    assert file.span(1, 4) == Span(1, 2, 2, 2)
    assert file.span(3, 2) == Span(2, 1, 2, 1)

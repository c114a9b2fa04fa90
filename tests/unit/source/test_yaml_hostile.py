"""Any bytes: the reader never raises, and every place it names lies in the text."""

from __future__ import annotations

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from shotc.source.file import SourceFile, Span
from shotc.source.yaml_tree import Document, parse

TOKENS = [
    *"abc0129-+.?:,[]{}&*!|>'\"%@`#~ \t\n\r",
    *("\n", "\n  ", "\n    ", ": ", "- ", "? ", "---\n", "...\n", "<<", "&a ", "*a", "!!int ", "!x ", "|2\n"),
    *("null", "true", "1e9", ".nan", '"', '\\"', "\\x4", "\x00", "\x85", "\u2028", "\ufeff", "é", "日", "😀"),
]


def lies_in(span: Span, file: SourceFile) -> bool:
    lines = file.lines()
    inside = 1 <= span.line <= span.end_line <= len(lines)
    return (
        inside
        and 1 <= span.column <= len(lines[span.line - 1]) + 1
        and 1 <= span.end_column <= len(lines[span.end_line - 1]) + 1
        and (span.line, span.column) <= (span.end_line, span.end_column)
    )


def strays(document: Document) -> list[Span]:
    """Return the places that a document names outside of its text."""
    spans = [*document.keys.values(), *document.values.values()]
    for fault in document.faults:
        spans += [fault.span, *(span for span, _ in fault.related)]
    return [span for span in spans if not lies_in(span, document.file)]


@pytest.mark.slow
@given(st.binary(max_size=200))
@example(b"\xef\xbb\xbf")
@example(b"\xff\xfe")
@example(b"a: |\r\n x\r\n")
@example(b"\xef\xbb\xbf\xef\xbb\xbf- a: [")
def test_any_bytes(data: bytes) -> None:
    document = parse(data, "m")
    assert strays(document) == []
    assert document.whole or document.faults


@pytest.mark.slow
@given(st.lists(st.sampled_from(TOKENS), max_size=40).map("".join))
@example("a: !")
@example("!<x")
@example("? : x")
@example('"\\')
@example("a: &a\nb: *a")
@example("{[")
@example("{{a}")
@example("&a : *a")
@example("a: ! \u2028")
def test_any_text_that_looks_like_yaml(text: str) -> None:
    document = parse(text.encode("utf-8", "surrogatepass"), "m")
    assert strays(document) == []
    assert document.whole or document.faults

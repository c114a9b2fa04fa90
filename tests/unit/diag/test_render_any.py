"""Renderers take whatever they are given: any words, any spans, in the text or not."""

from __future__ import annotations

import json
import re
from importlib import import_module

import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.diag.model import Diagnostic, Label
from shotc.diag.registry import registry
from shotc.source.file import SourceFile, Span

pytestmark = pytest.mark.slow

NASTY = st.text(st.sampled_from([*"ab:% ,\t\n\r\x00\x1b\x7f\u202e\u2028é日😀\ud800", "\u0301"]), max_size=30)
NUMBER = st.integers(0, 9) | st.integers(0, 400)
SPANS = st.builds(Span, NUMBER, NUMBER, NUMBER, NUMBER)
NAMES = st.sampled_from(["a.yaml", "b.yaml", "no such"]) | NASTY
LABELS = st.builds(Label, NAMES, SPANS, NASTY)
DIAGNOSTICS = st.builds(
    Diagnostic,
    st.sampled_from(sorted(registry())),
    NASTY,
    st.lists(LABELS, max_size=4).map(tuple),
    st.lists(NASTY, max_size=2).map(tuple),
    NASTY,
)
TEXTS = st.lists(NASTY, max_size=9).map("\n".join) | NASTY.map(lambda text: text * 20)


@pytest.mark.long
@pytest.mark.parametrize("name", ["text", "concise", "json", "sarif", "github"])
@given(found=st.lists(DIAGNOSTICS, max_size=4), texts=st.tuples(TEXTS, TEXTS))
def test_never_fails_and_never_lets_control_characters_through(
    name: str, found: list[Diagnostic], texts: tuple[str, str]
) -> None:
    sources = {n: SourceFile(n, text) for n, text in zip(("a.yaml", "b.yaml"), texts, strict=True)}
    rendered = import_module(f"shotc.diag.render.{name}").render(found, sources)
    assert not re.search("[\x00-\x09\x0b-\x1f\x7f\u2028\u202e\ud800]", rendered)
    if name in ("json", "sarif"):
        json.loads(rendered)
    else:
        assert rendered.count("\n") >= len(set(found))
    if name in ("concise", "github"):
        assert rendered.count("\n") == len(set(found))


@given(st.lists(DIAGNOSTICS, min_size=1, max_size=3))
def test_json_says_it_all(found: list[Diagnostic]) -> None:
    document = json.loads(import_module("shotc.diag.render.json").render(found, {}))
    assert len(document["diagnostics"]) == len(set(found))
    assert document["summary"]["errors"] + document["summary"]["warnings"] == len(set(found))
    keys = {
        "code",
        "slug",
        "severity",
        "message",
        "file",
        "line",
        "column",
        "end_line",
        "end_column",
        "notes",
        "help",
    }
    assert all(set(entry) == keys for entry in document["diagnostics"])

"""Values and their places: the core schema of YAML 1.2, spans that cut out exactly what was written."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from shotc.source.file import KeyPath, SourceFile, Span
from shotc.source.yaml_tree import Document, parse


def cut(file: SourceFile, span: Span) -> str:
    """Return the text of a span."""
    lines = [file.line(number) for number in range(span.line, span.end_line + 1)]
    lines[-1] = lines[-1][: span.end_column - 1]
    lines[0] = lines[0][span.column - 1 :]
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("12", 12),
        ("-3", -3),
        ("+4", 4),
        ("017", 17),
        ("0o17", 15),
        ("0x1F", 31),
        ("1e3", 1000.0),
        ("1.", 1.0),
        (".5", 0.5),
        ("-1.5E-2", -0.015),
        (".inf", math.inf),
        ("-.INF", -math.inf),
        ("1e999", math.inf),
        ("-" + "9" * 5000, -math.inf),
        ("9" * 309, math.inf),
        ("true", True),
        ("False", False),
        ("null", None),
        ("~", None),
        ("", None),
        ("on", "on"),
        ("yes", "yes"),
        ("12:30:00", "12:30:00"),
        ("1_000", "1_000"),
        ("2026-11-21", "2026-11-21"),
        ("0b11", "0b11"),
        (".", "."),
        ("12 km/h", "12 km/h"),
        ("'12'", "12"),
        ('"a\\tb"', "a\tb"),
        ("!!str 12", "12"),
        ("! 12", "12"),
        ("!!int 12", 12),
        ("!!float 12", 12.0),
        ("!!seq [1]", [1]),
        ("!!map {b: 1}", {"b": 1}),
    ],
)
def test_scalars_follow_the_core_schema(text: str, value: Any) -> None:
    document = parse(f"a: {text}\n".encode(), "m")
    assert document.faults == ()
    found = document.root["a"]
    assert found == value
    assert type(found) is type(value)


def test_nan_is_a_number() -> None:
    assert math.isnan(parse(b"a: .nan\n", "m").root["a"])


TEXT = """\
shotc: 1
drones:
  cam1: {home: [0, -60, 0.5], model: "x500"}   # the first
  cam2:
shots:
  - id: reveal
    at: &here [1, 2, 3]

    note: |
      two
      lines

  # a remark
  - {id: two, at: *here}
"""
PLACES: dict[KeyPath, tuple[str, int, int]] = {
    ("shotc",): ("1", 1, 8),
    ("drones", "cam1"): ('{home: [0, -60, 0.5], model: "x500"}', 3, 9),
    ("drones", "cam1", "home"): ("[0, -60, 0.5]", 3, 16),
    ("drones", "cam1", "home", 1): ("-60", 3, 20),
    ("drones", "cam1", "model"): ('"x500"', 3, 38),
    ("drones", "cam2"): ("", 4, 8),
    ("shots", 0, "id"): ("reveal", 6, 9),
    ("shots", 0, "at"): ("&here [1, 2, 3]", 7, 9),
    ("shots", 0, "note"): ("|\n      two\n      lines", 9, 11),
    ("shots", 1): ("{id: two, at: *here}", 14, 5),
    ("shots", 1, "at"): ("*here", 14, 19),
    ("shots", 1, "at", 2): ("3", 7, 22),
}


@pytest.fixture(scope="module")
def document() -> Document:
    found = parse(TEXT.encode(), "m")
    assert found.faults == ()
    return found


@pytest.mark.parametrize("path", PLACES)
def test_values_have_their_place(document: Document, path: KeyPath) -> None:
    span = document.values[path]
    assert (cut(document.file, span), span.line, span.column) == PLACES[path]


def test_keys_have_their_place(document: Document) -> None:
    for path, span in document.keys.items():
        assert cut(document.file, span) == path[-1]
    assert set(document.keys) == {p for p in document.values if p and isinstance(p[-1], str)}


def test_a_list_ends_with_its_last_item(document: Document) -> None:
    span = document.values[("drones",)]
    assert (span.line, span.end_line, span.end_column) == (3, 4, 8)
    assert document.values[("shots", 0)].end_line == 11


def test_aliases_repeat_a_value(document: Document) -> None:
    assert document.root["shots"][1]["at"] == [1, 2, 3]


# JSON writes characters beyond the first plane as pairs of escapes, and DEL as it is; YAML has neither.
WORDS = st.text(
    st.characters(max_codepoint=0xFFFF, exclude_categories=["Cs"], exclude_characters="\x7f"), max_size=6
)
JSON = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(10**12), 10**12)
    | st.floats(allow_nan=False, allow_infinity=False)
    | WORDS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(WORDS, inner, max_size=4),
    max_leaves=12,
)


@pytest.mark.slow
@given(st.dictionaries(WORDS, JSON, max_size=4))
@example({"a": 1e300, "<<": "\u2028"})
def test_json_is_read_as_json(data: dict[str, Any]) -> None:
    text = json.dumps(data)
    found = parse(text.encode(), "m")
    assert found.faults == ()
    assert found.root == json.loads(text)


@pytest.mark.slow
@given(st.dictionaries(WORDS, JSON, max_size=4))
def test_spans_cut_out_what_was_written(data: dict[str, Any]) -> None:
    text = json.dumps(data, ensure_ascii=True, indent=1)
    found = parse(text.encode(), "m")
    for path, span in found.values.items():
        assert json.loads(cut(found.file, span)) == _at(found.root, path)
    for path, span in found.keys.items():
        assert json.loads(cut(found.file, span)) == path[-1]


def _at(data: Any, path: KeyPath) -> Any:
    for step in path:
        data = data[step]
    return data

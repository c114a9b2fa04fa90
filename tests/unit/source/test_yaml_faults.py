"""Every way a mission text can be wrong, each with the exact place it is blamed on."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
import yaml

from shotc.source.limits import MAX_BYTES, MAX_DEPTH, MAX_FAULTS
from shotc.source.yaml_tree import parse

# name, text, kind, (line, column, end line, end column)
CASES = [
    ("tab", "a:\n\tb: 1\n", "tab-indentation", (2, 1, 2, 2)),
    ("tabs", "a:\n\t\tb: 1\n", "tab-indentation", (2, 1, 2, 3)),
    ("tab after spaces", "a:\n  b: 1\n \tc: 2\n", "tab-indentation", (3, 2, 3, 3)),
    ("tab in block text", "a: |\n\tb\n", "tab-indentation", (2, 1, 2, 2)),
    ("tab after dash", "a:\n- \tb: 1\n", "tab-indentation", (2, 3, 2, 4)),
    ("two colons", "a: b: c\n", "needs-quotes", (1, 5, 1, 6)),
    ("deeper key", "a: 1\n  b: 2\n", "indentation", (2, 3, 2, 4)),
    ("no blank after colon", "a:1\nbc: 2\n", "indentation", (2, 1, 2, 3)),
    ("shallower key", "a:\n  b: 1\n c: 2\n", "indentation", (3, 2, 3, 6)),
    ("shallower item", "a:\n  - b\n - c\n", "indentation", (3, 2, 3, 5)),
    ("key among items", "- a\nb: 1\n", "indentation", (2, 1, 2, 5)),
    ("item among keys", "a: 1\n- b\n", "indentation", (2, 1, 2, 4)),
    ("item on key line", "a: - 1\n", "indentation", (1, 4, 1, 5)),
    ("open list", "a: 0\nb: [1, 2\nc: 3\n", "unclosed", (2, 4, 2, 5)),
    ("open list at end", "a: [1, [2", "unclosed", (1, 8, 1, 9)),
    ("open list after comma", "a: [1,", "unclosed", (1, 4, 1, 5)),
    ("open mapping", "a: {b: 1\nc: 2\n", "unclosed", (1, 4, 1, 5)),
    ("open quote", "a: 'b\nc: 1\n", "unclosed", (1, 4, 1, 5)),
    ("open quote at document", 'a: "b\n---\n', "unclosed", (1, 4, 1, 5)),
    ("stray bracket", "a: {b: 1}}\n", "syntax", (1, 10, 1, 11)),
    ("bracket as value", "a: ]\n", "syntax", (1, 4, 1, 5)),
    ("bracket alone", "}\n", "syntax", (1, 1, 1, 2)),
    ("comma first", "a: [, 1]\n", "syntax", (1, 5, 1, 6)),
    ("text after quote", 'a: "b" c\n', "syntax", (1, 8, 1, 9)),
    ("no colon", "a: 1\nbcd\ne: 1\n", "syntax", (2, 1, 2, 4)),
    ("after end", "a: 1\n...\nb: 2\n", "syntax", (3, 1, 3, 5)),
    ("directive", "%NO such\na: 1\n", "syntax", (1, 1, 1, 9)),
    ("yaml 3", "%YAML 3.0\n---\na: 1\n", "syntax", (1, 1, 1, 10)),
    ("colour among keys", "a: {b: 1, c: #39f, d: 2}\n", "needs-quotes", (1, 14, 1, 18)),
    ("colour on its line", "a: {b: 1,\n  c: #3399ff,\n  d: 2}\n", "needs-quotes", (2, 6, 2, 13)),
    ("colours in a list", "a: [#f00, #0f0]\n", "needs-quotes", (1, 5, 1, 9)),
    ("comment in open list", "a: [1, # 2\n  3, #then\n", "unclosed", (1, 4, 1, 5)),
    ("sign in quotes", "a: {b: '#39f', c: \"d: #e\"\n", "unclosed", (1, 4, 1, 5)),
    ("at sign", "a: @b c\n", "needs-quotes", (1, 4, 1, 8)),
    ("backtick", "a: `b`\n", "needs-quotes", (1, 4, 1, 7)),
    ("percent", "a: %5\n", "needs-quotes", (1, 4, 1, 6)),
    ("escape", 'a: "b\\qc"\n', "needs-quotes", (1, 6, 1, 8)),
    ("short escape", 'a: "b\\x4"\n', "needs-quotes", (1, 6, 1, 8)),
    ("lone star", "a: * b\n", "needs-quotes", (1, 4, 1, 5)),
    ("lone ampersand", "a: & b\n", "needs-quotes", (1, 4, 1, 5)),
    ("duplicate", "a: 1\nb: 2\na: 3\n", "duplicate-key", (3, 1, 3, 2)),
    ("quoted duplicate", 'a: {b: 1, "b": 2}\n', "duplicate-key", (1, 11, 1, 14)),
    ("python tag", "a: !!python/object/apply:os.system [ls]\n", "tag", (1, 4, 1, 35)),
    ("own tag", "a: !mine 3\n", "tag", (1, 4, 1, 9)),
    ("tag handle", "a: !x!y 3\n", "tag", (1, 4, 1, 8)),
    ("misfit tag", "a: !!int x\n", "tag", (1, 4, 1, 9)),
    ("tag behind anchor", "a: &b !mine 3\n", "tag", (1, 7, 1, 12)),
    ("two documents", "a: 1\n---\nb: 2\n", "several-documents", (2, 1, 2, 4)),
    ("empty", "", "empty-file", (1, 1, 1, 1)),
    ("blank", "  \n\n", "empty-file", (1, 1, 1, 1)),
    ("comments", "# a\n# b\n", "empty-file", (1, 1, 1, 1)),
    ("null", "null\n", "empty-file", (1, 1, 1, 1)),
    ("empty document", "---\n...\n", "empty-file", (1, 1, 1, 1)),
    ("list", "# c\n- a: 1\n- b\n", "not-a-mapping", (2, 1, 2, 7)),
    ("scalar", "hello there\n", "not-a-mapping", (1, 1, 1, 12)),
    ("merge", "a: &a {b: 1}\nc: {<<: *a}\n", "merge-key", (2, 5, 2, 7)),
    ("number key", "a: {12: b}\n", "key-not-text", (1, 5, 1, 7)),
    ("null key", "~: b\n", "key-not-text", (1, 1, 1, 2)),
    ("no key in brackets", "a: {: b}\n", "syntax", (1, 5, 1, 6)),
    ("no key", "a: 1\n: b\n", "syntax", (2, 1, 2, 2)),
    ("empty key", "?\n: b\n", "key-not-text", (1, 2, 1, 2)),
    ("truth key", "true: b\n", "key-not-text", (1, 1, 1, 5)),
    ("list key", "? [a]\n: b\n", "complex-key", (1, 3, 1, 6)),
    ("template", "a: {{ b }: 1}\n", "complex-key", (1, 5, 1, 10)),
    ("unknown alias", "ab: &ab 1\nc: *ac\n", "unknown-alias", (2, 4, 2, 7)),
    ("recursive alias", "a: &b [1, *b]\n", "recursive-alias", (1, 11, 1, 13)),
    ("nul", "a: b\x00c\n", "control-character", (1, 5, 1, 6)),
    ("escape code", "a: 1\nb: \x1b[31m\n", "control-character", (2, 4, 2, 5)),
    ("mark inside", "a: \ufeffb\n", "control-character", (1, 4, 1, 5)),
    ("delete", "é\x7f: b\n", "control-character", (1, 2, 1, 3)),
    ("crlf", "a: 1\r\nb: 2\r\na: 3\r\n", "duplicate-key", (3, 1, 3, 2)),
    ("separator is no line", "a: '\u2028'\nb: 2\na: 3\n", "duplicate-key", (3, 1, 3, 2)),
    ("wide characters", "日本: 1\n日本: 2\n", "duplicate-key", (2, 1, 2, 3)),
    ("astral characters", "😀: 1\na: {😀: 1, 😀: 2}\n", "duplicate-key", (2, 11, 2, 12)),
]


@pytest.mark.parametrize(("text", "kind", "place"), [c[1:] for c in CASES], ids=[c[0] for c in CASES])
def test_one_fault_at_its_place(text: str, kind: str, place: tuple[int, int, int, int]) -> None:
    faults = parse(text.encode(), "m.yaml").faults
    assert [fault.kind for fault in faults] == [kind]
    span = faults[0].span
    assert (span.line, span.column, span.end_line, span.end_column) == place
    assert faults[0].message[0] == faults[0].message[0].lower()
    assert not faults[0].message.endswith(".")


@pytest.mark.parametrize("value", ["#3399ff", "#f80", "#1"])
@pytest.mark.parametrize("hidden", ["a: {b: {c: 1, d: HERE}}\n", "a: {b: {d: HERE,\n  c: 2}}\n"])
def test_a_sign_that_hides_a_value_is_cured_by_the_quotes_that_the_help_gives(
    hidden: str, value: str
) -> None:
    (fault,) = parse(hidden.replace("HERE", value).encode(), "m").faults
    assert fault.message.startswith("'#' begins a comment")
    assert fault.related[0][1] == "this '{' is not closed"
    _, _, quoted = fault.help.rpartition(": ")
    assert not parse(hidden.replace("HERE", quoted).encode(), "m").faults


def test_several_faults_in_one_run() -> None:
    text = "<<: 1\na: 2\na: 3\n1: 2\n? [1]\n: x\nb: !t *a\nc: *d\ne: [\n"
    kinds = [fault.kind for fault in parse(text.encode(), "m").faults]
    assert kinds[:4] == ["merge-key", "duplicate-key", "key-not-text", "complex-key"]
    assert kinds[-1] in ("unclosed", "syntax", "unknown-alias")
    assert len(kinds) >= 5


def test_the_second_of_two_keys_is_blamed_and_the_first_named() -> None:
    (fault,) = parse(b"a: 1\nb: 2\na: 3\n", "m").faults
    assert fault.notes == ("first given on line 1",)
    ((span, remark),) = fault.related
    assert (span.line, span.column, remark) == (1, 1, "first given here")


def test_the_first_of_two_values_is_kept() -> None:
    document = parse(b"a: 1\nb: 2\na: {c: !t 3}\n", "m")
    assert document.root == {"a": 1, "b": 2}
    assert [fault.kind for fault in document.faults] == ["duplicate-key", "tag"]


def test_other_tabbed_lines_are_listed() -> None:
    (fault,) = parse(b"a:\n  b: 1\n\tc: 2\n\td: 2\n\n\t\n  e: 1\n\tf: 1\n", "m").faults
    assert fault.span.line == 3
    assert fault.notes == ("tabs also begin lines 4, 8",)


@pytest.mark.parametrize(
    ("data", "place", "note"),
    [
        (b"a: 1\nb: caf\xe9 x\n", (2, 7), "byte 11 of the file is 0xe9"),
        ("é: ".encode() + b"\xff\n", (1, 4), "byte 4 of the file is 0xff"),
        (b"\xef\xbb\xbfa: \xc3", (1, 4), "byte 3 of the file is 0xc3"),
        (b"\xed\xa0\x80: 1", (1, 1), "byte 0 of the file is 0xed"),
    ],
)
def test_bytes_that_are_not_utf8(data: bytes, place: tuple[int, int], note: str) -> None:
    faults = parse(data, "m").faults
    assert faults[0].kind == "not-utf8"
    assert (faults[0].span.line, faults[0].span.column) == place
    assert note in faults[0].notes


@pytest.mark.parametrize("codec", ["utf-16", "utf-16-le", "utf-16-be", "utf-32"])
def test_wider_encodings_are_named(codec: str) -> None:
    document = parse("shotc: 1\nmission: a\n".encode(codec), "m")
    (fault,) = document.faults
    assert fault.kind == "not-utf8"
    assert codec[:6].upper() in fault.message
    assert "mission: a" in document.file.text
    assert not document.whole


def test_a_byte_order_mark_is_accepted() -> None:
    document = parse(b"\xef\xbb\xbfa: 1\n", "m")
    assert document.faults == ()
    assert document.root == {"a": 1}
    assert document.keys[("a",)].column == 1


def test_a_picture_is_no_text() -> None:
    document = parse(b"\x89PNG\r\n\x1a\n" + bytes(range(32)) * 8, "m")
    assert "this is not a text file" in [fault.message for fault in document.faults]
    assert not document.whole


def read_events(monkeypatch: pytest.MonkeyPatch) -> list[yaml.Event]:
    """Return a list that every event which is taken from the parser is appended to."""
    events: list[yaml.Event] = []
    parser = yaml.parse

    def counted(*args: Any, **options: Any) -> Iterator[yaml.Event]:
        for event in parser(*args, **options):
            events.append(event)
            yield event

    monkeypatch.setattr(yaml, "parse", counted)
    return events


@pytest.mark.parametrize(
    "text",
    [
        "[" * 20_000,
        "- " * 20_000,
        "? " * 20_000,
        "{a: " * 20_000,
        "x: [" * 500_000,
        "[" * 1_000_000,
        "a: " + "[" * 20_000 + "]" * 20_000,
        "".join(" " * i + "a:\n" for i in range(1000)),
    ],
    ids=["lists", "items", "keys", "mappings", "mixed", "million", "closed", "indented"],
)
def test_deep_nesting_stops_early(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    events = read_events(monkeypatch)
    document = parse(text.encode(), "m")
    assert [fault.kind for fault in document.faults] == ["too-deep"]
    assert not document.whole
    # The stream, the document, and of each level a key and a start.
    assert len(events) <= 2 + 2 * (MAX_DEPTH + 1)


def test_the_deepest_that_is_read() -> None:
    def nested(depth: int) -> bytes:
        return b"a: " + b"[" * (depth - 1) + b"]" * (depth - 1)

    assert parse(nested(MAX_DEPTH), "m").faults == ()
    (fault,) = parse(nested(MAX_DEPTH + 1), "m").faults
    assert (fault.kind, fault.span.column) == ("too-deep", 3 + MAX_DEPTH)


def test_an_alias_bomb_is_refused_before_it_goes_off() -> None:
    lines = ["a: &a [x, x, x, x, x, x, x, x, x]"]
    lines += [f"{c}: &{c} [{', '.join([f'*{p}'] * 9)}]" for p, c in zip("abcdefgh", "bcdefghi", strict=True)]
    document = parse("\n".join(lines).encode(), "m")
    (fault,) = document.faults
    assert fault.kind == "alias-expansion"
    assert fault.span.line == 5
    assert not document.whole


def test_aliases_cannot_build_what_brackets_may_not() -> None:
    half = "[" * 40 + "]" * 40
    text = f"a: &a {half}\nb: {'[' * 30}*a{']' * 30}\n"
    (fault,) = parse(text.encode(), "m").faults
    assert (fault.kind, fault.span.line, fault.span.column) == ("too-deep", 2, 34)


@pytest.mark.long
def test_too_many_bytes_and_values() -> None:
    (fault,) = parse(b"a: " + b"x" * MAX_BYTES, "m").faults
    assert fault.kind == "too-large"
    (fault,) = parse(b"a: [" + b"1," * 250_000 + b"]", "m").faults
    assert fault.kind == "too-many-values"


@pytest.mark.slow
def test_directives_cannot_take_quadratic_time(monkeypatch: pytest.MonkeyPatch) -> None:
    events = read_events(monkeypatch)
    text = "".join(f"%TAG !a{i}! b\n" for i in range(100_000))
    (fault,) = parse(text.encode(), "m").faults
    assert (fault.kind, fault.span.line) == ("syntax", 1)
    assert events == []  # the parser, which compares each directive with all others, is not asked


def test_a_flood_of_faults_is_capped_and_counted() -> None:
    text = "".join("a: 1\n" for _ in range(1000))
    faults = parse(text.encode(), "m").faults
    assert len(faults) == MAX_FAULTS
    assert faults[-1].notes[-1] == f"{999 - MAX_FAULTS} more faults of the text are not shown"


def test_what_was_read_before_a_syntax_error_is_kept() -> None:
    document = parse(b"shotc: 1\nmission: a\nshots:\n  - {id: b}\n  - {id: c\n", "m")
    assert document.root["mission"] == "a"
    assert document.root["shots"][0] == {"id": "b"}
    assert not document.whole

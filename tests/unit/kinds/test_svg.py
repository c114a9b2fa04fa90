"""Which drawings are drawings, and which line is blamed."""

from __future__ import annotations

import pytest

from shotc.kinds.svg import svg_fault

SVG = '<?xml version="1.0"?>\n<svg xmlns="http://www.w3.org/2000/svg" {1}>\n{0}\n</svg>'
PATH = '<path d="M0 0L1 1" fill="url(#g)" style="fill: url( #g )"/>'


@pytest.mark.parametrize(
    "body",
    [
        PATH,
        f"<defs><g id='a'/></defs><use href='#a'/><s:use xmlns:s='u' s:href=' #a'/>{PATH}",
        f"<style>.a {{fill: red}}</style><text>@import is only a word here</text>{PATH}",
        f"<metadata xmlns:r='r'><r:d r:resource='http://example.org'/></metadata>{PATH}",
        "<g><circle r='1'/></g>",
    ],
)
def test_a_plain_drawing_is_accepted(body: str) -> None:
    assert svg_fault(SVG.format(body, "").encode()) is None


@pytest.mark.parametrize(
    ("body", "line", "says"),
    [
        ("<script>alert(1)</script>", 3, "a script"),
        (f"{PATH}\n<s:script xmlns:s='http://www.w3.org/2000/svg'/>", 4, "a script"),
        ("<g onload='x()'/>", 3, "`onload`"),
        ("<foreignObject/>", 3, "a page"),
        ("<image href='http://example.org/a.png'/>", 3, "http://example.org"),
        ("<image xmlns:xlink='l' xlink:href='file:///etc/passwd'/>", 3, "file:///etc/passwd"),
        ("<image href='data:image/png;base64,AAAA'/>", 3, "data:"),
        ("<use href='other.svg#a'/>", 3, "other.svg"),
        ("<style>\n@import 'x.css';</style>", 3, "@import"),
        ("<style>\n.a { fill: URL('http://x') }</style>", 3, "URL("),
        ("<path fill='url(http://x#g)'/>", 3, "url(http"),
        ("<path style=\"fill: url( 'x.svg#g' )\"/>", 3, "url("),
        ("<?xml-stylesheet href='x.css'?>", 3, "style sheet"),
    ],
)
def test_what_is_more_than_a_drawing_is_unsafe(body: str, line: int, says: str) -> None:
    wrong = svg_fault(SVG.format(body + PATH, "").encode())
    assert wrong is not None
    assert wrong.unsafe
    assert says in wrong.fault.message
    assert wrong.fault.line is not None
    assert line <= wrong.fault.line <= line + 1
    assert wrong.fault.help


@pytest.mark.parametrize("root", ["onload='x()'", "style='background: url(x.png)'"])
def test_the_root_is_held_to_the_same(root: str) -> None:
    wrong = svg_fault(SVG.format(PATH, root).encode())
    assert wrong is not None
    assert wrong.unsafe


def test_entities_are_refused_before_they_grow() -> None:
    bomb = '<!DOCTYPE svg [<!ENTITY a "aa"><!ENTITY b "&a;&a;">]>\n<svg>&b;</svg>'
    wrong = svg_fault(bomb.encode())
    assert wrong is not None
    assert wrong.unsafe
    assert "document type" in wrong.fault.message


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"", "not well-formed"),
        (b"<svg>", "not well-formed"),
        (b"\x89PNG", "not well-formed"),
        (b"<gpx/>", "`gpx`"),
        (b"<svg/>", "no shapes"),
        (b"<?xml version='1.0' encoding='klingon'?><svg/>", "encoding"),
        (b"<svg><text>A</text></svg>", "no shapes"),
    ],
)
def test_what_is_no_drawing_is_unusable(data: bytes, says: str) -> None:
    wrong = svg_fault(data)
    assert wrong is not None
    assert not wrong.unsafe
    assert says in wrong.fault.message


def test_deep_drawings_are_read_without_recursion() -> None:
    assert svg_fault(b"<svg>" + b"<g>" * 20_000 + PATH.encode() + b"</g>" * 20_000 + b"</svg>") is None

"""Checks of SVG files: whether they are well-formed and contain only a drawing."""

from __future__ import annotations

import re
from typing import Any, NamedTuple

from shotc.kinds.files import FileFault, not_xml
from shotc.source.xml import StopParsing, feed

SHAPES = {"path", "rect", "circle", "ellipse", "line", "polyline", "polygon"}
_ACTIVE = {"script": "a script", "foreignObject": "a page of another sort"}
# Possessive quantifiers, so that runs of spaces are not scanned twice.
_OUTSIDE = re.compile(r"@import|url\(\s*+['\"]?+\s*+[^#\s'\"]", re.IGNORECASE)
_OWN = "export it as a plain SVG, with all that it draws in the file itself"


class DrawingFault(NamedTuple):
    """A fault of a drawing; unsafe : whether it contains more than a drawing."""

    fault: FileFault
    unsafe: bool = False


def svg_fault(data: bytes) -> DrawingFault | None:
    """Return the fault of an SVG file, or None if it can be drawn.

    A document type declaration is refused, because entities could grow without bound. Scripts and references
    outside the file are refused too; nothing is ever fetched.
    """
    reader = _Svg()
    wrong = feed(data, reader)
    if wrong is not None:
        return DrawingFault(not_xml(wrong))
    if reader.wrong is not None:
        return reader.wrong
    if not reader.shapes:
        help_ = f"turn what it shows into shapes: {', '.join(sorted(SHAPES))}"
        return DrawingFault(FileFault("the drawing has no shapes", None, help_))
    return None


class _Svg:
    """Expat's handlers; they count shapes until the first fault."""

    def __init__(self) -> None:
        self.parser: Any = None
        self.wrong: DrawingFault | None = None
        self.shapes = 0
        self._root = ""
        self._style = 0  # number of open style elements

    def doctype(self, *_: Any) -> None:
        self._stop("it has a document type declaration", "remove the <!DOCTYPE ...> line")

    def instruction(self, target: str, _: str) -> None:
        if target.lower() == "xml-stylesheet":
            self._stop("it asks for a style sheet from outside", _OWN)

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        name = tag.rsplit(":", 1)[-1]
        if not self._root:
            self._root = name
            if name != "svg":
                self._stop(f"its root is `{name[:30]}`, not `svg`", "export it as SVG", unsafe=False)
        if name in _ACTIVE:
            self._stop(f"it holds {_ACTIVE[name]}", f"remove the <{name}> element")
        self.shapes += name in SHAPES
        self._style += name == "style"
        for key, value in attributes.items():
            self._attribute(key.rsplit(":", 1)[-1], value)

    def end(self, tag: str) -> None:
        self._style -= tag.rsplit(":", 1)[-1] == "style"

    def text(self, data: str) -> None:
        if self._style:
            self._no_reference(data)

    def _attribute(self, key: str, value: str) -> None:
        if key.lower().startswith("on"):
            self._stop(f"it holds a script, in `{key[:30]}`", f"remove `{key[:30]}`")
        if key == "href" and not value.lstrip().startswith("#"):
            self._stop(f"it refers to `{value[:60]}`", _OWN)
        self._no_reference(value)

    def _no_reference(self, text: str) -> None:
        match = _OUTSIDE.search(text)
        if match is not None:
            self._stop(f"it refers to `{text[match.start() : match.start() + 60]}`", _OWN)

    def _stop(self, message: str, help: str, *, unsafe: bool = True) -> None:
        self.wrong = DrawingFault(FileFault(message, self.parser.CurrentLineNumber, help), unsafe)
        raise StopParsing

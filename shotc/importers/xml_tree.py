"""Parse XML to a tree with line numbers. Any bytes give a tree or one fault."""

from __future__ import annotations

from codecs import BOM_UTF8, BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from shotc.importers.words import CUT_IN_TWO, EXPORT_AGAIN
from shotc.source.xml import StopParsing, feed

LARGEST_BYTES = 4_000_000  # bytes
MOST_NODES = 100_000
DEEPEST_LEVEL = 60


@dataclass(slots=True)
class Node:
    """An element: its name, its text without that of its children, and its line and column from 1.

    wide : number of characters if it is a value of another format, 0 for an XML element
    """

    tag: str
    line: int
    column: int
    attributes: dict[str, str] = field(default_factory=dict)
    text: str = ""
    children: list[Node] = field(default_factory=list)
    wide: int = 0

    def first(self, tag: str) -> Node | None:
        """Return the first child with that name, or None."""
        return next((child for child in self.children if child.tag == tag), None)

    def all(self, tag: str) -> list[Node]:
        """Return the children with that name."""
        return [child for child in self.children if child.tag == tag]

    def everything(self) -> Iterator[Node]:
        """Yield this element and all its descendants."""
        yield self
        for child in self.children:
            yield from child.everything()

    def value(self, tag: str) -> str:
        """Return the stripped text of the first child with that name; empty if there is none."""
        child = self.first(tag)
        return "" if child is None else child.text.strip()


class XmlFault(NamedTuple):
    """Why bytes are not XML; line and column from 1."""

    message: str
    help: str
    line: int = 1
    column: int = 1


def readable_text(data: bytes) -> str:
    """Return the text of any file, to show its lines in messages."""
    wide = data.startswith((BOM_UTF16_LE, BOM_UTF16_BE))
    return data.decode("utf-16" if wide else "utf-8-sig", "replace")


def parse_xml(data: bytes) -> Node | XmlFault:
    """Return the root element. A document type is refused, because its entities could grow without bound."""
    if len(data) > LARGEST_BYTES:
        return XmlFault(f"the file is larger than {LARGEST_BYTES / 1e6:.0f} MB", CUT_IN_TWO)
    reader = _Reader()
    wrong = feed(data.removeprefix(BOM_UTF8), reader)  # expat would count the mark as a column
    if wrong is not None:
        help_ = f"correct it there, or {EXPORT_AGAIN}"
        return XmlFault(f"it is no XML: {wrong.reason}", help_, wrong.line, wrong.column)
    if reader.fault is not None:
        return reader.fault
    assert reader.root is not None
    return reader.root


class _Reader:
    """Expat's handlers."""

    def __init__(self) -> None:
        self.parser: Any = None
        self.root: Node | None = None
        self.fault: XmlFault | None = None
        self._open: list[Node] = []
        self._count = 0

    def doctype(self, *_: Any) -> None:
        self._stop("it has a document type declaration, which is refused", "remove `<!DOCTYPE ...>`")

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        node = Node(tag, self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1, attributes)
        self._count += 1
        if self._count > MOST_NODES or len(self._open) >= DEEPEST_LEVEL:
            self._stop("it has too many elements, or too deep ones", CUT_IN_TWO)
        if self._open:
            self._open[-1].children.append(node)
        else:
            self.root = node
        self._open.append(node)

    def text(self, data: str) -> None:
        if self._open:
            self._open[-1].text += data

    def end(self, _tag: str) -> None:
        self._open.pop()

    def _stop(self, message: str, help: str) -> None:
        line, column = self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1
        self.fault = XmlFault(message, help, line, column)
        raise StopParsing

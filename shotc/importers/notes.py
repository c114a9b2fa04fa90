"""What an importer had to assume: each with the element that it is about, and the words for a comment."""

from __future__ import annotations

from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.importers.xml_tree import Node
from shotc.source.file import Span


class Note(NamedTuple):
    """One assumption.

    message : what is wrong or missing there; taken : what is taken instead, which is the comment, too
    """

    node: Node
    message: str
    taken: str

    @property
    def comment(self) -> str:
        """The words for a comment."""
        return f"assumed: {self.taken} (line {self.node.line}: {self.message})"


class Notes:
    """Assumptions in the order in which they are made, each once."""

    def __init__(self) -> None:
        self._found: dict[tuple[int, str], Note] = {}

    @property
    def found(self) -> tuple[Note, ...]:
        """All of them."""
        return tuple(self._found.values())

    def assume(self, node: Node, message: str, taken: str) -> str:
        """Note an assumption, and return the comment that goes with it."""
        note = Note(node, plain(message), plain(taken))
        return self._found.setdefault((id(node), note.message), note).comment

    def below(self, node: Node) -> list[str]:
        """Return the comments that are about an element or what is in it."""
        inside = {id(n) for n in node.everything()}
        return [note.comment for note in self.found if id(note.node) in inside]


def plain(text: str, most: int | None = None) -> str:
    """Return a text on one line, with nothing in it that would end a comment; at most so many characters."""
    return "".join(c if c.isprintable() else " " for c in text[:most])


def label(file: str, node: Node) -> Label:
    """Return a label on an element's tag."""
    end = node.column + (node.wide or len(node.tag) + 1)
    return Label(file, Span(node.line, node.column, node.line, end))


def told(file: str, notes: Notes, *, strict: bool) -> tuple[Diagnostic, ...]:
    """Return a warning for every assumption, or an error where nothing may be assumed."""
    code = "I005" if strict else "I004"
    return tuple(
        Diagnostic(code, note.message, (label(file, note.node),), (), f"taken: {note.taken}")
        for note in notes.found
    )

"""Assumptions of an importer, each with the element that it is about and a text for a comment."""

from __future__ import annotations

from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.importers.xml_tree import Node
from shotc.source.file import Span


class Note(NamedTuple):
    """One assumption.

    message : what is wrong or missing
    taken   : what the importer assumes instead; also part of the comment
    """

    node: Node
    message: str
    taken: str

    @property
    def comment(self) -> str:
        """The text for a comment."""
        return f"assumed: {self.taken} (line {self.node.line}: {self.message})"


class Notes:
    """Assumptions in the order in which they are made, without repeats."""

    def __init__(self) -> None:
        self._found: dict[tuple[int, str], Note] = {}

    @property
    def assumptions(self) -> tuple[Note, ...]:
        """All assumptions so far."""
        return tuple(self._found.values())

    def assume(self, node: Node, message: str, taken: str) -> str:
        """Record an assumption and return its comment."""
        note = Note(node, plain(message), plain(taken))
        return self._found.setdefault((id(node), note.message), note).comment

    def below(self, node: Node) -> list[str]:
        """Return the comments about an element and its descendants."""
        inside = {id(n) for n in node.everything()}
        return [note.comment for note in self.assumptions if id(note.node) in inside]


def plain(text: str, most: int | None = None) -> str:
    """Return at most ``most`` characters of a text, on one line, with nothing that would end a comment."""
    return "".join(c if c.isprintable() else " " for c in text[:most])


def label(file: str, node: Node) -> Label:
    """Return a label on an element's tag."""
    end = node.column + (node.wide or len(node.tag) + 1)
    return Label(file, Span(node.line, node.column, node.line, end))


def assumption_diagnostics(file: str, notes: Notes, *, strict: bool) -> tuple[Diagnostic, ...]:
    """Return a warning for every assumption, or an error if ``strict``."""
    code = "I005" if strict else "I004"
    return tuple(
        Diagnostic(code, note.message, (label(file, note.node),), (), f"taken: {note.taken}")
        for note in notes.assumptions
    )

"""Read tables from text: rows of cells with their line and column."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from shotc.importers.cameras.places import number
from shotc.importers.cameras.takes import Refused
from shotc.importers.notes import Notes, plain
from shotc.importers.xml_tree import Node

SEPARATORS = (",", ";", "\t")


class TableRow(NamedTuple):
    """One row: its first cell, used as the place of the row, and its cells by the names of their columns."""

    node: Node
    cells: dict[str, Node]

    def text(self, column: str) -> str:
        """Return a cell's text, empty if there is no cell."""
        cell = self.cells.get(column)
        return "" if cell is None else cell.text

    def number(self, column: str, notes: Notes) -> float | None:
        """Return a cell's number, or None; a text that is no number gives a note."""
        cell = self.cells.get(column)
        if cell is None or not cell.text:
            return None
        value = number(cell.text)
        if value is None:
            notes.assume(cell, f"`{plain(cell.text, 20)}` is no number", "none")
        return value


class CameraTable(NamedTuple):
    """A table. ``node``: its first line; ``heads``: the cells of that line by column name in lower case."""

    node: Node
    heads: dict[str, Node]
    rows: tuple[TableRow, ...]


def table_of(text: str, needed: Sequence[Sequence[str]], example: str) -> CameraTable | Refused:
    """Return a table whose first line names its columns, or why the text is none.

    needed  : for each required column, its accepted names
    example : a valid first line, for the message
    """
    lines = text.splitlines()
    first = next((i for i, line in enumerate(lines) if line.strip()), None)
    start = Node("", 1, 1, wide=1)
    if first is None or "\0" in text:
        return Refused(
            "I001",
            "it is empty" if first is None else "it is no text",
            start,
            f"give a table that begins with `{example}`",
        )
    separator = max(SEPARATORS, key=lines[first].count)
    heads = {cell.text.lower(): cell for cell in reversed(_cells(lines[first], first, separator))}
    head = Node("", first + 1, 1, wide=max(1, len(lines[first])))
    for names in needed:
        if not heads.keys() & set(names):
            message = f"it has no column `{names[0]}` in its first line"
            return Refused("I002", message, head, f"begin it with a line such as `{example}`")
    order = list(dict.fromkeys(cell.text.lower() for cell in _cells(lines[first], first, separator)))
    return CameraTable(head, heads, tuple(_rows(lines, first, separator, order)))


def _rows(lines: Sequence[str], first: int, separator: str, order: Sequence[str]) -> Iterator[TableRow]:
    for i in range(first + 1, len(lines)):
        cells = _cells(lines[i], i, separator)
        if any(cell.text for cell in cells):
            yield TableRow(cells[0], dict(zip(order, cells, strict=False)))


def _cells(line: str, index: int, separator: str) -> list[Node]:
    cells, column = [], 1
    for part in line.split(separator):
        text = part.strip().strip('"').strip()
        cells.append(Node("", index + 1, column, text=text, wide=max(1, len(part))))
        column += len(part) + 1
    return cells

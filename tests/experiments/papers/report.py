"""Tables of measurements, and the forms they are written in: terminal text, Markdown and one HTML page."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np
from numpy.typing import ArrayLike

STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 1200px; margin: 2em auto; color: #222 }
table { border-collapse: collapse; margin: 1em 0; font-variant-numeric: tabular-nums }
th, td { border-bottom: 1px solid #ddd; padding: .3em .8em; text-align: right }
th { border-bottom: 2px solid #888; vertical-align: bottom }
th:first-child, td:first-child { text-align: left }
img { max-width: 100%; margin: 1em 0 }
li { color: #555 }
"""


@dataclass(frozen=True)
class Table:
    """One table of the report.

    rows : cells as text, each row as long as ``columns``; notes : conditions, a sentence each
    plot : bytes of a PNG that stands below the table, or None
    """

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    notes: tuple[str, ...] = ()
    plot: bytes | None = None

    def __post_init__(self) -> None:
        if any(len(row) != len(self.columns) for row in self.rows):
            raise ValueError(f"{self.title}: a row is not as long as the heading")


@dataclass(frozen=True)
class Section:
    """A heading with its tables; facts : what was run, a line each."""

    title: str
    tables: tuple[Table, ...]
    facts: tuple[str, ...] = ()


def spread(values: ArrayLike) -> str:
    """Return the median, the 95th percentile and the largest of times."""
    return " / ".join(f"{np.percentile(values, share):.2f}" for share in (50, 95, 100))


def text(table: Table) -> str:
    """Return a table for the terminal, columns aligned."""
    if not table.rows:
        return f"{table.title}: in the report\n"
    rows = [table.columns, *table.rows]
    widths = [max((len(row[i]) for row in rows), default=0) for i in range(len(table.columns))]
    lines = [
        "  ".join(
            cell.ljust(width) if i == 0 else cell.rjust(width)
            for i, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]
    return "\n".join([table.title, "", *lines, "", *(f"  {note}" for note in table.notes), ""])


def markdown(sections: Sequence[Section], level: int = 2) -> str:
    """Return sections as Markdown without plots; level : of the headings. What is only a plot is left out."""
    lines: list[str] = []
    for section in sections:
        lines += ["#" * level + " " + section.title, "", *(f"- {fact}" for fact in section.facts), ""]
        for table in (table for table in section.tables if table.rows):
            lines += ["#" * (level + 1) + " " + table.title, ""]
            lines += [_piped(table.columns), "|---|" + "---:|" * (len(table.columns) - 1)]
            lines += [*map(_piped, table.rows), ""]
            lines += [*(f"- {note}" for note in table.notes), ""] if table.notes else []
    return "\n".join(lines).rstrip() + "\n"


def html(title: str, facts: Sequence[str], sections: Sequence[Section]) -> str:
    """Return one page that needs no other file; its plots are in it."""
    body = [f"<h1>{escape(title)}</h1>", _list(facts)]
    for section in sections:
        body += [f"<h2>{escape(section.title)}</h2>", _list(section.facts)]
        for table in section.tables:
            body += [f"<h3>{escape(table.title)}</h3>"]
            if table.rows:
                body += ["<table>", _row("th", table.columns), *(_row("td", row) for row in table.rows)]
                body += ["</table>"]
            body += [_list(table.notes), _image(table)]
    head = f'<meta charset="utf-8"><title>{escape(title)}</title><style>{STYLE}</style>'
    return (
        f'<!doctype html>\n<html lang="en"><head>{head}</head>\n<body>\n'
        + "\n".join(body)
        + "\n</body></html>\n"
    )


def _piped(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def _row(tag: str, cells: Sequence[str]) -> str:
    return "<tr>" + "".join(f"<{tag}>{escape(cell)}</{tag}>" for cell in cells) + "</tr>"


def _list(lines: Sequence[str]) -> str:
    return "<ul>" + "".join(f"<li>{escape(line)}</li>" for line in lines) + "</ul>" if lines else ""


def _image(table: Table) -> str:
    if table.plot is None:
        return ""
    data = base64.b64encode(table.plot).decode("ascii")
    return f'<img alt="{escape(table.title)}" src="data:image/png;base64,{data}">'

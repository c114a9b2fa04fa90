"""Diagnostics and texts that the renderer tests share."""

from __future__ import annotations

from shotc.diag.model import Diagnostic, Label
from shotc.source.file import WHOLE_FILE, SourceFile, Span

MISSION = SourceFile(
    "specs/tower.yaml",
    "shotc: 1\n"
    "mission: tower\n"
    "drones:\n"
    "  cam1: {model: x500, home: [0, -60, 0]}\n"
    "\n"
    "  カメラ二: {model: x5oo}  # 二\n"
    "\tcam3: {}\n"
    "shots:\n"
    "  - {id: a, " + "size: 0.5, " * 20 + "model: x5oo, " + "size: 0.6, " * 20 + "}\n",
)
OTHER = SourceFile("specs/other.yaml", "a: 1\na: 2\n")
SOURCES = {file.name: file for file in (MISSION, OTHER)}


def at(line: int, column: int, end: int, text: str = "", file: SourceFile = MISSION) -> Label:
    return Label(file.name, Span(line, column, line, end), text)


REPORT = (
    Diagnostic("Y020", "unknown alias", (at(6, 16, 20, "no such model"),), ("known: x500", ""), "write x500"),
    Diagnostic(
        "Y012",
        "the key 'a' stands here a second time",
        (at(2, 1, 2, file=OTHER), at(1, 1, 2, "first given here", OTHER)),
        ("first given on line 1",),
        "keep one of the two",
    ),
    Diagnostic("Y008", "a tab cannot indent YAML", (at(7, 1, 2),), help="indent with spaces"),
    Diagnostic(
        "Y013", "far to the right", (at(9, 240, 244, "here"), at(4, 3, 7, "the drone"), at(4, 10, 15))
    ),
    Diagnostic(
        "Y010",
        "over several lines",
        (
            Label(MISSION.name, Span(3, 1, 6, 4), "from here on"),
            Label(OTHER.name, Span(1, 4, 1, 5), "and here"),
        ),
    ),
    Diagnostic("Y015", "the file holds no mission", (Label("gone.yaml", WHOLE_FILE),), help="two\nlines"),
    Diagnostic("X001", "shotc failed: \x1b[31mred\u202e", notes=("no place",)),
    Diagnostic("Y007", "past the end", (at(2, 15, 15, "here"), at(40, 3, 9))),
    Diagnostic("Y008", "a tab cannot indent YAML", (at(7, 1, 2),), help="indent with spaces"),
)

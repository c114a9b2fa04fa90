"""``shotc explain``: print the meaning of a code, with a mission that raises it and a corrected one."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches, unified_diff
from textwrap import fill, indent
from typing import Annotated

import typer

from shotc.cli import console
from shotc.diag.code_info import CodeInfo
from shotc.diag.registry import FAMILIES, registry

_LINE_CHARACTERS = 80

Code = Annotated[
    str | None,
    typer.Argument(metavar="CODE", help="A code or its name; without one, all codes are listed."),
]


def explain(code: Code = None) -> None:
    """Explain a diagnostic: what it means, why it matters, and how to correct it.

    Example: `shotc explain Y012` or `shotc explain duplicate-key`
    """
    table = registry()
    console.out(_listing(table) if code is None else _page(_find(code, table)))


def _find(code_or_slug: str, table: Mapping[str, CodeInfo]) -> CodeInfo:
    """Return the code with this name or slug. For an unknown one, raise a usage error with the nearest."""
    by_name = {code.lower(): info for code, info in table.items()}
    by_name |= {info.slug: info for info in table.values()}
    if info := by_name.get(code_or_slug.strip().lower()):
        return info
    near = get_close_matches(code_or_slug.lower(), by_name, n=3, cutoff=0.5)
    names = [f"{by_name[name].code} ({by_name[name].slug})" for name in near]
    hint = f"did you mean {' or '.join(dict.fromkeys(names))}?" if near else "`shotc explain` lists all codes"
    raise typer.BadParameter(f"`{code_or_slug}` is no code; {hint}", param_hint="CODE")


def _page(info: CodeInfo) -> str:
    parts = [
        f"{info.code} {info.slug}: {info.summary}",
        f"{info.severity}, since {info.since}",
        "",
        fill(info.explanation, _LINE_CHARACTERS),
    ]
    if info.failing:
        parts += ["", "Raises it:", "", indent(info.failing.rstrip(), "    ")]
    if info.passing:
        parts += _mended(info.failing, info.passing)
    return "\n".join(parts)


def _mended(failing: str, passing: str) -> list[str]:
    """Return the corrected mission: only the lines that change, or all of it if most lines change."""
    before, after = failing.rstrip().splitlines(), passing.rstrip().splitlines()
    lines = list(unified_diff(before, after, n=0, lineterm=""))[2:]
    changed = [f"    {line[0]} {line[1:]}" for line in lines if not line.startswith("@@")]
    if 0 < len(changed) < len(after):
        return ["", "Passes with:", "", *changed]
    return ["", "Passes:", "", indent(passing.rstrip(), "    ")]


def _listing(table: Mapping[str, CodeInfo]) -> str:
    width = max(len(info.slug) for info in table.values())
    blocks = []
    for letter, (_, title) in FAMILIES.items():
        rows = [info for info in table.values() if info.code.startswith(letter)]
        if rows:
            lines = [f"  {info.code}  {info.slug:<{width}}  {info.summary}" for info in rows]
            blocks.append("\n".join([f"{letter}: {title}", *lines]))
    return "\n\n".join(blocks)

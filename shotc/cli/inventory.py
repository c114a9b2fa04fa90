"""``shotc list``: what a mission can name."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from shotc.cli import console


class Group(StrEnum):
    """What can be listed."""

    KINDS = "kinds"
    DRONES = "drones"
    REFINERS = "refiners"
    EMITTERS = "emitters"
    COMPOSITIONS = "compositions"


Row = tuple[str, str]
GroupArgument = Annotated[Group, typer.Argument(help="What to list.")]


def show(group: GroupArgument) -> None:
    """List what a mission can name: kinds, drones, refiners, emitters or compositions.

    Example: `shotc list kinds`
    """
    rows = _rows(group)
    width = max((len(name) for name, _ in rows), default=0)
    console.out("\n".join(f"{name:<{width}}  {summary}".rstrip() for name, summary in rows))


def _rows(group: Group) -> list[Row]:
    match group:
        case Group.DRONES:
            return _drones()
        case Group.COMPOSITIONS:
            return _compositions()
        case _:
            return _plugins(group)


def _plugins(group: Group) -> list[Row]:
    """List a plugin group; a plugin of another package bears that package's name."""
    from shotc.plugins import discover, listing

    found = discover(group)
    if found.diagnostics:
        console.report(found.diagnostics, {})
    return [
        (name, summary if package == "shotc" else f"{summary} [{package}]")
        for name, summary, package in listing(group)
    ]


def _drones() -> list[Row]:
    from shotc.spec.presets import PRESETS

    return [(name, preset.summary) for name, preset in PRESETS.items()]


def _compositions() -> list[Row]:
    from shotc.spec.compositions import COMPOSITIONS

    rows = []
    for name, composition in COMPOSITIONS.items():
        points = [f"({u:.3g}, {v:.3g})" for u, v in composition.points]
        lines = [f"u = {u:.3g}" for u in composition.u_lines] + [f"v = {v:.3g}" for v in composition.v_lines]
        said = (
            "the target stays where the keyframe shows it" if composition.keep else ", ".join(points + lines)
        )
        rows.append((name, said))
    return rows

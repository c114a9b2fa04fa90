"""``shotc list``: list the names that a mission can use."""

from __future__ import annotations

from enum import StrEnum
from math import degrees
from typing import Annotated, Any

import typer

from shotc.cli import console
from shotc.cli.console import table
from shotc.plugins import discover, listing
from shotc.solvers.headings import DEFAULT, METHODS
from shotc.spec.compositions import FRAMES
from shotc.spec.presets import PRESETS


class Group(StrEnum):
    """What can be listed."""

    KINDS = "kinds"
    DRONES = "drones"
    REFINERS = "refiners"
    REPLANNERS = "replanners"
    EMITTERS = "emitters"
    SALIENCY = "saliency"
    COMPOSITIONS = "compositions"
    HEADINGS = "headings"


GROUPS: dict[str, str] = {
    Group.KINDS: "kinds of shots",
    Group.DRONES: "models of drones, with their limits",
    Group.REFINERS: "what refines a path, for `plan --refiner`",
    Group.REPLANNERS: "what plans anew in flight, for `simulate --replanner`",
    Group.EMITTERS: "what writes files, for `output: {emit: [...]}` and `emit`",
    Group.SALIENCY: "what guesses the subject of a picture, for `identify --saliency`",
    Group.COMPOSITIONS: "places and sets of places on screen, for `composition` and `frame`",
    Group.HEADINGS: "ways to turn a camera that follows nothing, for `plan --headings`",
}
DRONE_HEADING = (
    "name",
    "speed m/s",
    "climb m/s",
    "accel. m/s^2",
    "hfov deg",
    "endurance min",
    "autopilot",
    "what it is",
)
GroupArgument = Annotated[Group | None, typer.Argument(help="What to list; without it, what can be listed.")]


def show(group: GroupArgument = None) -> None:
    """List what a mission can name: kinds, drones, refiners, replanners, emitters, saliency, compositions
    or headings.

    Example: `shotc list kinds`
    """
    rows = list(GROUPS.items()) if group is None else _rows(group)
    console.out("\n".join(table(rows)) if rows else "")


def _rows(group: Group) -> list[tuple[str, ...]]:
    match group:
        case Group.DRONES:
            return _drones()
        case Group.COMPOSITIONS:
            return _compositions()
        case Group.HEADINGS:
            return _headings()
        case _:
            return _plugins(group)


def _plugins(group: Group) -> list[tuple[str, ...]]:
    """List a plugin group. A plugin of another package is shown with that package's name."""
    discovery = discover(group)
    if discovery.diagnostics:
        console.report(discovery.diagnostics, {})
    return [
        (name, summary + _remark(discovery.plugins.get(name), package))
        for name, summary, package in listing(group)
    ]


def _remark(plugin: Any, package: str) -> str:
    """Return the package of a plugin, if it is not shotc, and whether its missions can only be checked."""
    # Emitters and refiners do not have the attribute `planned`.
    later = "" if getattr(plugin, "planned", True) else " (checked, not planned yet)"
    return later + ("" if package == "shotc" else f" [{package}]")


def _drones() -> list[tuple[str, ...]]:
    """List the limits of the drones, in the units that missions mostly use."""
    return [
        DRONE_HEADING,
        *(
            (
                name,
                f"{preset.limits.speed:g}",
                f"{preset.limits.climb:g}",
                f"{preset.limits.acceleration:g}",
                f"{degrees(preset.hfov):.3g}",
                f"{preset.endurance / 60:.3g}",
                preset.autopilot,
                preset.summary,
            )
            for name, preset in PRESETS.items()
        ),
    ]


def _headings() -> list[tuple[str, ...]]:
    return [(name, said + (" [default]" if name == DEFAULT else "")) for name, said in METHODS.items()]


def _compositions() -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = []
    for name, composition in FRAMES.items():
        points = [f"({u:.3g}, {v:.3g})" for u, v in composition.points]
        lines = [f"u = {u:.3g}" for u in composition.u_lines] + [f"v = {v:.3g}" for v in composition.v_lines]
        lines += [f"else ({u:.3g}, {v:.3g})" for u, v in composition.last]
        said = (
            "the target stays where the keyframe shows it" if composition.keep else ", ".join(points + lines)
        )
        rows.append((name, said))
    return rows

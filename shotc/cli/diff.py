"""``shotc diff``: show the differences of two plans."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from shotc.cli import console
from shotc.cli.console import table
from shotc.cli.plans import proved

if TYPE_CHECKING:  # the base install has no numpy
    from shotc.ir.trajectory import Claim
    from shotc.planfile.compare import FleetChange, PlanComparison, ShotChange

Old = Annotated[Path, typer.Argument(metavar="OLD", help="A plan.json, or the folder that holds it.")]
New = Annotated[Path, typer.Argument(metavar="NEW", help="The plan to compare it with.")]

SAME_FLIGHT_M = 0.01
"""Two flights that are nearer than this count as equal; metres."""


def diff(old: Old, new: New) -> None:
    """Compare two plans: shots, path, limits, framing and certificate.

    Example: shotc diff out/tower/plan.json out/tower-slow/plan.json
    """
    from shotc.planfile.compare import compare

    comparison = compare(proved(old), proved(new))
    console.out("\n".join(_lines(comparison)))


def _lines(comparison: PlanComparison) -> Iterator[str]:
    if comparison.fleets:
        yield from table([("fleet", "drones", "lasts"), *map(_fleet, comparison.fleets)])
        yield ""
    apart = "drones apart" if comparison.fleets else "camera apart"
    yield from table([("shot", "starts", "lasts", apart), *map(_shot, comparison.shots)])
    rows = [row for change in comparison.claims if (row := _claim(change.old, change.new)) is not None]
    yield ""
    if rows:
        yield from table([("claim", "asked", "worst"), *rows])
    else:
        yield "the certificates say the same"


def _shot(change: ShotChange) -> tuple[str, ...]:
    apart = "-"
    if change.distance is not None and change.share is not None:
        same = change.distance < SAME_FLIGHT_M
        apart = "same path" if same else f"{change.distance:.2f} m at {100 * change.share:.0f} %"
    return (change.shot, _seconds(change.start), _seconds(change.duration), apart)


def _fleet(change: FleetChange) -> tuple[str, ...]:
    drones = _arrow(*("none" if count is None else str(count) for count in change.drones))
    return (change.fleet, drones, _seconds(change.duration))


def _seconds(pair: tuple[float | None, float | None]) -> str:
    return _arrow(*("none" if value is None else f"{value:.2f} s" for value in pair))


def _claim(old: Claim | None, new: Claim | None) -> tuple[str, ...] | None:
    """Return a row, or None if the two claims have the same text."""
    either = new or old
    assert either is not None
    name = f"{either.subject}: {either.constraint}" + (f" ({either.shot})" if either.shot else "")
    limits = _arrow(*(_say(c, c.limit) if c else "none" for c in (old, new)))
    worst = _arrow(*(_say(c, c.worst) + _state(c) if c else "none" for c in (old, new)))
    return None if "->" not in limits + worst else (name, limits, worst)


def _say(claim: Claim, value: float) -> str:
    from shotc.ir.measures import measure

    return measure(value, claim.unit) if isfinite(value) else "-"


def _state(claim: Claim) -> str:
    return "" if claim.holds else " (lost)"


def _arrow(old: str, new: str) -> str:
    return old if old == new else f"{old} -> {new}"

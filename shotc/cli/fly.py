"""``shotc fly``: rehearse the fleets of a plan in simulation."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated

import typer

from shotc.cli import console
from shotc.cli.console import clock, table
from shotc.cli.plans import PlanPath, proved
from shotc.cli.verify import Format
from shotc.ir.show import drone_names
from shotc.rounding import at_least, up

if TYPE_CHECKING:
    from shotc.ir.show import Fleet
    from shotc.show.simulation.rehearse import Rehearsal

Gusty = Annotated[float, typer.Option("--gusts", min=0.0, help="Standard deviation of gusts, m/s an axis.")]
Seed = Annotated[int, typer.Option(min=0, help="Seed of the gusts.")]
FormatOption = Annotated[Format, typer.Option("--format", help="How to print what came of it.")]
LARGEST_MARGIN = 2.0
"""Times the separation: with a larger margin a show has no pictures left."""
HEADING = ("fleet", "drones", "strays, RMS", "99 %", "farthest", "nearest", "asked", "margin")


def fly(plan: PlanPath, gusts: Gusty = 0.0, seed: Seed = 1, format: FormatOption = Format.TEXT) -> None:
    """Rehearse a show: fly its fleets in simulation, with lag and gusts, and say how far they stray.

    For every fleet: how far its drones are from where the plan has them (the root mean square, what 99 % of
    them never exceed, and the farthest), the nearest that two come, and the separation and margin that the
    mission asks for. A margin of twice the farthest cannot be used up; where the nearest stays above what is
    asked, the margin was enough in this wind. A simulation proves nothing: it helps to choose. Example:

        shotc fly out/show/plan.json --gusts 0.3
    """
    from shotc.show.simulation.rehearse import rehearse
    from shotc.show.simulation.vehicle import Gusts

    trajectory = proved(plan).trajectory
    if not trajectory.fleets:
        raise typer.BadParameter("the plan has no fleet; `fly` rehearses shows", param_hint="PLAN")
    fleets = {fleet.name: fleet for fleet in trajectory.keyframes.mission.fleets}
    rehearsals = [
        (fleets[track.fleet], rehearse(fleets[track.fleet], track, Gusts(gusts), seed))
        for track in trajectory.fleets
    ]
    console.out(_document(rehearsals) if format is Format.JSON else _text(rehearsals))


def _text(rehearsals: list[tuple[Fleet, Rehearsal]]) -> str:
    return "\n".join([*table([HEADING, *(_row(*each) for each in rehearsals)]), "", *_remarks(rehearsals)])


def _row(fleet: Fleet, came: Rehearsal) -> tuple[str, ...]:
    apart = fleet.apart
    near = "-" if came.near is None else f"{came.near.distance:.2f} m"
    strays = (came.rmse, came.usual, came.farthest)
    sizes = (*(f"{value:.2f} m" for value in strays), near)
    return (fleet.name, str(len(fleet.pads)), *sizes, f"{apart.horizontal:g} m", f"{apart.margin:g} m")


def _remarks(rehearsals: list[tuple[Fleet, Rehearsal]]) -> Iterator[str]:
    for fleet, came in rehearsals:
        names, near = drone_names(fleet), came.near
        yield f"{fleet.name}: {names[came.drone]} strays farthest, at {clock(came.time)}"
        if near is not None:
            text = f"{names[near.first]} and {names[near.second]} come nearest, at {clock(near.time)}"
            yield f"{fleet.name}: {text}"
        yield f"{fleet.name}: {_verdict(fleet, came)}"


def _verdict(fleet: Fleet, came: Rehearsal) -> str:
    """Say whether the margin was enough, and which one cannot be used up."""
    below = 0 if came.near is None else came.near.below
    safe = up(2 * came.farthest, 1)
    if below:
        pairs = "1 pair comes" if below == 1 else f"{below} pairs come"
        return f"{pairs} nearer than the separation; {_remedy(fleet, came.farthest, safe)}"
    if fleet.apart.margin >= 2 * came.farthest:
        return "no two drones can come too near in this wind: the margin is twice the farthest stray, or more"
    return f"the margin was enough in this run; {_remedy(fleet, came.farthest, safe)}"


def _remedy(fleet: Fleet, farthest: float, safe: float) -> str:
    """Say which margin keeps any two drones apart, or that none is reasonable."""
    stray = f"a drone strays up to {at_least(farthest)} m from its place"
    if safe > LARGEST_MARGIN * fleet.apart.horizontal:
        return f"{stray}, too far for any margin: do not fly this show in such wind"
    return f"{stray}: plan with `separation: {{margin: {safe:g}}}`, which keeps any two apart in such wind"


def _document(rehearsals: list[tuple[Fleet, Rehearsal]]) -> str:
    rows = [
        {"fleet": fleet.name, **asdict(came), "separation": fleet.apart._asdict()}
        for fleet, came in rehearsals
    ]
    return json.dumps({"fleets": rows}, indent=2)

"""Text and JSON of collective returns for ``verify --abort-every``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from shotc.cli.console import table
from shotc.collective import Return
from shotc.ir.measures import measure
from shotc.rounding import as_minutes

HEADING = ("collective return", "from", "at rest", "over the pads", "landed", "nearest")


def returns_text(returns: Sequence[Return], every: float) -> str:
    """Return the table of the returns that take longest, brake longest and come nearest to something."""
    held = [held_return for held_return in returns if held_return.holds]
    rows: list[tuple[str, ...]] = []
    if held:
        longest = max(held, key=lambda held_return: held_return.down - held_return.time)
        slowest = max(held, key=lambda held_return: _rest(held_return) - held_return.time)
        rows += [_row("longest", longest), _row("longest until at rest", slowest)]
        apart = [
            (near.worst / near.limit, held_return)
            for held_return in held
            if (near := held_return.nearest) is not None
        ]
        if apart:
            rows.append(_row("nearest drones", min(apart, key=lambda pair: pair[0])[1]))
    first = f"{len(held)} of {len(returns)} returns hold, one every {every:g} s from lift-off to landing"
    return "\n".join([first, *(["", *("  " + line for line in table([HEADING, *rows]))] if rows else [])])


def _row(name: str, fleet_return: Return) -> tuple[str, ...]:
    near = fleet_return.nearest
    over = max(fleet.over for fleet in fleet_return.fleets)
    spans = (f"{time - fleet_return.time:.1f} s" for time in (_rest(fleet_return), over, fleet_return.down))
    apart = ""
    if near is not None:
        pair = " and ".join(near.drones)
        apart = f"{measure(near.worst, near.unit)} of {measure(near.limit, near.unit)}, {pair}"
    return (name, as_minutes(fleet_return.time), *spans, apart)


def _rest(fleet_return: Return) -> float:
    return max(fleet.rest for fleet in fleet_return.fleets)


def returns_document(returns: Sequence[Return]) -> list[dict[str, Any]]:
    """Return the returns for JSON: times in seconds of mission time, distances in metres."""
    return [
        {
            "time": fleet_return.time,
            "holds": fleet_return.holds,
            "landed": round(fleet_return.down, 6),
            "nearest": None if (near := fleet_return.nearest) is None else near.worst,
            "fleets": [
                {
                    "fleet": fleet.fleet,
                    "at_rest": round(fleet.rest, 6),
                    "over_pads": round(fleet.over, 6),
                    "landed": round(fleet.down, 6),
                    "as_planned": fleet.track is None,
                }
                for fleet in fleet_return.fleets
            ],
            "broken": [f"{claim.subject}: {claim.constraint}" for claim in fleet_return.broken],
        }
        for fleet_return in returns
    ]

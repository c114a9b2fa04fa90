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
    held = [found for found in returns if found.holds]
    rows: list[tuple[str, ...]] = []
    if held:
        longest = max(held, key=lambda found: found.down - found.time)
        slowest = max(held, key=lambda found: _rest(found) - found.time)
        rows += [_row("longest", longest), _row("longest until at rest", slowest)]
        apart = [(near.worst / near.limit, found) for found in held if (near := found.nearest) is not None]
        if apart:
            rows.append(_row("nearest drones", min(apart, key=lambda pair: pair[0])[1]))
    first = f"{len(held)} of {len(returns)} returns hold, one every {every:g} s from lift-off to landing"
    return "\n".join([first, *(["", *("  " + line for line in table([HEADING, *rows]))] if rows else [])])


def _row(name: str, found: Return) -> tuple[str, ...]:
    near = found.nearest
    over = max(fleet.over for fleet in found.fleets)
    spans = (f"{time - found.time:.1f} s" for time in (_rest(found), over, found.down))
    apart = ""
    if near is not None:
        pair = " and ".join(near.drones)
        apart = f"{measure(near.worst, near.unit)} of {measure(near.limit, near.unit)}, {pair}"
    return (name, as_minutes(found.time), *spans, apart)


def _rest(found: Return) -> float:
    return max(fleet.rest for fleet in found.fleets)


def returns_document(returns: Sequence[Return]) -> list[dict[str, Any]]:
    """Return the returns for JSON: times in seconds of mission time, distances in metres."""
    return [
        {
            "time": found.time,
            "holds": found.holds,
            "landed": round(found.down, 6),
            "nearest": None if (near := found.nearest) is None else near.worst,
            "fleets": [
                {
                    "fleet": fleet.fleet,
                    "at_rest": round(fleet.rest, 6),
                    "over_pads": round(fleet.over, 6),
                    "landed": round(fleet.down, 6),
                    "as_planned": fleet.track is None,
                }
                for fleet in found.fleets
            ],
            "broken": [f"{claim.subject}: {claim.constraint}" for claim in found.broken],
        }
        for found in returns
    ]

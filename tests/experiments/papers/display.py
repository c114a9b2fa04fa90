"""The *display* paper: goals for a viewpoint, splines within limits, and fleets that follow them.

Run it alone by `python -m tests.experiments.papers --only display`.
"""

from __future__ import annotations

from collections.abc import Callable

from tests.experiments.papers import coverage, crossing, following, limited
from tests.experiments.papers.report import Section, Table

FACTS = (
    "`python -m tests.experiments.papers --only display` runs these tables alone",
    "splines are those of Eq. 4 with the goals for control points, both ends three times; c is the paper's "
    "c-bar",
)
TABLES: dict[str, Callable[[], Table]] = {
    "goals": coverage.table,
    "splines, sampled": limited.sampled_table,
    "splines, three speeds": limited.speeds_table,
    "following squares": following.squares_table,
    "the ball on a square": following.corners_table,
    "stranding": following.stranding_table,
    "the walking human": following.human_table,
    "avoidance and plan": crossing.table,
}


def section(say: Callable[[str], None]) -> Section:
    """Run all of it."""
    tables = []
    for name, table in TABLES.items():
        say(f"display: {name}")
        tables.append(table())
    return Section("Fleets that draw", tuple(tables), FACTS)

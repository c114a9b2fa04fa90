"""Litchi missions (``.csv``), for its Mission Hub and for Litchi Pilot on machines without waypoints."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

from shotc.emit.base import Emission
from shotc.emit.litchi.table import MOST_POINTS, read_table, write_table
from shotc.emit.waypoints.machine_files import FileFormat, emit_files
from shotc.emit.waypoints.models import ROUNDED
from shotc.emit.waypoints.report import without_waypoints
from shotc.ir.trajectory import VerifiedIR

FARTHEST_M = 30_000.0
"""Longest length of a mission, metres: the limit of the older DJI SDK that Litchi uses."""

FORMAT = FileFormat(
    "litchi",
    ("dji-fly", "litchi"),
    MOST_POINTS,
    "-litchi.csv",
    ROUNDED,
    lambda points, _: write_table(points),
    read_table,
    halts=True,
    photos=("dji-fly", "litchi"),
    farthest=FARTHEST_M,
)
SETTINGS = (
    "litchi: set in the Hub what the table cannot say: Heading Mode Custom (WD), Path Mode Curved Turns,"
    " Finish Action Land; record by hand where Litchi does nothing at the points of a curved mission"
)


class LitchiEmitter:
    """Writes a table for each drone that Litchi flies."""

    name: ClassVar[str] = "litchi"
    summary: ClassVar[str] = "Litchi waypoint missions (.csv)"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return the missions, with notes on the error that the format adds and warnings about what it cannot
        carry.
        """
        emission = emit_files(plan, FORMAT)
        if not emission.artifacts:
            return emission
        lost = without_waypoints(plan.trajectory.keyframes.mission, plan.trajectory.drones)
        return replace(
            emission, diagnostics=(*emission.diagnostics, *lost), notes=(*emission.notes, SETTINGS)
        )


EMITTER = LitchiEmitter()

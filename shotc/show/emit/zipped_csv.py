"""<mission>-csv.zip: one table for each drone, in the format of Skybrush and its tools for Blender.

A row is a time in whole milliseconds, a position in metres, and the light's levels from 0 to 255 as sent to
the lamp.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np

from shotc.emit.base import Artifact, Emission
from shotc.emit.fleet_rows import fleet_rate
from shotc.emit.zip_parts import archive_parts
from shotc.filenames import file_name
from shotc.geom.bernstein import Array
from shotc.ir.sampling import clock
from shotc.ir.trajectory import VerifiedIR
from shotc.show.emit.sampled import count, sampled
from shotc.spec.presets import MANY_DRONES

HEADER = "Time [msec],x [m],y [m],z [m],Red,Green,Blue"
ROW = "%d,%.3f,%.3f,%.3f,%d,%d,%d"


@dataclass(frozen=True, slots=True)
class ZippedCsv:
    """Writes one archive for all fleets, drone by drone; the same plan gives the same bytes."""

    name: ClassVar[str] = "zipped-csv"
    summary: ClassVar[str] = "<mission>-csv.zip: a table of places and lights for each drone, for Skybrush"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return the archive; no file without fleets."""
        mission, drones = plan.trajectory.keyframes.mission, count(plan)
        if drones == 0:
            return Emission(
                (), notes=("no tables are zipped: they hold the show of a fleet, and the mission has none",)
            )
        parts = partial(archive_parts, _Members(plan))
        large = drones > MANY_DRONES
        whole = b"" if large else b"".join(parts())
        file = Artifact(f"{file_name(mission.name)}-csv.zip", whole, parts if large else None)
        note = f"{file.name}: x is East, y is North; in Skybrush set the orientation of the show to 90 deg"
        return Emission((file,), notes=(note,))


@dataclass(frozen=True, slots=True)
class _Members:
    """The tables of a plan, generated anew for each iteration."""

    plan: VerifiedIR

    def __iter__(self) -> Iterator[tuple[str, bytes]]:
        mission = self.plan.trajectory.keyframes.mission
        ticks = clock(fleet_rate(mission), self.plan.trajectory.end)
        millis = np.unique(np.round(1e3 * ticks).astype(int))
        times = millis / 1e3
        for drone in sampled(self.plan, times, times):
            rows = np.column_stack([millis, drone.places, drone.colors])
            yield f"{drone.name}.csv", _table(rows)


def _table(rows: Array) -> bytes:
    form = "\n".join([ROW] * len(rows))
    return f"{HEADER}\n{form % tuple((rows + 0.0).ravel().tolist())}\n".encode("ascii")


EMITTER = ZippedCsv()

"""DJI WPML missions (``.kmz``): for DJI Fly, and for DJI Pilot 2."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

from shotc.emit.base import Emission
from shotc.emit.dji.kmz import MOST_POINTS, read_kmz, write_kmz
from shotc.emit.waypoints.machine_files import FileFormat, emit_files
from shotc.emit.waypoints.models import CURVED
from shotc.ir.trajectory import VerifiedIR

FORMAT = FileFormat(
    "dji",
    ("dji-fly", "pilot-2"),
    MOST_POINTS,
    ".kmz",
    CURVED,
    write_kmz,
    read_kmz,
    zooms=("pilot-2",),
    says_link_lost=True,
    photos=("pilot-2",),
)
"""The focal-length unit of machines that fly with DJI Fly is not known, so their files contain no zoom."""


COPIED = (
    "dji-fly: take off from the pad, heights count from there; the file replaces one that DJI Fly has "
    "saved on the controller (shotc/docs/flying.md)"
)


class DjiEmitter:
    """Writes a ``.kmz`` for each drone that a DJI app flies."""

    name: ClassVar[str] = "dji"
    summary: ClassVar[str] = "DJI waypoint missions (.kmz) for DJI Fly and Pilot 2"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return the missions, with notes on the error that the format adds and warnings about what it cannot
        carry.
        """
        emission = emit_files(plan, FORMAT)
        drones = plan.trajectory.keyframes.mission.drones
        copied = emission.artifacts and any(drone.autopilot == "dji-fly" for drone in drones)
        return replace(emission, notes=(*emission.notes, COPIED)) if copied else emission


EMITTER = DjiEmitter()

"""The door to the compiler: missions in, bytes out. Nothing else here knows of it."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from shotc import api
from tests.support.compiled import Autopilot, compiled
from tests.support.second_opinion.case import Case
from tests.support.second_opinion.mission import Mission

FLIES_MAVLINK = {"px4", "ardupilot"}


@cache
def case_of(path: Path, refiner: str | None = None, autopilot: Autopilot | None = None) -> Case:
    """Return the files that a mission becomes; it looks at MAVLink, which DJI's machines would not get."""
    done = compiled(path, refiner, autopilot)
    assert done.plan is not None, [(d.code, d.message) for d in done.diagnostics]
    emitted = api.emit_plan(done.plan, ["csv", "mavlink"])
    files = {artifact.name: artifact.data for artifact in emitted.artifacts}
    case = Case(Mission.of(path), files, tuple(map(str, emitted.notes)))
    if all(drone["autopilot"] in FLIES_MAVLINK for drone in case.drones.values()):
        return case
    return case_of(path, refiner, "px4")

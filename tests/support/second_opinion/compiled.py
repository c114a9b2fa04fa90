"""The door to the compiler: missions in, bytes out. Nothing else here knows of it."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from shotc import api
from shotc.ir.source import TAKES
from shotc.ir.trajectory import VerifiedIR
from shotc.lowering import with_autopilot
from tests.support.compiled import Autopilot, compiled
from tests.support.records import replace
from tests.support.second_opinion.case import Case
from tests.support.second_opinion.mission import Mission


@cache
def case_of(path: Path, refiner: str | None = None, autopilot: Autopilot | None = None) -> Case:
    """Return the files that a mission becomes; it looks at MAVLink, which DJI's machines would not get."""
    done = compiled(path, refiner, autopilot)
    assert done.plan is not None, [(d.code, d.message) for d in done.diagnostics]
    emitted = api.emit_plan(_with_missions(done.plan), ["csv", "mavlink"])
    files = {artifact.name: artifact.data for artifact in emitted.artifacts}
    return Case(Mission.of(path), files, tuple(map(str, emitted.notes)))


def _with_missions(plan: VerifiedIR) -> VerifiedIR:
    """Return a plan whose drones all take MAVLink missions."""
    ir = plan.trajectory
    if all("mavlink" in TAKES[drone.autopilot] for drone in ir.keyframes.mission.drones):
        return plan
    return replace(plan, trajectory=replace(ir, keyframes=with_autopilot(ir.keyframes, "px4")))

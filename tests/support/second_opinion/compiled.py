"""The door to the compiler: missions in, bytes out. Nothing else here knows of it."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Literal

from shotc import api
from tests.support.compiled import compiled
from tests.support.second_opinion.case import Case
from tests.support.second_opinion.mission import Mission


@cache
def case_of(
    path: Path, refiner: str | None = None, autopilot: Literal["px4", "ardupilot"] | None = None
) -> Case:
    """Return the files that a mission becomes."""
    done = compiled(path, refiner, autopilot)
    assert done.plan is not None, [(d.code, d.message) for d in done.diagnostics]
    emitted = api.emit_plan(done.plan, ["csv", "mavlink"])
    files = {artifact.name: artifact.data for artifact in emitted.artifacts}
    return Case(Mission.of(path), files, tuple(map(str, emitted.notes)))

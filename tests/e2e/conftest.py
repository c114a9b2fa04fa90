"""Every mission of the tree compiled once a session, and the tests of one mission kept in one process."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

import pytest

from shotc import api
from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR
from tests.e2e import tables
from tests.e2e.tables import Table

ROOT = Path(__file__).parents[2]
MISSIONS = sorted([*ROOT.glob("specs/*.yaml"), *ROOT.glob("shotc/templates/*.yaml")])


@dataclass(frozen=True)
class Planned:
    """One mission, compiled; its tables are made when they are first asked for."""

    path: Path
    plan: VerifiedIR
    diagnostics: tuple[Diagnostic, ...]

    @property
    def mission(self) -> MissionIR:
        return self.plan.trajectory.keyframes.mission

    @property
    def track(self) -> DroneTrajectory:
        (track,) = self.plan.trajectory.drones
        return track

    @cached_property
    def files(self) -> dict[str, bytes]:
        """plan.json and the two tables."""
        return {a.name: a.data for a in api.emit_plan(self.plan, ["csv"]).artifacts}

    @cached_property
    def motion(self) -> Table:
        return tables.read(self.files["trajectory.csv"])

    @cached_property
    def framing(self) -> Table:
        return tables.read(self.files["framing.csv"])


Plan = Callable[[Path], Planned]


def compiled(path: Path) -> api.Compilation:
    """Compile a file, named as one that stands in the current folder, without a refiner."""
    return api.compile_source(path.read_bytes(), path.name, path.parent, api.PlanOptions(refiner="none"))


@pytest.fixture(scope="session")
def plan() -> Plan:
    """Plan a mission; the second time it is at hand."""

    @cache
    def planned(path: Path) -> Planned:
        done = compiled(path)
        assert done.plan is not None, [(d.code, d.message) for d in done.diagnostics]
        return Planned(path, done.plan, done.diagnostics)

    return planned


def each_mission() -> list[object]:
    """Return all missions as parameters; with ``--dist loadgroup`` one process has all tests of a mission."""
    return [pytest.param(path, id=path.stem, marks=pytest.mark.xdist_group(path.stem)) for path in MISSIONS]

"""Every mission that films, compiled once a session, and the tests of one mission kept in one process."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

import numpy as np
import pytest

from shotc import api
from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR
from tests.support import csv_tables, written_missions
from tests.support.command import run
from tests.support.compiled import compiled
from tests.support.csv_tables import Table
from tests.support.lakeside_show import LAKE, Show
from tests.support.written_missions import Course, Written

ROOT = Path(__file__).parents[2]
FILES = sorted([*ROOT.glob("specs/*.yaml"), *ROOT.glob("shotc/templates/*.yaml")])
SHOWS = [path for path in FILES if "fleets" in written_missions.read(path)]
MISSIONS = [path for path in FILES if path not in SHOWS]
"""Those that film; what is tested of shows is in test_shows.py and beside it."""


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

    @property
    def tracks(self) -> dict[str, DroneTrajectory]:
        return {track.drone: track for track in self.plan.trajectory.drones}

    @cached_property
    def written(self) -> Written:
        """The mission as a user reads it."""
        return written_missions.read(self.path)

    @cached_property
    def courses(self) -> dict[str, Course]:
        """Where every target is over mission time, of those that move by the mission as it is written."""
        tracks = {name: target.get("track") for name, target in self.written["targets"].items()}
        return {
            target.name: written_missions.course(track)
            if (track := tracks[target.name])
            else Course(np.zeros(1), np.array([target.centre]))
            for target in self.mission.targets
        }

    @cached_property
    def files(self) -> dict[str, bytes]:
        """plan.json and the two tables."""
        return {a.name: a.data for a in api.emit_plan(self.plan, ["csv"]).artifacts}

    @cached_property
    def motion(self) -> Table:
        return csv_tables.read(self.files["trajectory.csv"])

    @cached_property
    def flights(self) -> dict[str, Table]:
        """The rows of trajectory.csv of each drone."""
        return {str(name): self.motion.where(drone=name) for name in dict.fromkeys(self.motion["drone"])}

    @cached_property
    def filmed_by(self) -> dict[str, str]:
        """The drone of each shot, by trajectory.csv."""
        pairs = set(zip(self.motion["shot"].tolist(), self.motion["drone"].tolist(), strict=True))
        found = {shot: drone for shot, drone in pairs if shot}
        assert len(found) == sum(bool(shot) for shot, _ in pairs), "a shot of two drones"
        return found

    @cached_property
    def framing(self) -> Table:
        return csv_tables.read(self.files["framing.csv"])


Plan = Callable[[Path], Planned]


@pytest.fixture(scope="session")
def plan() -> Plan:
    """Plan a mission; the second time it is at hand."""

    @cache
    def planned(path: Path) -> Planned:
        done = compiled(path, "none")
        assert done.plan is not None, [(d.code, d.message) for d in done.diagnostics]
        return Planned(path, done.plan, done.diagnostics)

    return planned


def each_mission(long: Callable[[Path], bool] = lambda _: False) -> list[object]:
    """Return all missions as parameters; with ``--dist loadgroup`` one process has all tests of a mission.

    long : whether what is asked of a mission takes a second
    """
    return [
        pytest.param(
            path,
            id=path.stem,
            marks=[pytest.mark.long if long(path) else pytest.mark.slow, pytest.mark.xdist_group(path.stem)],
        )
        for path in MISSIONS
    ]


@pytest.fixture(scope="session")
def show(tmp_path_factory: pytest.TempPathFactory) -> Show:
    """The show over the lake, planned by the command."""
    folder = tmp_path_factory.mktemp("show")
    for name in (LAKE.name, "heart.svg"):
        (folder / name).write_bytes((LAKE.parent / name).read_bytes())
    done = run("plan", LAKE.name, "-o", "out", folder=folder)
    assert (done.code, done.err) == (0, "")
    return Show(folder, done.out)

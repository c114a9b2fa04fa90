"""Groups of a fleet, end to end: fireworks join a show in the middle, leave early, and meet nobody."""

from __future__ import annotations

import json
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from shotc import api
from shotc.cli.show_facts import beside
from shotc.collective import collective_returns
from shotc.emit.plan_json import EMITTER
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.trajectory import VerifiedIR
from shotc.show import assignment
from tests.support.command import run
from tests.support.compiled import compiled_text
from tests.support.grouped_shows import ACROSS, TEXT, least_between
from tests.support.resealed_plans import resealed

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("groups")]


ALONE = """\
shotc: 1
mission: alone
fleets: {swarm: {count: 4, layout: {grid: {spacing: 4}}, separation: 2 m}}
shots:
  - {id: cube, kind: display, fleet: swarm, frames: [{cube: {center: [6, 6, 26], size: 9}, hold: 4}]}
"""


@pytest.fixture(scope="module")
def plan() -> VerifiedIR:
    found = compiled_text(TEXT)
    assert found.plan is not None, found.diagnostics
    return found.plan


def flights(plan: VerifiedIR) -> dict[str, FleetTrajectory]:
    return {flight.fleet: flight for flight in plan.trajectory.fleets}


def aloft(flight: FleetTrajectory) -> tuple[float, float]:
    """When the first drone is off its pad, and when all are down, by samples."""
    times = np.arange(0.0, float(flight.breaks[-1]) + 0.1, 0.1)
    up = (places(flight.breaks, flight.coef, times)[..., 2] > 0.01).any(axis=0)
    return float(times[up][0]), float(times[up][-1])


def test_fireworks_join_in_the_middle_and_are_down_before_the_others_leave(plan: VerifiedIR) -> None:
    found = {name: aloft(flight) for name, flight in flights(plan).items()}
    up, down = found["swarm/fire"]
    assert up > max(found["swarm"][0], found["swarm/ring"][0]) + 5.0
    assert down < min(found["swarm"][1], found["swarm/ring"][1])
    shown = {s.display: s for flight in plan.trajectory.fleets for s in flight.shown}
    assert shown["rain"].start == pytest.approx(70.0)
    assert shown["halo"].start == pytest.approx(35.0)
    assert shown["rain"].end == pytest.approx(76.0)


def test_no_two_drones_of_different_groups_come_too_near_at_any_of_many_times(plan: VerifiedIR) -> None:
    times = np.linspace(0.0, plan.trajectory.end, 6001)
    for one, other in combinations(plan.trajectory.fleets, 2):
        assert least_between(one, other, times) >= ACROSS - 1e-6
    names = {c.constraint for c in plan.certificate if c.holds and c.constraint.startswith("separation")}
    assert names == {"separation", "separation from swarm/fire", "separation from swarm/ring"}


@pytest.mark.long
def test_ways_that_nobody_asked_for_are_changed_and_that_is_told(
    plan: VerifiedIR, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert any("another one is in its way" in told for told in beside(plan.trajectory.stats))
    monkeypatch.setattr(assignment, "beside", lambda *_: [])
    done = api.compile_source(TEXT.encode(), "mission.yaml", None, api.PlanOptions())
    refused = next(d for d in done.diagnostics if d.code == "D087")
    assert "`swarm/" in refused.message
    assert len(refused.labels) == 2


@pytest.mark.long
def test_the_plan_is_proved_again_from_its_bytes(plan: VerifiedIR) -> None:
    (file,) = EMITTER.emit(plan).artifacts
    report = api.verify_plan(file.data, "plan.json")
    assert report.plan is not None, report.diagnostics
    assert report.certificate == plan.certificate
    document = json.loads(file.data)
    rest = document["mission"]["fleets"][0]
    assert (rest["name"], rest["group"]["numbers"][0]) == ("swarm", 13)
    rest["group"]["numbers"][0] = 4  # who knows the format seals it anew
    assert {d.code for d in api.verify_plan(resealed(document), "plan.json").diagnostics} == {"V041"}


@pytest.mark.long
def test_the_command_says_who_draws_what(tmp_path: Path) -> None:
    (tmp_path / "show.yaml").write_text(TEXT)
    done = run("plan", "show.yaml", "--output", "out", "--emit", "skyc", folder=tmp_path)
    assert done.code == 0, done.err
    assert "3 displays of 24 drones" in done.out
    assert "swarm/fire (4 drones)" in done.out
    assert (tmp_path / "out" / "three-groups.skyc").exists()


@pytest.mark.long
def test_compare_has_nothing_to_compare_without_a_camera(tmp_path: Path) -> None:
    (tmp_path / "show.yaml").write_text(ALONE)
    done = run("compare", "show.yaml", folder=tmp_path)
    assert (done.code, done.out) == (2, "")
    assert "no camera films in it" in done.err


@pytest.mark.long
def test_all_groups_come_home_from_any_time_and_meet_nobody(plan: VerifiedIR) -> None:
    found = collective_returns(plan, 4.0, lambda _: None)
    assert len(found) > 20
    assert all(each.holds for each in found), [(each.time, each.broken) for each in found if not each.holds]

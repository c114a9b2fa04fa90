"""Drones that film nothing: bodies on their pads, for planners, for the proof and for who reads it."""

from pathlib import Path

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.checking import check_source
from shotc.cli.summary import summary
from shotc.emit.csv_table import CsvTable
from shotc.emit.waypoints.clearance import keep_outs
from shotc.ir.drone import Drone
from shotc.ir.parked import bodies, parked
from shotc.ir.trajectory import Claim, TrajectoryIR, VerifiedIR
from shotc.planning.clock.visibility import visibility_of
from shotc.planning.obstacles import flight_space, pad_space
from tests.support import show_plans
from tests.support.records import replace
from tests.support.tampered_plans import MISSION, PLAN, with_mission
from tests.support.verdicts import verdict_on

HEAD = """\
shotc: 1
mission: m
targets:
  tower: {at: [0, 0, 12], radius: 4, height: 24}
  runner: {track: {start: [0, -30, 0.9], velocity: [1.5, 0, 0]}, radius: 0.4, height: 1.8}
drones:
  cam1: {model: x500, home: [0, -60, 0]}
  cam2: {model: x500, home: HOME}
rules: {separation: 8, mutual_visibility: {strength: off}}
shots:
"""
PAST = """\
  - id: past
    kind: keyframes
    drone: cam1
    target: tower
    keyframes:
      - {at: [-10, -49, 3.6], look_at: tower, frame: center}
      - {at: [10, -49, 3.6], look_at: tower, frame: center}
"""
BESIDE = """\
  - {id: beside, kind: lateral, drone: cam1, target: runner, side: right, distance: 8, altitude: 3,
     timing: {duration: 12}}
"""


def with_spare(home: tuple[float, float, float], **rules: object) -> TrajectoryIR:
    """The sample plan in a mission that has a second drone, which films nothing and does not fly."""
    spare: Drone = replace(MISSION.drones[0], name="cam2", home=home, path=("drones", "cam2"))
    return with_mission(drones=(*MISSION.drones, spare), rules=replace(MISSION.rules, **rules))


def found(ir: TrajectoryIR, constraint: str) -> Claim:
    return next(c for c in verdict_on(ir).certificate if c.constraint == constraint)


@pytest.mark.parametrize(("out", "broken"), [(8.001, False), (7.999, True)])
def test_separation_from_a_drone_that_does_not_fly(out: float, broken: bool) -> None:
    # The orbit passes (40, 0, 20) at t = 37 s.
    ir = with_spare((40.0 - out, 0.0, 20.0), separation=8.0)
    claim = found(ir, "separation from cam2")
    assert claim.worst == pytest.approx(out, abs=1e-4)
    assert claim.time == pytest.approx(37.0, abs=0.1)
    assert (claim.method, claim.hard, claim.holds) == ("bounded", True, not broken)
    assert ("V022" in {d.code for d in verdict_on(ir).diagnostics}) is broken


def test_two_drones_that_do_not_fly_are_no_matter_of_the_plan() -> None:
    one = with_spare((70.0, 0.0, 0.0))
    third = replace(one.keyframes.mission.drones[1], name="cam3", path=("drones", "cam3"))
    ir = with_mission(one, drones=(*one.keyframes.mission.drones, third))
    names = [c.constraint for c in verdict_on(ir).certificate if c.constraint.startswith("separation")]
    assert names == ["separation from cam2", "separation from cam3"]


@pytest.mark.slow
def test_a_parked_drone_is_in_a_picture_and_is_said_to_be_on_its_pad() -> None:
    ir = with_spare((-10.0, 0.0, 20.0), visibility="require")
    fault = next(d for d in verdict_on(ir).diagnostics if d.code == "V025")
    assert "cam2 stands on its pad all the time" in " ".join(fault.notes)
    assert "move the home of `cam2`" in fault.help


@pytest.mark.slow
def test_a_parked_drone_hides_a_target_for_the_proof_and_for_the_table() -> None:
    # On the line from the orbit's middle to the centre of the tower, well before the tower.
    ir = with_spare((36.0, 0.0, 20.0 - 8.0 * 0.1), separation=0.1)
    ir = with_mission(ir, drones=(MISSION.drones[0], replace(ir.keyframes.mission.drones[1], radius=1.0)))
    assert found(ir, "tower visible").worst < 1.0
    assert any("drone `cam2` hides up to" in n for d in verdict_on(ir).diagnostics for n in d.notes)
    tables = {a.name: a.data.decode() for a in CsvTable().emit(VerifiedIR(ir, ())).artifacts}
    header, *rows = tables["framing.csv"].splitlines()
    column = header.split(",").index("occluded")
    assert {row.split(",")[column] for row in rows} == {"0", "1"}


def test_everybody_is_who_flies_and_who_stands() -> None:
    ir = with_spare((9.0, -60.0, 0.5))
    assert [track.drone for track in bodies(ir)] == ["cam1", "cam2"]
    (track,) = parked(ir)
    assert np.allclose(track.curve(np.array([-5.0, 0.0, 0.5, 99.0]))[:, :3], (9.0, -60.0, 0.5))
    assert parked(PLAN) == ()
    grounded = replace(PLAN, drones=())
    assert [track.drone for track in parked(grounded)] == ["cam1"]


def test_planners_keep_clear_of_it_wherever_they_look_at_what_stands() -> None:
    mission = with_spare((9.0, -60.0, 0.5), separation=7.0).keyframes.mission
    flies, stands = mission.drones
    for space in (flight_space(mission, flies), pad_space(mission, flies)):
        (pad,) = (o for o in space.obstacles if str(o.owner) == "drone cam2")
        assert pad.clearance == 7.0
        assert (pad.part.bottom, pad.part.top) == (0.5, 0.5)
        assert "drone cam1" not in {o.owner for o in space.obstacles}
    assert "drone cam2" not in {o.owner for o in flight_space(mission, stands).obstacles}
    assert "drone cam2" in {str(o.owner) for o in keep_outs(mission, flies)}


@pytest.mark.parametrize(("strength", "count"), [("require", 1), ("prefer", 0), ("off", 0)])
def test_a_pad_in_a_picture_bends_a_shot_only_where_it_must_not_be(strength: str, count: int) -> None:
    mission = with_spare((9.0, -60.0, 0.5), visibility=strength).keyframes.mission
    assert len(visibility_of(mission, mission.drones[0], {}).bodies) == count


@pytest.mark.long
@pytest.mark.parametrize(("shot", "home"), [(PAST, "[0, -47, 0]"), (BESIDE, "[14, -36, 0]")])
def test_a_way_past_a_parked_drone_is_planned_at_its_distance(shot: str, home: str) -> None:
    plan = compile_source(
        (HEAD.replace("HOME", home) + shot).encode(), "m.yaml", None, PlanOptions("none")
    ).plan
    assert plan is not None
    (claim,) = (c for c in plan.certificate if c.constraint.startswith("separation"))
    assert 8.0 - 1e-6 <= claim.worst < 10.0
    assert any(d.cause == "drone cam2" for d in plan.trajectory.deviations) or shot is PAST
    text = " ".join(summary(plan, [Path("out/plan.json")], []).split())
    assert (
        f"cam2 films nothing and stands on its pad, {claim.worst:.2f} m from the nearest, 8.00 m needed"
        in text
    )


def test_a_keyframe_at_a_parked_drone_is_told_by_check_on_its_line_with_a_move_that_helps() -> None:
    text = HEAD.replace("HOME", "[-10, -45, 0]") + PAST
    faults = check_source(text.encode(), "m.yaml", None).diagnostics
    assert [d.code for d in faults] == ["Q004"]
    assert faults[0].labels[0].span.line == text[: text.index("{at: [-10")].count("\n") + 1
    assert faults[0].labels[1].span.line == text[: text.index("cam2:")].count("\n") + 1
    assert "5.38 m apart" in faults[0].notes[0]
    place = faults[0].help.rpartition("to ")[2]
    corrected = text.replace("[-10, -49, 3.6]", place)
    assert check_source(corrected.encode(), "m.yaml", None).diagnostics == ()


def test_where_it_is_open_who_films_nobody_is_known_to_stand() -> None:
    text = (HEAD.replace("HOME", "[-10, -45, 0]") + PAST).replace("drone: cam1", "drone: auto")
    assert check_source(text.encode(), "m.yaml", None).diagnostics == ()


@pytest.mark.parametrize(("home", "codes"), [("[3.6, -60, 0]", ["G019"]), ("[8, -60, 0]", [])])
def test_homes_are_apart_where_one_of_the_drones_flies(home: str, codes: list[str]) -> None:
    text = HEAD.replace("HOME", home) + PAST
    assert [
        d.code for d in check_source(text.encode(), "m.yaml", None).diagnostics if d.code[0] != "P"
    ] == codes


def test_a_drone_that_may_be_chosen_is_not_parked_and_its_home_counts() -> None:
    text = HEAD.replace("HOME", "[3.6, -60, 0]") + PAST.replace("drone: cam1", "drone: auto")
    options = PlanOptions("none")
    assert [d.code for d in compile_source(text.encode(), "m.yaml", None, options).diagnostics] == ["G019"]
    two_idle = text.replace("drones:\n", "drones:\n  cam0: {model: x500, home: [70, 0, 0]}\n").replace(
        "auto", "cam0"
    )
    assert "G019" not in {d.code for d in check_source(two_idle.encode(), "m.yaml", None).diagnostics}


@pytest.mark.parametrize(("aside", "broken"), [(3.1, False), (2.9, True)])
def test_fleets_keep_clear_of_parked_drones(aside: float, broken: bool) -> None:
    # The first drone draws at (0, 20, 30); two metres of separation more than its own fleet asks for count.
    spare: Drone = replace(MISSION.drones[0], name="cam", home=(-aside, 20.0, 30.0), path=("drones", "cam"))
    ir = show_plans.show(show_plans.mission(drones=(spare,)))
    claim = found(ir, "separation from cam")
    assert claim.worst == pytest.approx(aside, abs=1e-4)
    assert claim.drones == ("swarm-1",)
    assert claim.holds is not broken
    assert ("V022" in {d.code for d in verdict_on(ir).diagnostics}) is broken


@pytest.mark.parametrize(("aside", "broken"), [(3.1, False), (2.9, True)])
def test_fleets_and_drones_keep_clear_of_the_pads_of_a_fleet_that_shows_nothing(
    aside: float, broken: bool
) -> None:
    # Heights count half as much here: 2 m of separation upwards against 1 m aside, with the margin.
    idle = show_plans.fleet(((90.0, 0.0, 0.0), (-aside, 20.0, 30.0)), "idle")
    show = show_plans.show()
    mission = show_plans.mission(fleets=(show_plans.fleet(), idle))
    claim = found(replace(show, keyframes=replace(show.keyframes, mission=mission)), "separation from idle")
    assert claim.worst == pytest.approx(aside, abs=1e-4)
    assert claim.drones == ("swarm-1", "idle-2")
    # The orbit passes (40, 0, 20); of many pads the nearest one counts.
    pads = tuple((200.0 + 4 * k, 0.0, 0.0) for k in range(20))
    idle = show_plans.fleet((*pads[:7], (40.0 - aside, 0.0, 20.0), *pads[7:]), "idle")
    film = with_mission(fleets=(idle,))
    claim = found(film, "separation from idle")
    assert claim.worst == pytest.approx(aside, abs=1e-4)
    assert claim.holds is not broken
    assert ("V022" in {d.code for d in verdict_on(film).diagnostics}) is broken


@pytest.mark.slow
def test_a_show_plans_beside_a_fleet_that_shows_nothing() -> None:
    text = """\
shotc: 1
mission: show
world: {origin: {lat: 47, lon: 8, alt: 400}}
fleets:
  swarm: {count: 4, layout: {grid: {spacing: 4, origin: [0, 0, 0]}}}
  idle: {count: 2, layout: {grid: {spacing: 4, origin: [40, 0, 0]}}}
shots:
  - {id: ball, kind: display, fleet: swarm, viewpoint: [0, -80, 2],
     frames: [{sphere: {center: [0, 20, 30], radius: 8}, hold: 4}]}
"""
    made = compile_source(text.encode(), "m.yaml", None, PlanOptions())
    assert made.plan is not None
    assert [track.fleet for track in made.plan.trajectory.fleets] == ["swarm"]
    assert "fleet idle shows nothing and stands on its pads" in summary(
        made.plan, [Path("out/plan.json")], []
    )


def test_of_many_pads_the_nearest_counts_not_the_one_whose_box_is() -> None:
    # The first is in the box round the way home, 8.5 m from the way; the second is 6 m above the orbit.
    idle = show_plans.fleet(((24.0, -24.0, 12.0), (40.0, 0.0, 26.0)), "idle")
    claim = found(with_mission(fleets=(idle,)), "separation from idle")
    assert claim.worst == pytest.approx(6.0, abs=1e-4)

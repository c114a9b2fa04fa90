"""Ways between shots keep away from what is filmed and from all else, and taper to where shots begin."""

from pathlib import Path

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.diag.model import Diagnostic
from shotc.geom.solid_arrays.points import distances
from shotc.ir.bodies import moved
from shotc.ir.mission import MissionIR
from shotc.ir.passes import PassContext
from shotc.ir.trajectory import Claim, TrajectoryIR, VerifiedIR
from shotc.ir.transits import TransitInterval, transit_intervals
from shotc.passes.verify import judge
from tests.support.records import replace

pytestmark = pytest.mark.slow

HEAD = """\
shotc: 1
mission: m
targets: {TARGETS}
drones: {cam: {model: x500, home: HOME}}
RULES
shots:
"""
TOWER = "tower: {at: [0, 0, 12], radius: 4, height: 24}"
PERSON = "person: {at: [0, 0, 0.9], radius: 0.4, height: 1.8}"
PAST_TOWER = """\
  - {id: west, kind: static, drone: cam, at: [-40, -3, 8], look_at: tower}
  - {id: east, kind: static, drone: cam, at: [40, -3, 8], look_at: tower}
"""
RADIUS = 0.6
STEP = 0.01


def planned(
    targets: str, shots: str, rules: str = "", home: str = "[-60, -3, 0]"
) -> tuple[VerifiedIR | None, tuple[Diagnostic, ...]]:
    head = HEAD.replace("TARGETS", targets).replace("HOME", home)
    text = head.replace("RULES", f"rules: {{{rules}}}" if rules else "rules: {}") + shots
    done = compile_source(text.encode(), "m.yaml", Path.cwd(), PlanOptions(refiner="none"))
    return done.plan, done.diagnostics


def plan_of(*mission: str) -> VerifiedIR:
    plan, told = planned(*mission)
    assert plan is not None, [(d.code, d.message) for d in told]
    return plan


def gaps(plan: VerifiedIR, target: str, way: TransitInterval) -> tuple[np.ndarray, np.ndarray]:
    """Distances of the body from a target on a way, and from its ends as the target sees them."""
    ir = plan.trajectory
    solid = ir.keyframes.mission.target(target)
    t = np.append(np.arange(way.start, way.end, STEP), way.end)
    beside = ir.drones[0].curve(t)[:, :3] - moved(solid, t)
    away = np.linalg.norm(beside[:, None] - beside[[0, -1]], axis=2)
    return distances(solid.solid, beside) - RADIUS, away


def nearest(plan: VerifiedIR, target: str) -> float:
    return min(
        float(gaps(plan, target, way)[0].min()) for way in transit_intervals(plan.trajectory.drones[0].phases)
    )


def claim_of(certificate: tuple[Claim, ...], constraint: str) -> Claim:
    return next(c for c in certificate if c.constraint == constraint)


def codes(told: tuple[Diagnostic, ...]) -> set[str]:
    return {d.code for d in told}


@pytest.fixture(scope="module")
def past_tower() -> VerifiedIR:
    return plan_of(TOWER, PAST_TOWER)


@pytest.fixture(scope="module")
def as_near_as_allowed() -> VerifiedIR:
    return plan_of(TOWER, PAST_TOWER, "transit_clearance: {filmed: 0, other: 0}")


def test_a_tower_beside_a_transit_is_passed_at_5_m(past_tower: VerifiedIR) -> None:
    assert nearest(past_tower, "tower") >= 5.0
    claim = claim_of(past_tower.certificate, "target tower on transits")
    assert (claim.limit, claim.method, claim.hard, claim.holds) == (5.0, "bounded", False, True)
    assert claim.worst == pytest.approx(nearest(past_tower, "tower"), abs=1e-3)


def test_without_the_clearance_it_is_passed_as_near_as_target_clearance_lets(
    as_near_as_allowed: VerifiedIR,
) -> None:
    assert 1.0 <= nearest(as_near_as_allowed, "tower") < 2.0
    assert not [c for c in as_near_as_allowed.certificate if c.constraint.endswith(" on transits")]


def test_what_nobody_films_is_passed_at_3_m() -> None:
    bystander = "bystander: {at: [0, -3, 8], radius: 0.4, height: 16}"
    plan = plan_of(f"{TOWER.replace('[0, 0, 12]', '[0, 60, 12]')}, {bystander}", PAST_TOWER)
    assert 3.0 <= nearest(plan, "bystander") < 5.0


def test_a_walker_is_passed_at_5_m_where_there_is_time() -> None:
    # On the latest way it would be below the drone, which flies 4 m high.
    walker = (
        "walker: {track: {points: [[-60, 0, 0.9], [60, 0, 0.9]], times: [0, 106]}, radius: 0.4, height: 1.8}"
    )
    shots = """\
  - {id: first, kind: static, drone: cam, at: [0, -20, 4], look_at: walker, timing: {start: 10, duration: 4}}
  - {id: last, kind: static, drone: cam, at: [0, 20, 4], heading: 0 deg, pitch: -5 deg, timing: {start: 60}}
"""
    near = plan_of(walker, shots, "transit_clearance: {filmed: 0, other: 0}", "[0, -40, 0]")
    plan = plan_of(walker, shots, "", "[0, -40, 0]")
    assert nearest(near, "walker") < 3.0
    assert nearest(plan, "walker") >= 5.0
    assert claim_of(plan.certificate, "target walker on transits").holds


def test_a_shot_at_2_m_begins_and_ends_there_and_its_ways_taper() -> None:
    shots = "  - {id: near, kind: static, drone: cam, at: [-2.55, 1.8, 3], look_at: person}\n"
    plan = plan_of(PERSON, shots)
    for way in transit_intervals(plan.trajectory.drones[0].phases):
        gap, away = gaps(plan, "person", way)
        needs = np.minimum(5.0, (gap[[0, -1]] + 0.5 * away).min(axis=1))
        assert (gap >= needs - 1e-6).all()
        assert gap.max() > 5.0
        assert min(gap[[0, -1]]) < 2.5
    assert claim_of(plan.certificate, "target person on transits").worst == pytest.approx(5.0, abs=1e-5)


GAP = """\
world: {zones: {a: {keep: out, box: {center: [-22, 0, 30], size: [40, 10, 60]}},
                b: {keep: out, box: {center: [22, 0, 30], size: [40, 10, 60]}}}}
rules: {"""
THROUGH = "  - {id: see, kind: static, drone: cam, at: [0, 20, 3], look_at: person}\n"


def through_gap(rules: str, aside: float = 22.0) -> tuple[VerifiedIR | None, tuple[Diagnostic, ...]]:
    """Plan a mission whose way leads between two boxes of 40 m; aside : of their middles, metres."""
    head = HEAD.replace("TARGETS", PERSON.replace("[0, 0, 0.9]", "[0, 40, 0.9]")).replace(
        "HOME", "[0, -30, 0]"
    )
    text = head.replace("RULES", GAP.replace("22", f"{aside}") + rules + "}") + THROUGH
    done = compile_source(text.encode(), "m.yaml", Path.cwd(), PlanOptions(refiner="none"))
    return done.plan, done.diagnostics


def test_a_gap_too_narrow_is_flown_through_and_told_once_a_way() -> None:
    plan, told = through_gap("")
    assert plan is not None
    assert [d.message.split(";")[0].split(" m ")[-1] for d in told if d.code == "V034"] == [
        "on the way to shot `see`",
        "on the way home",
    ]
    assert 1.2 <= claim_of(plan.certificate, "zone a on transits").worst <= 1.4 + 1e-6
    (line,) = {d.help for d in told if d.code == "V034" and "on the way home" in d.message}
    assert line is not None
    assert "`rules: {transit_clearance: {other: 1." in line


@pytest.mark.parametrize(("aside", "told"), [(23.4, False), (23.2, True)])
def test_what_lacks_less_than_a_tenth_is_in_the_certificate_and_not_told(aside: float, told: bool) -> None:
    plan, found = through_gap("", aside)
    assert plan is not None
    claim = claim_of(plan.certificate, "zone a on transits")
    assert not claim.holds
    assert claim.worst == pytest.approx(aside - 20.6, abs=0.02)
    assert ("V034" in codes(found)) == told


def test_what_is_told_may_be_written_down() -> None:
    _, told = through_gap("")
    line = next(d.help for d in told if d.code == "V034")
    assert line is not None
    plan, told = through_gap(line.split("`")[1].removeprefix("rules: {").removesuffix("}"))
    assert plan is not None
    assert "V034" not in codes(told)
    assert claim_of(plan.certificate, "zone a on transits").hard


def test_a_clearance_that_is_written_down_takes_any_detour() -> None:
    plan, told = through_gap("transit_clearance: {other: 3}")
    assert plan is not None
    assert claim_of(plan.certificate, "zone a on transits").worst >= 3.0
    assert "V034" not in codes(told)


def test_one_that_cannot_be_kept_is_refused_with_its_line() -> None:
    shots = "  - {id: see, kind: static, drone: cam, at: [-12, 0, 3], look_at: person}\n"
    lane = "world: {zones: {lane: {keep: in, box: {center: [-30, 0, 6], size: [80, 12, 12]}}}}"
    passed = "post: {at: [-24, 0, 5], radius: 0.4, height: 10}"
    text = HEAD.replace("TARGETS", f"{PERSON}, {passed}").replace("HOME", "[-60, 0, 0]")
    text = text.replace("RULES", f"rules: {{transit_clearance: {{other: 8 m}}}}\n{lane}") + shots
    done = compile_source(text.encode(), "m.yaml", Path.cwd(), PlanOptions(refiner="none"))
    assert done.plan is None
    (error, *_) = [d for d in done.diagnostics if d.code == "V035"]
    # Both ways pass the post at the same distance, and the first one is named.
    assert [label.text for label in error.labels] == ["required here", "is passed", "on the way here"]
    assert error.labels[0].span.line == 5


def with_rules(ir: TrajectoryIR, mission: MissionIR) -> TrajectoryIR:
    return replace(ir, keyframes=replace(ir.keyframes, mission=mission))


def test_a_plan_that_passes_nearer_than_the_mission_requires_is_refused(
    as_near_as_allowed: VerifiedIR,
) -> None:
    ir = as_near_as_allowed.trajectory
    mission = ir.keyframes.mission
    asked = mission.rules.transits._replace(filmed=5.0, filmed_required=True)
    forged = with_rules(ir, mission._replace(rules=mission.rules._replace(transits=asked)))
    verdict = judge(forged, PassContext())
    assert "V035" in codes(verdict.diagnostics)
    claim = claim_of(verdict.certificate, "target tower on transits")
    assert (claim.hard, claim.holds) == (True, False)
    assert claim.worst == pytest.approx(nearest(as_near_as_allowed, "tower"), abs=1e-3)


def test_ways_are_all_that_is_neither_filmed_nor_over_the_pad(past_tower: VerifiedIR) -> None:
    phases = past_tower.trajectory.drones[0].phases
    found = transit_intervals(phases)
    assert [way.shot for way in found] == ["west", "east", None]
    assert [way.start for way in found] == [
        next(p.end for p in phases if p.name == "takeoff"),
        *(p.end for p in phases if p.shot),
    ]

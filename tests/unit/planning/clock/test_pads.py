"""Pads that targets come over: the drone is off in time, lands when they are gone, or the mission is told."""

from __future__ import annotations

import pytest

from shotc.checking import check_source
from shotc.diag.model import Diagnostic
from shotc.ir.trajectory import Claim, VerifiedIR
from tests.support.compiled import compiled_text

PADS = """\
shotc: 1
mission: pads
targets:
  runner: {track: {start: [-40, 20, 0.9], velocity: [3, 0, 0]}, radius: 0.4, height: 1.8}
  walker: {track: TRACK, radius: 0.4, height: 1.8}
drones:
  cam1: {model: x500, home: [0, 0, 0]}
shots:
  - {id: side, kind: lateral, drone: cam1, target: runner, side: right, distance: 8, altitude: 4,
     timing: {START duration: 8}}
"""
STATIC = """\
shotc: 1
mission: wall
targets:
  walker: {track: TRACK, radius: 0.4, height: 1.8}
drones:
  cam1: {model: x500, home: [0, 0, 0]}
shots:
  - {id: wall, kind: static, drone: cam1, at: [20, -10, 8], heading: 20 deg, pitch: -10 deg,
     timing: {START duration: 8}}
"""
CROSSES = "{start: [0, -10.5, 0.9], velocity: [0, 1.5, 0]}"
"""Touches the body on the pad from 6.3 to 7.7 s."""
SOON = "{start: [0, -3.2, 0.9], velocity: [0, 1.5, 0]}"
"""Touches it from 1.5 s on: the drone is above by then, and has to go on rising."""
TARRIES = "{points: [[0, -30, 0.9], [0, -0.2, 0.9], [0, -0.1, 0.9], [0, 30, 0.9]], times: [0, 25, 60, 80]}"
STAYS = "{points: [[0, -30, 0.9], [0, -0.2, 0.9]], times: [0, 16]}"
AT_ONCE = "{start: [0.3, 0.3, 0.9], velocity: [0, 1.5, 0]}"


def compiled(mission: str, track: str, start: str = "") -> tuple[VerifiedIR | None, tuple[Diagnostic, ...]]:
    text = mission.replace("TRACK", track).replace("START", start)
    done = compiled_text(text, "none", "m.yaml")
    return done.plan, done.diagnostics


def at_home(plan: VerifiedIR) -> Claim:
    return next(c for c in plan.certificate if c.constraint == "target walker at home")


@pytest.mark.long
@pytest.mark.parametrize("mission", [PADS, STATIC])
@pytest.mark.parametrize(
    ("track", "start", "off"), [(CROSSES, "start: 20,", 6.3), (CROSSES, "", 6.3), (SOON, "start: 20,", 4.5)]
)
def test_a_drone_is_off_its_pad_before_a_target_comes_over_it(
    mission: str, track: str, start: str, off: float
) -> None:
    plan, found = compiled(mission, track, start)
    assert plan is not None, found
    assert at_home(plan).holds
    takes_off = plan.trajectory.drones[0].phases[0]
    assert takes_off.name == "takeoff"
    lifted = plan.trajectory.drones[0].curve([off])[0, 2]
    assert lifted > 2.4


@pytest.mark.slow
def test_a_drone_waits_with_its_landing_until_its_pad_is_free() -> None:
    plan, found = compiled(PADS, TARRIES, "start: 16,")
    assert plan is not None, found
    assert at_home(plan).holds
    assert plan.trajectory.drones[0].phases[-1].end > 60.0


@pytest.mark.parametrize(
    ("track", "start", "says"),
    [
        (AT_ONCE, "start: 20,", "at t = 0.0 s"),
        (STAYS, "start: 20,", "it stays there, and the drone films until 28.0 s at least"),
    ],
)
def test_what_no_plan_can_avoid_is_told_in_check_with_both_lines(track: str, start: str, says: str) -> None:
    text = PADS.replace("TRACK", track).replace("START", start)
    (told,) = (d for d in check_source(text.encode(), "m.yaml", None).diagnostics if d.code == "M012")
    assert says in told.notes[0]
    assert [label.span.line for label in told.labels] == [7, 5]


def test_a_drone_that_films_nothing_is_in_the_way_for_all_the_mission() -> None:
    parked = PADS.replace("shots:", "  cam2: {model: x500, home: [0, 9, 0]}\nshots:")
    text = parked.replace("TRACK", CROSSES).replace("START", "start: 20,")
    (told,) = check_source(text.encode(), "m.yaml", None).diagnostics
    assert told.code == "M012"
    assert "films nothing" in told.notes[0]


@pytest.mark.slow
def test_what_planning_alone_can_tell_names_the_pad_and_the_track() -> None:
    plan, found = compiled(PADS, STAYS)
    assert plan is None
    (told,) = (d for d in found if d.code == "M013")
    assert "land" in told.message
    assert [label.span.line for label in told.labels] == [7, 5]


WALKERS = """\
shotc: 1
mission: three
targets:
  a: {track: {start: [0, 0, 0.9], velocity: [1.4, 0, 0]}, radius: 0.4, height: 1.8}
  b: {track: {start: [0, 1.5, 0.9], velocity: [1.4, 0, 0]}, radius: 0.4, height: 1.8}
  c: {track: {start: [0, -1.5, 0.9], velocity: [1.4, 0, 0]}, radius: 0.4, height: 1.8}
drones:
  cam1: {model: x500, home: [0, -15, 0]}
shots:
  - {id: tail, kind: chase, drone: cam1, target: a, distance: 5, altitude: 2.7,
     timing: {start: 20, duration: 10}}
"""


@pytest.mark.long
def test_a_motion_begins_where_walkers_have_just_passed() -> None:
    """Three seconds before it begins they are there: the drone comes from aside, just in time."""
    plan, found = compiled(WALKERS, "")
    assert plan is not None, found
    assert all(claim.holds for claim in plan.certificate if claim.hard)


FIELD = """\
shotc: 1
mission: field
world:
  zones: {field: {keep: in, polygon: {points: [[-47, -45], [55, -45], [55, 85], [-47, 85]], height: [0, 53]}}}
targets:
  cyclist: {track: {start: [6, -164, 0.9], velocity: [0, 4.8, 0]}, radius: 0.7, height: 1.8}
drones:
  cam1: {model: pro, home: [9, 9, 0]}
shots:
  - {id: tail, kind: chase, drone: cam1, target: cyclist, distance: 4.2, altitude: 7.7, timing: {duration: 8}}
"""


def test_a_shot_whose_target_is_still_outside_begins_later() -> None:
    """As soon as the drone is there the cyclist is 60 m and more beyond the border, where it may not go."""
    plan, found = compiled(FIELD, "")
    assert plan is not None, found
    (start,) = (p.start for p in plan.trajectory.drones[0].phases if p.shot == "tail")
    _, north, _ = plan.trajectory.keyframes.mission.target("cyclist").at(start)
    assert north > -45 - 50

"""A preference to keep out of pictures costs a shot what the rule states, or is given up and told once."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.ir.path import ClockDeviation
from shotc.ir.preference import MOST_MOVED_SHARE, Price, given_up, noted
from shotc.passes.solve_path_qp.explain.on_clock import left_places
from shotc.planning.clock import position
from shotc.planning.clock.preferred import Cost

pytestmark = pytest.mark.slow

FAR = """\
shotc: 1
mission: far
targets: {yacht: {track: {start: [-80, 0, 8.85], velocity: [2.2, 0, 0]}, radius: 7.25, height: 17.7}}
drones:
  near: {model: pro, camera: {hfov: 105 deg, aspect: "1:1"}, priority: 1, home: [-14, -24, 0]}
  tele: {model: x500, camera: {hfov: 40 deg}, priority: 2, home: [0, 85, 0]}
rules: {separation: 6, mutual_visibility: {strength: prefer}}
shots:
  - {id: behind, kind: chase, drone: near, target: yacht, distance: 18, altitude: 10,
     timing: {start: 37, duration: 9}}
  - {id: side, kind: lateral, drone: tele, target: yacht, side: left, distance: 90, altitude: 11.3,
     timing: {start: 36, duration: 5}}
"""

ORBIT = """\
shotc: 1
mission: beside
targets: {walker: {radius: 0.4, height: 1.8, track: {start: [0, 0, 0.9], velocity: [1.2, 0, 0]}}}
drones:
  one: {model: x500, home: [-20, -30, 0], priority: FIRST}
  two: {model: x500, home: [-30, -30, 0], priority: 2}
rules: {allow: [fast-pan, hidden-subject], mutual_visibility: {strength: "STRENGTH"}}
shots:
  - {id: follow, kind: chase, drone: one, target: walker, distance: 8, altitude: 3,
     timing: {start: 20, duration: 20}}
  - {id: round, kind: orbit, drone: two, target: walker, radius: 15, altitude: 6, sweep: SWEEP deg,
     start_azimuth: AZIMUTH deg, timing: {start: 20, duration: 20}}
"""
ROUND, ASIDE = (135, 270), (-30, 6)  # the first azimuth and the sweep, degrees


@cache
def planned(text: str) -> Compilation:
    return compile_source(text.encode(), "m.yaml", None, PlanOptions(refiner="none"))


@cache
def orbit(strength: str = "prefer", first: int = 1, way: tuple[int, int] = ROUND) -> Compilation:
    text = ORBIT.replace("STRENGTH", strength).replace("FIRST", str(first))
    return planned(text.replace("AZIMUTH", str(way[0])).replace("SWEEP", str(way[1])))


def apart(a: Compilation, b: Compilation, drone: str, span: tuple[float, float]) -> float:
    """Return how far two flights of one drone are apart at most, metres."""
    times, flights = np.linspace(*span, 101), []
    for done in (a, b):
        assert done.plan is not None
        flights.append(next(t for t in done.plan.trajectory.drones if t.drone == drone))
    return float(
        np.linalg.norm(flights[0].curve(times)[:, :3] - flights[1].curve(times)[:, :3], axis=1).max()
    )


def whole(done: Compilation) -> float:
    assert done.plan is not None
    return min(c.worst for c in done.plan.certificate if c.constraint == "yacht in frame")


def told(done: Compilation, code: str) -> list[str]:
    return [" ".join((d.message, *d.notes, d.help or "")) for d in done.diagnostics if d.code == code]


def test_a_preference_crops_nobody_and_tells_who_is_seen() -> None:
    done = planned(FAR)
    assert whole(done) == 1.0
    assert "V033" in {d.code for d in done.diagnostics}


def test_without_its_rule_it_would(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(position, "cost", lambda *_: Cost(0.0, 0.0, crops=False))
    assert whole(planned.__wrapped__(FAR)) < 0.9


def test_an_orbit_that_cannot_keep_out_of_a_picture_stays_what_it_is() -> None:
    assert apart(orbit(), orbit("off"), "two", (20.0, 40.0)) < 1e-6


def test_what_costs_no_more_than_the_rule_is_kept() -> None:
    kept = orbit(way=ASIDE)
    assert 0.5 < apart(kept, orbit("off", way=ASIDE), "two", (20.0, 40.0)) <= MOST_MOVED_SHARE * 16.0
    assert told(kept, "V033") == []
    assert len(told(kept, "M008")) == 1


def test_stretches_off_a_shots_place_are_told_in_one() -> None:
    done = orbit()
    assert done.plan is not None
    cause = "the pictures of other drones"
    stretches = [ClockDeviation("round", 0.6 + 0.1 * k, 21.0 + k, cause) for k in range(7)]
    (said,) = left_places(done.plan.trajectory.keyframes.mission, stretches)
    assert said.message == "shot `round` leaves its place by 1.20 m at t = 27.0 s"
    assert "on 7 stretches: 0.60 m at t = 21.0 s" in said.notes[1]
    assert said.notes[1].endswith("and 2 more")


def test_what_is_given_up_is_told_once_a_shot_with_its_price_and_the_switch() -> None:
    said = told(orbit(), "V033")
    assert len(said) == 2
    for one in said:
        assert "the preference is given up for shot `round`: even a move by 12.0" in one
        assert "rules: {mutual_visibility: {strength: off}}" in one
        assert "`require` there" in one
    assert told(orbit(), "M008") == []


@pytest.mark.long
def test_a_requirement_pays_whatever_it_takes() -> None:
    chase = orbit("require", 3)
    assert chase.plan is not None
    assert apart(chase, orbit("off", 3), "one", (20.0, 40.0)) > MOST_MOVED_SHARE * 8.5
    (said,) = told(chase, "M008")
    assert "rules: {mutual_visibility: {strength: off}}" in said


def test_what_it_would_have_cost_is_told_where_the_rule_is_against_it() -> None:
    (*_, said) = told(orbit("prefer", 3), "V033")
    assert "shot `follow`: keeping the drones' pictures free would move it by" in said
    assert "a preference moves it by at most 20 %" in said


def test_a_price_is_a_statistic_of_the_plan() -> None:
    price = Price(12.0, 0.8, suffices=False)
    assert given_up(noted("s", price), "s") == price
    assert given_up(noted("s", price), "t") is None
    assert given_up((("s.preference_given_up", "none"),), "s") is None

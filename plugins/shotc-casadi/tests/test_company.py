"""Shots of standing targets refined where others fly and move: as alone, beside these, in their old time."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from shotc_casadi import company
from shotc_casadi.refiner import OURS

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.ir.passes import PassContext
from shotc.ir.path import PathIR, filmed
from shotc.ir.trajectory import VerifiedIR
from shotc.passes.refine_path.settle import same
from tests.support.few import few

pytestmark = pytest.mark.slow

ALONE = (Path(__file__).parents[3] / "specs/tower-fly-past.yaml").read_text()
HOME, TOWER = "home: [-90, -90, 0]}", "  tower: {at: [0, 0, 30], radius: 6, height: 60}\n"
SECOND = f"{HOME[:-1]}, priority: 1}}\n  cam2: {{model: x500, priority: 2, home: "
BYSTANDER = (
    ALONE.replace(HOME, SECOND + "[130, 130, 0]}")
    .replace(TOWER, TOWER + "  bush: {at: [150, 150, 2], radius: 1, height: 4}\n")
    .__add__(
        "  - {id: round, kind: orbit, drone: cam2, target: bush, radius: 12, altitude: 8, sweep: 1 rad}\n"
    )
)
WALKER = "  walker: {track: {start: [100, -160, 0.9], velocity: [0.3, 0, 0]}, radius: 0.4, height: 1.8}\n"
LATER = ALONE.replace(TOWER, TOWER + WALKER) + (
    "  - {id: walk, kind: lateral, drone: cam1, target: walker, side: right, distance: 8, altitude: 3,\n"
    "     timing: {duration: 6}}\n"
)
# Where the shot backs off from its tower, a drone stands, 7.8 m from the convex path, or a balloon passes.
BEHIND = ALONE.replace(HOME, SECOND + "[-16, -120, 0]}") + (
    "  - {id: still, kind: static, drone: cam2, at: [-17, -83, 30], heading: 200 deg, pitch: 0 deg,\n"
    "     timing: {start: 25, duration: 14}}\n"
)
BALLOON = (
    "  balloon: {track: {points: [[-10, -128, 30], [-13, -83, 30], [-16, -128, 30]], speed: 1.5 m/s},\n"
    "    radius: 2, height: 4}\n"
)
CROSSED = ALONE.replace(TOWER, TOWER + BALLOON) + (
    "  - {id: float, kind: static, drone: cam1, target: balloon, at: [70, -128, 30], look_at: balloon,\n"
    "     timing: {duration: 2}}\n"
)
PAIR = """\
shotc: 1
mission: pair
targets: {tower: {at: [0, 0, 12], radius: 4, height: 24}, mast: {at: [110, -120, 12], radius: 2, height: 24}}
drones:
  cam1: {model: x500, home: [-60, -90, 0], priority: 1}
  cam2: {model: x500, home: [60, -90, 0], priority: 2}
rules: {composition: thirds, allow: [jump-cut], mutual_visibility: {strength: require}}
output: {emit: [csv]}
shots:
  - id: pass
    kind: keyframes
    drone: cam1
    target: tower
    keyframes:
      - {at: [-40, -42, 8], look_at: tower}
      - {at: [40, -42, 6], look_at: tower, frame: left-third}
  - id: over
    kind: keyframes
    drone: cam2
    target: mast
    timing: {after: pass}
    keyframes:
      - {at: [62, -50, 12], look_at: mast}
      - {at: [90, -45, 8], look_at: mast}
  - {id: fixed, kind: static, drone: cam1, at: [-50, -44, 12], look_at: tower, timing: {duration: 4}}
"""
BESIDE = "ours"


@cache
def planned(text: str, refiner: str = BESIDE) -> Compilation:
    return compile_source(text.encode(), "m.yaml", None, PlanOptions(refiner=refiner))


def plan(text: str, refiner: str = BESIDE) -> VerifiedIR:
    done = planned(text, refiner)
    assert done.plan is not None, done.diagnostics
    return done.plan


def path_of(text: str, refiner: str = BESIDE, step: str = "refine-path") -> PathIR:
    return next(report.output for report in planned(text, refiner).reports if report.name == step)


def shown(text: str, refiner: str = BESIDE, shot: str = "fly-past") -> float:
    """Return the share of a shot's frames in which its target is whole."""
    claims = plan(text, refiner).certificate
    return next(c.worst for c in claims if c.constraint == "tower in frame" and c.shot == shot)


def times(text: str, refiner: str) -> list[tuple[str, float, float]]:
    tracks = plan(text, refiner).trajectory.drones
    return [(f"{t.drone} {p.name} {p.shot}", p.start, p.end) for t in tracks for p in t.phases]


def refined(text: str, refiner: str = BESIDE) -> dict[str, str]:
    stats = plan(text, refiner).trajectory.stats
    return {name.removesuffix(".refined"): str(v) for name, v in stats if name.endswith(".refined")}


def codes(text: str, refiner: str = BESIDE) -> list[str]:
    return [d.code for d in planned(text, refiner).diagnostics]


@pytest.mark.parametrize("text", few([BYSTANDER, LATER], [LATER]), ids=["bystander", "later"])
def test_a_target_is_whole_in_company_as_it_is_alone(text: str) -> None:
    assert shown(text, "none") == pytest.approx(0.666, abs=2e-3)
    assert shown(text) == 1.0
    assert set(refined(text).values()) == {"yes"}
    assert "R014" not in codes(text)


@pytest.mark.parametrize("text", few([BYSTANDER, LATER, BEHIND, CROSSED, PAIR], [LATER, PAIR]))
def test_every_phase_keeps_its_time(text: str) -> None:
    before, after = times(text, "none"), times(text, BESIDE)
    assert [name for name, *_ in before] == [name for name, *_ in after]
    assert np.allclose([t for _, *t in before], [t for _, *t in after], rtol=0, atol=1e-6)


@pytest.mark.long
def test_nobody_comes_nearer_than_the_separation_where_a_shot_backs_off() -> None:
    alone = shown(ALONE)
    (apart,) = (c for c in plan(BEHIND).certificate if c.constraint == "separation from cam2")
    assert shown(BEHIND) == alone == 1.0  # it backs off another way, and as far as it takes
    assert shown(BEHIND, "none") < 0.8
    assert apart.holds
    assert refined(BEHIND) == {"fly-past": "yes", "still": "its camera stands still"}


@pytest.mark.long
def test_a_shot_keeps_clear_of_what_crosses_behind_it() -> None:
    assert shown(CROSSED) > shown(CROSSED, "none") + 0.2
    assert refined(CROSSED) == {"fly-past": "yes", "float": "yes"}


def test_what_nothing_keeps_clear_is_told_and_flown_as_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(company, "MOST_TRIES", 0)
    before = path_of(BEHIND, "none", "solve-path-qp")
    outcome = OURS.refine(before, PassContext())
    assert outcome.value is not None
    (told,) = outcome.diagnostics
    assert told.code == "R014"
    assert "shot `fly-past` is not refined: the refined path comes" in told.message
    assert "too near to drone cam2" in told.message
    assert same(filmed(before, "fly-past"), filmed(outcome.value, "fly-past"))


def test_two_drones_refined_at_once_keep_separation_pictures_and_order() -> None:
    assert set(refined(PAIR).values()) == {"yes", "its camera stands still"}
    assert all(c.holds for c in plan(PAIR).certificate)
    told = {name: (start, end) for name, start, end in times(PAIR, BESIDE)}
    assert told["cam2 shot over"][0] == pytest.approx(told["cam1 shot pass"][1], abs=1e-9)
    assert "R014" not in codes(PAIR)


@pytest.mark.parametrize("refiner", ["ang", "look-at"])
def test_the_conditions_from_keyframe_to_keyframe_turn_the_ways_beside_their_shots(refiner: str) -> None:
    assert refined(PAIR, refiner) == {"pass": "yes", "over": "yes", "fixed": "its camera stands still"}
    before, after = times(PAIR, "none"), times(PAIR, refiner)
    assert np.allclose([t for _, *t in before], [t for _, *t in after], rtol=0, atol=1e-6)


def test_a_shot_on_its_own_clock_that_a_condition_leaves_alone_is_told() -> None:
    told = [d for d in planned(LATER, "ang").diagnostics if d.code == "R014"]
    assert [d.message for d in told] == ["shot `walk` is not refined: `ang` goes from keyframe to keyframe"]
    assert refined(LATER, "ang")["fly-past"] == "yes"


def test_a_shot_that_cannot_keep_its_time_is_told_with_what_it_takes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shotc.planning.path.rejoin.lateness", lambda *_: 0.5)
    before = path_of(LATER, "none", "solve-path-qp")
    outcome = OURS.refine(before, PassContext())
    told = [d for d in outcome.diagnostics if d.code == "R014"]
    assert "the refined path cannot keep the 29.550 s of its convex path" in told[0].message
    assert outcome.value is not None
    assert same(filmed(before, "fly-past"), filmed(outcome.value, "fly-past"))


MAST = """\
shotc: 1
mission: mast
world:
  zones: {mast: {keep: out, cylinder: {center: [-23.8, 3.8], radius: 2.5, height: [0, 9.6]}}}
targets: {barn: {at: [0, 0, 3.5], radius: 7.3, height: 7}}
drones:
  cam1: {model: mini, camera: {hfov: 49 deg}, priority: 1, home: [37.8, -37.5, 0]}
  cam2: {model: pro, priority: 2, home: [-17.9, 20, 0]}
rules: {composition: thirds-lines, ground_clearance: 3, target_clearance: 1, separation: 3}
output: {emit: [csv]}
shots:
  - {id: rise, kind: elevator, drone: cam1, target: barn, azimuth: 153 deg, distance: 47.3,
     altitude: [13.9, 4]}
  - {id: round, kind: orbit, drone: cam2, target: barn, radius: 24.1, altitude: 4, start_azimuth: 256 deg,
     sweep: -44.2 deg, require: {in_frame: 100 %}}
"""


@pytest.mark.fuzz
def test_a_shot_that_needs_more_time_than_its_convex_path_gets_it_where_its_time_is_free() -> None:
    """Round the mast it backs off from the barn, which takes half a second more."""
    assert "R014" not in codes(MAST)
    assert refined(MAST)["round"] == "yes"
    shot = next(t for t in times(MAST, BESIDE) if t[0] == "cam2 shot round")
    plain = MAST.replace(", require: {in_frame: 100 %}", "")
    free = next(t for t in times(plain, "none") if t[0] == "cam2 shot round")
    assert shot[2] - shot[1] > 1.05 * (free[2] - free[1])
    given = MAST.replace("require: {in_frame: 100 %}", f"timing: {{duration: {free[2] - free[1]:.3f} s}}")
    assert "R014" in codes(given)

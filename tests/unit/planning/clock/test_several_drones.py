"""Several drones in one mission: they keep apart in the air and on the ground, whoever has to wait."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.checking import check_source
from shotc.ir.trajectory import VerifiedIR
from tests.support.compiled import compiled_text

pytestmark = pytest.mark.slow

KEPT, GIVEN_UP = 1.0, 2.5  # metres off a place

HEAD = """\
shotc: 1
mission: several
targets:
  runner:
    track: {points: [[0, 0, 0.9], [60, 0, 0.9], [90, 30, 0.9]], speed: 3 m/s}
    radius: 0.4
    height: 1.8
  tower: {at: [0, 80, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [20, -20, 0], priority: 1}
  cam2: {model: x500, home: [26, -20, 0], priority: 2}
  cam3: {model: x500, home: [32, -20, 0], priority: 3}
rules: {mutual_visibility: {strength: "off"}, allow: [fast-pan]}
shots:
"""
SIDE = """\
  - {id: side, kind: lateral, drone: cam1, target: runner, side: right, distance: 8, altitude: 4,
     timing: {start: 15, duration: 12}}
"""
PASS = """\
  - {id: pass, kind: flyby, drone: cam2, target: runner, behind: 10, ahead: 10, offset: -8, altitude: 4,
     timing: {start: 15, duration: 12}}
"""
TAIL = """\
  - {id: tail, kind: chase, drone: cam3, target: runner, distance: 6, altitude: 4,
     timing: {start: 16, duration: 10}}
"""
ORBITS = """\
  - {id: a, kind: orbit, drone: cam1, target: tower, radius: 45, altitude: 20, sweep: 120 deg,
     start_azimuth: 180 deg}
  - {id: b, kind: orbit, drone: cam2, target: tower, radius: 45, altitude: 20, sweep: -120 deg,
     start_azimuth: 180 deg}
"""


def planned(shots: str, head: str = HEAD) -> VerifiedIR:
    done = compiled_text((head + shots), "none", "m.yaml")
    assert done.plan is not None, done.diagnostics
    return done.plan


def nearest(plan: VerifiedIR) -> float:
    """Return how near any two drones come, by samples of our own; each stands at its ends."""
    tracks = [t.curve for t in plan.trajectory.drones]
    t = np.arange(0.0, max(c.end for c in tracks), 0.01)
    places = [c(np.minimum(t, c.end))[:, :3] for c in tracks]
    return min(
        float(np.linalg.norm(a - b, axis=1).min()) for i, a in enumerate(places) for b in places[i + 1 :]
    )


@pytest.mark.long
def test_three_drones_film_one_runner_and_keep_apart() -> None:
    plan = planned(SIDE + PASS + TAIL)
    assert nearest(plan) >= 3.0 - 1e-6
    claims = [c for c in plan.certificate if c.constraint.startswith("separation")]
    assert len(claims) == 3
    assert all(c.hard and c.holds and c.method == "bounded" for c in claims)
    assert min(c.worst for c in claims) == pytest.approx(nearest(plan), abs=0.02)


@pytest.mark.long
def test_the_lower_priority_gives_way() -> None:
    first = planned(SIDE + PASS)
    away = {c.shot: c.worst for c in first.certificate if c.constraint == "distance from its place"}
    assert away["side"] < KEPT
    assert away["pass"] > GIVEN_UP
    swapped = HEAD.replace("priority: 1", "priority: 9")
    other = planned(SIDE + PASS, swapped)
    away = {c.shot: c.worst for c in other.certificate if c.constraint == "distance from its place"}
    assert away["pass"] < KEPT
    assert away["side"] > GIVEN_UP


def test_drones_that_film_what_stands_wait_for_each_other() -> None:
    plan = planned(ORBITS)
    assert nearest(plan) >= 3.0 - 1e-6


def test_a_shot_waits_for_that_of_a_drone_of_lower_priority() -> None:
    wait = ORBITS.replace("start_azimuth: 180 deg}", "start_azimuth: 180 deg, timing: {after: b}}", 1)
    plan = planned(wait)
    phases = {p.shot: p for t in plan.trajectory.drones for p in t.phases if p.shot}
    assert phases["a"].start >= phases["b"].end - 1e-6


def test_homes_that_are_too_near_are_told_on_their_line() -> None:
    near = HEAD.replace("[26, -20, 0]", "[21, -20, 0]") + SIDE + PASS
    found = check_source(near.encode(), "m.yaml", None).diagnostics
    assert [d.code for d in found] == ["G019"]
    assert found[0].labels[0].span.line == 11


def seen_share(plan: VerifiedIR, watcher: str, other: str) -> float:
    """Return the share of a film in which the other drone is in the frame, by plain trigonometry."""
    tracks = {t.drone: t for t in plan.trajectory.drones}
    mission = plan.trajectory.keyframes.mission
    hits: list[bool] = []
    for phase in tracks[watcher].phases:
        if phase.shot is None:
            continue
        for t in np.arange(phase.start, phase.end, 0.04):
            x, y, z, yaw, pitch, _, hfov = tracks[watcher].curve(t)
            d = tracks[other].curve(min(t, tracks[other].curve.end))[:3] - [x, y, z]
            ahead = np.array([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)])
            right = np.array([np.sin(yaw), -np.cos(yaw), 0.0])
            depth, wide = d @ ahead, np.tan(hfov / 2)
            u = d @ right / wide
            v = d @ np.cross(right, ahead) / wide * mission.drone(watcher).aspect
            hits.append(bool(depth > 0 and abs(u) < depth and abs(v) < depth))
    return float(np.mean(hits))


def pairs() -> list[tuple[str, str]]:
    return [(a, b) for a in ("cam1", "cam2", "cam3") for b in ("cam1", "cam2", "cam3") if a != b]


@pytest.mark.long
def test_drones_keep_out_of_each_others_pictures_both_ways() -> None:
    off = planned(SIDE + PASS + TAIL)
    assert max(seen_share(off, a, b) for a, b in pairs()) > 0.5
    kept = planned(SIDE + PASS + TAIL, HEAD.replace('"off"', "require"))
    assert max(seen_share(kept, a, b) for a, b in pairs()) == 0.0
    assert nearest(kept) >= 3.0 - 1e-6


@pytest.mark.long
def test_a_cone_is_kept_free_where_the_mission_asks_for_one() -> None:
    cone = HEAD.replace('{strength: "off"}', "{strength: prefer, half_angle: 20 deg}")
    plan = planned(SIDE + PASS + TAIL, cone)
    tracks = {t.drone: t for t in plan.trajectory.drones}
    for a, b in pairs():
        (phase,) = (p for p in tracks[a].phases if p.shot)
        for t in np.arange(phase.start, phase.end, 0.04):
            x, y, z, yaw, pitch, _, _ = tracks[a].curve(t)
            d = tracks[b].curve(min(t, tracks[b].curve.end))[:3] - [x, y, z]
            ahead = [np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)]
            assert np.degrees(np.arccos(d @ ahead / np.linalg.norm(d))) > 20.0

"""Whole missions with shots on their own clock: several drones, warnings, and missions drawn at random."""

from __future__ import annotations

import numpy as np
import pytest
from shotc_casadi.clock.refiner import GUIDE_BETTER, KEPT

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.diag.registry import has_errors
from shotc.ir.path import CAM_PITCH, CAM_YAW, ClockLeg, PathIR

pytestmark = pytest.mark.slow

SEVERAL = """\
shotc: 1
mission: several
targets:
  runner:
    track: {points: [[0, 0, 0.9], [60, 0, 0.9], [90, 30, 0.9]], speed: 3 m/s}
    radius: 0.4
    height: 1.8
drones:
  cam1: {model: x500, home: [20, -20, 0], priority: 1}
  cam2: {model: x500, home: [26, -20, 0], priority: 2}
  cam3: {model: x500, home: [32, -20, 0], priority: 3}
rules: {mutual_visibility: {strength: require}, allow: [fast-pan]}
shots:
  - {id: side, kind: lateral, drone: cam1, target: runner, side: right, distance: 8, altitude: 4,
     timing: {start: 15, duration: 12}}
  - {id: pass, kind: flyby, drone: cam2, target: runner, behind: 10, ahead: 10, offset: -8, altitude: 4,
     timing: {start: 15, duration: 12}}
  - {id: tail, kind: chase, drone: cam3, target: runner, distance: 6, altitude: 4,
     timing: {start: 16, duration: 10}}
"""
ALONE = """\
shotc: 1
mission: run
targets:
  runner: {{track: {{points: [{points}], speed: {speed:.2f} m/s}}, radius: 0.4, height: 1.8}}
drones: {{cam1: {{model: x500, home: [{home[0]:.1f}, {home[1]:.1f}, 0], body: {body}}}}}
{world}{rules}shots:
  - {{id: s, drone: cam1, kind: {kind}, target: runner, {shot},
     timing: {{start: {start:.2f}, duration: {duration:.2f}}}}}
"""
CORNER = ALONE.format(
    points="[0, 0, 0.9], [60, 0, 0.9], [90, 30, 0.9]", speed=3.0, home=(45.0, -20.0), body="forward",
    world="", rules="", kind="chase", shot="distance: 8, altitude: 4", start=15.0, duration=12.0,
)  # fmt: skip


def compiled(text: str, refiner: str = "ours") -> Compilation:
    return compile_source(text.encode(), "run.yaml", None, PlanOptions(refiner=refiner))


def path(done: Compilation, step: str = "refine-path") -> PathIR:
    return next(report.output for report in done.reports if report.name == step)


def drawn(seed: int) -> str:
    """A mission of one shot at random: a course with corners, zones beside it, any kind and body."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 6))
    course = np.cumsum(np.vstack([[0.0, 0.0], rng.uniform(-25, 30, (count, 2))]), axis=0)
    speed, apart, height = rng.uniform(0.5, 5), rng.uniform(4, 15), rng.uniform(2.5, 12)
    lasts = float(np.linalg.norm(np.diff(course, axis=0), axis=1).sum() / speed)
    start = min(15.0, 0.4 * lasts)
    shots = {
        "chase": f"distance: {apart:.1f}, altitude: {height:.1f}",
        "lead": f"distance: {apart:.1f}, altitude: {height:.1f}",
        "lateral": f"side: left, distance: {apart:.1f}, altitude: {height:.1f}",
        "flyby": f"behind: {apart:.1f}, ahead: {apart:.1f}, offset: {rng.uniform(-6, 6):.1f}, "
        f"altitude: {height:.1f}",
        "orbit": f"radius: {apart:.1f}, altitude: {height:.1f}, sweep: {rng.uniform(-300, 300):.0f} deg",
    }
    kind = str(rng.choice(list(shots)))
    zones = []
    for i in range(int(rng.integers(0, 4))):
        x, y = course[rng.integers(0, count)] + rng.uniform(-8, 8, 2)
        sides = ", ".join(f"{side:.1f}" for side in rng.uniform(1, 6, 2))
        zones.append(f"z{i}: {{keep: out, box: {{center: [{x:.1f}, {y:.1f}, 4], size: [{sides}, 8]}}}}")
    return ALONE.format(
        points=", ".join(f"[{x:.2f}, {y:.2f}, 0.9]" for x, y in course),
        speed=speed,
        home=course.mean(axis=0) + rng.uniform(-20, 20, 2),
        body=rng.choice(["forward", "free", "follow-camera"]),
        world="world: {zones: {" + ", ".join(zones) + "}}\n" if zones else "",
        rules=str(rng.choice(["", "rules: {composition: thirds}\n"])),
        kind=kind,
        shot=shots[kind],
        start=start,
        duration=max(4.0, min(float(rng.uniform(5, 25)), lasts - start)),
    )


@pytest.mark.long
def test_several_drones_are_refined_beside_one_another_and_out_of_each_other_s_pictures() -> None:
    done = compiled(SEVERAL)
    assert done.plan is not None
    stats = dict(path(done).stats)
    assert {stats[f"{shot}.refine_status"] for shot in ("side", "pass", "tail")} == {"solved"}
    claims = [c for c in done.plan.certificate if "separation" in c.constraint or "picture" in c.constraint]
    assert len(claims) == 9
    for claim in claims:
        assert claim.worst >= (3.0 if "separation" in claim.constraint else 0.0)


@pytest.mark.long
def test_how_far_a_refined_shot_leaves_its_place_is_told_of_the_flown_motion() -> None:
    guide, ours = compiled(CORNER, "none"), compiled(CORNER)
    for done in (guide, ours):
        assert done.plan is not None
        (told,) = (d for d in done.diagnostics if d.code == "M008")
        claimed = next(c.worst for c in done.plan.certificate if c.constraint == "distance from its place")
        assert float(told.message.split(" by ")[1].split()[0]) == pytest.approx(claimed, abs=0.02)
    assert len({d.message for done in (guide, ours) for d in done.diagnostics if d.code == "M008"}) == 2


@pytest.mark.parametrize(
    ("seeds", "least"),
    [(range(400, 403), 1), pytest.param(range(403, 416), 3, marks=pytest.mark.fuzz)],
    ids=["few", "many"],
)
def test_whatever_is_drawn_is_refined_where_its_guide_can_be_flown(seeds: range, least: int) -> None:
    texts = [drawn(seed) for seed in seeds]
    flown = [text for text in texts if compiled(text, "none").plan is not None]
    assert len(flown) >= least
    for text in flown:
        ours = compiled(text)
        assert ours.plan is not None, (text, ours.diagnostics)
        assert not [d for d in ours.diagnostics if d.code[0] == "R" or has_errors([d])]
        before, after = (path(ours, step).timed[0].legs for step in ("solve-path-qp", "refine-path"))
        ((old, new),) = (pair for pair in zip(before, after, strict=True) if pair[0].shot == "s")
        if looks_past(ours):
            assert visible(ours) > visible(compiled(text, "none")), text
        else:
            assert turned(new) <= 1.05 * turned(old) + 1e-3, text


def looks_past(done: Compilation) -> bool:
    """Whether the camera leaves its place for what would hide its subject."""
    assert done.plan is not None
    return any("hide" in deviation.cause for deviation in done.plan.trajectory.deviations)


def visible(done: Compilation) -> float:
    """The share of frames in which the runner is visible."""
    assert done.plan is not None
    return next(c.worst for c in done.plan.certificate if c.constraint == "runner visible")


def turned(leg: ClockLeg) -> float:
    """The mean square of the camera's angular acceleration in the film, rad^2/s^4."""
    t = np.linspace(leg.start, leg.end, 2000)
    return sum(float((leg.curve.derivative(2)(t)[:, c] ** 2).mean()) for c in (CAM_YAW, CAM_PITCH))


@pytest.mark.long
def test_where_a_wall_leaves_no_room_on_the_side_of_the_pass_there_is_a_motion_all_the_same() -> None:
    text = ALONE.format(
        points="[0, 0, 0.9], [-23.35, 9.75, 0.9], [-47.51, 13.15, 0.9], [-43.09, 37.63, 0.9]",
        speed=2.2,
        home=(-30.7, 27.7),
        body="forward",
        world="world: {zones: {z0: {keep: out, box: {center: [-50.9, 12.3, 4], size: [5.5, 5.5, 8]}}}}\n",
        rules="",
        kind="flyby",
        shot="behind: 6.7, ahead: 6.7, offset: 1.2, altitude: 4.6",
        start=13.55,
        duration=18.74,
    )
    done = compiled(text)
    assert done.plan is not None, done.diagnostics
    # The solver found a motion: where its guide films the subject as well, that is flown, and told.
    status = dict(path(done).stats)["s.refine_status"]
    told = [d for d in done.diagnostics if d.code[0] == "R"]
    assert status == (KEPT if told else "solved")
    assert all(d.code == "R014" and GUIDE_BETTER in d.message for d in told)

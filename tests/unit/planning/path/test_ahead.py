"""Ways on which drones look where they fly: drawn missions, recomputed from the trajectory alone."""

from __future__ import annotations

from math import degrees, radians

import numpy as np
import pytest

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.geom.bernstein import Piecewise
from shotc.geom.solids import Cylinder
from shotc.geom.vec import wrapped
from shotc.ir.owners import Owner
from shotc.ir.path import BODY_YAW, CAM_YAW
from shotc.ir.trajectory import Claim, VerifiedIR
from shotc.planning.free_space import FreeSpace, Obstacle
from shotc.planning.obstacles import FreeSpaces
from shotc.planning.path import legs
from shotc.planning.path.ahead import CourseBounds, course_of
from shotc.planning.path.bends import as_clear, bent_ends, bent_starts, over_cone
from tests.support.few import few

pytestmark = pytest.mark.slow

FAST_M_S = 0.5


def drawn(seed: int) -> tuple[str, float]:
    """Return a mission of cameras that look anywhere, with blocks between, and its half-angle, degrees."""
    rng = np.random.default_rng([seed, 55])
    half_angle, body = float(rng.uniform(15.0, 80.0)), str(rng.choice(["follow-camera", "forward", "free"]))
    spots = rng.uniform(-60.0, 60.0, (3, 2)).round(1)
    shots, zones = "", ""
    for k, (x, y) in enumerate(spots):
        place = f"[{x}, {y}, {rng.uniform(6.0, 20.0):.1f}]"
        shots += (
            f"  - {{id: s{k}, kind: static, drone: cam, at: {place}, heading: {rng.uniform(0, 360):.0f} deg, "
            f"pitch: -5 deg, timing: {{duration: 3 s}}}}\n"
        )
    middle = spots[:-1] + 0.5 * np.diff(spots, axis=0)
    for k, (x, y) in enumerate(middle):
        if np.linalg.norm(spots - [x, y], axis=1).min() > 12.0:
            zones += (
                f"    z{k}: {{keep: out, cylinder: {{center: [{x}, {y}], radius: 6, height: [0, 60]}}}}\n"
            )
    world = f"world:\n  zones:\n{zones}" if zones else ""
    rules = f"rules: {{look_ahead: {half_angle:.2f} deg}}\n"
    drones = f"drones: {{cam: {{model: x500, home: [0, -75], body: {body}}}}}\n"
    return f"shotc: 1\nmission: look\n{world}{drones}{rules}shots:\n{shots}output: {{rate: 5}}\n", half_angle


def compiled(text: str) -> Compilation:
    return compile_source(text.encode(), "look.yaml", None, PlanOptions(refiner="none"))


def claimed(plan: VerifiedIR) -> Claim:
    return next(c for c in plan.certificate if c.constraint == "look ahead")


def off_course(plan: VerifiedIR) -> float:
    """Return the largest angle between nose and course on unfilmed ways, at samples, degrees."""
    (track,) = plan.trajectory.drones
    t = np.linspace(0.0, track.curve.end, 20_001)
    unfilmed = np.zeros(len(t), dtype=bool)
    for phase in track.phases:
        if phase.shot is None and phase.name not in ("takeoff", "land"):
            unfilmed |= (t >= phase.start) & (t <= phase.end)
    v = track.curve.derivative()(t)[:, :2]
    off = np.abs(wrapped(track.curve(t)[:, BODY_YAW] - np.arctan2(v[:, 1], v[:, 0])))
    return degrees(off[unfilmed & (np.linalg.norm(v, axis=1) > FAST_M_S)].max())


@pytest.mark.long
@pytest.mark.parametrize("seed", few(range(24), range(4)))
def test_whatever_is_drawn_is_flown_nose_first_between_shots(seed: int) -> None:
    text, half_angle = drawn(seed)
    done = compiled(text)
    assert done.plan is not None, [d.message for d in done.diagnostics]
    claim = claimed(done.plan)
    assert claim.holds
    assert claim.method == "bounded"
    assert off_course(done.plan) <= degrees(claim.worst) + 1e-3 <= half_angle + 2e-3


def test_without_the_rule_the_same_drone_looks_aside_and_nothing_is_claimed() -> None:
    text, half_angle = drawn(0)
    plan = compiled(text.replace(f"rules: {{look_ahead: {half_angle:.2f} deg}}\n", "")).plan
    assert plan is not None
    assert off_course(plan) > half_angle
    assert not [c for c in plan.certificate if c.constraint == "look ahead"]


@pytest.mark.long
def test_a_drone_on_the_mission_s_clock_looks_ahead_to_where_its_film_s_motion_begins() -> None:
    text = """\
shotc: 1
mission: walk
targets: {walker: {track: {points: [[0, 0, 0.9], [60, 0, 0.9]], speed: 1.5}, radius: 0.4, height: 1.8}}
drones: {cam: {model: x500, home: [-20, -60]}}
rules: {look_ahead: 30 deg, allow: [fast-pan]}
shots:
  - {id: first, kind: lateral, drone: cam, target: walker, side: left, distance: 8, altitude: 4,
     timing: {start: 22, duration: 5}}
  - {id: then, kind: static, drone: cam, at: [60, -40, 8], heading: 90 deg, pitch: -5 deg,
     timing: {duration: 3}}
"""
    plan = compiled(text).plan
    assert plan is not None
    assert degrees(claimed(plan).worst) <= 30.0
    (track,) = plan.trajectory.drones
    shot = next(p for p in track.phases if p.shot == "first")
    nose, course = track.curve(shot.start)[CAM_YAW], track.curve.derivative()(shot.start)[:2]
    assert abs(wrapped(float(nose) - float(np.arctan2(course[1], course[0])))) > radians(60.0)


ASIDE = """\
shotc: 1
mission: aside
drones: {cam: {model: x500, home: [0, -40]}}
rules: {look_ahead: 45 deg}
shots:
  - {id: a, kind: static, drone: cam, at: [0, 0, 10], heading: 20 deg, pitch: 0 deg, timing: {duration: 3}}
  - {id: b, kind: static, drone: cam, at: [60, 0, 10], heading: 20 deg, pitch: 0 deg, timing: {duration: 3}}
"""


def seconds_between(plan: VerifiedIR) -> float:
    (track,) = plan.trajectory.drones
    first, second = (p for p in track.phases if p.shot is not None)
    return second.start - first.end


@pytest.mark.long
def test_a_way_bends_where_that_takes_less_time_than_to_turn_first(monkeypatch: pytest.MonkeyPatch) -> None:
    bent = compiled(ASIDE).plan
    assert bent is not None
    for bends in ("bent_starts", "bent_ends"):
        monkeypatch.setattr(legs, bends, lambda way, over: iter(()))
    straight = compiled(ASIDE).plan
    assert straight is not None
    assert seconds_between(bent) < seconds_between(straight) - 0.8
    assert claimed(bent).holds


def test_a_bend_begins_where_its_nose_may_be_and_joins_the_old_way() -> None:
    x = np.linspace(0.0, 50.0, 6)
    way = Piecewise(np.array([0.0, 50.0]), np.column_stack([x, 0 * x, 9.0 + 0 * x])[None])
    over = over_cone(0.0, radians(100.0), radians(40.0))
    assert over == pytest.approx(radians(60.0))
    bends = list(bent_starts(way, over))
    assert bends
    for bend in bends:
        assert bend(0.0) == pytest.approx([0.0, 0.0, 9.0])
        assert bend(40.0) == pytest.approx(way(40.0))
        jumps = [np.abs(bend.derivative(k)(30.0 - 1e-9) - bend.derivative(k)(30.0 + 1e-9)) for k in (1, 2)]
        assert np.max(jumps) < 1e-6
    turns = [np.arctan2(*bend.derivative()(0.0)[[1, 0]]) for bend in bends]
    assert max(turns) == pytest.approx(over)
    (back, *_) = bent_ends(way, over)
    assert back(0.0) == pytest.approx(way(0.0))
    assert back(50.0) == pytest.approx(way(50.0))


def test_a_bend_through_something_is_not_clear() -> None:
    x = np.linspace(0.0, 50.0, 6)
    way = Piecewise(np.array([0.0, 50.0]), np.column_stack([x, 0 * x, 9.0 + 0 * x])[None])
    *_, wide = bent_starts(way, radians(60.0))
    middle = wide(8.0)
    owner = Owner("zone", "mast", ("world", "zones", "mast"))
    mast = Obstacle(owner, Cylinder((float(middle[0]), float(middle[1])), 0.2, 0.0, 20.0), 0.5)
    free = FreeSpace((), (), ())
    assert as_clear(FreeSpaces(free, free), wide, way)
    stands = FreeSpace((mast,), (), ())
    assert not as_clear(FreeSpaces(stands, stands), wide, way)


def test_a_way_so_steep_that_the_drone_is_slow_over_ground_has_no_course() -> None:
    plan = compiled(ASIDE).plan
    assert plan is not None
    (who,) = plan.trajectory.keyframes.mission.drones
    assert (who.limits.climb, who.limits.descent) == (3.0, 1.5)
    x = np.linspace(0.0, 20.0, 6)

    def course(level: float, rise: float) -> CourseBounds | None:
        way = np.column_stack([level * x, 0 * x, 30.0 + rise * x])[None]
        return course_of(who, Piecewise(np.array([0.0, 20.0]), way), radians(30.0))

    # Over ground it makes 0.3 m/s at 1.5 m/s down, 0.6 m/s at 3 m/s up.
    assert course(0.2, -1.0) is None
    assert course(0.2, 1.0) is not None
    assert course(0.5, -1.0) is not None

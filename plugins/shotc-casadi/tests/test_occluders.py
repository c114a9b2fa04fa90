"""What hides a subject: the closed form of horizon culling, the ellipsoids, and shots that look past them."""

from __future__ import annotations

from functools import cache

import casadi as ca
import numpy as np
import pytest
from shotc_casadi.clock import symbols
from shotc_casadi.clock.occluders import Occluder, enclosing, occluders_of
from shotc_casadi.clock.references import ClockSubject
from shotc_casadi.clock.refiner import subject_of
from shotc_casadi.clock.rounds import refine_clock
from shotc_casadi.clock.shown import past_occluders, visibility_of

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.geom.solids import Cylinder, Prism, box
from tests.support.few import few
from tests.support.refined_clocks import refine_clocks

MISSION = """\
shotc: 1
mission: past
{world}targets:
  runner: {{track: {{points: [[0, 0, 0.9], [120, 0, 0.9]], speed: 3 m/s}}, radius: 0.4, height: 1.8}}
  other:
    {{track: {{points: [[{first}, -3, 1], [{last}, -3, 1]], speed: {speed} m/s}}, radius: 0.4, height: 2}}
drones:
  cam: {{model: x500, home: [40, -20, 0], priority: 2}}
  bird: {{model: x500, home: [60, 20, 0], priority: 1}}
rules: {{separation: 2, mutual_visibility: {{strength: off}}, allow: [fast-pan]}}
shots:
  - {{id: s, drone: cam, {shot}, timing: {{start: 15, duration: 12}}}}
{more}"""
LATERAL = "kind: lateral, target: runner, side: right, distance: 8, altitude: 3"
FRAMING = (
    "kind: framing, subjects: [{target: runner, size: 0.35, view: {azimuth: 180 deg, elevation: 16 deg}}]"
)
KEYED = """\
kind: keyframes, target: runner, keyframes: [{at: {from: runner, offset: [0, -8, 3]}, look_at: runner},
     {at: {from: runner, offset: LAST}, look_at: runner}]"""
BIRD = """\
  - {id: t, drone: bird, kind: lateral, target: runner, side: right, distance: 4, altitude: 2.7,
     timing: {start: 15, duration: 12}}
"""
# Who goes along between camera and runner and falls behind, who is overtaken faster, and who is far away.
PASSING: dict[str, object] = {
    "first": 5,
    "last": 110,
    "speed": 2.7,
}
CROSSING: dict[str, object] = {"first": 21, "last": 101, "speed": 2.0}
AWAY: dict[str, object] = {"first": -90, "last": -10, "speed": 2.0}
KEEPS: dict[str, object] = {"world": "", "more": ""}


@cache
def compiled(text: str, refiner: str = "ours") -> Compilation:
    return compile_source(text.encode(), "past.yaml", None, PlanOptions(refiner=refiner))


def mission(shot: str, **how: object) -> str:
    return MISSION.format(shot=shot, **(KEEPS | how))


def subject(text: str) -> ClockSubject:
    done = compiled(text, "none")
    path = next(report.output for report in done.reports if report.name == "solve-path-qp")
    return subject_of(path, "s")


def visible(text: str, refiner: str) -> float:
    done = compiled(text, refiner)
    assert done.plan is not None, done.diagnostics
    return next(c.worst for c in done.plan.certificate if (c.shot, c.constraint) == ("s", "runner in sight"))


def drawn(seed: int) -> tuple[Occluder, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    scale = rng.normal(size=(3, 3)) + 2.0 * np.eye(3)
    eyes, points = rng.uniform(-6, 6, (2, 400, 3))
    return Occluder(scale, np.tile(rng.uniform(-1, 1, 3), (400, 1))), eyes, points


def corners_of(part: Cylinder | Prism) -> np.ndarray:
    if isinstance(part, Cylinder):
        turn = np.linspace(0.0, 2 * np.pi, 24)
        rim = np.array(part.centre) + part.radius * np.column_stack([np.cos(turn), np.sin(turn)])
    else:
        rim = np.array(part.points)
    return np.array([[x, y, z] for x, y in rim for z in (part.bottom, part.top)])


@pytest.mark.parametrize("seed", range(4))
def test_a_line_of_sight_is_covered_where_points_of_it_are_in_the_ellipsoid(seed: int) -> None:
    occluder, eyes, points = drawn(seed)
    share = np.linspace(0.0, 1.0, 1001)[:, None, None]
    line = (eyes + share * (points - eyes) - occluder.centres) @ occluder.scale.T
    least = np.linalg.norm(line, axis=2).min(axis=0)
    ends = np.minimum(np.linalg.norm(line[0], axis=1), np.linalg.norm(line[-1], axis=1))
    clear = ends > 1.1  # who is in it, or touches it, is not hidden by it
    found = occluder.occlusion(eyes, points)
    assert clear.any()
    assert (found[clear & (least < 0.999)] > 0).all()
    assert (found[clear & (least > 1.001)] <= 0).all()
    assert (found[ends < 1.0] == -np.inf).all()


@pytest.mark.slow
@pytest.mark.parametrize(("radius", "one"), [("0.4", False), ("2.7", True)])
def test_who_overlaps_the_subject_is_a_part_of_it_and_not_looked_past(radius: str, one: bool) -> None:
    text = mission(LATERAL, **(PASSING | {"speed": 3.0, "first": 0}))
    of = subject(text.replace("radius: 0.4, height: 2}", f"radius: {radius}, height: 2}}"))
    breaks = np.linspace(15.0, 27.0, 25)
    occluder = occluders_of(of, breaks)[0]
    points = np.array([of.mission.target("runner").at(float(t)) for t in breaks])
    occlusion = occluder.occlusion(points + np.array([0.0, -9.0, 0.1]), points)
    assert (occlusion == -np.inf).all() if one else (occlusion > 0.0).all()


def test_the_programme_s_term_is_the_paper_s() -> None:
    occluder, eyes, points = drawn(7)
    numbers, eye, point = ca.SX.sym("s", symbols.OCCLUDER_PARAMETERS), ca.SX.sym("e", 3), ca.SX.sym("p", 3)
    term = ca.Function("occlusion", [numbers, eye, point], [symbols.occlusion(numbers, eye, point)])
    given = [*occluder.scale.T.ravel(), *occluder.centres[0], 1.0]
    found = np.array([float(term(given, e, p)) for e, p in zip(eyes, points, strict=True)])
    to_point, to_centre = (points - eyes) @ occluder.scale.T, (occluder.centres - eyes) @ occluder.scale.T
    projected = (to_point * to_centre).sum(axis=1)
    paper = projected**2 / (to_point**2).sum(axis=1) - ((to_centre**2).sum(axis=1) - 1.0)
    assert found == pytest.approx(paper, abs=1e-6)
    counts = np.isfinite(occluder.occlusion(eyes, points))
    assert occluder.occlusion(eyes, points)[counts] == pytest.approx(paper[counts])


@pytest.mark.parametrize(
    "part", [Cylinder((3.0, -2.0), 0.4, 0.0, 1.8), box((5.0, 1.0, 4.0), (12.0, 1.0, 8.0), 0.6)]
)
def test_an_ellipsoid_holds_its_solid_and_touches_it(part: Cylinder | Prism) -> None:
    scale, centre = enclosing(part)
    away = np.linalg.norm((corners_of(part) - centre) @ scale.T, axis=1)
    assert away.max() == pytest.approx(1.0, abs=1e-6)


def test_a_solid_without_an_end_is_held_by_an_ellipsoid_without_one() -> None:
    scale, centre = enclosing(Cylinder((1.0, 2.0), 0.5, 0.0, np.inf))
    assert np.linalg.norm(scale @ (np.array([1.5, 2.0, 1e4]) - centre)) < 1.0


MAST = Cylinder((0.0, 0.0), 2.5, 0.0, 10.6)


def around(part: Cylinder | Prism, count: int) -> Occluder:
    scale, centre = enclosing(part)
    return Occluder(scale, np.tile(centre, (count, 1)), around_upright=True)


@pytest.mark.parametrize("part", [MAST, box((5.0, 1.0, 4.0), (12.0, 1.0, 8.0), 0.6)])
@pytest.mark.parametrize("seed", range(3))
def test_an_ellipsoid_that_leaves_both_ends_outside_contains_the_solid_as_well(
    part: Cylinder | Prism, seed: int
) -> None:
    occluder = around(part, 200)
    centre = occluder.centres[0]
    rng = np.random.default_rng(seed)
    beside = np.linalg.solve(occluder.scale, rng.uniform(-1.3, 1.3, (200, 3)).T).T + centre
    far = centre + rng.uniform(-1, 1, (200, 3)) + np.array([90.0, 0.0, 0.0])
    maps = occluder.scales(beside, far)
    ends = np.linalg.norm(np.einsum("nij,nj->ni", maps, beside - centre), axis=1)
    fixed = np.linalg.norm((beside - centre) @ occluder.scale.T, axis=1)
    other = np.abs(maps - occluder.scale).max(axis=(1, 2)) > 0.0
    assert other.any()
    assert (fixed[other] ** 2 <= 1.1).all()
    assert (ends[other] ** 2 > 1.1).all()
    lengths = np.linalg.norm(np.einsum("nij,cj->nci", maps, corners_of(part) - centre), axis=2)
    assert lengths.max() == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize(
    ("eye", "hides"),
    [
        ((0.0, 0.0, 11.2), True),  # just above the mast: behind its edge
        ((0.0, 0.0, 11.8), False),  # over its edge
        ((0.0, 3.4, 5.0), True),  # just behind it, beside its middle
        ((0.0, -3.4, 5.0), False),  # just in front
    ],
)
def test_a_camera_close_to_a_solid_is_told_what_it_hides(eye: tuple[float, ...], hides: bool) -> None:
    occluder, eyes, point = around(MAST, 1), np.array([eye]), np.array([[0.0, -30.0, 1.0]])
    assert bool(occluder.occlusion(eyes, point)[0] > 0.0) is hides


@pytest.mark.long
@pytest.mark.parametrize("shot", [LATERAL, FRAMING])
@pytest.mark.parametrize("walk", few([PASSING, CROSSING], [CROSSING]))
def test_who_passes_between_camera_and_subject_is_looked_past(shot: str, walk: dict[str, object]) -> None:
    text = mission(shot, **walk)
    assert visible(text, "none") < 0.95
    assert visible(text, "ours") > 0.995
    done = compiled(text)
    assert done.plan is not None
    assert not [d for d in done.diagnostics if d.code[0] in "RV"]
    (told,) = (d for d in done.plan.trajectory.deviations if d.shot == "s" and d.cause.startswith("what"))
    assert 0.5 < told.distance < 3.0
    claims = {c.constraint: c.worst for c in done.plan.certificate if c.shot == "s"}
    assert claims["runner in frame"] == 1.0
    assert claims["runner screen error"] < 0.01


@pytest.mark.long
def test_a_drone_between_camera_and_subject_is_looked_past() -> None:
    text = mission(
        LATERAL.replace("altitude: 3", "altitude: 4.5, allow: [hidden-subject]"), **(AWAY | {"more": BIRD})
    )
    assert visible(text, "none") < 0.5
    assert visible(text, "ours") > 0.99


@pytest.mark.slow
def test_where_nothing_hides_the_subject_the_shot_is_refined_as_ever() -> None:
    of = subject(mission(LATERAL, **AWAY))
    plain = refine_clock(of)
    assert visibility_of(of, of.leg).free.mean == 1.0
    assert past_occluders(of, plain) is None


@pytest.mark.slow
def test_a_place_that_the_author_gave_is_kept_whatever_hides_the_subject() -> None:
    of = subject(mission("kind: static, at: [63, -8, 3], look_at: runner", **CROSSING))
    assert visibility_of(of, of.leg).free.mean < 0.99
    assert past_occluders(of, refine_clock(of)) is None


@pytest.mark.long
def test_who_passes_between_two_keyframes_is_looked_past_and_these_stay() -> None:
    text = mission(KEYED.replace("LAST", "[3, -8, 3.5]"), **CROSSING)
    assert visible(text, "none") < 0.97
    assert visible(text, "ours") > 0.995
    done = compiled(text)
    assert done.plan is not None
    (flight,) = (d for d in done.plan.trajectory.drones if d.drone == "cam")
    runner = done.plan.trajectory.keyframes.mission.target("runner")
    for keyframe, offset in zip(flight.keyframes, ([0.0, -8.0, 2.1], [3.0, -8.0, 2.6]), strict=True):
        beside = flight.curve(keyframe.time)[:3] - np.array(runner.at(keyframe.time))
        assert beside == pytest.approx(offset, abs=1e-3)


@pytest.mark.slow
def test_a_camera_that_keyframes_keep_beside_a_target_stays_there() -> None:
    of = subject(mission(KEYED.replace("LAST", "[0, -8, 3]"), **CROSSING))
    assert visibility_of(of, of.leg).free.mean < 0.99
    assert past_occluders(of, refine_clock(of)) is None


@pytest.mark.long
def test_a_promise_goes_before_the_line_of_sight() -> None:
    text = mission(LATERAL + ", require: {size: [0.29, 0.3005]}", **PASSING)
    of = subject(text)
    plain = refine_clock(of)
    assert past_occluders(of, plain) is None
    assert past_occluders(subject(mission(LATERAL, **PASSING)), plain) is not None
    path, told = refine_clocks(of.path, "ours")
    assert told == ()
    assert visibility_of(of, subject_of(path, "s").leg).largest <= 0.3005


def test_a_distance_off_the_ideal_is_the_size_s_and_the_view_s_error_in_one() -> None:
    rng = np.random.default_rng(3)
    ideal = np.array([3.0, -6.0, 2.0])  # from the subject to the camera
    usual = float(np.linalg.norm(ideal))
    for off in 0.02 * usual * rng.normal(size=(20, 3)):
        moved = ideal + off
        away = float(np.linalg.norm(moved))
        size = usual / away - 1.0  # Eq. 8, as a share of the size asked for
        view = moved / away - ideal / usual  # Eq. 9
        assert size**2 + view @ view == pytest.approx(off @ off / usual**2, rel=0.25)


STATUES = """\
shotc: 1
mission: statues
targets:
  tall: {at: [0, 0, 2.965], radius: 1.28, height: 5.93}
  low: {at: [1.64, -4.5, 1.55], radius: 1.38, height: 3.1}
  near: {at: [-4.41, 0, 1.9], radius: 1.28, height: 3.8}
drones: {cam: {model: pro, camera: {hfov: 86 deg}, home: [12.7, -24.2, 0]}}
rules: {composition: thirds, ground_clearance: 3, target_clearance: 0.5, allow: [hidden-subject]}
shots:
  - id: s
    kind: framing
    drone: cam
    subjects:
      - {target: tall, frame: [-0.05, 0.1], size: 0.34}
      - {target: low, frame: [0.25, -0.05]}
      - {target: near}
    timing: {duration: 9}
"""


@pytest.mark.long
def test_a_camera_looks_past_others_no_farther_than_verification_believes() -> None:
    """It would go 9.5 m off its place, and 8.7 m are believed: half of its distance to the nearest statue."""
    done = compiled(STATUES)
    assert done.plan is not None, done.diagnostics
    (off,) = (c for c in done.plan.certificate if c.constraint == "distance from its place")
    assert 1.0 < off.worst < off.limit

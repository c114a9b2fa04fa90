"""The geometry stage on missions made by hand."""

from __future__ import annotations

from math import hypot, pi, radians

import numpy as np
import pytest

from shotc.api import PlanOptions, check_source, compile_source
from shotc.diag.codes.convex import CODES
from shotc.geom.camera import view
from shotc.geom.convex import distances
from shotc.geom.solids import Cylinder, Prism
from shotc.ir.mission import Gimbal, Target, Timing, Zone
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW
from shotc.passes.base import PassContext
from shotc.passes.parameterize_time import ParameterizeTime
from shotc.passes.solve_path_qp.faults import failure
from shotc.passes.solve_path_qp.position import Stretch, solve_stretch
from shotc.passes.solve_path_qp.room import flight_room
from shotc.passes.solve_path_qp.shots import Stuck
from tests.path_scenes import (
    ASPECT,
    FIELD,
    block,
    circle,
    framed,
    free,
    inside,
    legs,
    mission,
    out,
    planned,
    shot,
    solve,
)
from tests.records import replace

TOWER = Target("tower", (0.0, 0.0, 12.0), 4.0, 24.0, ("targets", "tower"))
TREE = out("tree", Cylinder((-20.0, 10.0), 3.0, 0.0, 12.0))
HOUSE = out("house", block((10, 25), (-8, 6), (0, 9)))


def codes(outcome):
    return [d.code for d in outcome.diagnostics]


@pytest.mark.parametrize("body", ["follow-camera", "forward", "free"])
def test_a_whole_flight_is_sound_in_every_body_mode(body):
    made = mission(TREE, HOUSE, inside("field", FIELD), body=body)
    path = planned(made, shot(circle(TOWER, 7, 40, 20, sweep=pi)))
    assert [leg.phase for leg in path.drones[0].legs] == ["takeoff", "transit", "shot", "return", "land"]


def test_placed_keyframes_are_passed_exactly_with_their_angles():
    made = mission(TREE, HOUSE, inside("field", FIELD))
    keyframes = [
        framed(0, (-40, -30, 10), TOWER, uv=(-1 / 3, 0.0)),
        framed(1, (5, -35, 18), TOWER, uv=(1 / 3, 0.1)),
        framed(2, (45, 20, 15), TOWER, uv=(0.0, 0.0), hold=2.0),
        framed(3, (30, 45, 12), TOWER, uv=(1 / 3, -0.1)),
    ]
    leg = legs(planned(made, shot(keyframes)), "shot")[0]
    for mark, keyframe in zip(leg.marks, keyframes, strict=True):
        q = leg.curve(mark.s)
        assert q[:3] == pytest.approx(keyframe.at, abs=1e-6)
        assert np.cos(q[CAM_YAW] - keyframe.yaw) == pytest.approx(1.0, abs=1e-12)
        assert q[CAM_PITCH] == pytest.approx(keyframe.pitch, abs=1e-6)
    assert [(s.s, s.hold) for s in leg.stops][1] == (leg.marks[2].s, 2.0)


def test_the_composition_is_kept_between_keyframes():
    made = mission(inside("field", FIELD))
    rng = np.random.default_rng(3)
    angles = np.linspace(0, 4, 9)
    spots = [(40 * np.cos(a) + 3 * rng.normal(), 40 * np.sin(a) + 3 * rng.normal(), 15.0) for a in angles]
    keyframes = [framed(i, p, TOWER, uv=((-1 / 3, 0.0), (1 / 3, 0.1))[i % 2]) for i, p in enumerate(spots)]
    leg = legs(planned(made, shot(keyframes)), "shot")[0]
    (span,) = leg.framing
    assert (span.start, span.end) == (0.0, leg.curve.end)
    for s in np.linspace(0, leg.curve.end, 300):
        q = leg.curve(s)
        d = tuple(c - p for c, p in zip(TOWER.centre, q[:3], strict=True))
        u, v, _ = view(q[CAM_YAW], q[CAM_PITCH], q[6], ASPECT).project(d)
        assert hypot(u - span.reference(s)[0], v - span.reference(s)[1]) < 5e-3


def test_a_zoom_is_monotone_and_framing_follows_it():
    made = mission()
    keyframes = [
        framed(0, (-40, 0, 12), TOWER, uv=(0.3, 0.0), hfov=radians(40)),
        framed(1, (-30, -30, 12), TOWER, uv=(0.3, 0.0), hfov=radians(70)),
        framed(2, (0, -40, 12), TOWER, uv=(0.3, 0.0), hfov=radians(70)),
    ]
    leg = legs(planned(made, shot(keyframes)), "shot")[0]
    hfov = leg.curve.ctrl[:, :, 6]
    assert hfov.min() >= radians(40) - 1e-12
    assert hfov.max() <= radians(70) + 1e-12
    for s in np.linspace(0, leg.curve.end, 100):
        q = leg.curve(s)
        d = tuple(c - p for c, p in zip(TOWER.centre, q[:3], strict=True))
        assert view(q[CAM_YAW], q[CAM_PITCH], q[6], ASPECT).project(d)[0] == pytest.approx(0.3, abs=5e-3)


def test_a_full_orbit_turns_the_camera_by_a_full_turn():
    leg = legs(planned(mission(), shot(circle(TOWER, 13, 40, 20))), "shot")[0]
    turned = leg.curve(leg.curve.end)[CAM_YAW] - leg.curve(0.0)[CAM_YAW]
    assert turned == pytest.approx(2 * pi, abs=1e-9)
    radius = np.linalg.norm(leg.curve(np.linspace(0, leg.curve.end, 500))[:, :2], axis=1)
    assert np.abs(radius - 40).max() < 0.3  # away from the ends a spline through 13 points is round


def test_a_hand_over_is_cut_in_the_middle():
    other = Target("shed", (40.0, 0.0, 3.0), 2.0, 6.0, ("targets", "shed"))
    made = mission(targets=(TOWER, other))
    keyframes = [
        framed(0, (-10, -30, 10), TOWER),
        framed(1, (10, -30, 10), TOWER, uv=(1 / 3, 0.0)),
        framed(2, (30, -25, 8), other),
        free(3, (50, -20, 10), yaw=2.0),
    ]
    leg = legs(planned(made, shot(keyframes)), "shot")[0]
    s = [m.s for m in leg.marks]
    spans = [(f.target, f.start, f.end, f.reference is None) for f in leg.framing]
    assert spans == [
        ("tower", s[0], s[1], False),
        ("tower", s[1], (s[1] + s[2]) / 2, True),
        ("shed", (s[1] + s[2]) / 2, s[2], True),
        ("shed", s[2], (s[2] + s[3]) / 2, True),
    ]


def test_a_pan_on_the_spot_rests_and_takes_two_metres_a_radian():
    made = mission(targets=())
    keyframes = [
        free(0, (0, -30, 10)),
        free(1, (20, -30, 10)),
        free(2, (20, -30, 10), yaw=2.0),
        free(3, (40, -20, 10), yaw=2.0),
    ]
    leg = legs(planned(made, shot(keyframes)), "shot")[0]
    assert [s.s for s in leg.stops][1:3] == [20.0, 24.0]
    on_the_spot = leg.curve(np.linspace(20.0, 24.0, 50))
    assert np.abs(on_the_spot[:, :3] - (20, -30, 10)).max() < 1e-9


def test_a_still_camera_is_a_hold_leg():
    made = mission(targets=(TOWER,))
    path = planned(
        made, shot([framed(0, (0, -40, 12), TOWER)], timing=Timing(duration=7.0)),
        shot([framed(0, (0, -40, 12), TOWER, hold=3.0)], name="s1"),
    )  # fmt: skip
    first, second = legs(path, "shot")
    assert first.curve is None
    assert [s.hold for s in first.stops + second.stops] == [7.0, 3.0]
    assert len(legs(path, "transit")) == 1  # the second shot starts where the first one stands


def test_yaw_is_continuous_across_the_whole_flight():
    shots = [
        shot([free(0, (0, -30, 10), yaw=3.0), free(1, (20, -30, 10), yaw=-3.0)]),
        shot([free(0, (30, -30, 10), yaw=-1.0), free(1, (40, -10, 10), yaw=2.9)], name="s1"),
        shot([free(0, (40, 20, 10), yaw=-2.9), free(1, (20, 40, 10), yaw=1.0)], name="s2"),
    ]
    path = planned(mission(targets=(), body="forward"), *shots)
    for leg in path.drones[0].legs:
        yaw = leg.curve(np.linspace(leg.curve.start, leg.curve.end, 200))[:, CAM_YAW]
        assert np.abs(np.diff(yaw)).max() < 0.2
        assert np.ptp(yaw) < pi


def test_forward_points_the_nose_along_the_motion():
    made = mission(body="forward", targets=(TOWER,))
    leg = legs(planned(made, shot(circle(TOWER, 13, 40, 20))), "shot")[0]
    s = np.linspace(0, leg.curve.end, 200)
    rate = leg.curve.derivative()(s)
    course = np.arctan2(rate[:, 1], rate[:, 0])
    assert np.cos(leg.curve(s)[:, BODY_YAW] - course).min() > np.cos(0.1)


def test_forward_yields_to_the_gimbal_and_does_not_flip():
    gimbal = Gimbal((radians(-90), radians(30)), (radians(-100), radians(100)), 1.0, 2.0)
    made = mission(body="forward", gimbal=gimbal, targets=(TOWER,))
    # Backing away from the tower, a little to either side: the wanted gimbal yaw passes 180 degrees.
    spots = [(10, -0.5, 12), (20, 0.5, 12), (30, -0.5, 12), (40, 0.5, 12), (50, -0.5, 12)]
    leg = legs(planned(made, shot([framed(i, p, TOWER) for i, p in enumerate(spots)])), "shot")[0]
    q = leg.curve(np.linspace(0, leg.curve.end, 300))
    assert np.ptp(q[:, BODY_YAW]) < 0.5


def test_free_does_not_turn_where_the_gimbal_can():
    made = mission(body="free", targets=(TOWER,))
    leg = legs(planned(made, shot(circle(TOWER, 7, 40, 20, sweep=pi))), "shot")[0]
    assert np.ptp(leg.curve(np.linspace(0, leg.curve.end, 100))[:, BODY_YAW]) < 0.02


def test_a_generated_path_leaves_its_ideal_and_says_so():
    pole = Cylinder((0.0, 40.0), 3.0, 0.0, 30.0)
    made = mission(out("pole", pole), inside("field", FIELD), targets=(TOWER,))
    outcome = solve(made, shot(circle(TOWER, 25, 40, 20, placed=False)))
    assert codes(outcome) == ["Q006"]
    (deviation,) = outcome.value.deviations
    assert deviation.cause == "zone pole"
    assert 3.6 <= deviation.distance <= 5.0
    leg = legs(planned(made, shot(circle(TOWER, 25, 40, 20, placed=False))), "shot")[0]
    q = leg.curve(np.linspace(0, leg.curve.end, 600))[:, :3]
    assert distances(pole, q).min() >= 0.6
    far = np.hypot(q[:, 0], q[:, 1] - 40) > 20
    assert np.abs(np.hypot(q[far, 0], q[far, 1]) - 40).max() < 0.4


def test_generated_ends_that_are_blocked_move_to_free_places():
    made = mission(out("pole", Cylinder((0.0, -40.0), 3.0, 0.0, 30.0)), targets=(TOWER,))
    path = planned(made, shot(circle(TOWER, 25, 40, 20, placed=False)))
    assert {d.cause for d in path.deviations} == {"zone pole"}


def test_transit_and_return_lead_round():
    wall = out("wall", block((-30, 30), (-31, -29), (0, 50)))
    made = mission(wall, inside("field", FIELD), targets=())
    path = planned(made, shot([free(0, (0, 0, 8)), free(1, (10, 0, 8))]))
    for phase in ("transit", "return"):
        q = legs(path, phase)[0].curve
        x = q(np.linspace(0, q.end, 400))
        crossing = x[np.abs(x[:, 1] + 30).argmin()]
        assert abs(crossing[0]) > 30


def test_keep_in_corners_are_rounded():
    ell = Prism(((-80, -80), (80, -80), (80, 80), (10, 80), (10, -10), (-80, -10)), 2.0, 50.0)
    ring = Cylinder((0.0, 0.0), 70.0, 2.0, 60.0)
    made = mission(inside("ell", ell), inside("ring", ring), targets=())
    path = planned(made, shot([free(0, (-50, -30, 8)), free(1, (40, 50, 8), yaw=1.0)]))
    leg = legs(path, "shot")[0]
    assert np.linalg.norm(leg.curve(np.linspace(0, leg.curve.end, 300))[:, :2], axis=1).max() <= 69.4


@pytest.mark.parametrize("body", ["follow-camera", "forward", "free"])
@pytest.mark.parametrize("size", [0.01, 0.04, 0.2, 5000.0])
def test_backing_away_by_any_length_is_planned_in_every_body_mode(size, body):
    # Flown backwards, so that the gimbal's end binds the body.
    spots = [30 + share * size for share in (0, 1 / 3, 2 / 3, 1)]
    keyframes = [framed(i, (0.8 * x, 0.6 * x, 12), TOWER) for i, x in enumerate(spots)]
    planned(mission(body=body), shot(keyframes))


def test_the_transit_altitude_obeys_ground_and_floors():
    made = mission(inside("high", replace(FIELD, bottom=7.0)), targets=())
    path = planned(made, shot([free(0, (0, 0, 20)), free(1, (10, 0, 20))]))
    takeoff = legs(path, "takeoff")[0]
    end = takeoff.curve(takeoff.curve.end)
    assert end[:2] == pytest.approx((0, -60))
    assert 7.6 < end[2] < 7.8


@pytest.mark.parametrize("width", [1.22, 1.3, 1.4, 3.0])
def test_a_gap_that_the_drone_fits_through_is_used(width):
    south = out("south", block((-1, 1), (-90, -width / 2), (0, 70)))
    north = out("north", block((-1, 1), (width / 2, 90), (0, 70)))
    made = mission(inside("field", FIELD), south, north, targets=(), home=(-10.0, -60.0, 0.0))
    planned(made, shot([free(0, (-20, 0, 8)), free(1, (20, 0, 8))]))


def test_a_gap_too_narrow_is_named_with_its_width():
    south = out("south", block((-1, 1), (-90, -0.4), (0, 70)))
    north = out("north", block((-1, 1), (0.4, 90), (0, 70)))
    made = mission(inside("field", FIELD), south, north, targets=(), home=(-10.0, -60.0, 0.0))
    outcome = solve(made, shot([free(0, (-20, 0, 8)), free(1, (20, 0, 8))]))
    (fault,) = outcome.diagnostics
    assert fault.code == "Q001"
    assert "the gap between zone `south` and zone `north` is 0.80 m; the drone needs 1.20 m" in fault.notes
    assert "0.2" in fault.help


def across(*zones: Zone, clearance: float = 2.0):
    made = mission(*zones, targets=(), home=(-10.0, -60.0, 0.0))
    made = replace(made, rules=replace(made.rules, ground_clearance=clearance))
    return solve(made, shot([free(0, (-20, 0, 8)), free(1, (20, 0, 8))]))


def test_a_gap_under_a_ceiling_is_measured_from_the_ceiling():
    wall = out("wall", block((-1, 1), (-90, 90), (0, 59.2)))
    (fault,) = across(inside("field", FIELD), wall).diagnostics
    assert "the gap between zone `wall` and zone `field` is 0.80 m; the drone needs 1.20 m" in fault.notes
    lower = out("wall", block((-1, 1), (-90, 90), (0, 59.2 - told(fault.help, "widen the gap by"))))
    assert across(inside("field", FIELD), lower).value is not None


def test_the_ground_is_nothing_to_move_but_its_clearance_is():
    wall = out("wall", block((-1, 1), (-90, 90), (2.4, 70)))
    field = inside("field", replace(FIELD, bottom=-5.0))
    (fault,) = across(field, wall).diagnostics
    assert "the ground is 2.40 m" not in fault.help
    assert "or the ground" not in fault.help
    lower = told(fault.help, "lower rules.ground_clearance to")
    assert 0.9 < lower <= 1.2
    assert across(field, wall, clearance=lower).value is not None


def test_of_many_zones_that_close_a_way_any_one_is_enough():
    sides = [((10, 30), (8, 12)), ((10, 30), (-12, -8)), ((8, 12), (-12, 12)), ((28, 32), (-12, 12))]
    walls = [out(f"w{i}", block(x, y, (-20, 60))) for i, (x, y) in enumerate(sides)]
    (fault,) = across(*walls, out("lid", block((8, 32), (-12, 12), (20, 22)))).diagnostics
    assert "any one of zone `w0`, zone `w1`, zone `w2`, zone `w3` and zone `lid`" in fault.help


def told(text: str, before: str) -> float:
    return float(text.split(f"{before} ")[1].split(" m", maxsplit=1)[0])


@pytest.mark.parametrize(
    ("zones", "home", "words"),
    [
        ((out("beam", block((-1, 1), (-61, -59), (2, 3))),), (0, -60, 0), "in the way above"),
        ((inside("field", FIELD),), (0, -90, 0), "is not inside zone `field`"),
        ((inside("low", replace(FIELD, top=3.0)),), (0, -60, 0), "no height to fly at"),
    ],
)
def test_a_pad_that_cannot_be_left_says_why(zones, home, words):
    outcome = solve(
        mission(*zones, targets=(), home=tuple(map(float, home))),
        shot([free(0, (0, 0, 2.3)), free(1, (9, 0, 2.3))]),
    )
    assert outcome.value is None
    assert any(d.code == "Q002" and words in d.message for d in outcome.diagnostics)


def test_all_drones_faults_are_told_in_one_run():
    made = mission(targets=(), home=(0.0, -90.0, 0.0))
    made = replace(made, zones=(inside("field", FIELD), out("box", block((-5, 5), (-5, 5), (0, 70)))))
    outcome = solve(
        made,
        shot([free(0, (-20, 0, 8)), free(1, (0, 0, 8))]),
        shot([free(0, (-20, 0, 8)), free(1, (2, 0, 8))], name="s1"),
    )
    assert sorted(codes(outcome)) == ["Q002", "Q004", "Q004"]


def test_a_corridor_that_no_curve_fits_names_the_smallest_conflict():
    made = mission(out("slab", block((-50, 50), (-1, 1), (0, 70))), targets=())
    drone = made.drones[0]
    corners = np.array([[-5.0, -20.0, 8.0], [0.0, 0.0, 8.0], [5.0, 20.0, 8.0]])
    steps = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    stretch = Stretch(
        corners + np.array([[0, 0, 0], [0.1, 0, 0], [0, 0, 0]]), np.concatenate([[0.0], np.cumsum(steps)]),
        (0, 1, 2), np.zeros((0, 3)), np.zeros(0), 0.75,
    )  # fmt: skip
    room = flight_room(made, drone)
    found = solve_stretch(room, stretch, drone.limits)
    assert found.curve is None
    placed = shot([free(i, c) for i, c in enumerate(corners)])
    fault = failure(made, drone, room, placed, Stuck(found, corners, (0, 1, 2)))
    assert fault.code == "Q003"
    assert fault.notes


def test_many_cuts_of_one_shot_are_one_warning():
    made = mission(targets=(replace(TOWER, centre=(0.0, 0.0, 40.0), height=2.0),))
    high = made.targets[0]
    ring = [framed(i, (x, 12.0, 10.0), high, placed=True) for i, x in enumerate((-60, -20, 0, 20, 60))]
    outcome = solve(made, shot(ring))
    assert codes(outcome) == ["Q007"]
    assert any("stretches" in note for note in outcome.diagnostics[0].notes)


def test_the_same_input_gives_the_same_path():
    made = mission(TREE, HOUSE, inside("field", FIELD), body="forward")
    one, two = (planned(made, shot(circle(TOWER, 7, 40, 20, sweep=pi))) for _ in range(2))
    assert one.stats == two.stats
    for a, b in zip(one.drones[0].legs, two.drones[0].legs, strict=True):
        assert np.array_equal(a.curve.ctrl, b.curve.ctrl)


@pytest.mark.parametrize("scale", [1e-2, 1.0, 30.0])
def test_sizes_from_decimetres_to_kilometres_are_planned(scale):
    points = np.array([(0, 0, 0), (10, 4, 1), (18, -3, 3), (30, 0, 0)]) * scale + (30000, -20000, 20)
    made = mission(targets=(), home=(30000.0, -20010.0, 0.0))
    planned(made, shot([free(i, p) for i, p in enumerate(points)]))


@pytest.mark.parametrize("info", [c for c in CODES if c.phase == "plan"], ids=lambda c: c.slug)
def test_examples_of_codes(info):
    def found(text):
        options = PlanOptions(stop_after="solve-path-qp")
        return {d.code for d in compile_source(text.encode(), "m.yaml", None, options).diagnostics}

    assert info.code in found(info.failing)
    assert not found(info.passing)


BENDS = [(-40, -30, 10), (0, -42, 18), (40, -30, 12), (45, 10, 20)]


def test_the_path_does_not_depend_on_the_duration():
    asked = [Timing(), Timing(duration=9.0), Timing(duration=200.0)]
    curves = []
    for timing in asked:
        keyframes = [free(i, at, yaw=0.4 * i) for i, at in enumerate(BENDS)]
        (leg,) = legs(planned(mission(), shot(keyframes, timing=timing)), "shot")
        curves.append(leg.curve)
    assert all(curve.ctrl.tobytes() == curves[0].ctrl.tobytes() for curve in curves)


@pytest.mark.parametrize("count", [2, 3, 4])
def test_the_shortest_duration_named_is_met_and_a_hundredth_less_is_not(count):
    made = mission()

    def timed(duration: float):
        keyframes = [free(i, at, yaw=0.4 * i) for i, at in enumerate(BENDS[:count])]
        outcome = solve(made, shot(keyframes, timing=Timing(duration=duration)))
        return ParameterizeTime().run(outcome.value, PassContext())

    (fault,) = timed(3.0).diagnostics
    shortest = float(fault.message.split("but ")[1].split(" s")[0])
    assert timed(shortest).value is not None
    assert [d.code for d in timed(shortest - 0.011).diagnostics] == ["T001"]


def test_plan_says_once_that_an_ideal_path_is_blocked():
    text = """\
shotc: 1
mission: round-the-tree
world: {zones: {tree: {keep: out, cylinder: {center: [30, 0], radius: 3, height: [0, 30]}}}}
targets: {mast: {at: [0, 0, 6], radius: 1, height: 12}}
drones: {cam1: {model: x500, home: [0, -60, 0]}}
shots:
  - {id: round, kind: orbit, drone: cam1, target: mast, composition: center, radius: 30, altitude: 10}
"""
    found = compile_source(text.encode(), "m.yaml", None, PlanOptions()).diagnostics
    assert [d.code for d in found if d.code in {"G016", "Q006"}] == ["Q006"]
    assert [d.code for d in check_source(text.encode(), "m.yaml", None).diagnostics] == ["G016"]

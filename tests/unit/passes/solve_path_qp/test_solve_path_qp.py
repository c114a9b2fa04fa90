"""The geometry stage on missions made by hand."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.checking import check_source
from shotc.geom.solid_arrays.points import distances
from shotc.geom.solids import Cylinder, Prism
from shotc.ir.limits import Timing
from shotc.ir.path import CAM_PITCH, CAM_YAW, HoldLeg
from tests.support.path_scenes import (
    FIELD,
    TOWER,
    block,
    circle,
    codes,
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
from tests.support.records import replace

TREE = out("tree", Cylinder((-20.0, 10.0), 3.0, 0.0, 12.0))
HOUSE = out("house", block((10, 25), (-8, 6), (0, 9)))


@pytest.mark.slow
@pytest.mark.parametrize("body", ["follow-camera", "forward", "free"])
def test_a_whole_flight_is_sound_in_every_body_mode(body):
    made = mission(TREE, HOUSE, inside("field", FIELD), body=body)
    path = planned(made, shot(circle(TOWER, 7, 40, 20, sweep=pi)))
    assert [leg.phase for leg in path.drones[0].legs] == ["takeoff", "transit", "shot", "return", "land"]


@pytest.mark.slow
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


def test_a_still_camera_is_a_hold_leg():
    made = mission(targets=(TOWER,))
    path = planned(
        made, shot([framed(0, (0, -40, 12), TOWER)], timing=Timing(duration=7.0)),
        shot([framed(0, (0, -40, 12), TOWER, hold=3.0)], name="s1"),
    )  # fmt: skip
    first, second = legs(path, "shot")
    assert isinstance(first, HoldLeg)
    assert (first.duration, second.duration, second.hold) == (7.0, None, 3.0)
    assert len(legs(path, "transit")) == 1  # the second shot starts where the first one stands


@pytest.mark.slow
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


@pytest.mark.slow
def test_generated_ends_that_are_blocked_move_to_free_places():
    made = mission(out("pole", Cylinder((0.0, -40.0), 3.0, 0.0, 30.0)), targets=(TOWER,))
    path = planned(made, shot(circle(TOWER, 25, 40, 20, placed=False)))
    assert {d.cause for d in path.deviations} == {"zone pole"}


@pytest.mark.slow
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


def test_the_transit_altitude_obeys_ground_and_floors():
    made = mission(inside("high", replace(FIELD, bottom=7.0)), targets=())
    path = planned(made, shot([free(0, (0, 0, 20)), free(1, (10, 0, 20))]))
    takeoff = legs(path, "takeoff")[0]
    end = takeoff.curve(takeoff.curve.end)
    assert end[:2] == pytest.approx((0, -60))
    assert 7.6 < end[2] < 7.8


@pytest.mark.slow
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
    (leg,) = legs(planned(made, shot([free(i, p) for i, p in enumerate(points)])), "shot")
    passed = leg.curve(np.array([mark.s for mark in leg.marks]))[:, :3]
    assert np.abs(passed - points).max() < 1e-6 * max(1.0, scale)


@pytest.mark.slow
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

"""The camera and the body along a path: compositions, zooms, pans, hand-overs and body modes."""

from __future__ import annotations

from math import hypot, pi, radians

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.geom.bernstein import Piecewise
from shotc.geom.camera import view
from shotc.geom.shapes import CylinderShape
from shotc.ir.drone import Gimbal
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW
from shotc.ir.target import Target
from shotc.planning.path.body import BodyTask, body_line
from shotc.solvers.conic import Status
from tests.support.film_plans import orbit_mission
from tests.support.path_scenes import (
    ASPECT,
    FIELD,
    TOWER,
    circle,
    codes,
    framed,
    free,
    inside,
    legs,
    mission,
    planned,
    shot,
    solve,
)
from tests.support.records import replace


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
    other = Target("shed", (40.0, 0.0, 3.0), CylinderShape(2.0, 6.0), ("targets", "shed"))
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


@pytest.mark.parametrize("body", ["follow-camera", "forward", "free"])
@pytest.mark.parametrize("size", [0.01, 0.04, 0.2, 5000.0])
def test_backing_away_by_any_length_is_planned_in_every_body_mode(size, body):
    # Flown backwards, so that the gimbal's end binds the body.
    spots = [30 + share * size for share in (0, 1 / 3, 2 / 3, 1)]
    keyframes = [framed(i, (0.8 * x, 0.6 * x, 12), TOWER) for i, x in enumerate(spots)]
    (leg,) = legs(planned(mission(body=body), shot(keyframes)), "shot")
    assert leg.curve.end == pytest.approx(size, rel=1e-3)
    assert leg.curve(leg.curve.end)[:3] == pytest.approx(keyframes[-1].at, abs=1e-6)


def test_many_cuts_of_one_shot_are_one_warning():
    made = mission(targets=(replace(TOWER, centre=(0.0, 0.0, 40.0), shape=CylinderShape(4.0, 2.0)),))
    high = made.targets[0]
    ring = [framed(i, (x, 12.0, 10.0), high, placed=True) for i, x in enumerate((-60, -20, 0, 20, 60))]
    outcome = solve(made, shot(ring))
    assert codes(outcome) == ["Q007"]
    assert any("stretches" in note for note in outcome.diagnostics[0].notes)


def test_a_body_does_not_point_along_half_a_millimetre() -> None:
    """An upright flight has no course, however a refiner ripples it."""
    drone = replace(orbit_mission().drones[0], body="forward")
    breaks = np.linspace(0.0, 20.0, 11)
    points = np.repeat(np.linspace(0.0, 20.0, 51)[:, None], 3, axis=1) * np.array([0.0, 0.0, 1.0])
    ctrl = np.stack([points[5 * i : 5 * i + 6] for i in range(10)])
    ctrl[:, 2:4, 0] += 5e-4 * (-1.0) ** np.arange(10)[:, None]
    task = BodyTask(Piecewise(breaks, ctrl), Piecewise(breaks, np.full((10, 6, 1), 0.7)), 0.7, 0.7, 2.0)
    status, body = body_line(drone, task)
    assert status is Status.SOLVED
    assert np.abs(body.ctrl - 0.7).max() < 1e-3


PUSHED = """\
shotc: 1
mission: pushed
world:
  zones:
    church: {keep: out, box: {center: [-75, -5, 17], size: [95, 45, 34]}}
    court: {keep: in, polygon: {points: [[-150, -130], [150, -130], [150, 130]], height: [2, 110]}}
targets: {tower: {at: [0, 0, 27.93], radius: 11.642, height: 55.86}}
drones: {cam: {model: x500, home: [90, 70, 0], camera: {hfov: 84 deg}}}
rules: {composition: center, target_clearance: 5}
shots:
  - {id: climb, kind: spiral, drone: cam, target: tower, radius: [85, 70], altitude: [12, 62],
     start_azimuth: 60 deg, sweep: 130 deg}
"""


@pytest.mark.slow
def test_keyframes_that_a_wall_pushes_together_do_not_spin_the_camera():
    """Half of the spiral lies behind a wall, where all its keyframes are nearest to the path's end."""
    options = PlanOptions(refiner="none", stop_after="solve-path-qp")
    done = compile_source(PUSHED.encode(), "pushed.yaml", None, options)
    (path,) = (report.output for report in done.reports if report.name == "solve-path-qp")
    (leg,) = legs(path, "shot")
    turns = np.diff(leg.curve(np.linspace(0, leg.curve.end, 2000))[:, [CAM_YAW, CAM_PITCH]], axis=0)
    assert np.abs(turns).sum(axis=0) == pytest.approx([pi, 0.5 * pi], abs=0.5 * pi)
    assert np.abs(turns).max() < 0.02

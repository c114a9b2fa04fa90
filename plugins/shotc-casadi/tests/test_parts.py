"""The parts around the solver: nodes, half-spaces, wishes, lines of sight, the spline and its proof."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import atan2, cos, hypot, pi, radians, sin, tan

import numpy as np
import pytest
from shotc_casadi.camera import NoFit, camera
from shotc_casadi.conditions import ANG, LOOK_AT, OURS, OURS_4PT
from shotc_casadi.problem import Margins
from shotc_casadi.proof import Check, checked, hopeless, tighter
from shotc_casadi.sight import sight_point
from shotc_casadi.stages import MOST, STAGES, stages
from shotc_casadi.symbols import FIELDS, PITCH, TIME, YAW
from shotc_casadi.walls import COUNTS, FREE, half_spaces
from shotc_casadi.wishes import own_angles, wishes

from shotc.geom.bernstein import Piecewise
from shotc.geom.camera import aim_at, frustum_margins, view
from shotc.geom.convex import support
from shotc.geom.solids import Cylinder
from shotc.ir.mission import Target, Timing
from shotc.ir.path import CAM_PITCH, CAM_YAW
from tests.path_scenes import ASPECT, HFOV, TOWER, block, circle, framed, free, mission, out, shot
from tests.records import replace as changed
from tests.refiner_scenes import subject, task

MAST = Target("mast", (30.0, 30.0, 5.0), 1.0, 10.0, ("targets", "mast"))


@cache
def arc():
    return subject(mission(targets=(TOWER,)), shot(circle(TOWER, 4, 45.0, 20.0, sweep=1.5)))


@cache
def walled():
    zones = (
        out("wall", block((28.0, 34.0), (-50.0, -38.0), (0.0, 40.0))),
        out("tank", Cylinder((45.0, -32.0), 3.0, 0.0, 30.0)),
    )
    return subject(mission(*zones, targets=(TOWER,)), shot(circle(TOWER, 4, 45.0, 20.0, sweep=1.5)))


def nodes_of(of, count=24):
    return stages(of.leg, of.placed, of.drone, count)


# nodes


def test_every_keyframe_and_stop_is_a_node_and_time_runs_on():
    held = circle(TOWER, 5, 45.0, 20.0, sweep=2.0)
    held[2] = changed(held[2], hold=2.0)
    of = subject(mission(targets=(TOWER,)), shot(held))
    nodes = nodes_of(of)
    assert len(nodes.s) == 25
    assert (np.diff(nodes.s) > 0).all()
    assert (np.diff(nodes.t) > 0).all()
    assert nodes.s[[0, -1]].tolist() == [of.leg.curve.start, of.leg.curve.end]
    for s in [m.s for m in of.leg.marks] + [stop.s for stop in of.leg.stops]:
        assert np.abs(nodes.s - s).min() == 0.0
    assert nodes.s[nodes.pins].tolist() == sorted({m.s for m in of.leg.marks})
    assert (np.diff(nodes.pins) >= 2).all()


def test_places_that_a_kind_generated_bind_only_at_rest():
    of = subject(mission(targets=(TOWER,)), shot(circle(TOWER, 5, 45.0, 20.0, sweep=2.0, placed=False)))
    nodes = nodes_of(of)
    assert nodes.pins.tolist() == [0, 24]


def test_nodes_are_even_in_time_between_keyframes():
    nodes = nodes_of(arc())
    for a, b in zip(nodes.pins[:-1], nodes.pins[1:], strict=True):
        steps = np.diff(nodes.t[a : b + 1])
        assert steps == pytest.approx(np.full(b - a, steps.mean()), rel=1e-9)


def test_many_keyframes_get_more_stages():
    assert len(nodes_of(arc(), None).s) == STAGES + 1
    many = subject(mission(targets=(TOWER,)), shot(circle(TOWER, 13, 45.0, 20.0, sweep=2.0)))
    assert STAGES < len(nodes_of(many, None).s) - 1 <= MOST


def test_a_duration_stretches_the_guess_to_it_less_the_holds():
    held = circle(TOWER, 5, 45.0, 20.0, sweep=2.0)
    held[2] = changed(held[2], hold=2.0)
    of = subject(mission(targets=(TOWER,)), shot(held, timing=Timing(duration=40.0)))
    assert nodes_of(of).t[-1] == pytest.approx(38.0)


# half-spaces


def test_every_half_space_holds_at_its_node_and_parts_it_from_something():
    of, nodes = walled(), nodes_of(walled(), 60)
    planes = half_spaces(of.room, of.leg.curve, nodes)
    assert planes.shape[1] in COUNTS[1:]
    p = of.leg.curve(nodes.s)[:, :3]
    real = np.linalg.norm(planes[:, :, :3], axis=2) > 0
    assert real.any(axis=1).sum() > 10
    assert np.linalg.norm(planes[real][:, :3], axis=1) == pytest.approx(1.0)
    slack = np.einsum("kmd,kd->km", planes[:, :, :3], p) - planes[:, :, 3]
    assert slack.min() >= 0.0
    assert (slack[~real] == -FREE).all()
    for k, row in zip(*np.nonzero(real), strict=True):
        n, b = planes[k, row, :3], planes[k, row, 3]
        beyond = [b - float(support(o.part, n[None])[0]) - o.clearance for o in of.room.obstacles]
        walls = [b - w.offset for w in of.room.walls if np.allclose(n, w.normal)]
        # One obstacle with its clearance lies wholly beyond the plane.
        assert max(beyond + walls) >= -1e-6


def test_points_of_an_obstacle_break_the_planes_near_it():
    of, nodes = walled(), nodes_of(walled(), 60)
    planes = half_spaces(of.room, of.leg.curve, nodes)
    p = of.leg.curve(nodes.s)[:, :3]
    k = int(np.linalg.norm(p[:, :2] - [31.0, -40.0], axis=1).argmin())
    inside = np.array([[x, y, z] for x in (28, 31, 34) for y in (-50, -44, -38) for z in (1.0, 20.0, 39.0)])
    slack = inside @ planes[k, :, :3].T - planes[k, :, 3]
    assert slack.min(axis=1).max() <= 0.0


def test_where_nothing_stands_there_is_no_half_space():
    of = subject(
        changed(mission(targets=()), rules=changed(mission().rules, ground_clearance=0.0)),
        shot([free(0, (0, -50, 40)), free(1, (40, -50, 40)), free(2, (60, -20, 40))]),
    )
    assert half_spaces(of.room, of.leg.curve, nodes_of(of)).shape == (25, 0, 4)


# wishes


def test_the_place_asked_is_that_of_the_leg():
    keys = [
        framed(i, (45 * cos(a), 45 * sin(a), 20.0), TOWER, uv=uv)
        for i, (a, uv) in enumerate([(-1.5, (0, 0)), (-0.9, (-1 / 3, 1 / 3)), (-0.2, (1 / 3, 0))])
    ]
    of = subject(mission(targets=(TOWER,)), shot(keys))
    (span,) = of.leg.framing
    s = np.linspace(of.leg.curve.start, of.leg.curve.end, 57)
    wanted = wishes(of, OURS, s)
    assert wanted.place == pytest.approx(span.reference(s), abs=1e-9)
    assert (wanted.framed == 1).all()
    assert (wanted.whole == 1).all()
    assert wanted.centre == pytest.approx(np.tile(TOWER.centre, (57, 1)))
    assert set(wanted.radius) == {TOWER.radius}
    assert wishes(of, OURS_4PT, s).place == pytest.approx(wanted.place)


def test_between_two_targets_one_becomes_the_other():
    keys = [framed(0, (-30, -40, 20), TOWER), framed(1, (10, -40, 15), TOWER), framed(2, (50, -10, 10), MAST)]
    of = subject(mission(targets=(TOWER, MAST)), shot(keys))
    first, middle, last = (m.s for m in of.leg.marks)
    s = np.linspace(middle, last, 41)
    wanted = wishes(of, OURS, s)
    share = (wanted.centre - TOWER.centre)[:, 0] / (MAST.centre[0] - TOWER.centre[0])
    assert share[[0, -1]] == pytest.approx([0, 1], abs=1e-12)
    assert (np.diff(share) >= 0).all()
    assert share[20] == pytest.approx(0.5)
    assert wanted.radius == pytest.approx((1 - share) * TOWER.radius + share * MAST.radius)
    assert wanted.height == pytest.approx((1 - share) * TOWER.height + share * MAST.height)
    before = wishes(of, OURS, np.linspace(first, middle, 11)[:-1])
    assert before.centre == pytest.approx(np.tile(TOWER.centre, (10, 1)))


def test_what_frames_nothing_keeps_the_angles_of_the_convex_path():
    keys = [framed(0, (-30, -40, 20), TOWER), framed(1, (0, -40, 20), TOWER), free(2, (40, -40, 20), yaw=1.0)]
    of = subject(mission(targets=(TOWER,)), shot(keys))
    middle = of.leg.marks[1].s
    s = np.linspace(of.leg.curve.start, of.leg.curve.end, 60)
    wanted = wishes(of, OURS, s)
    assert ((wanted.framed == 1) == (s < middle)).all()
    assert (wanted.whole == wanted.framed).all()
    assert wanted.aim == pytest.approx(of.leg.curve(s)[:, [CAM_YAW, CAM_PITCH]])


@pytest.mark.parametrize("condition", [ANG, LOOK_AT], ids=lambda c: c.name)
def test_the_papers_conditions_pass_through_the_authors_own_angles(condition):
    """Composition turned the camera; ANG and LOOK-AT know nothing of it."""
    keys = [
        changed(framed(i, (45 * cos(a), 45 * sin(a), 20.0), TOWER), asked=(0.2, -0.15))
        for i, a in enumerate((-1.5, -0.9, -0.2))
    ]
    of = subject(mission(targets=(TOWER,)), shot(keys))
    s = np.array([m.s for m in of.leg.marks])
    wanted = wishes(of, condition, s)
    for k, key in enumerate(keys):
        d = tuple(c - p for c, p in zip(TOWER.centre, key.at, strict=True))
        yaw, pitch = aim_at(d, (0.2, -0.15), HFOV, ASPECT)
        assert own_angles(of, key) == pytest.approx((yaw, pitch))
        assert np.exp(1j * wanted.aim[k, 0]) == pytest.approx(np.exp(1j * yaw), abs=1e-6)
        assert wanted.aim[k, 1] == pytest.approx(pitch, abs=1e-6)
    dense = wishes(of, condition, np.linspace(s[0], s[-1], 200)).aim
    assert np.abs(np.diff(dense, axis=0)).max() < 0.1  # no whole turns
    assert (wanted.whole == 0).all()


# lines of sight


def seen(of, at, yaw, pitch, target=None):
    key = changed(free(0, at, yaw=yaw, pitch=pitch), target=target)
    return sight_point(of, key, (yaw, pitch))


def test_a_ray_that_falls_meets_the_ground():
    of = subject(mission(targets=()), shot([free(0, (0, -50, 40)), free(1, (40, -50, 40))]))
    point = seen(of, (3.0, 4.0, 10.0), 0.0, radians(-30))
    assert point == pytest.approx([3 + 10 / tan(radians(30)), 4.0, 0.0], abs=1e-6)


def test_a_ray_meets_the_wall_of_a_cylinder_and_its_lid():
    of = arc()
    assert seen(of, (-40.0, 0.0, 12.0), 0.0, 0.0) == pytest.approx([-4.0, 0, 12], abs=2e-3)
    # Off its axis: the chord begins at -sqrt(r^2 - y^2).
    assert seen(of, (-40.0, 2.0, 12.0), 0.0, 0.0) == pytest.approx([-(12**0.5), 2, 12], abs=5e-3)
    down = seen(of, (-2.0, 0.0, 40.0), 0.0, radians(-89))
    assert down[2] == pytest.approx(24.0, abs=2e-3)


def test_the_nearest_of_what_a_ray_meets_counts():
    of = walled()
    point = seen(of, (20.0, -44.0, 10.0), 0.0, 0.0)
    assert point == pytest.approx([28.0, -44.0, 10.0], abs=2e-3)


def test_a_ray_that_meets_nothing_ends_as_far_as_the_target():
    of = arc()
    point = seen(of, (-40.0, 0.0, 12.0), pi, radians(20), "tower")
    assert np.linalg.norm(point - [-40, 0, 12]) == pytest.approx(40.0)
    assert seen(of, (-40.0, 0.0, 12.0), pi, radians(20))[0] == pytest.approx(-40 - 50 * cos(radians(20)))


# the spline through the nodes


def moved(of, nodes, *, by=0.3, pitch=0.0):
    """The convex path, lifted between its ends and with another pitch."""
    x = (nodes.s - nodes.s[0]) / (nodes.s[-1] - nodes.s[0])
    q = of.leg.curve(nodes.s)
    states = np.zeros((len(nodes.s), 16))
    states[:, :3], states[:, YAW], states[:, PITCH] = q[:, :3], q[:, CAM_YAW], q[:, CAM_PITCH]
    bump = np.sin(pi * x) ** 2
    states[:, 2] += by * bump
    states[:, PITCH] += pitch * bump
    states[:, YAW] += 0.05 * bump
    return states


@pytest.mark.parametrize("make", [arc, walled])
def test_the_camera_is_smooth_and_exact_where_it_binds(make):
    of, nodes = make(), nodes_of(make(), 100)
    states = moved(of, nodes)
    ends = states[[0, -1]][:, [YAW, PITCH]]
    found = camera(of.drone, of.leg, nodes, states, ends)
    bound = nodes.s[nodes.pins]
    assert found(bound)[:, :3] == pytest.approx(of.leg.curve(bound)[:, :3], abs=1e-9)
    assert found(np.array([found.start, found.end]))[:, 3:] == pytest.approx(ends, abs=1e-9)
    free_nodes = np.setdiff1d(np.arange(101), nodes.pins)
    off = found(nodes.s)[free_nodes] - states[free_nodes][:, [0, 1, 2, YAW, PITCH]]
    inner = np.abs(nodes.s[free_nodes][:, None] - bound).min(axis=1) > 4.0
    assert np.abs(off[inner, 3:]).max() < 1e-4
    assert np.abs(off[inner, :2]).max() < 1e-3
    for order in (0, 1, 2):
        d = found.derivative(order) if order else found
        jump = np.abs(d.ctrl[1:, 0] - d.ctrl[:-1, -1]).max()
        assert jump <= 1e-7 * (1 + np.abs(d.ctrl).max())
    assert set(of.leg.curve.breaks) <= set(found.breaks)


def test_the_camera_keeps_the_gimbals_pitch():
    of, nodes = arc(), nodes_of(arc(), 100)
    states = moved(of, nodes, pitch=0.4)
    low = float(of.leg.curve.ctrl[:, :, CAM_PITCH].min())
    top = float(of.leg.curve.ctrl[:, :, CAM_PITCH].max()) + 0.1
    drone = changed(of.drone, gimbal=changed(of.drone.gimbal, pitch=(low, top)))
    found = camera(drone, of.leg, nodes, states, states[[0, -1]][:, [YAW, PITCH]])
    assert found.ctrl[:, :, 4].max() <= top
    assert found.ctrl[:, :, 4].min() >= low
    assert found.ctrl[:, :, 4].max() == pytest.approx(top, abs=1e-3)


def test_ends_that_the_gimbal_does_not_reach_are_no_camera():
    of, nodes = arc(), nodes_of(arc(), 100)
    states = moved(of, nodes)
    drone = changed(of.drone, gimbal=changed(of.drone.gimbal, pitch=(-0.05, 0.0)))
    with pytest.raises(NoFit):
        camera(drone, of.leg, nodes, states, states[[0, -1]][:, [YAW, PITCH]])


# the proof


def convex(of):
    return of.leg.curve.channels(0, 1, 2, CAM_YAW, CAM_PITCH)


def test_the_convex_path_is_clear_and_in_time():
    check = checked(walled(), OURS, convex(walled()))
    assert (check.lack, check.late) == (0.0, 0.0)


def test_a_camera_through_a_wall_lacks_what_it_is_inside():
    of = walled()
    ctrl = convex(of).ctrl.copy()
    ctrl[:, :, :3] = [31.0, -44.0, 20.0]
    check = checked(of, OURS, Piecewise(of.leg.curve.breaks, ctrl))
    # Three metres deep, and the body's radius.
    assert check.lack == pytest.approx(3.0 + of.room.obstacles[0].clearance, abs=1e-6)


def test_a_target_that_sticks_out_between_nodes_is_found():
    of = arc()
    turned = convex(of).ctrl.copy()
    turned[:, :, 3] += 0.55
    found = Piecewise(of.leg.curve.breaks, turned)
    check = checked(of, OURS, found)
    s = np.linspace(found.start, found.end, 3000)
    worst = 0.0
    for x, y, z, yaw, pitch in found(s):
        d = (-x, -y, 12.0 - z)
        inside = frustum_margins(view(yaw, pitch, HFOV, ASPECT), d, TOWER.radius, TOWER.height)
        worst = max(worst, -min(inside) / hypot(*d))
    assert worst > 0.01
    assert check.cropped == pytest.approx(worst, rel=0.02)
    assert checked(of, OURS_4PT, found).cropped == 0.0  # the paper's four points are no promise


def test_a_duration_that_the_fastest_flight_misses_is_late():
    of = arc()
    quick = of._replace(leg=replace(of.leg, duration=9.0))
    check = checked(quick, OURS, convex(of))
    ample = of._replace(leg=replace(of.leg, duration=60.0))
    assert check.late > 0.05
    assert checked(ample, OURS, convex(of)).late == 0.0
    needed = 9.0 * (1 + check.late)
    just = of._replace(leg=replace(of.leg, duration=needed * 1.001))
    assert checked(just, OURS, convex(of)).late == 0.0
    assert not hopeless(ample)
    assert hopeless(of._replace(leg=replace(of.leg, duration=0.5)))
    assert not hopeless(of)


def test_margins_make_up_for_what_was_open():
    margins = tighter(Margins(), Check(0.1, 0.05, 0.01), hold=True)
    assert margins.room > 0.1
    assert margins.limits < 1 / 1.05
    assert margins.frame < Margins().frame - 0.01
    assert margins.hold > 1.0
    assert tighter(Margins(), Check(0.0, 0.0, 0.0), hold=True) == Margins()
    assert Check(0, 0, 0).holds
    assert not Check(0, 1e-9, 0).holds
    assert Check(0.5, 0, 0).helped(Check(1.0, 0, 0))
    assert not Check(0.95, 0, 0).helped(Check(1.0, 0, 0))


# the whole problem


def test_the_first_guess_is_at_rest_at_its_ends_and_on_the_path():
    made = task(arc())
    assert np.abs(made.states[[0, -1]][:, 3:9]).max() < 1e-9
    nodes = nodes_of(arc())
    assert made.states[:, :3] == pytest.approx(arc().leg.curve(nodes.s)[:, :3])
    assert made.states[:, TIME] == pytest.approx(nodes.t)
    assert np.isfinite(made.parameters).all()


def test_margins_narrow_the_frame_the_limits_and_the_room():
    plain, tight = task(walled()), task(walled(), margins=Margins(frame=0.9, room=0.2, limits=0.8, hold=5.0))
    at = dict(zip(FIELDS, np.cumsum([0, *FIELDS.values()]), strict=False))
    assert set(tight.parameters[:, at["frame"]]) == {0.9}
    assert tight.held[1][:2] == pytest.approx(plain.held[1][:2] * 0.8**2)
    assert tight.driven[1] == pytest.approx(plain.driven[1] * 0.8**2)
    assert tight.state_bounds[1][:, 5] == pytest.approx(plain.state_bounds[1][:, 5] * 0.8)
    assert (tight.state_bounds[1][:, PITCH] == plain.state_bounds[1][:, PITCH]).all()
    first = sum(FIELDS.values())
    moved_by = tight.parameters[:, first:].reshape(25, -1, 4) - plain.parameters[:, first:].reshape(25, -1, 4)
    real = np.linalg.norm(plain.parameters[:, first:].reshape(25, -1, 4)[:, :, :3], axis=2) > 0
    assert moved_by[real][:, 3] == pytest.approx(0.2)
    assert (moved_by[~real] == 0).all()


def test_a_camera_fixed_to_the_body_turns_no_faster_than_the_body():
    made = task(arc())
    limits, gimbal = arc().drone.limits, arc().drone.gimbal
    assert arc().drone.body == "follow-camera"
    assert made.state_bounds[1][0, YAW + 1] == pytest.approx(arc().leg.pace * limits.yaw_rate)
    loose = subject(mission(targets=(TOWER,), body="free"), shot(circle(TOWER, 4, 45.0, 20.0, sweep=1.5)))
    assert task(loose).state_bounds[1][0, YAW + 1] == pytest.approx(
        loose.leg.pace * (limits.yaw_rate + gimbal.rate)
    )


def test_the_aim_of_look_at_points_from_the_path_to_what_is_looked_at():
    s = nodes_of(arc()).s
    wanted = wishes(arc(), LOOK_AT, s)
    d = wanted.centre - arc().leg.curve(s)[:, :3]
    for k in range(len(s)):
        assert sin(wanted.aim[k, 0] - atan2(d[k, 1], d[k, 0])) == pytest.approx(0.0, abs=1e-9)

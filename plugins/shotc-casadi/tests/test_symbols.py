"""One stage: exact dynamics, a framing cost that is zero on the composition, an exact silhouette."""

from __future__ import annotations

from functools import cache
from math import cos, hypot, pi, radians, sin, tan

import casadi as ca
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.polynomial import Polynomial
from shotc_casadi.symbols import (
    ACCELERATION,
    FIELDS,
    INPUTS,
    LENGTH,
    PITCH,
    PITCH_ACCELERATION,
    PITCH_JERK,
    PITCH_RATE,
    POSITION,
    STATES,
    TIME,
    VELOCITY,
    YAW,
    YAW_ACCELERATION,
    YAW_JERK,
    YAW_RATE,
    size,
    stage,
)

from shotc.geom.camera import View, aim_at, frustum_margins, view
from shotc.geom.shapes import CylinderShape

ANGLE = st.floats(-pi, pi)
PITCHES = st.floats(radians(-85), radians(40))
COORDINATE = st.floats(-80, 80)
HFOV = st.floats(radians(25), radians(110))
ASPECT = 16 / 9


@cache
def function(visibility="none", planes=0):
    s = stage(visibility, planes)
    return ca.Function("stage", [s.z, s.p], [s.following, s.node, s.passing, s.held, s.driven])


def row(planes=(), **fields):
    """The parameters of a stage: zero (and a target far ahead) but for the given ones."""
    values = {name: np.zeros(width) for name, width in FIELDS.items()}
    values |= {"centre": np.array([100.0, 0.0, 0.0]), "half_width": 1.0, "half_height": 1.0}
    values |= fields
    flat = [np.broadcast_to(np.asarray(values[n], float), (FIELDS[n],)) for n in FIELDS]
    return np.concatenate([*flat, np.ravel(planes)])


def pose(yaw=0.0, pitch=0.0, **more):
    z = np.zeros(STATES + INPUTS)
    z[YAW], z[PITCH] = yaw, pitch
    for name, value in more.items():
        z[globals()[name.upper()]] = value
    return z


def node(z, form="none", /, **fields):
    return float(function(form)(z, row(**fields))[1])


@pytest.mark.slow
@given(st.lists(st.floats(-10, 10), min_size=STATES + INPUTS, max_size=STATES + INPUTS), st.floats(1e-3, 20))
def test_the_next_state_is_the_integral_of_constant_jerk(z, length):
    z = np.array(z)
    z[STATES + LENGTH] = length
    following = np.array(function()(z, row())[0]).ravel()
    chains = [(p, 3 + p, 6 + p, STATES + p) for p in range(3)] + [
        (YAW, YAW_RATE, YAW_ACCELERATION, STATES + YAW_JERK),
        (PITCH, PITCH_RATE, PITCH_ACCELERATION, STATES + PITCH_JERK),
    ]
    for q, v, a, j in chains:
        acceleration = Polynomial([z[j]]).integ(k=z[a])
        rate = acceleration.integ(k=z[v])
        place = rate.integ(k=z[q])
        scale = 1 + abs(z[[q, v, a, j]]).max() * max(1.0, length) ** 3
        assert following[[q, v, a]] == pytest.approx(
            [place(length), rate(length), acceleration(length)], abs=1e-13 * scale
        )
    assert following[TIME] == pytest.approx(z[TIME] + length)


@pytest.mark.slow
@given(
    st.tuples(COORDINATE, COORDINATE, COORDINATE),
    st.tuples(st.floats(-0.9, 0.9), st.floats(-0.9, 0.9)),
    HFOV,
    st.tuples(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3)),
)
def test_framing_costs_nothing_exactly_where_the_target_is_at_its_place(offset, uv, hfov, off):
    assume(hypot(offset[0], offset[1]) > 1.0)
    aim = aim_at(offset, uv, hfov, ASPECT)
    assume(aim is not None)
    half = tan(hfov / 2)
    references = {
        "centre": offset,
        "place": uv,
        "half_width": half,
        "half_height": half / ASPECT,
        "framing": 1.0,
    }
    assert node(pose(*aim), **references) == pytest.approx(0.0, abs=1e-12)

    yaw, pitch = aim[0] + off[0], aim[1] + off[1]
    u, v, depth = view(yaw, pitch, hfov, ASPECT).project(offset)
    assume(depth > 1e-3)
    rays = [np.array([a * half, b * half / ASPECT, 1.0]) for a, b in (uv, (u, v))]
    one, two = (r / np.linalg.norm(r) for r in rays)
    cost = node(pose(yaw, pitch), **references)
    in_half_frames = (one - two) / [half, half / ASPECT, half]
    assert cost == pytest.approx(float(np.sum(in_half_frames**2)), rel=1e-9, abs=1e-9)
    assert (cost > 1e-12) == (np.linalg.norm(in_half_frames) > 1e-6)


@given(ANGLE, PITCHES, st.tuples(ANGLE, PITCHES))
def test_aiming_is_the_squared_angle_to_the_aim(yaw, pitch, aim):
    cost = node(pose(yaw, pitch), aim=aim, aiming=1.0)
    assert cost == pytest.approx(cos(aim[1]) ** 2 * (yaw - aim[0]) ** 2 + (pitch - aim[1]) ** 2)


def scene(look, hfov, asked, offset, cylinder):
    """The hinge of a stage; the exact margins in half frames; what smoothing may take from each of them."""
    (yaw, pitch), (radius, height), half = look, cylinder, tan(hfov / 2)
    fields = {
        "centre": offset,
        "radius": radius,
        "height": height,
        "half_width": half,
        "half_height": half / ASPECT,
        "inside": asked,
        "visibility": 1.0,
    }
    seen = View(cos(yaw), sin(yaw), cos(pitch), sin(pitch), half, half / ASPECT)
    half_frames = [h / hypot(1, h) * hypot(*offset) for h in (half, half, half / ASPECT, half / ASPECT)]
    margins = np.array(frustum_margins(seen, offset, CylinderShape(radius, height))) / half_frames
    return fields, seen, margins, (1e-4 * height / 2 + 1e-3 * radius) / np.array(half_frames)


CYLINDERS = st.tuples(st.floats(0.1, 20), st.floats(0.1, 60))
ASKED = st.tuples(*[st.sampled_from([-0.1, 0.0, 0.03, 0.3])] * 4)


@pytest.mark.slow
@given(
    st.tuples(ANGLE, PITCHES),
    HFOV,
    ASKED,
    st.tuples(st.floats(5, 150), st.floats(-1.2, 1.2), st.floats(-1.0, 1.0)),
    CYLINDERS,
)
def test_the_hinge_is_zero_exactly_where_the_whole_cylinder_is_as_far_inside_as_asked(
    look, hfov, asked, where, cylinder
):
    away, aside, above = where
    yaw, pitch = look
    offset = (
        away * cos(yaw + aside) * cos(pitch + above),
        away * sin(yaw + aside) * cos(pitch + above),
        away * sin(pitch + above),
    )
    fields, _, margins, smoothing = scene(look, hfov, asked, offset, cylinder)
    hinge = node(pose(yaw, pitch), "silhouette", **fields)
    lacks = np.array(asked) - margins
    least, most = (float(np.sum(np.maximum(0.0, lacks + s) ** 2)) for s in (0.0, smoothing))
    assert (1 - 1e-9) * least - 1e-9 <= hinge <= (1 + 1e-9) * most + 1e-9
    if (lacks < -smoothing - 1e-9).all():
        assert hinge == 0.0
    if (lacks > 1e-9).any():
        assert hinge > 0.0


def cloud(offset, radius, height):
    """The two rims of a cylinder: its hull is the cylinder; (N, 3)."""
    a = np.linspace(0, 2 * pi, 1440, endpoint=False)
    rim = np.column_stack([radius * np.cos(a), radius * np.sin(a), np.zeros_like(a)])
    return np.concatenate([np.array(offset) + rim + [0, 0, end * height / 2] for end in (-1, 1)])


@pytest.mark.slow
@given(st.tuples(ANGLE, PITCHES), HFOV, st.tuples(st.floats(10, 150), st.floats(-0.6, 0.6)), CYLINDERS)
def test_the_hinge_agrees_with_a_cloud_of_points(look, hfov, where, cylinder):
    yaw, pitch = look
    away, aside = where
    offset = (away * cos(yaw + aside), away * sin(yaw + aside), away * tan(max(-1.2, min(pitch, 1.2))))
    fields, seen, *_ = scene(look, hfov, 0.0, offset, cylinder)
    smoothing = 1e-4 * cylinder[1] / 2 + 1e-3 * cylinder[0]
    hinge = node(pose(yaw, pitch), "silhouette", **fields)
    right, down, forward = seen.to_camera(tuple(cloud(offset, *cylinder).T))
    inside = np.stack(
        [
            (seen.half_width * forward + right) / hypot(1, seen.half_width),
            (seen.half_width * forward - right) / hypot(1, seen.half_width),
            (seen.half_height * forward + down) / hypot(1, seen.half_height),
            (seen.half_height * forward - down) / hypot(1, seen.half_height),
        ]
    )
    between = cylinder[0] * (1 - cos(pi / 1440))
    if inside.min() > smoothing + between + 1e-9:
        assert hinge == 0.0
    if inside.min() < -1e-9:
        assert hinge > 0.0


def four_points(p, radius, height, wide, tall):
    """Eq. 4-11 of Gebhardt and Hilliges in the view space x forward, y left, z up; normals of length 1.

    A distance from a plane counts in half frames a metre away.
    """
    x, y, z = p
    root = (radius**2 / (y**2 / x**2 + 1)) ** 0.5
    sides = [(x + (y**2 - y * side) / x, side, z) for side in (y + root, y - root)]
    points = np.array([(x, y, z + height / 2), (x, y, z - height / 2), *sides])
    tl, tr, bl, br = ((1.0, wide * a, tall * b) for a, b in ((1, 1), (-1, 1), (1, -1), (-1, -1)))
    pairs = [(np.cross(tl, tr), np.cross(bl, br)), (np.cross(tl, bl), np.cross(tr, br))]
    total = 0.0
    for (one, two), half in zip(pairs, (tall, wide), strict=True):
        unit = half / hypot(1, half)
        for point in points:
            d1, d2 = point @ one / np.linalg.norm(one), point @ two / np.linalg.norm(two)
            total += 0.0 if abs(d1 + d2) < abs(d1) + abs(d2) else min(d1**2, d2**2) / unit**2
    return total


@pytest.mark.slow
@given(
    ANGLE,
    st.tuples(st.floats(25, 120), st.floats(-20, 20), st.floats(-20, 20)),
    CYLINDERS,
    HFOV,
)
def test_at_no_pitch_the_four_points_are_those_of_the_paper(yaw, p, cylinder, hfov):
    half = tan(hfov / 2)
    ahead, left = np.array([cos(yaw), sin(yaw), 0.0]), np.array([-sin(yaw), cos(yaw), 0.0])
    offset = p[0] * ahead + p[1] * left + np.array([0.0, 0.0, p[2]])
    fields, *_ = scene((yaw, 0.0), hfov, 0.0, tuple(offset), cylinder)
    ours = node(pose(yaw), "points", **fields) * float(offset @ offset)
    theirs = four_points(p, *cylinder, half, half / ASPECT)
    assert ours == pytest.approx(theirs, rel=1e-6, abs=1e-9)


@pytest.mark.slow
@given(
    st.tuples(ANGLE, PITCHES),
    HFOV,
    st.tuples(st.floats(10, 150), st.floats(-0.6, 0.6), st.floats(-0.6, 0.6)),
    CYLINDERS,
)
def test_four_points_never_ask_for_more_than_the_silhouette(look, hfov, where, cylinder):
    (yaw, pitch), (away, aside, above) = look, where
    rise = max(-1.3, min(1.3, pitch + above))
    offset = (
        away * cos(yaw + aside) * cos(rise),
        away * sin(yaw + aside) * cos(rise),
        away * sin(rise),
    )
    fields, _, margins, _ = scene(look, hfov, 0.0, offset, cylinder)
    assume(min(margins) > 1e-6)
    assert node(pose(yaw, pitch), "points", **fields) == 0.0


def test_a_target_that_only_four_points_hold_is_cropped():
    # Near and wide: the rim in front hangs below the lowest point of the axis.
    fields, *_ = scene((0.0, radians(-20)), radians(70), 0.0, (20.0, 0.0, -7.28), (8.0, 8.0))
    look = pose(0.0, radians(-20))
    assert node(look, "points", **fields) == 0.0
    assert node(look, "silhouette", **fields) > 0.02**2  # by more than a fiftieth of the distance


def test_what_is_bounded_is_speed_acceleration_jerk_and_the_room():
    z = pose(position=[1, 2, 3], velocity=[3, 4, 9], acceleration=[1, 2, 2])
    z[STATES : STATES + 3] = [2, 3, 6]
    planes = [[1, 0, 0, 0.5], [0, 0, -1, -7.0]]
    _, _, _, held, driven = function("none", 2)(z, row(planes))
    assert np.array(held).ravel() == pytest.approx([25, 9, 0.5, 4.0])
    assert float(driven) == pytest.approx(49)
    assert size(2) == len(row(planes))


def test_the_way_to_the_next_node_costs_jerk_and_time():
    z = pose()
    z[STATES:] = [1, 2, 2, 3, 4, 0.5]
    cost = float(function()(z, row(jerk=10.0, angular_jerk=1.0, time=0.1, pace=7.0, nominal=4.0))[2])
    assert cost == pytest.approx(0.5 * (10 * 9 + 0.1) + 0.5 * 25 + 7 * (0.5 * 4 - 1) ** 2)


def test_a_node_is_drawn_to_its_state_and_along_the_path_to_its_place():
    references = np.arange(STATES, dtype=float)
    weight = np.linspace(0.0, 2.0, STATES)
    z = np.concatenate([references + 0.5, np.zeros(INPUTS)])
    assert node(z, state=references, state_weight=weight) == pytest.approx(0.25 * weight.sum())
    z = pose(position=[1.0, 2.0, 3.0])
    assert node(z, tangent=[0.6, 0.0, 0.8], lag=5.0) == pytest.approx(5 * (0.6 + 2.4) ** 2)
    assert z[POSITION].tolist() == [1, 2, 3]
    assert (z[VELOCITY] == 0).all()
    assert (z[ACCELERATION] == 0).all()

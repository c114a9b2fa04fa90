"""The nearest place of a composition set, against brute force over everything that shows the target."""

from __future__ import annotations

from math import cos, hypot, pi, radians, sin, tan

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from shotc.geom.camera import view
from shotc.geom.shapes import CylinderShape
from shotc.ir.limits import Vec2
from shotc.ir.mission import Composition
from shotc.planning.framing.candidates import (
    TOUCH_M,
    FixedCamera,
    ScreenLine,
    nearest_candidate,
    nearest_on_verticals,
    roomiest,
)
from shotc.spec.compositions import COMPOSITIONS
from tests.support.records import replace

THIRD = 1 / 3
CORNERS = tuple((u, v) for u in (-THIRD, THIRD) for v in (-THIRD, THIRD))
THIRDS = Composition("thirds", points=((0.0, 0.0), *CORNERS))
LINES = Composition("thirds-lines", u_lines=(-THIRD, THIRD), v_lines=(-THIRD, THIRD))

settings = st.builds(
    lambda distance, azimuth, rise, radius, height, hfov: FixedCamera(
        offset=(distance * cos(azimuth), distance * sin(azimuth), rise),
        shape=CylinderShape(radius, height),
        hfov=hfov,
        aspect=16 / 9,
        pitch=(radians(-90), radians(30)),
    ),
    st.floats(5, 80),
    st.floats(-pi, pi),
    st.floats(-30, 20),
    st.floats(0.2, 5),
    st.floats(0.2, 25),
    st.floats(radians(25), radians(100)),
)
# On the line v = 1/3 it fits on two short stretches, left and right, with nothing between them.
TWO_STRETCHES = FixedCamera(
    (5.0, 0.0, -16.75), CylinderShape(0.8125, 9.0), 0.6875, 16 / 9, (radians(-90), radians(30))
)
places = st.tuples(st.floats(-1, 1), st.floats(-1, 1))


def whole(setting: FixedCamera, uv: tuple[float, float]) -> bool:
    """Tell independently of the frustum planes whether the silhouette is in the frame."""
    aim = setting.aim(uv)
    if aim is None or not setting.pitch[0] - 1e-9 <= aim[1] <= setting.pitch[1] + 1e-9:
        return False
    camera = view(*aim, setting.hfov, setting.aspect)
    if camera.to_camera(setting.offset)[2] < setting.shape.radius + setting.shape.height:
        return setting.margin(aim) >= 0  # the silhouette formula is for cylinders well in front
    return max(abs(b) for b in setting.shape.bounds(camera, setting.offset)) <= 1


@pytest.mark.slow
@given(settings, places)
def test_the_chosen_point_is_the_nearest_that_shows_the_target_whole(
    setting: FixedCamera, asked: Vec2
) -> None:
    chosen = nearest_candidate(setting, THIRDS, asked)
    good = [p for p in THIRDS.points if whole(setting, p)]
    # Places on the very edge of being cropped may fall to either side.
    assume(all(abs(setting.slack(p)) > 1e-5 for p in THIRDS.points))
    if not good:
        assert chosen is None
    else:
        assert chosen in good
        assert setting.apart(asked, chosen) <= min(setting.apart(asked, p) for p in good) + 1e-9


@pytest.mark.long
@given(settings, places)
@example(TWO_STRETCHES, (1.0, 1.0))
@example(TWO_STRETCHES, (-1.0, 1.0))
def test_no_sampled_point_of_the_lines_is_nearer_than_the_chosen_one(
    setting: FixedCamera, asked: Vec2
) -> None:
    chosen = nearest_candidate(setting, LINES, asked)
    lines = [*(ScreenLine(c, True) for c in LINES.u_lines), *(ScreenLine(c, False) for c in LINES.v_lines)]
    sampled = [line.point(-1 + i / 100) for line in lines for i in range(201)]
    good = [p for p in sampled if setting.slack(p) >= 0]
    if chosen is None:
        assert not good
        return
    assert setting.slack(chosen) >= -TOUCH_M
    assert any(abs(chosen[0] - c) < 1e-12 for c in LINES.u_lines) or any(
        abs(chosen[1] - c) < 1e-12 for c in LINES.v_lines
    )
    assert max(abs(c) for c in chosen) <= 1
    assert all(setting.apart(asked, chosen) <= setting.apart(asked, p) + 1e-7 for p in good)


def test_a_target_moved_until_it_fits_is_whole_and_not_only_but_for_rounding() -> None:
    near = FixedCamera(
        (10.627, -6.247, -0.99), CylinderShape(3.84, 4.02), radians(50), 16 / 9, (radians(-90), radians(30))
    )
    chosen = nearest_on_verticals(near, THIRDS, (0.0, -0.9))
    assert chosen is not None
    assert 0.0 <= near.slack(chosen) <= 2 * TOUCH_M


@pytest.mark.long
@given(settings, places)
def test_the_verticals_give_the_nearest_whole_place_where_points_crop(
    setting: FixedCamera, asked: Vec2
) -> None:
    chosen = nearest_on_verticals(setting, THIRDS, asked)
    sampled = [(u, -1 + i / 100) for u in (0.0, -THIRD, THIRD) for i in range(201)]
    good = [p for p in sampled if setting.slack(p) >= 0]
    if chosen is None:
        assert not good
        assert roomiest(setting, THIRDS) < 0
        return
    assert setting.slack(chosen) >= -TOUCH_M
    assert all(setting.apart(asked, chosen) <= setting.apart(asked, p) + 1e-7 for p in good)


def test_the_foot_on_a_line_is_the_least_angle_not_the_least_pixel_distance() -> None:
    setting = FixedCamera((20.0, 0.0, 0.0), CylinderShape(0.1, 0.1), radians(90), 1.0, (-pi / 2, pi / 2))
    # On u = 1 the direction (1, v, 1) is nearest to (0, 1, 1) / sqrt 2 where v = (1 + 1) / (0 + 1) * 1 / 1,
    # past the frame's edge: the angle pulls it beyond the pixel foot v = 1.
    assert ScreenLine(1.0, True).foot(setting, (0.0, 1.0)) == 1.0
    assert ScreenLine(1.0, True).foot(setting, (0.0, 0.4)) == pytest.approx(0.8)
    assert ScreenLine(0.5, False).foot(setting, (0.4, 0.0)) == pytest.approx(0.4 * (1 + 0.25))


def test_a_stretch_that_just_fits_is_found_between_the_samples() -> None:
    tower = FixedCamera((40.0, 0.0, 0.0), CylinderShape(1.0, 24.0), radians(70), 16 / 9, (-pi / 2, pi / 2))
    low, high = 0.1, 1.0
    for _ in range(60):  # the nearest distance at which the tower fits on u = 0.2
        middle = (low + high) / 2
        snug = replace(tower, offset=(40.0 * middle, 0.0, 0.0))
        low, high = (
            (low, middle) if roomiest(snug, Composition("own", points=((0.2, 0.0),))) >= 0 else (middle, high)
        )
    snug = replace(tower, offset=(40.0 * high, 0.0, 0.0))
    place = nearest_on_verticals(snug, Composition("own", points=((0.2, 0.9),)), (0.2, 0.9))
    assert place is not None
    assert place[0] == 0.2
    assert abs(place[1]) < 1e-3


def test_ties_fall_to_the_first_point_of_the_set() -> None:
    setting = FixedCamera((30.0, 0.0, 0.0), CylinderShape(0.5, 1.0), radians(60), 1.5, (-pi / 2, pi / 2))
    corners = Composition("corners", points=CORNERS)
    assert nearest_candidate(setting, corners, (0.0, 0.0)) == CORNERS[0]
    assert nearest_candidate(setting, corners, (1e-13, 1e-13)) == CORNERS[0]


def test_a_place_that_the_gimbal_cannot_reach_is_no_candidate() -> None:
    above = FixedCamera(
        (20.0, 0.0, 10.0), CylinderShape(0.5, 1.0), radians(60), 16 / 9, (-pi / 2, radians(20))
    )
    # Looking straight at it takes 26.6 deg; putting it high in the frame takes less.
    chosen = nearest_candidate(above, Composition("u0", u_lines=(0.0,)), (0.0, 0.0))
    assert chosen is not None
    aim = above.aim(chosen)
    assert aim is not None
    assert aim[1] == pytest.approx(radians(20), abs=1e-6)
    half = tan(above.hfov / 2) / above.aspect
    wanted = tan(radians(26.565051177) - radians(20)) / half
    assert chosen[1] == pytest.approx(wanted, abs=1e-6)


def test_directions_are_unit_vectors_of_the_pinhole() -> None:
    setting = FixedCamera((1.0, 0.0, 0.0), CylinderShape(0.1, 0.1), radians(90), 2.0, (-1.0, 1.0))
    assert hypot(*setting.direction((0.7, -0.3))) == pytest.approx(1.0)
    x, y, z = setting.direction((1.0, 1.0))
    assert (x / z, y / z) == pytest.approx((1.0, 0.5))


THIRDS_FIRST = COMPOSITIONS["thirds-first"]


def test_a_set_that_prefers_the_thirds_takes_the_centre_only_where_neither_third_fits() -> None:
    slim = FixedCamera((0.0, 20.0, 0.0), CylinderShape(0.5, 2.0), radians(70), 16 / 9, (-1.5, 0.5))
    place = nearest_candidate(slim, THIRDS_FIRST, (0.0, 0.0))
    assert place is not None
    assert place == pytest.approx((-1 / 3, 0.0))
    wide = slim._replace(shape=CylinderShape(11.0, 2.0))  # fits across the frame in its middle alone
    assert nearest_candidate(wide, THIRDS_FIRST, (0.0, 0.0)) == (0.0, 0.0)
    assert nearest_candidate(wide._replace(shape=CylinderShape(15.0, 2.0)), THIRDS_FIRST, (0.0, 0.0)) is None


def test_a_set_that_prefers_the_thirds_keeps_the_side_that_is_asked() -> None:
    slim = FixedCamera((0.0, 20.0, 0.0), CylinderShape(0.5, 2.0), radians(70), 16 / 9, (-1.5, 0.5))
    assert nearest_candidate(slim, THIRDS_FIRST, (0.2, 0.1)) == pytest.approx((1 / 3, 0.1), abs=0.02)

"""The viewpoint of subjects: distances and lenses in closed form, and the least-squares pose of several."""

from __future__ import annotations

from math import cos, hypot, pi, radians, sin, tan

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import least_squares

from shotc.geom import viewpoint as module
from shotc.geom.camera import aim_at, view
from shotc.geom.framing import Cameras, frames
from shotc.geom.shapes import CylinderShape
from shotc.geom.viewpoint import (
    Lens,
    PlaceBounds,
    PreviousView,
    RequiredView,
    direction,
    distance_for,
    first_pose,
    judged,
    lens_for,
    nearest,
    size_from,
    stand,
    viewpoint,
)

LENS = Lens(radians(70), 16 / 9, (-pi / 2, radians(30)))
ROOM = PlaceBounds(2.7, 1.6)
MAN = RequiredView((0.0, 0.0, 20.0), CylinderShape(0.4, 1.8))

angles = st.floats(-pi, pi)
places = st.tuples(st.floats(-0.6, 0.6), st.floats(-0.5, 0.5))


def test_a_thin_target_at_eye_level_has_the_size_of_its_height_over_the_picture_there() -> None:
    thin = MAN._replace(shape=CylinderShape(1e-6, 1.8))
    distance = distance_for(thin, LENS, (1.0, 0.0, 0.0), 0.3)
    assert distance == pytest.approx(1.8 / (2 * 0.3 * tan(radians(35)) * 9 / 16), rel=1e-4)


@pytest.mark.slow
@settings(deadline=None, max_examples=60)
@given(azimuth=angles, elevation=st.floats(-0.3, 1.3), uv=places, size=st.floats(0.03, 1.2))
def test_the_distance_gives_the_size_that_verification_measures(azimuth, elevation, uv, size) -> None:
    toward = direction(azimuth, elevation)
    wanted = MAN._replace(uv=uv)
    away = distance_for(wanted, LENS, toward, size)
    x, y, z = (c * away for c in toward)
    aim = aim_at((-x, -y, -z), uv, LENS.hfov, LENS.aspect)
    assume(aim is not None and MAN.shape.gap((x, y, z)) > 0.3)
    eye = np.array([[x, y, z + 20.0]])
    cameras = Cameras(eye, np.array([aim[0]]), np.array([aim[1]]), np.array([LENS.hfov]), LENS.aspect)
    seen = frames(cameras, MAN.centre, MAN.shape)
    assert seen.size[0] == pytest.approx(size, rel=1e-6)
    assert (seen.u[0], seen.v[0]) == pytest.approx(uv, abs=1e-9)


@pytest.mark.slow
@given(azimuth=angles, elevation=st.floats(-1.5, 1.5), near=st.floats(0.1, 5.0))
def test_the_nearest_place_keeps_just_its_clearance(azimuth, elevation, near) -> None:
    toward = direction(azimuth, elevation)
    away = nearest(MAN, toward, near)
    x, y, z = (c * away for c in toward)
    assert MAN.shape.gap((x, y, z)) == pytest.approx(near, abs=1e-6)


@pytest.mark.parametrize(
    ("azimuth", "elevation"), [(0.4, 0.2), (-2.0, 0.7), (3.0, -0.1), (None, 0.5), (None, -0.3), (1.1, None)]
)
def test_the_angle_from_the_required_view_is_that_between_the_two_directions(
    azimuth: float | None, elevation: float | None
) -> None:
    for az, el in ((0.5, 0.1), (0.4, 0.4), (2.8, -0.2)):
        toward = np.array(direction(az, el))
        eye = np.array(MAN.centre) + 30.0 * toward
        seen = judged(
            (*eye, *aim_at(-toward, (0.0, 0.0), LENS.hfov, LENS.aspect)),
            LENS,
            MAN._replace(azimuth=azimuth, elevation=elevation),
        )
        asked = direction(az if azimuth is None else azimuth, el if elevation is None else elevation)
        if elevation is None:
            toward, asked = np.array(direction(az, 0.0)), direction(azimuth, 0.0)
        angle = 2.0 * np.arcsin(0.5 * np.linalg.norm(toward - asked))
        assert seen.angle == pytest.approx(angle, rel=0.03 if azimuth is None else 1e-9)


@pytest.mark.parametrize(("yaw", "pitch"), [(0.6, 0.0), (-0.62, 0.0), (0.0, 0.4), (0.0, -0.37), (0.0, 0.0)])
def test_a_subject_extends_out_of_the_frame_by_its_point_farthest_out(yaw: float, pitch: float) -> None:
    turn = np.linspace(0, 2 * pi, 4000)
    rim = np.column_stack([12.0 + 0.4 * np.cos(turn), 0.4 * np.sin(turn)])
    camera = view(yaw, pitch, LENS.hfov, LENS.aspect)
    points = [camera.project((rim[:, 0], rim[:, 1], np.full(len(rim), z)))[:2] for z in (-0.9, 0.9)]
    farthest = float(np.abs(points).max()) - 1.0
    seen = judged((-12.0, 0.0, 20.0, yaw, pitch), LENS, MAN)
    assert seen is not None
    assert seen.out == pytest.approx(max(0.0, farthest), abs=1e-5)
    assert (seen.out == 0.0) is ((yaw, pitch) == (0.0, 0.0))
    larger = judged((-12.0, 0.0, 20.0, yaw, pitch), LENS, MAN._replace(size=1.2))
    assert larger is not None
    assert larger.out == 0.0


def test_the_lens_that_gives_a_size_gives_it() -> None:
    offset = (0.0, -8.0, 1.0)
    hfov = lens_for(MAN, LENS, offset, 0.6)
    assert hfov is not None
    assert size_from(MAN, LENS._replace(hfov=hfov), offset) == pytest.approx(0.6, rel=1e-6)
    assert lens_for(MAN, LENS, offset, 1e-4) is None


def test_a_free_elevation_is_level_or_as_little_above_as_the_ground_asks() -> None:
    assert stand(MAN, LENS, ROOM, 0.0, 0.3)[2] == 0.0
    low = MAN._replace(centre=(0.0, 0.0, 0.9))
    offset = stand(low, LENS, ROOM, 0.0, 0.3)
    assert offset[2] + 0.9 == pytest.approx(ROOM.floor, abs=1e-6)
    assert size_from(low, LENS, offset) == pytest.approx(0.3, rel=1e-6)


def test_one_subject_is_shown_where_and_as_large_as_it_is_asked_for() -> None:
    asked = MAN._replace(uv=(0.3, -0.2), size=0.3, azimuth=0.4, elevation=0.2)
    pose, cost = viewpoint((asked,), LENS, ROOM, first_pose([asked], LENS, ROOM, 0.0))
    seen = judged(pose, LENS, asked)
    assert seen is not None
    assert (seen.screen, seen.size, seen.angle) == pytest.approx((0.0, 0.3, 0.0), abs=1e-4)
    assert cost < 1e-6


def test_below_a_floor_that_no_elevation_reaches_a_camera_looks_down_from_its_own_side() -> None:
    x, y, z = stand(MAN, LENS, PlaceBounds(1e6, 1.6), 0.4, 0.3)
    assert z > 0.0
    assert (x / hypot(x, y), y / hypot(x, y)) == pytest.approx((sin(0.4), cos(0.4)))


@pytest.mark.long
@settings(deadline=None, max_examples=40)
@given(
    apart=st.floats(1.5, 6.0),
    away=st.floats(8.0, 25.0),
    rise=st.floats(1.0, 6.0),
    pan=st.floats(-0.2, 0.2),
)
def test_what_a_camera_sees_leads_back_to_a_camera_that_sees_it(apart, away, rise, pan) -> None:
    """From the places and sizes in a real picture, a camera is found whose picture is the same."""
    centres = [(0.0, apart / 2, 20.0), (0.0, -apart / 2, 20.5)]
    eye = (away * np.cos(0.3), away * np.sin(0.3), 20.0 + rise)
    yaw, pitch = aim_at((-eye[0], -eye[1], -rise), (0.0, 0.0), LENS.hfov, LENS.aspect) or (0.0, 0.0)
    pose = (*eye, yaw + pan, pitch)
    camera = view(pose[3], pose[4], LENS.hfov, LENS.aspect)
    subjects = []
    for centre in centres:
        u, v, _ = camera.project(tuple(c - e for c, e in zip(centre, eye, strict=True)))
        bare = RequiredView(centre, CylinderShape(0.4, 1.8))
        seen = judged(pose, LENS, bare)
        assume(seen is not None and seen.out == 0.0 and abs(u) < 0.8 and abs(v) < 0.7)
        subjects.append(bare._replace(uv=(u, v), size=seen.size))
    guesses = [first_pose(subjects, LENS, ROOM, k * pi / 6) for k in range(12)]
    found, _ = min(
        (viewpoint(tuple(subjects), LENS, ROOM, guess) for guess in guesses), key=lambda pair: pair[1]
    )
    for subject in subjects:
        seen = judged(found, LENS, subject)
        assert seen is not None
        assert seen.screen < 0.03
        assert seen.size == pytest.approx(subject.size, rel=0.05)


@pytest.mark.parametrize("size", [(0.4, 1.8), (0.1, 60.0)])
@pytest.mark.parametrize("hfov", [4.0, 20.0, 70.0, 120.0])
def test_the_first_pose_has_all_subjects_in_its_frame_through_any_lens(
    hfov: float, size: tuple[float, float]
) -> None:
    lens = Lens(radians(hfov), 16 / 9, (-pi / 2, radians(30)))
    subjects = [
        RequiredView((x, y, 3.0), CylinderShape(*size)) for x, y in ((0.0, 0.0), (6.0, 1.0), (-2.0, 5.0))
    ]
    for bearing in range(12):
        pose = first_pose(subjects, lens, ROOM, bearing * pi / 6)
        assert all(
            found is not None and found.out == 0.0 for found in (judged(pose, lens, s) for s in subjects)
        )


@pytest.mark.parametrize("seed", range(8))
def test_no_general_solver_does_better_from_where_ours_ends(seed: int) -> None:
    """Subjects at random, more asked than can be had: the cost is a minimum, within the bounds."""
    rng = np.random.default_rng(seed)
    subjects = tuple(
        RequiredView(
            (*rng.uniform(-8, 8, 2), 0.9),
            CylinderShape(0.4, 1.8),
            uv=tuple(rng.uniform(-0.6, 0.6, 2)),
            size=float(rng.uniform(0.1, 0.4)),
            azimuth=float(rng.uniform(0, 2 * pi)) if k == 0 else None,
        )
        for k in range(2)
    )
    pose, cost = viewpoint(subjects, LENS, ROOM, first_pose(subjects, LENS, ROOM, 0.5))

    def residuals(x: np.ndarray) -> np.ndarray:
        found = module._residuals(tuple(x), subjects, LENS, ROOM, (None, 10.0))
        return np.full(26, 1e3) if found is None else np.array(found)

    low = [-np.inf, -np.inf, ROOM.floor - 1e-9, -np.inf, LENS.pitch[0] - 1e-9]
    high = [np.inf, np.inf, np.inf, np.inf, LENS.pitch[1] + 1e-9]
    best = least_squares(residuals, pose, bounds=(low, high), x_scale=[10, 10, 10, 1, 1])
    assert cost <= 2 * best.cost * 1.01 + 1e-6
    assert pose[2] >= ROOM.floor


def test_a_subject_without_a_place_comes_to_the_middle_of_the_frame() -> None:
    subject = MAN._replace(size=0.3, azimuth=0.4, elevation=0.1)
    pose, _ = viewpoint((subject,), LENS, ROOM, first_pose([subject], LENS, ROOM, 1.0))
    offset = tuple(c - e for c, e in zip(MAN.centre, pose[:3], strict=True))
    u, v, _ = view(pose[3], pose[4], LENS.hfov, LENS.aspect).project(offset)
    assert (u, v) == (pytest.approx(0.0, abs=1e-3), pytest.approx(0.0, abs=1e-3))


def test_a_camera_goes_no_farther_than_its_way() -> None:
    subjects = (
        MAN._replace(uv=(-0.3, 0.0), size=0.3),
        RequiredView((3.0, 0.0, 20.0), CylinderShape(0.4, 1.8), (0.3, 0.0)),
    )
    start = first_pose(subjects, LENS, ROOM, 0.0)
    free, _ = viewpoint(subjects, LENS, ROOM, start)
    since = PreviousView(start[:3], start[:3], 1.0)
    held, _ = viewpoint(subjects, LENS, ROOM, start, since)
    assert hypot(*(a - b for a, b in zip(free[:3], start[:3], strict=True))) > 2.0
    assert hypot(*(a - b for a, b in zip(held[:3], start[:3], strict=True))) < 1.1


@pytest.mark.parametrize("azimuth", [0.3, 2.0, -1.2])
def test_a_side_that_is_asked_for_alone_is_the_one_that_is_seen(azimuth: float) -> None:
    subject = MAN._replace(uv=(0.2, -0.1), size=0.3, azimuth=azimuth)
    pose, cost = viewpoint((subject,), LENS, ROOM, first_pose([subject], LENS, ROOM, azimuth + 0.4))
    east, north = pose[0] - MAN.centre[0], pose[1] - MAN.centre[1]
    assert np.arctan2(east, north) == pytest.approx(azimuth, abs=1e-3)
    assert cost < 1e-6


@pytest.mark.parametrize("elevation", [0.3, 0.8])
def test_a_height_that_is_asked_for_alone_is_the_one_that_is_seen(elevation: float) -> None:
    subject = MAN._replace(uv=(0.2, -0.1), size=0.3, elevation=elevation)
    pose, cost = viewpoint((subject,), LENS, ROOM, first_pose([subject], LENS, ROOM, 0.4))
    x, y, z = (a - b for a, b in zip(pose[:3], MAN.centre, strict=True))
    assert np.arctan2(z, hypot(x, y)) == pytest.approx(elevation, abs=1e-3)
    assert cost < 1e-6


def test_off_a_preferred_pose_shares_of_the_distance_and_angles_count() -> None:
    drawn = module.PreferredPose((3.0, 4.0, MAN.centre[2]), 0.4, -0.3)
    far = hypot(*(a - b for a, b in zip(drawn.at, MAN.centre, strict=True)))
    pose = (3.5, 4.0, MAN.centre[2] - 1.0, 0.7, -0.1)
    place, angles = [0.5 / far, 0.0, -1.0 / far], [2.0 * sin(0.15), 0.2]
    found = module._off_pose(pose, drawn, (MAN,))
    assert found == pytest.approx([module.NEAR_WEIGHT * each for each in (*place, *angles)])
    for yaw, pitch in ((None, -0.3), (0.4, None), (None, None)):
        free = module._off_pose(pose, drawn._replace(yaw=yaw, pitch=pitch), (MAN,))
        kept = [a for a, asked in zip(angles, (yaw, pitch), strict=True) if asked is not None]
        assert free == pytest.approx([module.NEAR_WEIGHT * each for each in (*place, *kept)])
    assert module._off_pose(pose, None, (MAN,)) == []


@pytest.mark.parametrize(("radius", "height"), [(2.0, 1.0), (0.5, 6.0)])
def test_the_first_pose_stands_back_by_the_spread_of_the_subjects_over_half_the_smaller_field(
    radius: float, height: float
) -> None:
    both = [
        RequiredView((x, 0.0, 20.0), CylinderShape(r, h))
        for x, r, h in ((-3.0, radius, height), (3.0, 0.1, 0.1))
    ]
    x, y, z, yaw, pitch = first_pose(both, LENS, ROOM, radians(30))
    back = (3.0 + radius + height / 2) * (1.0 + 1.0 / (tan(radians(35)) * 9 / 16)) + ROOM.near
    toward = direction(radians(30), 0.0)
    assert (x, y, z) == pytest.approx((back * toward[0], back * toward[1], 20.0))
    assert (yaw, pitch) == pytest.approx((radians(-120), 0.0))

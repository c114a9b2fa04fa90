"""What the checks of shows reckon with, against slower and independent reckonings."""

from __future__ import annotations

import random
from itertools import combinations, product
from math import cos, dist, hypot, inf, pi, sin, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom.apart import ROUNDING_RATIO, spacing
from shotc.geom.pads import nearest_pair
from shotc.ir.limits import Vec3
from shotc.ir.show import Apart, Box, Lettering, Model, Picture, Source, Sphere, Torus
from shotc.show.geom.fit import ROGERS_SHARE, _on_face, _round_box, most_drones
from shotc.show.geom.shape import NARROW_SHARE, balls, bounds, depth_in, highest, lowest
from shotc.show.goals.body import upright_axes

coordinates = st.floats(-8, 8).map(lambda x: round(x, 3))
aparts = st.builds(
    Apart,
    st.sampled_from(["ellipsoid", "cylinder"]),
    st.floats(0.5, 4),
    st.floats(0.5, 4),
    st.sampled_from([0.0, 0.15]),
)
angles = st.floats(-4, 4)
CENTRE = (3.0, -2.0, 30.0)
solids = st.one_of(
    st.builds(Sphere, st.just(CENTRE), st.floats(0.5, 20)),
    st.builds(lambda s, h: Box(CENTRE, s, h), st.tuples(*[st.floats(0.5, 20)] * 3), angles),
    st.builds(
        lambda r, t, h, i: Torus(CENTRE, r, t, h, i), st.floats(3, 20), st.floats(0.5, 3), angles, angles
    ),
)


def kept(p: Vec3, q: Vec3, apart: Apart) -> float:
    """How many times the separation two places are apart, as Apart says it."""
    across, up = hypot(p[0] - q[0], p[1] - q[1]) / apart.across, abs(p[2] - q[2]) / apart.upright
    return hypot(across, up) if apart.shape == "ellipsoid" else max(across, up)


def picture(source: Source, fill: str = "volume") -> Picture:
    return Picture(source, fill, None, None, 0.0, ("shots", 0, "frames", 0))  # type: ignore[arg-type]


def inside(source: Source, p: Vec3) -> bool:
    """Tell whether a point is in a shape, by its definition."""
    d = [a - b for a, b in zip(p, CENTRE, strict=True)]
    if isinstance(source, Sphere):
        return hypot(*d) <= source.radius
    h = source.heading  # type: ignore[union-attr]
    right, ahead = d[0] * cos(h) - d[1] * sin(h), d[0] * sin(h) + d[1] * cos(h)
    if isinstance(source, Box):
        return all(abs(x) <= s / 2 for x, s in zip((right, ahead, d[2]), source.size, strict=True))
    assert isinstance(source, Torus)
    # Tilt the ring back until it lies flat: its axis leans ahead.
    along = ahead * sin(source.tilt) + d[2] * cos(source.tilt)
    level = ahead * cos(source.tilt) - d[2] * sin(source.tilt)
    return hypot(hypot(right, level) - source.radius, along) <= source.tube


@pytest.mark.slow
@given(st.lists(st.tuples(coordinates, coordinates, coordinates), min_size=2, max_size=25), aparts)
def test_the_nearest_pads_are_found(pads: list[Vec3], apart: Apart) -> None:
    found = nearest_pair(pads, apart)
    least = min(kept(p, q, apart) for p, q in combinations(pads, 2))
    if found is None:
        assert least >= 1 - 1e-5
    else:
        assert found.one < found.other
        assert kept(pads[found.one], pads[found.other], apart) == pytest.approx(found.share, abs=1e-9)
        assert found.share <= least + 1e-5


def test_thousands_of_pads_in_one_place_are_soon_told() -> None:
    apart = Apart("ellipsoid", 2.0, 2.0, 0.0)
    assert nearest_pair([(1.0, 1.0, 0.0)] * 5000, apart) is not None
    rng = random.Random(1)
    dense = [(rng.random() / 1000, rng.random() / 1000, 0.0) for _ in range(5000)]
    found = nearest_pair(dense, apart)
    assert found is not None
    assert found.share < 1e-5


@pytest.mark.slow
@given(solids, st.tuples(*[st.floats(-1.3, 1.3)] * 3))
def test_how_deep_a_point_lies_agrees_with_the_shape(source: Source, share: Vec3) -> None:
    low, high = bounds(source) or ((0.0,) * 3, (0.0,) * 3)
    half = max(h - c for h, c in zip(high, CENTRE, strict=True))
    p: Vec3 = tuple(c + half * s for c, s in zip(CENTRE, share, strict=True))  # type: ignore[assignment]
    deep = depth_in(picture(source), p, 1.0)
    if abs(deep) > 1e-9:
        assert (deep > 0) == inside(source, p)
    if inside(source, p):
        assert all(a - 1e-9 <= x <= b + 1e-9 for a, x, b in zip(low, p, high, strict=True))


@pytest.mark.slow
@given(solids, st.randoms(use_true_random=False))
def test_balls_lie_in_the_shape_and_reach_as_high_and_low(source: Source, rng: random.Random) -> None:
    shape = balls(source)
    low, high = bounds(source) or ((0.0,) * 3, (0.0,) * 3)
    assert lowest(shape) == pytest.approx(low[2], abs=1e-9)
    assert highest(shape) == pytest.approx(high[2], abs=1e-9)
    for ball in shape:
        a, b = rng.uniform(0, 2 * pi), rng.uniform(-1, 1)
        r = 0.999 * ball.radius
        shrink = 0.9999 if isinstance(source, Box) else 1.0  # whose corners are on its surface
        out = (sqrt(1 - b * b) * cos(a), sqrt(1 - b * b) * sin(a), b)
        p = tuple(c + shrink * (x - c) + r * o for c, x, o in zip(CENTRE, ball.centre, out, strict=True))
        assert inside(source, p)  # type: ignore[arg-type]


def test_what_has_no_place_has_no_balls() -> None:
    free = Model(("a.ply",), None, None, None, 0.0)
    assert balls(free) == ()
    assert bounds(free) is None
    assert most_drones(picture(free), Apart("ellipsoid", 2.0, 2.0, 0.0)) == inf
    assert lowest(balls(Lettering("go", CENTRE, 8.0, 1.0, None))) == CENTRE[2] - 2
    assert lowest(balls(Lettering("Go", CENTRE, 8.0, 1.0, None))) == CENTRE[2] - 4


def packed(gap: float, stretch: float, offset: Vec3) -> list[Vec3]:
    """The densest packing of space (face-centred cubic) by balls of diameter ``gap``, stretched back."""
    a = gap / sqrt(2)
    n = range(-round(22 / a) - 2, round(22 / a) + 3)
    cells = ((i, j, k) for i, j, k in product(n, n, n) if (i + j + k) % 2 == 0)
    x, y, z = offset
    return [
        (CENTRE[0] + a * (i + x), CENTRE[1] + a * (j + y), CENTRE[2] + a * (k + z) / stretch)
        for i, j, k in cells
    ]


@pytest.mark.long
@settings(max_examples=25, deadline=None)
@given(solids, st.sampled_from([(1.0, 1.0), (1.0, 2.0), (2.0, 1.2)]), st.tuples(*[st.floats(0, 1)] * 3))
def test_the_densest_packing_never_beats_the_bound(
    source: Source, size: tuple[float, float], offset: Vec3
) -> None:
    apart = Apart("ellipsoid", 2 * size[0], 2 * size[1], 0.0)
    gap = spacing(apart)
    held = [p for p in packed(gap, apart.across / apart.upright, offset) if inside(source, p)]
    assert len(held) <= most_drones(picture(source), apart)


def test_the_bound_of_a_large_ball_is_little_above_the_densest_packing() -> None:
    ball = picture(Sphere(CENTRE, 100.0))
    densest = sqrt(2.0) * 4.0 / 3.0 * pi * 100.0**3
    assert densest < most_drones(ball, Apart("ellipsoid", 1.0, 1.0, 0.0)) < 1.1 * densest


@pytest.mark.slow
@given(st.floats(1.0, 30.0), st.integers(2, 400))
def test_points_spread_on_a_sphere_never_beat_the_bound(radius: float, count: int) -> None:
    golden = pi * (3 - sqrt(5))
    heights = [1 - (2 * i + 1) / count for i in range(count)]
    points = [
        (radius * sqrt(1 - z * z) * cos(golden * i), radius * sqrt(1 - z * z) * sin(golden * i), radius * z)
        for i, z in enumerate(heights)
    ]
    gap = min(dist(p, q) for p, q in combinations(points, 2))
    apart = Apart("ellipsoid", gap / ROUNDING_RATIO, gap / ROUNDING_RATIO, 0.0)
    assert most_drones(picture(Sphere(CENTRE, radius), "surface"), apart) >= count - 1e-6


@pytest.mark.parametrize(
    ("count", "gap"), [(2, 2.0), (3, sqrt(3)), (4, sqrt(8 / 3)), (6, sqrt(2)), (12, 1.0514622)]
)
def test_the_bound_on_a_sphere_is_met_by_the_regular_bodies(count: int, gap: float) -> None:
    apart = Apart("ellipsoid", gap / ROUNDING_RATIO - 1e-7, gap / ROUNDING_RATIO - 1e-7, 0.0)
    bound = most_drones(picture(Sphere(CENTRE, 1.0), "surface"), apart)
    assert count <= bound + 1e-5
    assert bound < count + 1


@pytest.mark.parametrize("n", [2, 5, 9])
def test_a_lattice_on_the_faces_of_a_cube_never_beats_the_bound(n: int) -> None:
    apart = Apart("ellipsoid", 2.0, 2.0, 0.0)
    side = (n - 1) * spacing(apart)
    on_faces = sum(1 for p in product(range(n), repeat=3) if {0, n - 1} & set(p))
    assert on_faces <= most_drones(picture(Box(CENTRE, (side, side, side), 0.3), "surface"), apart)


@pytest.mark.slow
@given(st.floats(3, 20), st.floats(0.5, 3), angles, angles)
def test_balls_of_a_ring_go_round_its_axis(radius: float, tube: float, heading: float, tilt: float) -> None:
    axis = (sin(tilt) * sin(heading), sin(tilt) * cos(heading), cos(tilt))
    away = [
        tuple(a - b for a, b in zip(ball.centre, CENTRE, strict=True))
        for ball in balls(Torus(CENTRE, radius, tube, heading, tilt))
    ]
    for d in away:
        assert hypot(*d) == pytest.approx(radius)
        assert sum(a * b for a, b in zip(d, axis, strict=True)) == pytest.approx(0.0, abs=1e-9 * radius)
    steps = [dist(a, b) for a, b in zip(away, [*away[1:], away[0]], strict=True)]
    assert steps == pytest.approx([steps[0]] * len(steps))


@pytest.mark.parametrize(
    ("sides", "reach", "volume"),
    [
        ((2.0, 3.0, 5.0), 0.0, 30.0),
        ((0.0, 0.0, 0.0), 2.0, 4 / 3 * pi * 8.0),  # a ball
        ((3.0, 0.0, 0.0), 2.0, 3.0 * pi * 4.0 + 4 / 3 * pi * 8.0),  # a rod
        ((0.0, 5.0, 0.0), 2.0, 5.0 * pi * 4.0 + 4 / 3 * pi * 8.0),
        ((0.0, 0.0, 7.0), 2.0, 7.0 * pi * 4.0 + 4 / 3 * pi * 8.0),
        # A plate: its two faces, half a rod along each of its four sides, a ball at its corners.
        ((3.0, 5.0, 0.0), 2.0, 2 * 15.0 * 2.0 + 8.0 * pi * 4.0 + 4 / 3 * pi * 8.0),
        ((0.0, 5.0, 7.0), 2.0, 2 * 35.0 * 2.0 + 12.0 * pi * 4.0 + 4 / 3 * pi * 8.0),
        ((3.0, 0.0, 7.0), 2.0, 2 * 21.0 * 2.0 + 10.0 * pi * 4.0 + 4 / 3 * pi * 8.0),
        ((2.0, 3.0, 5.0), 0.1, 30.0 + 2 * 31.0 * 0.1 + pi * 10.0 * 0.01 + 4 / 3 * pi * 0.001),
    ],
)
def test_what_is_within_reach_of_a_box_has_the_volume_of_its_faces_edges_and_corners(
    sides: Vec3, reach: float, volume: float
) -> None:
    assert _round_box(*sides, reach) == pytest.approx(volume)


def test_rows_of_triangles_come_near_the_bound_of_a_face_and_a_row_meets_it() -> None:
    assert _on_face(6.0, 0.0, 2.0) == pytest.approx(4.0)
    assert _on_face(0.0, 6.0, 2.0) == pytest.approx(4.0)
    rows = 200
    for gap in (0.5, 2.0):
        count = rows * 101 - rows // 2  # 101 and 100 in turn
        bound = _on_face(100 * gap, (rows - 1) * gap * sqrt(0.75), gap)
        assert 0.99 * bound < count <= bound


def test_balls_of_a_text_stand_in_the_plane_that_its_reader_faces() -> None:
    text = Lettering("HI", (3.0, 4.0, 20.0), 5.0, 0.7, None)
    away = np.array([ball.centre for ball in balls(text)]) - text.centre
    right, ahead, up = upright_axes(text.heading)
    assert away @ ahead == pytest.approx(0.0, abs=1e-12)
    assert (np.ptp(away @ right), np.ptp(away @ up)) == pytest.approx((NARROW_SHARE * 5.0 * 2, 5.0))


def test_balls_of_a_model_stand_over_each_other_as_high_as_it_is() -> None:
    model = Model(("a.ply",), 1.0, (3.0, 4.0, 20.0), 6.0, 0.0)
    shape = balls(model)
    assert {ball.centre[:2] for ball in shape} == {(3.0, 4.0)}
    assert (lowest(shape), highest(shape)) == (17.0, 23.0)


@pytest.mark.parametrize("upright", [0.5, 1.0, 2.0])
@pytest.mark.parametrize(
    ("source", "volume"),
    [
        (Sphere(CENTRE, 3000.0), 4.0 / 3.0 * pi * 3000.0**3),
        (Box(CENTRE, (2000.0, 3000.0, 4000.0), 0.0), 2000.0 * 3000.0 * 4000.0),
        (Torus(CENTRE, 9000.0, 3000.0, 0.0, 0.0), 2.0 * pi**2 * 9000.0 * 3000.0**2),
    ],
)
def test_a_huge_solid_holds_as_many_as_cells_of_their_least_volume_fill_it(
    source: Source, volume: float, upright: float
) -> None:
    apart = Apart("ellipsoid", 1.0, upright, 0.0)
    cell = pi / 6.0 * spacing(apart) ** 3 / ROGERS_SHARE / (apart.across / apart.upright)
    assert most_drones(picture(source), apart) * cell == pytest.approx(volume, rel=0.006)

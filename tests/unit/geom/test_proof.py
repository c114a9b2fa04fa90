"""Bounds against dense sampling, analytic values, spikes between samples and grazes of a millimetre."""

from math import hypot, inf, pi

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from shotc.geom import proof
from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.geom.pieces import Pieces, cut, join, pieces
from shotc.geom.proof import inf_channel, inf_distance, sup_channel, sup_norm, sup_outside
from shotc.geom.solid_arrays.points import signed_distance
from shotc.geom.solid_arrays.segments import blocks
from shotc.geom.solids import (
    Cylinder,
    Prism,
    Solid,
    box,
    closest_on_segment,
    convex_parts,
    depth,
    distance,
    edges,
    inside_polygon,
)
from shotc.geom.solids import signed_distance as exact_distance

coordinates = st.floats(-50, 50, allow_nan=False, width=32)


@st.composite
def curves(draw: st.DrawFn, channels: int = 3) -> Piecewise:
    count = draw(st.integers(1, 4))
    widths = draw(arrays(float, count, elements=st.floats(0.1, 5)))
    ctrl = draw(arrays(float, (count, 6, channels), elements=coordinates))
    return Piecewise(np.concatenate([[0.0], np.cumsum(widths)]), ctrl)


def fine(_best: float) -> float:
    return 1e-6


def dense(curve: Piecewise, count: int = 4001) -> np.ndarray:
    return curve(np.linspace(curve.start, curve.end, count))


@pytest.mark.slow
@settings(deadline=None, max_examples=60)
@given(curves())
def test_norm_bound_holds_at_every_sample_and_is_tight(curve: Piecewise) -> None:
    bound = sup_norm(pieces(curve), fine)
    assert bound.proven >= np.linalg.norm(dense(curve), axis=1).max() - 1e-9
    assert bound.attained <= bound.proven <= bound.attained + 1e-6
    there = [*curve(bound.at), *curve(np.nextafter(bound.at, -inf))]
    assert min(abs(hypot(*there[:3]) - bound.attained), abs(hypot(*there[3:]) - bound.attained)) < 1e-6


@pytest.mark.slow
@settings(deadline=None, max_examples=40)
@given(curves(channels=2))
def test_channel_bounds_enclose_every_sample(curve: Piecewise) -> None:
    samples = dense(curve)[:, 1]
    high, low = sup_channel(pieces(curve), 1, fine), inf_channel(pieces(curve), 1, fine)
    assert low.proven <= samples.min() + 1e-9
    assert high.proven >= samples.max() - 1e-9
    assert high.proven - high.attained <= 1e-6
    assert low.attained - low.proven <= 1e-6


def test_known_extremes_of_a_rest_to_rest_quintic() -> None:
    zero = np.zeros((2, 1))
    curve = quintic_hermite(np.array([1.0, 3.0]), np.array([[0.0], [10.0]]), zero, zero)
    speed = sup_norm(pieces(curve.derivative()), lambda _: 1e-9)
    assert speed.proven == pytest.approx(15 / 8 * 10 / 2, abs=2e-9)
    assert speed.at == pytest.approx(2.0, abs=1e-3)
    acceleration = sup_norm(pieces(curve.derivative(2)), lambda _: 1e-9)
    assert acceleration.proven == pytest.approx(10 / 3**0.5 * 10 / 4, abs=2e-9)


def test_a_plateau_ends_and_stays_proven() -> None:
    turns = np.linspace(0, 2 * pi, 400)
    circle = np.stack([np.cos(turns), np.sin(turns)], axis=-1) * 30.0
    rate = np.stack([-np.sin(turns), np.cos(turns)], axis=-1) * 30.0
    curve = quintic_hermite(turns, circle, rate, -circle)
    bound = sup_norm(pieces(curve), fine)
    assert bound.proven == pytest.approx(30.0, abs=2e-6)


def test_a_spike_between_any_two_samples_is_found() -> None:
    # Half a millisecond of 5 m/s^2 in a minute of rest, between two samples at 50 Hz and at 1 kHz.
    breaks = np.array([0.0, 30.0002, 30.0007, 60.0])
    ctrl = np.zeros((3, 3, 1))
    ctrl[1, 1] = 10.0
    curve = Piecewise(breaks, ctrl)
    for rate in (50, 1000):
        assert np.abs(curve(np.arange(0, 60 * rate) / rate)).max() == 0
    bound = sup_norm(pieces(curve), fine)
    assert bound.attained == pytest.approx(5.0, abs=1e-5)
    assert 30.0002 < bound.at < 30.0007


def test_cut_is_the_same_polynomial_on_the_interval() -> None:
    rng = np.random.default_rng(3)
    curve = Piecewise(np.array([0.0, 1.0, 2.5, 3.0]), rng.normal(size=(3, 6, 2)))
    for start, end in ((0.3, 0.7), (0.3, 2.7), (1.0, 2.5), (0.0, 3.0), (2.9, 3.0)):
        bag = cut(curve, start, end)
        assert bag.low[0] == start
        assert bag.high[-1] == end
        for low, high, ctrl in zip(bag.low, bag.high, bag.ctrl, strict=True):
            piece = Piecewise(np.array([low, high]), ctrl[None])
            at = np.linspace(low, high, 9)[1:-1]
            np.testing.assert_allclose(piece(at), curve(at), atol=1e-12)
    assert len(cut(curve, 1.0, 1.0)) == 0
    assert len(cut(curve, 4.0, 5.0)) == 0
    assert len(join([cut(curve, 0.0, 1.0), cut(curve, 2.0, 3.0)])) == 3


def test_derivative_of_pieces_is_the_curves() -> None:
    rng = np.random.default_rng(5)
    curve = Piecewise(np.array([0.0, 0.5, 2.5]), rng.normal(size=(2, 6, 3)))
    np.testing.assert_allclose(pieces(curve).derivative().ctrl, curve.derivative().ctrl)


L_SHAPE = Prism(((0, 0), (10, 0), (10, 4), (4, 4), (4, 10), (0, 10)), 1.0, 8.0)
SOLIDS = [Cylinder((3.0, -2.0), 5.0, -1.0, 12.0), box((20, 5, 4), (10, 8, 8), 0.5), L_SHAPE]


# It ends on the solid's floor, and comes there along the seam of two of its convex parts.
INTO_A_SEAM = Piecewise(
    np.array([0.0, 1.0]),
    np.array([[[1, 1, 0], [1, 1, 1], [0, 1, 1], [1, 1, 1], [1, 1, 1], [1, 1, 1]]], float),
)


@pytest.mark.slow
@settings(deadline=None, max_examples=30)
@given(curve=curves(), solid=st.sampled_from(SOLIDS))
@example(curve=INTO_A_SEAM, solid=L_SHAPE)
def test_distance_bound_holds_at_every_sample(curve: Piecewise, solid: Solid) -> None:
    bound = inf_distance(pieces(curve), solid, lambda _: 1e-4)
    sampled = min(distance(solid, tuple(p)) for p in dense(curve, 301))
    if bound.attained > 0:
        assert bound.proven <= sampled + 1e-9
        assert bound.attained - bound.proven <= 1e-4
        assert distance(solid, tuple(curve(bound.at))) == pytest.approx(bound.attained, abs=1e-6)
    else:
        # It may only touch: then the place it names is on the solid.
        assert distance(solid, tuple(curve(bound.at))) <= 1e-9


def straight(a: tuple[float, float, float], b: tuple[float, float, float]) -> Pieces:
    return pieces(Piecewise(np.array([0.0, 2.0]), np.linspace(a, b, 6)[None]))


@pytest.mark.parametrize("gap_mm", [-1.0, 1.0])
def test_a_graze_of_one_millimetre_is_told_exactly(gap_mm: float) -> None:
    clearance = 0.6
    y = 5.0 + clearance + gap_mm / 1000
    round_ = inf_distance(straight((-30, y, 3), (40, y, 3)), Cylinder((0, 0), 5, 0, 9), lambda _: 1e-7)
    flat = inf_distance(
        straight((-30, y, 3), (40, y, 3)), Prism(((-2, -2), (2, -2), (2, 5), (-2, 5)), 0, 9), lambda _: 1e-7
    )
    for bound in (round_, flat):
        assert bound.proven == pytest.approx(y - 5.0, abs=2e-7)
        assert (bound.proven >= clearance) is (gap_mm > 0)


def test_how_deep_a_curve_enters_is_told() -> None:
    through = straight((-30, 1, 3), (30, 1, 3))
    bound = inf_distance(through, Cylinder((0, 0), 5, 0, 9), lambda _: 1e-6)
    assert bound.proven == pytest.approx(-3.0, abs=0.02)  # the floor is 3 m below
    assert inf_distance(through, Cylinder((0, 0), 5, -inf, inf), lambda _: 1e-6).proven == pytest.approx(
        -4.0, abs=0.01
    )


def test_touching_at_one_point_is_no_distance() -> None:
    along_top = straight((-30, 0, 9), (30, 0, 9))
    assert inf_distance(along_top, Cylinder((0, 0), 5, 0, 9), lambda _: 1e-6).proven == pytest.approx(0.0)
    corner = straight((0, 10, 4), (10, 0, 4))
    post = Prism(((0, 0), (5, 0), (5, 5), (0, 5)), 0, 9)
    assert inf_distance(corner, post, lambda _: 1e-6).proven == pytest.approx(0.0, abs=1e-6)


def test_keep_in_margins_of_hull_pockets_floor_and_ceiling() -> None:
    field = Prism(((-80, -80), (80, -80), (80, 80), (-80, 80)), 2, 60)
    assert sup_outside(straight((0, 0, 30), (75, 0, 30)), field, fine).proven == pytest.approx(-5.0)
    assert sup_outside(straight((0, 0, 30), (75, 0, 1)), field, fine).proven == pytest.approx(1.0)
    up = straight((0, 0, 0), (0, 0, 58))
    assert sup_outside(up, field, fine, floor=False).proven == pytest.approx(-2.0)
    assert sup_outside(up, field, fine).proven == pytest.approx(2.0)
    pond = Cylinder((0, 0), 50, -inf, inf)
    assert sup_outside(straight((0, 0, 5), (47, 0, 5)), pond, fine).proven == pytest.approx(-3.0)
    # Across the notch of an L, inside its hull.
    assert sup_outside(straight((9, 2, 4), (2, 9, 4)), L_SHAPE, fine).proven > 0
    assert sup_outside(straight((9, 2, 4), (2, 2, 4)), L_SHAPE, fine).proven == pytest.approx(-1.0)
    assert sup_outside(straight((1, 3, 4), (3, 3, 4)), L_SHAPE, fine).proven == pytest.approx(-1.0)


@settings(deadline=None, max_examples=60)
@given(st.sampled_from(SOLIDS), st.tuples(coordinates, coordinates, coordinates))
def test_array_distances_are_the_scalar_ones(solid: Solid, p: tuple[float, float, float]) -> None:
    measured = float(signed_distance(solid, np.array([p]))[0])
    assert measured == pytest.approx(exact_distance(solid, p), abs=1e-9)
    assert max(measured, 0.0) == pytest.approx(distance(solid, p), abs=1e-9)
    assert max(-measured, 0.0) == pytest.approx(depth(solid, p), abs=1e-9)


def inside(solid: Solid, p: np.ndarray) -> bool:
    if not solid.bottom <= p[2] <= solid.top:  # a line along the floor of a solid is hidden by it
        return False
    if isinstance(solid, Cylinder):
        return hypot(p[0] - solid.centre[0], p[1] - solid.centre[1]) < solid.radius
    return inside_polygon(solid.points, (p[0], p[1]))


@pytest.mark.slow
@settings(deadline=None, max_examples=80)
@given(
    st.sampled_from(SOLIDS),
    st.tuples(coordinates, coordinates, coordinates),
    st.tuples(coordinates, coordinates, coordinates),
)
@example(SOLIDS[1], (0.0, 0.0, 0.0), (14.0, 4.0, 0.0))
@example(L_SHAPE, (2.0837100975335286e-19, 0.0, 2.0), (0.0, 0.0, 0.0))
@example(L_SHAPE, (-2.0837100975335286e-19, 0.0, 2.0), (0.0, 0.0, 0.0))
def test_sight_lines_against_marching(solid: Solid, a: tuple, b: tuple) -> None:  # type: ignore[type-arg]
    eye, point = np.array(a), np.array(b)
    march = [inside(solid, eye + (point - eye) * s) for s in np.linspace(0, 1, 801)]
    length = float(np.linalg.norm(point - eye))
    hidden = bool(blocks(solid, eye[None], point)[0])
    if sum(march) >= 3 and length > 0.1:
        assert hidden
    # Within nanometres of a wall, a line along it counts as inside.
    near = (distance(solid, tuple(eye + (point - eye) * s)) <= 1e-8 for s in np.linspace(0, 1, 801))
    if hidden and sum(march) == 0 and not any(near):
        # The run inside must then be shorter than a march step.
        assert not blocks(solid, eye[None], point, least=length / 400)[0]


@pytest.mark.slow
@given(st.floats(0.01, 0.99), st.floats(-9, 9))
def test_no_sight_line_slips_through_between_two_parts(share: float, rise: float) -> None:
    solid = Prism(tuple((x + 0.1, y + 0.7) for x, y in L_SHAPE.points), 1.0, 8.0)
    for part in convex_parts(solid):
        assert isinstance(part, Prism)
        for (ax, ay), (bx, by) in edges(part.points):
            x, y = ax + share * (bx - ax), ay + share * (by - ay)
            if depth(solid, (x, y, 4.0)) > 0.01:  # a seam inside the solid, not one of its walls
                assert blocks(solid, np.array([[x, y, -20.0]]), np.array([x, y, 20.0]))[0]
                assert blocks(
                    solid, np.array([[ax, ay, 4.0 + rise / 3]]), np.array([bx, by, 4.0 - rise / 3])
                )[0]


def test_a_sight_line_that_only_touches_is_free() -> None:
    eyes = np.array([[-10.0, 5.0, 3.0], [-10.0, 4.9, 3.0], [-10.0, 0.0, 9.0]])
    seen = blocks(Cylinder((0, 0), 5, 0, 9), eyes, np.array([10.0, 5.0, 3.0]))
    assert list(seen) == [False, True, True]
    assert closest_on_segment((0, 0), (1, 0), (0.5, 2)) == (0.5, 0.0)
    assert len(edges(L_SHAPE.points)) == 6


@pytest.mark.parametrize("halted", [False, True])
def test_a_bound_that_is_left_coarse_is_still_a_bound(halted: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    # Whether it need not be any closer, or too many pieces are open: what was not looked into counts.
    if halted:
        monkeypatch.setattr(proof, "OPEN_PIECES_LIMIT", 0)
    gap = 1e-6 if halted else 100.0
    hill = Piecewise(np.array([0.0, 1.0]), np.array([[[0.0, 0.0, 0.0], [0.0, 8.0, 9.0], [0.0, 0.0, 0.0]]]))
    highest = sup_norm(pieces(hill), lambda _: gap)
    assert highest.attained < hypot(4.0, 4.5) <= highest.proven
    floor = Cylinder((0.0, 20.0), 1.0, -inf, inf)
    twice = Piecewise(
        np.array([0.0, 1.0, 2.0]),
        np.array([[[0.0, 0.0, 0.0], [9.0, 6.0, 0.0], [0.0, 15.0, 0.0]], [[0.0, 15.0, 0.0]] * 3]),
    )
    wave = Piecewise(twice.breaks, twice.ctrl + np.array([0.0, -15.0, 0.0]))
    nearest = inf_distance(pieces(wave), floor, lambda _: gap)
    assert nearest.proven <= 19.0


@pytest.mark.parametrize("first", [0, 1])
def test_a_piece_that_comes_near_at_its_end_counts_however_far_its_middle(first: int) -> None:
    # The one passes level at 1.5 m over a box, the other comes down to 1 m beside it at its end.
    over = np.linspace((-5.0, 0.0, 5.5), (5.0, 0.0, 5.5), 6)
    down = np.linspace((30.0, 0.0, 3.0), (3.0, 0.0, 3.0), 6)
    curves = np.stack([over, down][:: 1 if first == 0 else -1])
    solid = Prism(((-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)), 0.0, 4.0)
    found = inf_distance(Pieces(np.array([0.0, 1.0]), np.array([1.0, 2.0]), curves), solid, fine)
    assert found.proven == pytest.approx(1.0, abs=2e-6)


def test_a_box_round_a_solid_is_no_nearer_than_it_is() -> None:
    solid = Cylinder((0.0, 0.0), 10.0, 0.0, 4.0)
    for place, gap in (
        ((13.0, 0.0, 2.0), 3.0),
        ((13.0, 14.0, 2.0), 5.0),
        ((13.0, 14.0, 16.0), 13.0),
        ((9, 9, 2), 0),
    ):
        ctrl = np.tile(np.array(place, float), (1, 6, 1))
        assert proof.box_gap(ctrl, solid)[0] == pytest.approx(gap)
        assert gap <= distance(solid, place) + 1e-12


def test_the_ceiling_of_a_zone_is_left_as_its_floor_is() -> None:
    room = Cylinder((0.0, 0.0), 50.0, 2.0, 60.0)
    rising = straight((0, 0, 30), (10, 0, 63))
    assert sup_outside(rising, room, fine).proven == pytest.approx(3.0)
    assert sup_outside(rising, room, fine, floor=False).proven == pytest.approx(3.0)


def test_a_pocket_of_a_zone_is_outside_of_it_also_where_its_hull_is_not_left() -> None:
    # Deep in the notch, a metre from the next wall, and above its floor by more.
    inside = straight((7, 7, 4), (6.5, 6.5, 4))
    assert sup_outside(inside, L_SHAPE, fine).proven > 0.0


def hill(low: float, inner: float) -> Piecewise:
    """One channel over [low, low + 1] that begins and ends at 0; all control points between are ``inner``."""
    ctrl = np.array([[0.0, inner, inner, inner, inner, 0.0]])
    return Piecewise(np.array([low, low + 1.0]), ctrl[:, :, None])


def test_a_piece_that_is_closed_early_counts_in_the_bound() -> None:
    """The first hill is 0.9375 high and within the gap of what is attained, the spike beside it is halved."""
    spike = Piecewise(np.array([2.0, 3.0]), np.array([[0.9, 0.0, 1.6, 0.0, 0.0, 0.0]])[:, :, None])
    both = join([pieces(hill(0.0, 1.0)), pieces(spike)])
    top = 0.9375
    for bound in (
        sup_channel(both, 0, lambda _: 0.5),
        sup_channel(join([pieces(spike), pieces(hill(5.0, 1.0))]), 0, lambda _: 0.5),
    ):
        assert bound.proven >= top
        assert 0.9 <= bound.attained <= bound.proven <= bound.attained + 0.5
    below = inf_channel(join([pieces(negative(hill(0.0, 1.0))), pieces(negative(spike))]), 0, lambda _: 0.5)
    assert below.attained - 0.5 <= below.proven <= -top


def negative(curve: Piecewise) -> Piecewise:
    return Piecewise(curve.breaks, -curve.ctrl)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize(
    ("off", "met"), [(-2.1, False), (-1.9, True), (0.0, True), (1.9, True), (2.1, False)]
)
def test_boxes_overlap_if_they_do_along_every_axis(axis: int, off: float, met: bool) -> None:
    solid = Prism(((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)), -1.0, 1.0)
    ctrl = np.random.default_rng(1).uniform(-1.0, 1.0, (1, 6, 3))
    ctrl[0, :2] = [[-1.0] * 3, [1.0] * 3]
    ctrl[:, :, axis] += off
    assert proof._box_overlap(ctrl, solid).tolist() == [met]
    assert proof.box_gap(ctrl, solid) == pytest.approx([max(0.0, abs(off) - 2.0)])


def test_a_curve_without_pieces_is_near_nothing() -> None:
    nothing = Pieces(np.zeros(0), np.zeros(0), np.zeros((0, 4, 3)))
    found = inf_distance(nothing, Cylinder((0.0, 0.0), 1.0, 0.0, 1.0), lambda _: 1e-6)
    assert (found.proven, found.attained, found.at) == (inf, inf, 0.0)

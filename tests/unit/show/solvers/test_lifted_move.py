"""The height of a fleet along its path: where it is required, how far it is extended, what is enough."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.ir.limits import Limits
from shotc.show.geom.arcs import Gaps
from shotc.show.solvers.lifted_move import (
    BEYOND_M,
    EXTENSION_SHARES,
    STORED_STEPS,
    WIDTH_SHARES,
    Course,
    Drive,
    Rise,
    RisingPath,
    _concave,
    _enough,
    _farthest,
    _lines,
    lifted,
    sampled,
)

FAR_M, WALL_M = 100.0, 20.0
SHARE = np.linspace(0.0, 1.0, 1001)
WALL = Rise(SHARE, np.where((SHARE > 0.4999) & (SHARE < 0.6001), WALL_M, 0.0))
"""A wall from the middle of a path of 100 m to 60 m."""


def height(line: np.ndarray, share: float) -> float:
    return float(np.interp(share, *line.T))


def test_the_drone_with_the_longest_way_tells_how_far_it_is() -> None:
    starts = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 5.0, 0.0]])
    assert _farthest((starts, starts + np.array([[1.0, 0, 0], [3.0, 4.0, 12.0], [0, 2.0, 0]]))) == 13.0


def test_heights_rise_to_a_wall_a_share_of_the_flown_length_before_it_and_fall_as_late() -> None:
    lines = [line for k, line in enumerate(_lines(FAR_M, WALL)) if k % len(WIDTH_SHARES) == 0]
    assert len(lines) == len(EXTENSION_SHARES)
    for extension, line in zip(EXTENSION_SHARES, lines, strict=True):
        before = extension * (FAR_M + 2.0 * WALL_M) / FAR_M
        for inside in (0.5 - before + 0.002, 0.6 + before - 0.002, 0.55):
            assert height(line, inside) == pytest.approx(WALL_M, abs=1e-6)
        # It is straight up to there and down from there, beside the cut of a corner between two steps.
        assert height(line, 0.25) == pytest.approx(WALL_M * 0.25 / (0.5 - before), rel=0.01)
        assert height(line, 0.9) == pytest.approx(WALL_M * 0.1 / (0.4 - before), rel=0.01)


def test_lines_begin_and_end_on_the_path_and_have_steps_of_one_flown_length() -> None:
    lines = list(_lines(FAR_M, WALL))
    for k, line in enumerate(lines):
        assert line.shape == (STORED_STEPS + 1, 2)
        assert (line[0].tolist(), line[-1].tolist()) == ([0.0, 0.0], [1.0, 0.0])
        if k % len(WIDTH_SHARES) == 0:
            flown = np.hypot(np.diff(line[:, 0]) * FAR_M, np.diff(line[:, 1]))
            assert np.median(flown) == pytest.approx(flown.mean(), rel=0.01)
            assert flown.max() <= np.median(flown) * (1.0 + 1e-9)
        else:
            half = round(WIDTH_SHARES[k % len(WIDTH_SHARES)] * STORED_STEPS)
            sharp = lines[k - k % len(WIDTH_SHARES)]
            mean = sharp[STORED_STEPS // 2 - half : STORED_STEPS // 2 + half + 1].mean(axis=0)
            assert line[STORED_STEPS // 2] == pytest.approx(mean)


@pytest.mark.parametrize("seed", range(4))
def test_the_concave_hull_is_above_all_values_and_touches_them_where_it_bends(seed: int) -> None:
    rng = np.random.default_rng(seed)
    at, values = np.cumsum(rng.uniform(0.1, 1.0, 30)), rng.uniform(0.0, 5.0, 30)
    values[[0, -1]] = 0.0
    hull = _concave(at, values)
    slopes = np.diff(hull) / np.diff(at)
    assert (hull >= values - 1e-12).all()
    assert (np.diff(slopes) <= 1e-9).all()
    bends = np.flatnonzero(np.diff(slopes) < -1e-9) + 1
    assert len(bends)
    assert hull[bends] == pytest.approx(values[bends])


def test_a_height_is_enough_if_it_is_beyond_all_that_is_required_and_no_more() -> None:
    points = np.array([0.0, 0.0, 0.0, 1.0, 3.0, 2.0, 0.0, 0.0, 0.0])
    need = 1.5 * sampled(points) ** 2
    factor = _enough(points, need)
    assert (factor * sampled(points) - need)[need > 1e-3].min() == pytest.approx(BEYOND_M)
    assert _enough(points, np.zeros(len(need))) == 1.0
    assert _enough(0.0 * points, need) == np.inf


@pytest.mark.parametrize("easing", ["linear"])
def test_a_fleet_rises_over_a_wall_whatever_its_easing(easing: str) -> None:
    """A move at one speed has no profile of few pieces: it has more."""
    starts = np.array([[0.0, 0.0, 10.0], [0.0, 3.0, 10.0]])
    ends = (starts, starts + np.array([FAR_M, 0.0, 0.0]))
    path = RisingPath(np.column_stack([1.0 - SHARE, SHARE]), WALL)
    limits = Limits(5.0, 2.5, 2.0, 2.5, 8.0, 1.0, 1.0)
    move = lifted(ends, Course(np.zeros(3)), [path], Drive(limits, 1.0, easing))  # type: ignore[arg-type]
    assert move is not None
    assert WALL_M <= move.height < 1.3 * WALL_M
    share, height = sampled(move.ctrl[:, 1]), sampled(move.lift)
    assert WALL_M <= height[(share > 0.5) & (share < 0.6)].min() <= WALL_M + 2.0 * BEYOND_M
    assert BEYOND_M <= 0.1
    for flown, way, up in zip(move.between(*ends), move.ctrl[3:-3, 1], move.lift[3:-3], strict=True):
        assert flown == pytest.approx(starts + np.array([way * FAR_M, 0.0, up]))
    assert move.duration == pytest.approx(move.piece * move.pieces)
    assert move.duration > 100.0 / 5.0


def test_arcs_are_free_where_the_formations_are_a_separation_apart_on_them() -> None:
    """Between formations without share to spare, a is 1 until b is 1."""
    around, straight = (
        np.array([[1.0, 0.0], *[middle] * 3, [0.0, 1.0]])[[0, 0, 0, 1, 2, 3, 4, 4, 4]]
        for middle in ((1.5, 1.5), (0.5, 0.5))
    )
    course = Course(np.zeros(3), Gaps(1.0, 1.0))
    assert course.free(np.stack([around, straight])).tolist() == [True, False]
    assert Course(np.zeros(3)).free(np.stack([around, straight])).all()

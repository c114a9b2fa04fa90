"""How short the pieces of a move may be."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.ir.show import Easing
from shotc.show.geom.arcs import Gaps
from shotc.show.solvers.arc_move import ArcMove, fastest_arc
from shotc.show.solvers.move import (
    EVEN_SHARE,
    LIMIT_SHARE,
    PIECES,
    WORTH_RATIO,
    CommonMove,
    Ramps,
    family,
    fastest,
    least_piece,
    least_pieces,
    profile,
    ramps_of,
)
from tests.support.fleet_scenes import LIMITS

LIMITED = ("speed", "climb", "descent", "acceleration", "jerk")
EASINGS: tuple[Easing, ...] = ("ease-in-out", "linear", "ease-in", "ease-out")


@pytest.mark.parametrize("pieces", [3, 5, 20])
def test_all_drones_at_once_are_as_slow_as_each_alone(pieces: int) -> None:
    ways = np.random.default_rng(0).normal(scale=10.0, size=(30, 3))
    ways[3] = 0.0
    alone = [least_piece(pieces, way[None], LIMITS) for way in ways]
    assert np.array_equal(least_pieces(pieces, ways, LIMITS), alone)
    assert least_piece(pieces, ways, LIMITS) >= max(alone) * (1 - 1e-12)


@pytest.mark.parametrize("far", [0.5, 4.0, 40.0, 400.0])
def test_a_move_takes_hardly_longer_than_any_shape_of_any_number_of_pieces(far: float) -> None:
    ways = np.array([[far, 0.0, 0.0], [0.0, 0.3 * far, 0.1 * far]])
    move = fastest(ways, LIMITS, 1.0)
    shortest = min(pieces * least_piece(pieces, ways, LIMITS) for pieces in PIECES)
    assert move.duration <= 1.002 * WORTH_RATIO * shortest
    assert move.duration >= far / (LIMIT_SHARE * LIMITS.speed)


def test_a_pace_is_a_share_of_every_limit() -> None:
    ways = np.array([[9.0, 2.0, 1.0]])
    half = LIMITS._replace(**{name: 0.5 * getattr(LIMITS, name) for name in LIMITED})
    assert fastest(ways, LIMITS, 0.5).piece == fastest(ways, half, 1.0).piece


@pytest.mark.parametrize(
    ("ways", "changes", "limit", "drone"),
    [
        ([[1.0, 0.0, 0.0], [900.0, 0.0, 0.0]], {}, "speed", 1),
        ([[1.0, 0.0, 0.0], [1.0, 0.0, 900.0]], {}, "climb", 1),
        ([[0.0, 0.0, -900.0], [1.0, 0.0, 9.0]], {}, "descent", 0),
        ([[9.0, 0.0, 0.0], [1.0, 0.0, 0.0]], {"acceleration": 0.01}, "acceleration", 0),
        ([[9.0, 0.0, 0.0], [0.0, 0.0, 10.0]], {"jerk": 0.01}, "jerk", 1),
    ],
)
def test_the_limit_that_is_by_far_the_tightest_binds_the_drone_with_the_longest_way(
    ways: list[list[float]], changes: dict[str, float], limit: str, drone: int
) -> None:
    move = fastest(np.array(ways), LIMITS._replace(**changes), 1.0)
    assert (move.limit, move.drone) == (limit, drone)


@pytest.mark.parametrize("ramps", [Ramps(0.2, 0.5, 0.5, 0.8), Ramps(0.5, 0.2, 0.8, 0.5)])
def test_the_peaks_of_a_profile_are_those_of_its_derivatives(ramps: Ramps) -> None:
    at = np.linspace(0.0, 1.0, 4001)
    s = profile(at, ramps)
    for order, peak in enumerate(ramps.peaks, 1):
        s = np.diff(s) * 4000.0
        assert np.abs(s).max() == pytest.approx(peak, rel=2e-3), order


def speeds(move: CommonMove) -> Array:
    """Control points of s' over the time of the move: what is between them lies in their hull."""
    return np.asarray(np.diff(move.s) * move.pieces)


@pytest.mark.parametrize("far", [2.0, 20.0, 200.0])
@pytest.mark.parametrize("easing", EASINGS)
def test_a_move_speeds_up_once_and_slows_down_once_as_its_easing_says(easing: Easing, far: float) -> None:
    ways = np.array([[far, 0.0, 0.0], [0.0, 0.3 * far, 0.1 * far]])
    move = fastest(ways, LIMITS, 1.0, easing)
    assert (move.s[:3] == 0.0).all()
    assert (move.s[-3:] == 1.0).all()
    rate = speeds(move)
    up = np.diff(rate)
    turns = np.flatnonzero(np.abs(up) > 1e-9)
    assert (np.diff(np.sign(up[turns])) <= 0.0).all()  # up, then down, never up again
    half = float(np.interp(0.5 * (move.pieces + 2), np.arange(move.pieces + 3), move.s))
    # Of CSS: cubic-bezier(0.42, 0, 1, 1) is at 0.315 half-way, and ease-out at 0.685.
    low, high = {"ease-in": (0.25, 0.38), "ease-out": (0.62, 0.75)}.get(easing, (0.499, 0.501))
    assert low <= half <= high
    if easing == "linear":
        assert rate.max() <= 1.0 / EVEN_SHARE
    assert move.duration >= fastest(ways, LIMITS, 1.0).duration / WORTH_RATIO
    for way in ways:
        shares = [np.abs(np.diff(move.s, k)).max() / move.piece**k for k in (1, 2, 3)]
        across = float(np.hypot(*way[:2]))
        assert shares[0] * across <= LIMITS.speed
        assert shares[0] * way[2] <= LIMITS.climb
        assert shares[1] * np.linalg.norm(way) <= LIMITS.usable_acceleration
        assert shares[2] * np.linalg.norm(way) <= LIMITS.jerk


def test_slow_at_the_end_is_slow_at_the_beginning_flown_back() -> None:
    ways = np.array([[30.0, 0.0, 0.0]])
    one, other = (fastest(ways, LIMITS, 1.0, easing) for easing in ("ease-in", "ease-out"))
    assert one.piece == other.piece
    assert np.allclose(one.s, 1.0 - other.s[::-1], atol=1e-12)


def test_arcs_are_flown_by_the_easing() -> None:
    # Two level sheets, as dense as they may be, one turned by a right angle and matched that way.
    sheet = np.array([[1.5 * (k % 6 - 2.5), 1.5 * (k // 6 - 2.5), 0.0] for k in range(36)])
    ends = sheet, sheet[:, [1, 0, 2]] * np.array([-1.0, 1.0, 1.0])

    def share(easing: Easing) -> float:
        """How much of the quarter turn is flown after half of the time."""
        move = fastest_arc(ends, np.zeros(3), Gaps(1.0, 1.0), LIMITS, 1.0, easing)
        assert isinstance(move, ArcMove)
        at = 0.5 * (move.pieces + 2)
        a, b = (np.interp(at, np.arange(move.pieces + 3), move.ctrl[:, k]) for k in range(2))
        return float(np.arctan2(b, a) / (np.pi / 2))

    first, even, both, last = map(share, ("ease-in", "linear", "ease-in-out", "ease-out"))
    assert even == pytest.approx(0.5, abs=0.02)
    assert both == pytest.approx(0.5, abs=0.02)
    assert first < 0.4
    assert last > 0.6


@pytest.mark.parametrize("easing", ["ease-in-out", "linear", "ease-in", "ease-out"])
def test_every_profile_that_is_tried_goes_from_rest_to_rest_and_never_back(easing: Easing) -> None:
    shapes, steps = family(20, easing)
    assert (shapes[:, :3] == 0.0).all()
    assert (shapes[:, -3:] == 1.0).all()
    assert np.diff(shapes, axis=1).min() >= -1e-12
    for order in (1, 2, 3):
        most = np.abs(np.diff(shapes, order, axis=1)).max(axis=1)
        assert steps[:, order - 1] == pytest.approx(most)
    if easing in {"ease-in", "ease-out"}:
        half = shapes[:, shapes.shape[1] // 2]
        assert (half < 0.45).all() if easing == "ease-in" else (half > 0.55).all()


@pytest.mark.parametrize("easing", EASINGS)
def test_both_ramps_of_a_profile_fit_into_its_time(easing: Easing) -> None:
    for ramps in ramps_of(easing):
        assert ramps.up + ramps.down <= 1.0 + 1e-12
        assert 0.0 < min(ramps.up_jerk, ramps.down_jerk) <= max(ramps.up_jerk, ramps.down_jerk) <= 1.0

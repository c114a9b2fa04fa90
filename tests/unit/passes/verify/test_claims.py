"""When a limit holds: its tolerance on both sides, bounds above and below, and what a claim says."""

from __future__ import annotations

from math import inf

import pytest

from shotc.geom.proof import ProvedExtreme
from shotc.geom.surface.ground import NoGround
from shotc.passes.verify.claims import Limit, WorstValue, bounded, claim, gap, held, known, less, slack
from tests.support.plain_flights import plain_flight, plain_mission

PATH = ("rules", "it")


@pytest.mark.parametrize(
    ("limit", "tolerance"), [(0.0, 1e-6), (0.5, 1e-6), (-0.5, 1e-6), (1.0, 1e-6), (8.0, 8e-6), (-300.0, 3e-4)]
)
@pytest.mark.parametrize("upper", [True, False])
def test_a_limit_holds_up_to_a_millionth_of_it_or_of_its_unit(
    limit: float, tolerance: float, upper: bool
) -> None:
    assert slack(limit) == pytest.approx(tolerance)
    sign = 1.0 if upper else -1.0
    for share, holds in ((-9.0, True), (0.0, True), (0.99, True), (1.01, False), (1e6, False)):
        worst = WorstValue(limit + sign * share * tolerance)
        assert held("cam", Limit("it", limit, "m", PATH, upper=upper), worst).holds == holds


@pytest.mark.parametrize("limit", [inf, -inf])
@pytest.mark.parametrize("worst", [-inf, 0.0, inf])
@pytest.mark.parametrize("upper", [True, False])
def test_a_limit_without_a_number_always_holds(limit: float, worst: float, upper: bool) -> None:
    assert slack(limit) == 0.0
    assert held("cam", Limit("it", limit, "m", PATH, upper=upper), WorstValue(worst)).holds


@pytest.mark.parametrize(("upper", "worst"), [(True, inf), (False, -inf)])
def test_what_is_proved_of_nothing_breaks_a_limit(upper: bool, worst: float) -> None:
    assert not held("cam", Limit("it", 5.0, "m", PATH, upper=upper), WorstValue(worst)).holds


def test_a_claim_says_all_that_its_limit_and_its_worst_value_do() -> None:
    limit = Limit("it", 5, "m", PATH, upper=False, hard=False, shot="half")  # type: ignore[arg-type]
    found = held("cam", limit, WorstValue(6, 2.0, "sampled", (1.0, 2.0, 3.0)), ("one", "two"))  # type: ignore[arg-type]
    assert (found.constraint, found.subject, found.shot, found.unit) == ("it", "cam", "half", "m")
    assert (found.upper, found.hard, found.holds) == (False, False, True)
    assert (found.time, found.position, found.method) == (2.0, (1.0, 2.0, 3.0), "sampled")
    assert (found.path, found.drones) == (PATH, ("one", "two"))
    assert isinstance(found.limit, float)
    assert isinstance(found.worst, float)


def test_a_claim_of_a_drone_has_the_place_at_its_time() -> None:
    flight = plain_flight(plain_mission())
    limit = Limit("it", 5.0, "m", PATH)
    assert claim(flight, limit, WorstValue(1.0, 9.0)).position == pytest.approx((20.0, 0.0, 10.0))
    assert claim(flight, limit, WorstValue(1.0)).position is None
    given = WorstValue(1.0, 9.0, position=(7.0, 7.0, 7.0))
    assert claim(flight, limit, given).position == (7.0, 7.0, 7.0)
    found = bounded(flight, limit, ProvedExtreme(4.0, 3.0, 9.0))
    assert (found.worst, found.time, found.method, found.subject) == (4.0, 9.0, "bounded", "cam1")
    assert (found.upper, found.hard, found.shot) == (True, True, None)


@pytest.mark.parametrize(
    ("limit", "worst", "expected"),
    [
        (8.0, 8.0, 4e-6),
        (0.0, 0.0, 5e-7),
        (8.0, 8.03, 4e-6),
        (8.0, 18.0, 1e-3),
        (8.0, -12.0, 2e-3),
        (inf, 3.0, inf),
    ],
)
def test_bounds_are_closed_to_half_of_the_tolerance_near_a_limit(
    limit: float, worst: float, expected: float
) -> None:
    assert gap(limit)(worst) == pytest.approx(expected)


def test_the_surface_of_a_body_is_its_radius_nearer() -> None:
    assert less(ProvedExtreme(4.0, 5.0, 2.0), 0.5) == ProvedExtreme(3.5, 4.5, 2.0)


@pytest.mark.parametrize("unknown", [inf, -inf])
def test_off_the_terrain_nothing_is_proved(unknown: float) -> None:
    off = NoGround(3.0, (1.0, 2.0), 4.0)
    assert known(off, unknown) == ProvedExtreme(unknown, unknown, 3.0)
    bound = ProvedExtreme(1.0, 2.0, 3.0)
    assert known(bound, unknown) is bound

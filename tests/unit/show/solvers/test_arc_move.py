"""What moves with common scalars need of the limits, and how the time along their paths follows from it."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.ir.limits import Limits
from shotc.show.solvers.arc_move import ASKED_SHARE, SMOOTHED_SHARE, Drones, times_of
from shotc.show.solvers.move import LIMIT_SHARE, TICK_S

LIMITS = Limits(5.0, 2.5, 2.0, 3.0, 8.0, 1.0, 1.0)
SPEED, CLIMB, DESCENT, ACCELERATION, JERK = (LIMIT_SHARE * m for m in (5.0, 2.5, 2.0, 3.0, 8.0))
FROM, TO = np.array([[0.0, 0.0, 10.0], [0.0, 0.0, 10.0]]), np.array([[30.0, 40.0, 10.0], [6.0, 8.0, 10.0]])
LINE = np.column_stack([np.linspace(1.0, 0.0, 401), np.linspace(0.0, 1.0, 401)])


def drones() -> Drones:
    return Drones.of((FROM, TO), np.zeros(3), LIMITS, 1.0)


@pytest.mark.parametrize(
    ("order", "rate", "rising", "share"),
    [
        (1, (-0.1, 0.1), 0.0, 5.0 / SPEED),
        (1, (-0.1, 0.1), 4.0, 4.0 / CLIMB),
        (1, (-0.1, 0.1), -4.0, 4.0 / DESCENT),
        (2, (-0.1, 0.1), 0.0, 5.0 / ACCELERATION),
        (2, (-0.1, 0.1), 12.0, 13.0 / ACCELERATION),
        (3, (0.1, -0.1), -12.0, 13.0 / JERK),
    ],
)
def test_the_busiest_drone_tells_the_share_of_a_limit(
    order: int, rate: tuple[float, float], rising: float, share: float
) -> None:
    """The first drone goes 50 m, the second one 10 m."""
    found = drones().shares(np.array([rate]), order, np.array([rising]))
    assert found == pytest.approx([share])


@pytest.mark.parametrize(
    ("limit", "lift", "piece"),
    [
        ("speed", (0.0, 0.0, 0.0, 0.0, 0.0), 0.49 * 50.0 / SPEED),
        ("climb", (0.0, 0.0, 40.0, 20.0, 0.0), 40.0 / CLIMB),
        ("descent", (0.0, 20.0, 40.0, 0.0, 0.0), 40.0 / DESCENT),
        ("acceleration", (0.0, 0.0, 0.0, 0.0, 0.0), (0.48 * 50.0 / ACCELERATION) ** (1 / 2)),
        ("jerk", (0.0, 0.0, 0.0, 0.0, 0.0), (0.48 * 50.0 / JERK) ** (1 / 3)),
    ],
)
def test_a_move_tells_the_limit_and_the_drone_that_hold_it_back(
    limit: str, lift: tuple[float, ...], piece: float
) -> None:
    """All limits but the one are a thousand times higher, or those of speeds a hundred times."""
    others = {name: 1e3 * getattr(LIMITS, name) for name in ("acceleration", "jerk") if name != limit}
    if limit in {"acceleration", "jerk"}:
        others |= {name: 1e2 * getattr(LIMITS, name) for name in ("speed", "climb", "descent")}
    ctrl = np.array([[1.0, 0.0], [0.99, 0.01], [0.5, 0.5], [0.01, 0.99], [0.0, 1.0]])
    found = Drones.of((FROM, TO), np.zeros(3), LIMITS._replace(**others), 1.0).binding(ctrl, np.array(lift))
    assert (found.limit, found.piece) == (limit, pytest.approx(piece))
    assert found.drone == 0 or limit in {"climb", "descent"}
    assert 0.0 <= found.ticks - found.piece < TICK_S


def test_the_time_along_a_path_follows_what_speed_and_acceleration_need_of_their_limits() -> None:
    """Under a parabola of height H the share of the path u is passed as 1 / (4 H |1 - 2 u|) allows."""
    peak, u = 100.0, np.linspace(0.0, 1.0, 401)
    passed = times_of(drones(), LINE, 4.0 * peak * u * (1.0 - u))
    climb = 4.0 * peak * np.abs(1.0 - 2.0 * u) / np.where(u < 0.5, CLIMB, DESCENT)
    needs = np.hypot(np.maximum(climb, 50.0 / SPEED), np.sqrt(8.0 * peak / ACCELERATION / ASKED_SHARE))
    expected = np.concatenate([[0.0], np.cumsum(0.5 * (needs[1:] + needs[:-1]))])
    assert passed == pytest.approx(expected / expected[-1], abs=0.2 * SMOOTHED_SHARE)
    assert (np.diff(passed) > 0.0).all()


def test_a_part_that_needs_acceleration_takes_longer_by_what_that_is_of_its_limit() -> None:
    """Level for the first half of 5 m, then along a parabola with an acceleration of 6 m."""
    short = Drones.of((FROM, 0.9 * FROM + 0.1 * TO), np.zeros(3), LIMITS, 1.0)
    u = np.linspace(0.0, 1.0, 401)
    passed = times_of(short, LINE, 3.0 * np.maximum(u - 0.5, 0.0) ** 2)
    speeds = np.maximum(5.0 / SPEED, 6.0 * np.maximum(u - 0.5, 0.0) / CLIMB)
    needs = np.where(u > 0.5, np.hypot(speeds, np.sqrt(6.0 / ACCELERATION / ASKED_SHARE)), speeds)
    expected = np.concatenate([[0.0], np.cumsum(0.5 * (needs[1:] + needs[:-1]))])
    assert passed == pytest.approx(expected / expected[-1], abs=0.2 * SMOOTHED_SHARE)


def test_whoever_stays_has_the_same_time_for_every_part() -> None:
    still = Drones.of((FROM, FROM), FROM[0], LIMITS, 1.0)
    assert times_of(still, LINE) == pytest.approx(np.linspace(0.0, 1.0, 401))


def test_a_path_that_stays_for_a_while_has_a_time_for_every_part_that_grows() -> None:
    share = np.interp(np.linspace(0.0, 1.0, 401), [0.0, 0.3, 0.7, 1.0], [0.0, 0.5, 0.5, 1.0])
    passed = times_of(drones(), np.column_stack([1.0 - share, share]))
    assert (np.diff(passed) > 0.0).all()
    assert passed[240] - passed[160] < 1e-3


def test_a_piece_lasts_until_the_largest_share_of_a_limit_is_one() -> None:
    rng = np.random.default_rng(4)
    ctrl = np.cumsum(rng.uniform(0.0, 0.2, (5, 9, 2)), axis=1)
    lift = rng.uniform(0.0, 3.0, (5, 9))
    seconds = drones().least_pieces(ctrl, lift)
    for k in range(5):
        assert drones().least_pieces(ctrl[k], lift[k]) == seconds[k]
        shares = [
            drones().shares(np.diff(ctrl[k], n, axis=0), n, np.diff(lift[k], n)).max() / seconds[k] ** n
            for n in (1, 2, 3)
        ]
        assert max(shares) == pytest.approx(1.0)

"""D086: drones for which no flight was found that keeps them apart, and the time in which there is one."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.geom.separation import Nearest, closest
from shotc.ir.fleet import GoalIR
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.show import Apart
from shotc.ir.trajectory import TrajectoryIR
from shotc.show.assignment import AssignGoals, order
from shotc.show.separation import KeepApart
from shotc.show.separation.faults import RepairAttempts, too_near
from shotc.show.separation.longer import MoveBetweenStops
from shotc.show.solvers.qcqp import DerivativeBounds, overdraft
from shotc.show.splines import BoundSplines
from tests.support.fleet_scenes import LIMITS, animation, display, fleet, goals, morph, picture

RADIUS = 4.0
WIDE = Apart("ellipsoid", 1.3, 2.8, 0.1)


@pytest.fixture(autouse=True)
def one_thread() -> Iterator[None]:
    """As the command plans: threads only hinder algebra as small as this."""
    with threadpool_limits(1, "blas"):
        yield


def ring(count: int, turned: float = 0.0) -> Array:
    angle = 2.0 * np.pi * np.arange(count) / count + turned
    return np.stack([RADIUS * np.cos(angle), RADIUS * np.sin(angle), 0 * angle + 40.0], axis=1)


def planned(ir: GoalIR, said: list[str] | None = None) -> Outcome[TrajectoryIR]:
    ctx = PassContext(seed=1, progress=([] if said is None else said).append)
    show = AssignGoals().run(ir, ctx).value
    assert show is not None
    bound = BoundSplines().run(show, ctx).value
    assert bound is not None
    return KeepApart().run(bound, ctx)


def half_a_turn(period: float) -> GoalIR:
    """A ring that is turned by half a turn, with hardly time to go straight through its middle."""
    frames = [ring(12, np.pi * k / 13) for k in range(14)]
    return goals((fleet(12, apart=WIDE),), (display(animation(14, period)),), {"show": [frames]})


def swapped(transition: float) -> GoalIR:
    shown = display(picture(), picture(transition=transition))
    return goals((fleet(8),), (shown,), {"show": [[ring(8)], [ring(8)]]})


def apart(ir: TrajectoryIR, asked: Apart) -> None:
    flight = ir.fleets[0]
    assert closest(flight.breaks, flight.coef, asked).proven >= asked.across - 1e-6
    assert (overdraft(flight.breaks, flight.coef, DerivativeBounds(LIMITS)) <= 0.0).all()


def told(found: Diagnostic, key: str) -> float:
    assert found.code == "D086"
    assert found.help is not None
    assert f"`{key}: " in found.help
    return float(found.help.split(f"`{key}: ")[1].split("`")[0])


@pytest.mark.long
def test_a_period_that_is_too_short_comes_with_one_that_does() -> None:
    said: list[str] = []
    (found,) = planned(half_a_turn(0.27), said).diagnostics
    assert "0.90 m of each other" in found.message
    assert "the separation is 1.40 m" in found.message
    assert found.notes[0].startswith("they are `swarm-")
    best = float(found.notes[1].split("keeps ")[1].split(" m")[0])
    assert 0.88 <= best < 1.4
    period = told(found, "period")
    assert 0.27 < period <= 0.35
    done = planned(half_a_turn(period)).value
    assert done is not None
    apart(done, WIDE)
    # It is the least: a little less time is not enough.
    assert planned(half_a_turn(round(period - 0.02, 2))).value is None
    assert any(f"would `period: {period:.2f}` do" in text for text in said)


@pytest.mark.fuzz
@pytest.mark.slow
def test_a_transition_that_is_too_short_comes_with_one_that_does(monkeypatch: pytest.MonkeyPatch) -> None:
    """All swap sides through the middle, which no matching of ours would have them do."""
    kindly = order.matched

    def across(starts: Array, ends: Array) -> Array:
        low = min(starts[:, 2].min(), ends[:, 2].min())
        away = np.linalg.norm(starts[:, None] - ends, axis=2)
        return np.asarray(away.argmax(axis=1)) if low > 15.0 else kindly(starts, ends)

    monkeypatch.setattr(order, "matched", across)
    (found,) = planned(swapped(3.85)).diagnostics
    transition = told(found, "transition")
    assert 3.85 < transition < 6.0
    done = planned(swapped(transition)).value
    assert done is not None
    apart(done, fleet(8).apart)


def test_pads_too_near_for_any_way_are_to_be_laid_out_wider() -> None:
    """Straight ways cannot fail from pads as far apart as goals are, so that is a remedy without a try."""
    ir = morph(8)
    show = AssignGoals().run(ir, PassContext()).value
    assert show is not None
    flight, mission = show.fleets[0], ir.keyframes.mission
    near = Nearest(0.4, 0.5, 1, 2, 12.0, (0.0, 0.0, 20.0))
    for start, end in (
        (flight.phases[1].start, flight.phases[1].end),
        (flight.phases[-2].start, flight.phases[-2].end),
    ):
        a, b = (int(np.abs(flight.breaks - t).argmin()) for t in (start, end))
        stretch = MoveBetweenStops.of(flight, flight.breaks[a : b + 1], flight.coef[:, a : b + 3])
        found = too_near(mission, mission.fleets[0], stretch, RepairAttempts(near, 0.4, None))
        assert found.help == "put the pads 1.42 m or more apart"
        assert stretch.key == "transition"
        assert (stretch.shown is None) == (start > flight.shown[-1].end - 1e-6)


def test_what_nothing_helps_is_to_be_larger() -> None:
    show = AssignGoals().run(half_a_turn(0.5), PassContext()).value
    assert show is not None
    flight, mission = show.fleets[0], show.goals.keyframes.mission
    a, b = (int(np.abs(flight.breaks - flight.shown[k].start).argmin()) for k in (0, -1))
    stretch = MoveBetweenStops.of(flight, flight.breaks[a : b + 1], flight.coef[:, a : b + 3])
    assert (stretch.key, stretch.pieces) == ("period", 1)
    assert stretch.lasting(0.5) == pytest.approx(stretch.breaks, abs=1e-9)
    near = Nearest(0.4, 0.5, 1, 2, 12.0, (0.0, 0.0, 20.0))
    found = too_near(mission, mission.fleets[0], stretch, RepairAttempts(near, 0.678, None))
    assert found.help is not None
    assert "larger" in found.help
    assert "keeps 0.67 m" in found.notes[1]

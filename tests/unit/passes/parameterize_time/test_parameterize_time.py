"""parameterize-time on paths made by hand: exact times, holds, starts, joints, and faults with numbers."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi, radians

import numpy as np
import pytest

from shotc.diag.model import Span
from shotc.geom.bernstein import Piecewise
from shotc.ir.limits import Limits
from shotc.ir.passes import PassContext
from shotc.ir.path import Stop
from shotc.passes.parameterize_time import ParameterizeTime
from shotc.planning.timing import move as move_module
from shotc.planning.timing.leg import fastest_moves, plan_of, timed_once
from shotc.solvers.conic import Status
from tests.support.records import replace
from tests.support.timed_flights import (
    FORTY,
    FROM,
    TO,
    faults,
    number_before,
    shot_time,
    straight,
    timed,
)
from tests.support.timing_paths import (
    CEILING,
    HFOV,
    circle,
    flight,
    jumps,
    line,
    mission,
    s_curve_time,
    shot_leg,
    shot_phase,
    smooth,
    uses,
)

pytestmark = pytest.mark.slow


@pytest.fixture
def anew() -> Iterator[None]:
    """No move is at hand from before, and none is left for others."""
    timed_once.cache_clear()
    yield
    timed_once.cache_clear()


class TestFlight:
    def test_phases_cover_the_flight_without_gaps(self) -> None:
        drone = timed(flight(mission(), straight())).drones[0]
        assert drone.curve.start == 0.0
        assert [p.name for p in drone.phases] == ["takeoff", "transit", "shot", "land"]
        ends = [p.end for p in drone.phases]
        assert [p.start for p in drone.phases] == [0.0, *ends[:-1]]
        assert ends[-1] == drone.curve.end

    def test_the_whole_curve_is_c2_and_within_limits_and_ends_at_rest(self) -> None:
        leg = shot_leg(smooth(3), pace=0.75)
        drone = timed(flight(mission(), leg)).drones[0]
        value, rate, acceleration = jumps(drone.curve)
        assert value < 1e-9
        assert rate < 1e-8
        assert acceleration < 1e-6
        assert max(uses(drone.curve, CEILING).values()) <= 1.0
        assert np.abs(drone.curve.derivative(1).ctrl[-1, -1]).max() == 0.0
        assert np.diff(drone.curve.breaks).min() > 1e-6

    def test_the_shot_flies_its_path_from_end_to_end(self) -> None:
        ir = timed(flight(mission(), shot_leg(circle(20, pi))))
        start, end = shot_phase(ir)
        t = np.linspace(start, end, 300)
        p = ir.drones[0].curve(t)
        assert np.hypot(p[:, 0], p[:, 1]) == pytest.approx(20.0, abs=1e-3)
        assert p[0] == pytest.approx(circle(20, pi)(0.0))
        assert p[-1] == pytest.approx(circle(20, pi)(20 * pi))
        assert (np.diff(np.arctan2(p[:, 1], p[:, 0] + 1e-9)) >= -1e-9).all()

    def test_statistics_tell_how_each_move_was_timed(self) -> None:
        stats = dict(timed(flight(mission(), straight())).stats)
        assert stats["shot half move 0 topp_time"] == pytest.approx(40 / 8 + 8 / 3, rel=5e-3)
        assert stats["shot half move 0 time"] == pytest.approx(FORTY, rel=0.02)
        assert 1.0 <= float(stats["shot half move 0 scale"]) < 1.03
        assert {"cam1 takeoff 0 move 0 cells", "cam1 transit 1 move 0 steps"} <= stats.keys()

    def test_runs_are_equal_to_the_last_bit(self) -> None:
        curves = []
        for _ in range(2):
            timed_once.cache_clear()
            curves.append(timed(flight(mission(), straight(duration=11.0))).drones[0].curve)
        a, b = curves
        assert a.ctrl.tobytes() == b.ctrl.tobytes()
        assert a.breaks.tobytes() == b.breaks.tobytes()

    def test_paths_of_the_same_numbers_are_timed_once(self) -> None:
        curve = circle(20, pi)
        leg, again, other = (
            shot_leg(path)
            for path in (curve, Piecewise(curve.breaks.copy(), curve.ctrl.copy()), circle(21, pi))
        )
        (first,), (same,), (another,) = (fastest_moves(x, plan_of(x), CEILING) for x in (leg, again, other))
        assert same is first
        assert another.duration != first.duration


class TestRough:
    @pytest.mark.usefixtures("anew")
    def test_where_the_solver_gives_up_the_flight_is_slower_and_says_so(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(move_module, "rate_of_line", lambda _path, _span: None)
        monkeypatch.setattr(move_module, "retime", lambda _problem, around: (Status.FAILED, around))
        outcome = ParameterizeTime().run(flight(mission(), straight()), PassContext())
        assert outcome.value is not None
        assert {d.code for d in outcome.diagnostics} == {"T006"}
        shot = next(d for d in outcome.diagnostics if "shot `half`" in d.message)
        assert shot.labels[0].span == mission().origins.keys["shots", 0]
        assert "jerk 8.00 m/s^3" in shot.notes[0]
        assert max(uses(outcome.value.drones[0].curve, CEILING).values()) <= 1.0
        start, end = shot_phase(outcome.value)
        assert FORTY < end - start < 1.5 * FORTY


class TestEndurance:
    def test_too_long_a_flight_lists_its_phases_longest_first(self) -> None:
        (fault,) = faults(flight(mission(endurance=60.0), straight(duration=80.0)))
        assert fault.code == "T004"
        assert "60 s" in fault.message
        assert fault.notes[0].index("shot `half` 80.0 s") < fault.notes[0].index("transit")
        assert fault.labels[0].span == mission().origins.values["drones", "cam1", "endurance"]
        over = number_before(fault.help, " s, cut", after="by ")
        shot_time(straight(duration=80.0 - over), mission(endurance=60.0))

    def test_where_the_power_is_written_no_other_endurance_is_proposed(self) -> None:
        written = mission(endurance=60.0)
        of_power = {("drones", "cam1", "power"): Span(6, 30, 6, 40)}
        keys = {**written.origins.keys, **of_power}
        written = replace(written, origins=written.origins._replace(keys=keys))
        (fault,) = faults(flight(written, straight(duration=80.0)))
        assert fault.labels[0].span == Span(6, 30, 6, 40)
        assert "`endurance:" not in fault.help
        assert "a battery that hovers" in fault.help


class TestAngles:
    def test_a_turn_on_the_spot_between_moves_is_a_move_of_its_own(self) -> None:
        turned = (*TO[:3], radians(90), 0.0, radians(90), HFOV)
        go, turn = line(FROM, TO), line(TO, turned)
        both = Piecewise(
            np.concatenate([go.breaks, 40.0 + turn.breaks[1:]]), np.concatenate([go.ctrl, turn.ctrl])
        )
        stops = (Stop(0.0, 0.0), Stop(40.0, 0.0), Stop(both.end, 0.0))
        ir = timed(flight(mission(), shot_leg(both, stops=stops)))
        assert "shot half move 1 time" in dict(ir.stats)
        assert max(uses(ir.drones[0].curve, CEILING).values()) <= 1.0
        assert ir.drones[0].curve(shot_phase(ir)[1])[3] == pytest.approx(radians(90))

    def test_slow_gimbals_hold_the_drone_back_and_are_named(self) -> None:
        away = (*TO[:4], radians(-60), 0.0, HFOV)
        gimbal = replace(mission().drones[0].gimbal, rate=radians(5))
        slow = mission(gimbal=gimbal)
        leg = shot_leg(line(FROM, away), duration=8.5)
        (fault,) = faults(flight(slow, leg))
        assert "gimbal rate 5.00 deg/s" in fault.notes[1]
        assert number_before(fault.message, " s is the shortest") > 12.0


def test_limits_so_low_that_the_flight_takes_minutes_still_hold() -> None:
    limits = Limits(0.5, 0.4, 0.3, 0.2, 0.1, radians(3), radians(3))
    ir = timed(flight(mission(limits=limits), straight()))
    low = replace(
        CEILING,
        speed=0.5,
        climb=0.4,
        descent=0.3,
        acceleration=0.2,
        jerk=0.1,
        yaw_rate=radians(3),
        yaw_acceleration=radians(3),
    )
    assert max(uses(ir.drones[0].curve, low).values()) <= 1.0
    assert shot_time(straight(), mission(limits=limits)) <= 1.02 * s_curve_time(40.0, 0.5, 0.2, 0.1)

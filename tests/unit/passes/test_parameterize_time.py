"""parameterize-time on paths made by hand: exact times, holds, starts, joints, and faults with numbers."""

from __future__ import annotations

from math import pi, radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.diag.model import Diagnostic
from shotc.diag.registry import registry
from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.ir.mission import Limits, MissionIR, Timing
from shotc.ir.path import FramingSpan, Leg, Mark, PathIR, Stop
from shotc.ir.trajectory import TrajectoryIR
from shotc.passes.base import PassContext
from shotc.passes.parameterize_time import ParameterizeTime
from shotc.passes.parameterize_time import move as move_module
from shotc.solvers.conic import Status
from tests.records import replace
from tests.timing_paths import (
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

FROM = (0.0, 0.0, 10.0, 0.0, 0.0, 0.0, HFOV)
TO = (40.0, 0.0, 10.0, 0.0, 0.0, 0.0, HFOV)
FORTY = s_curve_time(40.0, 8.0, 3.0, 8.0)


def straight(**changes: object) -> Leg:
    return shot_leg(line(FROM, TO), FROM, **changes)


def timed(path: PathIR) -> TrajectoryIR:
    outcome = ParameterizeTime().run(path, PassContext())
    assert outcome.diagnostics == ()
    assert outcome.value is not None
    return outcome.value


def faults(path: PathIR) -> tuple[Diagnostic, ...]:
    outcome = ParameterizeTime().run(path, PassContext())
    assert outcome.value is None
    assert all(d.code in registry() for d in outcome.diagnostics)
    return outcome.diagnostics


def shot_time(leg: Leg, of: MissionIR | None = None) -> float:
    start, end = shot_phase(timed(flight(of or mission(), leg)))
    return end - start


class TestFlight:
    def test_phases_cover_the_flight_without_gaps(self) -> None:
        drone = timed(flight(mission(), straight())).drones[0]
        assert drone.curve.start == 0.0
        assert [p.name for p in drone.phases] == ["takeoff", "transit", "shot", "land"]
        ends = [p.end for p in drone.phases]
        assert [p.start for p in drone.phases] == [0.0, *ends[:-1]]
        assert ends[-1] == drone.curve.end

    def test_the_whole_curve_is_c2_and_within_limits_and_ends_at_rest(self) -> None:
        leg = shot_leg(smooth(3), tuple(smooth(3)(0.0)), pace=0.75)
        drone = timed(flight(mission(), leg)).drones[0]
        value, rate, acceleration = jumps(drone.curve)
        assert value < 1e-9
        assert rate < 1e-8
        assert acceleration < 1e-6
        assert max(uses(drone.curve, CEILING).values()) <= 1.0
        assert np.abs(drone.curve.derivative(1).ctrl[-1, -1]).max() == 0.0
        assert np.diff(drone.curve.breaks).min() > 1e-6

    def test_the_shot_flies_its_path_from_end_to_end(self) -> None:
        ir = timed(flight(mission(), shot_leg(circle(20, pi), tuple(circle(20, pi)(0.0)))))
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
        a, b = (timed(flight(mission(), straight(duration=11.0))).drones[0].curve for _ in range(2))
        assert a.ctrl.tobytes() == b.ctrl.tobytes()
        assert a.breaks.tobytes() == b.breaks.tobytes()


class TestRough:
    def test_where_the_solver_gives_up_the_flight_is_slower_and_says_so(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
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


class TestPace:
    def test_pace_is_a_share_of_every_limit(self) -> None:
        half = s_curve_time(40.0, 4.0, 1.5, 4.0)
        assert shot_time(straight(pace=0.5)) == pytest.approx(half, rel=0.02)
        assert shot_time(straight(pace=0.5)) >= half * (1 - 1e-6)

    def test_what_is_not_filmed_is_flown_at_full_limits(self) -> None:
        drone = timed(flight(mission(), straight(pace=0.3))).drones[0]
        takeoff = drone.phases[0]
        assert takeoff.end == pytest.approx(s_curve_time(6.0, 4.0, 3.0, 8.0), rel=0.02)


class TestDuration:
    @pytest.mark.parametrize("seconds", [9.0, 12.5, 60.0, 600.0])
    def test_a_given_duration_is_met_exactly(self, seconds: float) -> None:
        assert shot_time(straight(duration=seconds)) == pytest.approx(seconds, abs=1e-9)

    def test_a_duration_includes_holds_and_may_use_the_full_limits(self) -> None:
        stops = (Stop(0.0, 1.0), Stop(20.0, 2.0), Stop(40.0, 0.5))
        ir = timed(flight(mission(), straight(duration=16.0, stops=stops, pace=0.4)))
        start, end = shot_phase(ir)
        assert end - start == pytest.approx(16.0, abs=1e-9)
        assert still(ir, start, start + 1.0)
        assert still(ir, end - 0.5, end)
        middle = resting(ir, 20.0)
        assert middle[1] - middle[0] == pytest.approx(2.0, abs=1e-9)
        # Both moves are slowed alike, and they are alike.
        assert middle[0] - (start + 1.0) == pytest.approx(end - 0.5 - middle[1], rel=1e-3)

    def test_too_short_names_the_shortest_which_then_works(self) -> None:
        (fault,) = faults(flight(mission(), straight(duration=6.0)))
        assert fault.code == "T001"
        assert "given 6 s" in fault.message
        shortest = number_before(fault.message, " s is the shortest")
        assert FORTY <= shortest <= 1.02 * FORTY
        assert shot_time(straight(duration=shortest)) == pytest.approx(shortest, abs=1e-9)
        assert fault.labels[0].span == mission().origins.values["shots", 0, "timing", "duration"]
        assert f"duration: {shortest:.2f} s" in fault.help

    def test_too_short_names_the_limit_that_binds_and_how_far_to_raise_it(self) -> None:
        (fault,) = faults(flight(mission(), straight(duration=7.8)))
        assert any("from keyframe 1 to 2" in note and "speed 8.00 m/s" in note for note in fault.notes)
        assert mission().origins.values["drones", "cam1", "limits", "speed"] in [
            label.span for label in fault.labels
        ]
        raised = number_before(fault.help, " m/s", after="`limits.speed` to ")
        limits = mission().drones[0].limits
        faster = mission(limits=replace(limits, speed=raised))
        assert shot_time(straight(duration=7.8), faster) == pytest.approx(7.8, abs=1e-9)
        slower = mission(limits=replace(limits, speed=0.95 * raised))
        assert faults(flight(slower, straight(duration=7.8)))[0].code == "T001"

    def test_a_raised_speed_is_told_with_the_wind_that_was_taken_off(self) -> None:
        calm = faults(flight(mission(), straight(duration=7.8)))[0].help
        windy = faults(flight(replace(mission(), wind=2.0), straight(duration=7.8)))[0].help
        speeds = [number_before(text, " m/s", after="`limits.speed` to ") for text in (calm, windy)]
        assert speeds[1] == pytest.approx(speeds[0] + 2.0, abs=0.011)

    def test_holds_longer_than_the_duration_are_too_short_a_duration(self) -> None:
        stops = (Stop(0.0, 5.0), Stop(40.0, 5.0))
        (fault,) = faults(flight(mission(), straight(duration=9.0, stops=stops)))
        assert number_before(fault.message, " s is the shortest") >= 10.0 + FORTY

    @settings(max_examples=8, deadline=None, derandomize=True)
    @given(seed=st.integers(0, 1000), share=st.floats(1.0, 5.0))
    def test_any_duration_from_the_shortest_up_can_be_flown(self, seed: int, share: float) -> None:
        path = smooth(seed, size=8.0)
        leg = shot_leg(path, tuple(path(0.0)))
        (fault,) = faults(flight(mission(), replace(leg, duration=0.5)))
        shortest = number_before(fault.message, " s is the shortest")
        ir = timed(flight(mission(), replace(leg, duration=share * shortest)))
        start, end = shot_phase(ir)
        assert end - start == pytest.approx(share * shortest, abs=1e-9)
        assert max(uses(ir.drones[0].curve, CEILING, samples=25).values()) <= 1.0


class TestStill:
    def test_a_still_shot_lasts_its_duration(self) -> None:
        ir = timed(flight(mission(), shot_leg(None, FROM, duration=7.25, stops=(Stop(0.0, 3.0),))))
        start, end = shot_phase(ir)
        assert end - start == pytest.approx(7.25, abs=1e-12)
        assert still(ir, start, end)

    def test_or_its_hold(self) -> None:
        assert shot_time(shot_leg(None, FROM, stops=(Stop(0.0, 3.0),))) == pytest.approx(3.0, abs=1e-12)

    def test_a_shot_that_takes_no_time_is_a_fault(self) -> None:
        (fault,) = faults(flight(mission(), shot_leg(None, FROM, stops=(Stop(0.0, 0.0),))))
        assert fault.code == "T005"


class TestStart:
    def test_the_first_frame_is_at_start_and_the_wait_belongs_to_the_transit(self) -> None:
        ir = timed(flight(mission(), straight(start=30.0)))
        assert shot_phase(ir)[0] == pytest.approx(30.0, abs=1e-12)
        transit = ir.drones[0].phases[1]
        assert (transit.name, transit.end) == ("transit", 30.0)
        assert still(ir, 29.0, 30.0)

    def test_too_early_names_the_earliest_which_then_works(self) -> None:
        (fault,) = faults(flight(mission(), straight(start=5.0)))
        assert fault.code == "T003"
        earliest = number_before(fault.message, " s is the earliest")
        assert shot_phase(timed(flight(mission(), straight(start=earliest))))[0] == pytest.approx(earliest)
        assert "takeoff" in fault.notes[0]
        assert "transit" in fault.notes[0]
        assert fault.labels[0].span == mission().origins.values["shots", 0, "timing", "start"]

    def test_a_fault_does_not_bring_others_after_it(self) -> None:
        found = faults(flight(mission(), straight(start=14.0, duration=1.0)))
        assert [d.code for d in found] == ["T001"]


class TestEndurance:
    def test_too_long_a_flight_lists_its_phases_longest_first(self) -> None:
        (fault,) = faults(flight(mission(endurance=60.0), straight(duration=80.0)))
        assert fault.code == "T004"
        assert "60 s" in fault.message
        assert fault.notes[0].index("shot `half` 80.0 s") < fault.notes[0].index("transit")
        assert fault.labels[0].span == mission().origins.values["drones", "cam1", "endurance"]
        over = number_before(fault.help, " s, or cut", after="by ")
        shot_time(straight(duration=80.0 - over), mission(endurance=60.0))


class TestKeyframeTimes:
    def marks(self, *marks: tuple[float, float | None]) -> tuple[Mark, ...]:
        return tuple(Mark(s, t, i, ("shots", 0, "keyframes", i)) for i, (s, t) in enumerate(marks))

    def at(self, ir: TrajectoryIR, time: float) -> float:
        """x at a time from the shot's start."""
        return float(ir.drones[0].curve(shot_phase(ir)[0] + time)[0])

    def test_a_place_is_passed_at_its_time(self) -> None:
        marks = self.marks((0.0, None), (10.0, 6.0), (40.0, None))
        ir = timed(flight(mission(), straight(marks=marks, duration=14.0)))
        assert shot_phase(ir)[1] - shot_phase(ir)[0] == pytest.approx(14.0, abs=1e-9)
        assert self.at(ir, 6.0) == pytest.approx(10.0, abs=8.0 * 1e-3)
        assert max(uses(ir.drones[0].curve, CEILING).values()) <= 1.0
        assert ir.drones[0].keyframes[1].time == pytest.approx(shot_phase(ir)[0] + 6.0, abs=1e-3)

    def test_several_places_at_their_times_without_a_stop(self) -> None:
        marks = self.marks((0.0, 0.0), (8.0, 4.0), (20.0, 7.0), (26.0, 11.0), (40.0, 15.0))
        ir = timed(flight(mission(), straight(marks=marks)))
        for mark in marks[1:]:
            assert self.at(ir, mark.time or 0.0) == pytest.approx(mark.s, abs=8.0 * 1e-3)
        start, end = shot_phase(ir)
        assert end - start == pytest.approx(15.0, abs=1e-9)
        t = np.linspace(start + 2.0, end - 2.0, 200)
        assert np.abs(ir.drones[0].curve.derivative(1)(t)[:, 0]).min() > 0.3
        assert max(uses(ir.drones[0].curve, CEILING).values()) <= 1.0

    def test_what_follows_the_last_time_keeps_its_pace(self) -> None:
        stops = (Stop(0.0, 0.0), Stop(20.0, 1.0), Stop(40.0, 0.0))
        marks = self.marks((0.0, None), (20.0, 9.0), (40.0, None))
        ir = timed(flight(mission(), straight(marks=marks, stops=stops, pace=0.5)))
        start, end = shot_phase(ir)
        assert self.at(ir, 9.0) == pytest.approx(20.0, abs=1e-6)
        assert end - start == pytest.approx(10.0 + s_curve_time(20.0, 4.0, 1.5, 4.0), rel=0.02)
        times = [k.time - start for k in ir.drones[0].keyframes]
        assert times[:2] == pytest.approx([0.0, 9.0])
        assert times[2] == pytest.approx(end - start)

    def test_a_last_keyframe_before_the_end_waits_there(self) -> None:
        marks = self.marks((0.0, None), (40.0, 12.0))
        ir = timed(flight(mission(), straight(marks=marks, duration=16.0)))
        start, end = shot_phase(ir)
        assert end - start == pytest.approx(16.0, abs=1e-9)
        assert still(ir, start + 12.0, end)
        assert not still(ir, start + 11.5, end)

    def test_a_first_keyframe_after_the_start_is_held_until_then(self) -> None:
        marks = self.marks((0.0, 3.0), (40.0, 15.0))
        ir = timed(flight(mission(), straight(marks=marks)))
        start, end = shot_phase(ir)
        assert still(ir, start, start + 3.0)
        assert end - start == pytest.approx(15.0, abs=1e-9)

    @pytest.mark.parametrize("end", [None, 20.0])
    def test_too_early_names_the_earliest_which_then_works(self, end: float | None) -> None:
        marks = self.marks((0.0, None), (20.0, 2.0), (40.0, None))
        (fault,) = faults(flight(mission(), straight(marks=marks, duration=end)))
        assert fault.code == "T002"
        assert "keyframe 2" in fault.message
        assert fault.labels[0].span == mission().origins.values["shots", 0, "keyframes", 1, "time"]
        earliest = number_before(fault.help, " s`", after="`time: ")
        assert 2.5 < earliest < 6.0
        again = self.marks((0.0, None), (20.0, earliest), (40.0, None))
        ir = timed(flight(mission(), straight(marks=again, duration=end)))
        assert self.at(ir, earliest) == pytest.approx(20.0, abs=8.0 * 1e-3)

    def test_the_rest_too_fast_blames_the_duration(self) -> None:
        marks = self.marks((0.0, None), (10.0, 10.0), (40.0, None))
        (fault,) = faults(flight(mission(), straight(marks=marks, duration=12.0)))
        assert fault.code == "T001"
        shortest = number_before(fault.message, " s is the shortest")
        ir = timed(flight(mission(), straight(marks=marks, duration=shortest)))
        assert self.at(ir, 10.0) == pytest.approx(10.0, abs=8.0 * 1e-3)


class TestFraming:
    def reference(self, start: float, end: float) -> Piecewise:
        value = np.array([[-0.3, 0.0], [0.3, 0.2]])
        return quintic_hermite(np.array([start, end]), value, np.zeros((2, 2)), np.zeros((2, 2)))

    def test_references_follow_the_path(self) -> None:
        wanted = self.reference(0.0, 40.0)
        leg = straight(framing=(FramingSpan("tower", 0.0, 40.0, wanted),))
        ir = timed(flight(mission(), leg))
        start, end = shot_phase(ir)
        (span,) = ir.drones[0].framing
        assert (span.shot, span.target, span.start, span.end) == ("half", "tower", start, end)
        assert span.reference is not None
        t = np.linspace(start, end, 500)
        assert span.reference(t) == pytest.approx(wanted(ir.drones[0].curve(t)[:, 0]), abs=1e-4)

    def test_spans_meet_at_the_end_of_a_hold(self) -> None:
        stops = (Stop(0.0, 0.0), Stop(20.0, 2.0), Stop(40.0, 0.0))
        spans = (
            FramingSpan("tower", 0.0, 20.0, self.reference(0.0, 20.0)),
            FramingSpan("tower", 20.0, 30.0, None),
            FramingSpan("tower", 30.0, 40.0, self.reference(30.0, 40.0)),
        )
        ir = timed(flight(mission(), straight(framing=spans, stops=stops)))
        first, second, third = ir.drones[0].framing
        assert first.end == second.start == resting(ir, 20.0)[1]
        assert second.end == pytest.approx(third.start, abs=1e-9)
        assert third.end == shot_phase(ir)[1]
        assert second.reference is None
        assert third.reference is not None
        assert third.reference(third.start) == pytest.approx([-0.3, 0.0], abs=1e-9)
        assert float(ir.drones[0].curve(third.start)[0]) == pytest.approx(30.0, abs=1e-6)

    def test_a_still_shot_keeps_its_reference(self) -> None:
        span = FramingSpan(
            "tower", 0.0, 0.0, Piecewise(np.array([0.0, 1.0]), np.tile([0.1, -0.2], (1, 6, 1)))
        )
        ir = timed(flight(mission(), shot_leg(None, FROM, duration=4.0, framing=(span,))))
        (found,) = ir.drones[0].framing
        assert (found.start, found.end) == shot_phase(ir)
        assert found.reference is not None
        assert found.reference(found.end) == pytest.approx([0.1, -0.2])


class TestAngles:
    def test_a_turn_on_the_spot_between_moves_is_a_move_of_its_own(self) -> None:
        turned = (*TO[:3], radians(90), 0.0, radians(90), HFOV)
        go, turn = line(FROM, TO), line(TO, turned)
        both = Piecewise(
            np.concatenate([go.breaks, 40.0 + turn.breaks[1:]]), np.concatenate([go.ctrl, turn.ctrl])
        )
        stops = (Stop(0.0, 0.0), Stop(40.0, 0.0), Stop(both.end, 0.0))
        ir = timed(flight(mission(), shot_leg(both, FROM, stops=stops)))
        assert "shot half move 1 time" in dict(ir.stats)
        assert max(uses(ir.drones[0].curve, CEILING).values()) <= 1.0
        assert ir.drones[0].curve(shot_phase(ir)[1])[3] == pytest.approx(radians(90))

    def test_slow_gimbals_hold_the_drone_back_and_are_named(self) -> None:
        away = (*TO[:4], radians(-60), 0.0, HFOV)
        gimbal = replace(mission().drones[0].gimbal, rate=radians(5))
        slow = mission(gimbal=gimbal)
        leg = shot_leg(line(FROM, away), FROM, duration=8.5)
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


def number_before(text: str, mark: str, after: str = "") -> float:
    """The number that stands right before a mark, after another."""
    text = text[text.index(after) + len(after) :] if after else text
    return float(text[: text.index(mark)].split()[-1].strip("`"))


def still(ir: TrajectoryIR, start: float, end: float) -> bool:
    at = ir.drones[0].curve(np.linspace(start, end, 20))
    return float(np.abs(at - at[0]).max()) < 1e-9


def resting(ir: TrajectoryIR, x: float) -> tuple[float, float]:
    """When the drone arrives at and leaves a place on the x axis where it holds, from the pieces."""
    curve = ir.drones[0].curve
    held = [i for i, c in enumerate(curve.ctrl) if np.ptp(c, axis=0).max() == 0 and abs(c[0, 0] - x) < 1e-6]
    return float(curve.breaks[held[0]]), float(curve.breaks[held[-1] + 1])


class TestWaiting:
    def two(self) -> PathIR:
        """Two drones; the first one's shot waits for the second one's, which holds for 20 s."""
        base = mission()
        other = replace(base.drones[0], name="cam2", priority=2)
        shot = base.shots[0]
        shots = (replace(shot, timing=Timing(after="late")), replace(shot, id="late", drone="cam2"))
        of = replace(base, drones=(*base.drones, other), shots=shots)
        first = flight(of, straight()).drones[0]
        held = shot_leg(None, FROM, shot="late", duration=20.0)
        second = flight(of, held).drones[0]
        return replace(flight(of, straight()), drones=(first, replace(second, drone="cam2")))

    def test_a_shot_begins_once_the_shot_it_waits_for_has_ended(self) -> None:
        one, two = timed(self.two()).drones
        late = next(p for p in two.phases if p.shot == "late")
        half = next(p for p in one.phases if p.shot == "half")
        assert half.start == pytest.approx(late.end)
        assert [p.name for p in one.phases] == ["takeoff", "transit", "shot", "land"]

    def test_a_wait_right_after_a_shot_is_a_transit(self) -> None:
        path = flight(mission(), straight())
        takeoff, transit, shot, land = path.drones[0].legs
        again = replace(
            shot, shot="again", curve=None, pose=TO, stops=(Stop(0.0, 2.0),), marks=(), start=40.0
        )
        legs = (takeoff, transit, shot, again, land)
        drone = timed(replace(path, drones=(replace(path.drones[0], legs=legs),))).drones[0]
        assert [p.name for p in drone.phases] == ["takeoff", "transit", "shot", "transit", "shot", "land"]
        assert drone.phases[4].start == 40.0
        assert drone.phases[4].end == pytest.approx(42.0)

"""Times that keyframes ask for, and the time a framing is given in."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise, quintic_hermite
from shotc.ir.path import FramingSpan, Mark, Stop
from shotc.ir.trajectory import TrajectoryIR
from tests.support.timed_flights import (
    FROM,
    faults,
    number_before,
    resting,
    still,
    straight,
    timed,
)
from tests.support.timing_paths import (
    CEILING,
    flight,
    held_leg,
    mission,
    s_curve_time,
    shot_phase,
    uses,
)


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

    @pytest.mark.long
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

    @pytest.mark.slow
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
        ir = timed(flight(mission(), held_leg(FROM, duration=4.0, framing=(span,))))
        (found,) = ir.drones[0].framing
        assert (found.start, found.end) == shot_phase(ir)
        assert found.reference is not None
        assert found.reference(found.end) == pytest.approx([0.1, -0.2])

"""When shots begin, how long they last and what they wait for: a time, another shot, a still camera."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.ir.limits import Timing
from shotc.ir.path import PathIR, Stop
from tests.support.records import replace
from tests.support.timed_flights import (
    FORTY,
    FROM,
    TO,
    faults,
    number_before,
    resting,
    shot_time,
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
    shot_leg,
    shot_phase,
    smooth,
    uses,
)


class TestPace:
    @pytest.mark.slow
    def test_pace_is_a_share_of_every_limit(self) -> None:
        half = s_curve_time(40.0, 4.0, 1.5, 4.0)
        assert shot_time(straight(pace=0.5)) == pytest.approx(half, rel=0.02)
        assert shot_time(straight(pace=0.5)) >= half * (1 - 1e-6)

    @pytest.mark.slow
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

    @pytest.mark.slow
    def test_too_short_names_the_shortest_which_then_works(self) -> None:
        (fault,) = faults(flight(mission(), straight(duration=6.0)))
        assert fault.code == "T001"
        assert "given 6 s" in fault.message
        shortest = number_before(fault.message, " s is the shortest")
        assert FORTY <= shortest <= 1.02 * FORTY
        assert shot_time(straight(duration=shortest)) == pytest.approx(shortest, abs=1e-9)
        assert fault.labels[0].span == mission().origins.values["shots", 0, "timing", "duration"]
        assert f"duration: {shortest:.2f} s" in fault.help

    @pytest.mark.slow
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

    @pytest.mark.slow
    def test_a_raised_speed_is_told_with_the_wind_that_was_taken_off(self) -> None:
        calm = faults(flight(mission(), straight(duration=7.8)))[0].help
        windy = faults(flight(replace(mission(), wind=2.0), straight(duration=7.8)))[0].help
        speeds = [number_before(text, " m/s", after="`limits.speed` to ") for text in (calm, windy)]
        assert speeds[1] == pytest.approx(speeds[0] + 2.0, abs=0.011)

    def test_holds_longer_than_the_duration_are_too_short_a_duration(self) -> None:
        stops = (Stop(0.0, 5.0), Stop(40.0, 5.0))
        (fault,) = faults(flight(mission(), straight(duration=9.0, stops=stops)))
        assert number_before(fault.message, " s is the shortest") >= 10.0 + FORTY

    @pytest.mark.slow
    @settings(max_examples=4, deadline=None, derandomize=True)
    @given(seed=st.integers(0, 1000), share=st.floats(1.0, 5.0))
    def test_any_duration_from_the_shortest_up_can_be_flown(self, seed: int, share: float) -> None:
        path = smooth(seed, size=8.0)
        leg = shot_leg(path)
        (fault,) = faults(flight(mission(), replace(leg, duration=0.5)))
        shortest = number_before(fault.message, " s is the shortest")
        ir = timed(flight(mission(), replace(leg, duration=share * shortest)))
        start, end = shot_phase(ir)
        assert end - start == pytest.approx(share * shortest, abs=1e-9)
        assert max(uses(ir.drones[0].curve, CEILING, samples=25).values()) <= 1.0


class TestStill:
    def test_a_still_shot_lasts_its_duration(self) -> None:
        ir = timed(flight(mission(), held_leg(FROM, 3.0, duration=7.25)))
        start, end = shot_phase(ir)
        assert end - start == pytest.approx(7.25, abs=1e-12)
        assert still(ir, start, end)

    def test_or_its_hold(self) -> None:
        assert shot_time(held_leg(FROM, 3.0)) == pytest.approx(3.0, abs=1e-12)

    def test_a_shot_that_takes_no_time_is_a_fault(self) -> None:
        (fault,) = faults(flight(mission(), held_leg(FROM)))
        assert fault.code == "T005"


class TestStart:
    def test_the_first_frame_is_at_start_and_the_wait_belongs_to_the_transit(self) -> None:
        ir = timed(flight(mission(), straight(start=30.0)))
        assert shot_phase(ir)[0] == pytest.approx(30.0, abs=1e-12)
        transit = ir.drones[0].phases[1]
        assert (transit.name, transit.end) == ("transit", 30.0)
        assert still(ir, 29.0, 30.0)

    @pytest.mark.slow
    def test_too_early_names_the_earliest_which_then_works(self) -> None:
        (fault,) = faults(flight(mission(), straight(start=5.0)))
        assert fault.code == "T003"
        earliest = number_before(fault.message, " s is the earliest")
        assert shot_phase(timed(flight(mission(), straight(start=earliest))))[0] == pytest.approx(earliest)
        assert "takeoff" in fault.notes[0]
        assert "transit" in fault.notes[0]
        assert fault.labels[0].span == mission().origins.values["shots", 0, "timing", "start"]

    @pytest.mark.slow
    def test_a_fault_does_not_bring_others_after_it(self) -> None:
        found = faults(flight(mission(), straight(start=14.0, duration=1.0)))
        assert [d.code for d in found] == ["T001"]


class TestWaiting:
    def two(self) -> PathIR:
        """Two drones; the first one's shot waits for the second one's, which holds for 20 s."""
        base = mission()
        other = replace(base.drones[0], name="cam2", priority=2)
        shot = base.shots[0]
        shots = (replace(shot, timing=Timing(after="late")), replace(shot, id="late", drone="cam2"))
        of = replace(base, drones=(*base.drones, other), shots=shots)
        first = flight(of, straight()).drones[0]
        held = held_leg(FROM, shot="late", duration=20.0)
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
        again = held_leg(TO, 2.0, shot="again", marks=(), start=40.0)
        legs = (takeoff, transit, shot, again, land)
        drone = timed(replace(path, drones=(replace(path.drones[0], legs=legs),))).drones[0]
        assert [p.name for p in drone.phases] == ["takeoff", "transit", "shot", "transit", "shot", "land"]
        assert drone.phases[4].start == 40.0
        assert drone.phases[4].end == pytest.approx(42.0)

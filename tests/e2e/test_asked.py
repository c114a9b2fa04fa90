"""What the author asked for is what is flown: durations, starts, times, holds, places and order."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from shotc.ir.phases import Phase
from tests.e2e.conftest import Plan, Planned, each_mission
from tests.support.csv_tables import Table

pytestmark = pytest.mark.parametrize("path", each_mission())


def phases(planned: Planned) -> dict[str, Phase]:
    return {p.shot: p for track in planned.tracks.values() for p in track.phases if p.shot is not None}


def times_reached(planned: Planned) -> dict[tuple[str, int], float]:
    return {(k.shot, k.index): k.time for track in planned.tracks.values() for k in track.keyframes}


@pytest.mark.long
def test_durations_and_starts_are_met(plan: Plan, path: Path) -> None:
    planned = plan(path)
    flown = phases(planned)
    for shot in planned.mission.shots:
        phase, timing = flown[shot.id], shot.timing
        if timing.duration is not None:
            assert phase.end - phase.start == pytest.approx(timing.duration, abs=1e-6)
        if timing.start is not None:
            assert phase.start == pytest.approx(timing.start, abs=1e-6)
        if timing.after is not None:
            assert phase.start >= flown[timing.after].end - 1e-9


@pytest.mark.long
def test_rows_of_a_shot_are_those_between_its_ends(plan: Plan, path: Path) -> None:
    planned = plan(path)
    for shot, phase in phases(planned).items():
        times = planned.motion.where(shot=shot)["t_s"]
        step = 1 / planned.mission.rate
        assert phase.start - 1e-9 <= times[0] < phase.start + step
        assert phase.end - step - 1e-9 <= times[-1] <= phase.end


def test_keyframes_are_met_where_and_when_they_were_placed(plan: Plan, path: Path) -> None:
    planned = plan(path)
    flown = phases(planned)
    reached = times_reached(planned)
    for shot in planned.mission.shots:
        motion = planned.flights[planned.filmed_by[shot.id]]
        times = [reached[shot.id, index] for index in range(len(shot.keyframes))]
        assert times == sorted(times)
        for keyframe, time in zip(shot.keyframes, times, strict=True):
            if keyframe.time is not None:
                assert time - flown[shot.id].start == pytest.approx(keyframe.time, abs=1e-6)
            if keyframe.placed:
                assert position(motion, time) == pytest.approx(keyframe.at, abs=1e-3)
            hfov = np.interp(time, motion["t_s"], motion["hfov_rad"])
            assert hfov == pytest.approx(keyframe.hfov, abs=1e-3)


def position(motion: Table, time: float) -> list[float]:
    """The position at any time, from the rows next to it, which lie close to a parabola."""
    row = int(np.argmin(np.abs(motion["t_s"] - time)))
    late = time - motion["t_s"][row]
    x, v, a = (
        motion.numbers(*names)[row]
        for names in (
            ("x_m", "y_m", "z_m"),
            ("vx_m_s", "vy_m_s", "vz_m_s"),
            ("ax_m_s2", "ay_m_s2", "az_m_s2"),
        )
    )
    return list(x + v * late + a * late**2 / 2)


def test_holds_are_at_rest_and_as_long_as_asked(plan: Plan, path: Path) -> None:
    planned = plan(path)
    reached = times_reached(planned)
    for shot in planned.mission.shots:
        for index, keyframe in enumerate(shot.keyframes):
            if keyframe.hold == 0:
                continue
            rows = planned.motion.where(shot=shot.id)
            time = reached[shot.id, index]
            held = (rows["t_s"] >= time) & (rows["t_s"] <= time + keyframe.hold)
            assert held.sum() >= keyframe.hold * planned.mission.rate - 1
            assert np.ptp(rows.numbers("x_m", "y_m", "z_m")[held], axis=0).max() < 1e-3
            assert np.abs(rows.numbers("vx_m_s", "vy_m_s", "vz_m_s")[held]).max() < 1e-3
            assert np.ptp(rows.numbers("cam_yaw_rad", "cam_pitch_rad")[held], axis=0).max() < 1e-3

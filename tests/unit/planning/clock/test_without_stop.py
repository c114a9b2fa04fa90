"""A drone that would be late for a shot does not stop before its run-up."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.api import Compilation
from shotc.planning.clock.run_up import RunUp
from tests.support.compiled import compiled_text

MISSION = """\
shotc: 1
mission: cyclist
targets:
  cyclist: {{track: {{start: [0, 0, 0.9], velocity: [-5.2, 3.0, 0]}}, radius: 0.6, height: 1.8}}
drones:
  cam: {{model: mavic-3e, home: [-20, -25, 0]}}
shots:
  - {{id: s, drone: cam, {shot}, timing: {{duration: 6, start: {start}}}}}
"""
ABOVE = "kind: crane, target: cyclist, azimuth: 0 deg, distance: [16, 8], altitude: [4, 12]"
STANDING = "kind: static, at: [-110, 70, 12], look_at: cyclist"


def planned(shot: str, start: float) -> Compilation:
    return compiled_text(MISSION.format(shot=shot, start=start), "none", "m.yaml")


@pytest.mark.parametrize("place", [(-60.0, 20.0, 3.0), (30.0, 5.0, 8.0)])
def test_a_run_up_begins_at_a_place_at_rest_and_ends_with_the_film_s_speed(place: tuple[float, ...]) -> None:
    film = RunUp(2.0, np.array([1.0, 2.0, 3.0]), np.array([4.0, -1.0, 0.5]))
    begun, step = film.begun(np.array(place), 9.0), 1e-5
    first, then, last, end = begun.at(np.array([-9.0, -9.0 + step, -step, 0.0]))
    assert first == pytest.approx(place)
    assert np.linalg.norm(then - first) / step < 1e-3
    assert end == pytest.approx(film.place)
    assert (end - last) / step == pytest.approx(film.velocity, abs=1e-3)


@pytest.mark.slow
def test_who_would_be_late_flies_on_into_the_shot() -> None:
    done = planned(ABOVE, 15.0)
    assert done.plan is not None, done.diagnostics
    (drone,) = done.plan.trajectory.drones
    rise, film = drone.phases[0], next(phase for phase in drone.phases if phase.shot == "s")
    assert film.start == pytest.approx(15.0)
    between = np.linspace(rise.end + 3.0, film.start, 200)
    assert np.linalg.norm(drone.curve.derivative(1)(between)[:, :3], axis=1).min() > 2.0
    assert all(claim.holds for claim in done.plan.certificate if claim.hard)


@pytest.mark.slow
@pytest.mark.parametrize(("shot", "start"), [(ABOVE, 12.0), (STANDING, 12.0)])
def test_who_cannot_be_there_in_time_is_told_so(shot: str, start: float) -> None:
    assert [d.code for d in planned(shot, start).diagnostics] == ["T003"]


@pytest.mark.slow
def test_a_camera_that_its_author_placed_stands_there_from_the_first_frame() -> None:
    done = planned(STANDING, 18.6)
    assert done.plan is not None, done.diagnostics
    film = np.linspace(18.6, 24.6, 50)
    off = done.plan.trajectory.drones[0].curve(film)[:, :3] - np.array([-110.0, 70.0, 12.0])
    assert np.abs(off).max() < 0.02

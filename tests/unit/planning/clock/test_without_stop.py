"""A drone that would be late for a shot does not stop before its run-up."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from shotc.api import Compilation
from shotc.geom.bernstein import Array, Piecewise, state_at
from shotc.geom.bspline import spline
from shotc.ir.path import ClockLeg
from shotc.ir.trajectory import DroneTrajectory
from shotc.passes.verify.shape import joint_steps
from shotc.planning.clock.bounds import with_ends
from shotc.planning.clock.run_up import Departure, Link, RunUp
from tests.support.compiled import compiled_text
from tests.support.films_in_a_row import SKIER, THIRD

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
    begun, step = film.begun(Departure.at_rest(np.array(place), 3.0), 12.0), 1e-5
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


def filmed(mission: str, refiner: str = "none") -> DroneTrajectory:
    """Return the flight of a mission's only drone, with all hard claims held."""
    done = compiled_text(mission, refiner, "m.yaml")
    assert done.plan is not None, done.diagnostics
    assert all(claim.holds for claim in done.plan.certificate if claim.hard)
    return done.plan.trajectory.drones[0]


def slowest_between(flight: DroneTrajectory) -> float:
    """Return the least speed from the first film to the last one, m/s."""
    films = [phase for phase in flight.phases if phase.name == "shot"]
    times = np.arange(films[0].start, films[-1].end, 0.01)
    return float(np.linalg.norm(flight.curve.derivative(1)(times)[:, :3], axis=1).min())


@pytest.mark.long
@pytest.mark.parametrize("refiner", ["none", "ours"])
def test_a_drone_flies_on_from_film_to_film_where_a_stop_takes_too_long(refiner: str) -> None:
    """With a stop between them, the second film begins at 40 s or later."""
    flight = filmed(SKIER, refiner)
    follow, drop = (phase for phase in flight.phases if phase.name == "shot")
    assert (follow.start, follow.end, drop.start, drop.end) == pytest.approx((12.0, 20.0, 27.0, 32.0))
    assert slowest_between(flight) > 2.0


@pytest.mark.long
def test_the_film_before_stays_as_it_is_without_the_next_one() -> None:
    alone = filmed(SKIER[: SKIER.index("  - {id: drop")])
    times = np.linspace(12.0, 20.0, 200)
    assert filmed(SKIER).curve(times) == pytest.approx(alone.curve(times), abs=1e-9)


@pytest.mark.long
def test_three_films_are_flown_without_a_stop() -> None:
    assert slowest_between(filmed(SKIER + THIRD)) > 1.0


@pytest.mark.long
def test_the_told_start_can_be_flown() -> None:
    """It is sooner than a stop allows."""
    early = SKIER.replace("start: 27", "start: 21.2")
    (late,) = compiled_text(early, "none", "m.yaml").diagnostics
    found = re.search(r"`start: ([\d.]+) s`", late.help)
    assert late.code == "T003"
    assert found is not None
    assert 21.2 < float(found[1]) < 27.0
    assert any("without a stop on the last transit" in note for note in late.notes)
    filmed(SKIER.replace("start: 27", f"start: {found[1]}"))


state = arrays(np.float64, (3, 3), elements=st.floats(-50.0, 50.0, width=32))


@given(begin=state, end=state, seconds=st.floats(0.05, 5.0))
def test_a_spline_takes_the_states_at_its_ends_exactly(begin: Array, end: Array, seconds: float) -> None:
    breaks = np.linspace(3.0, 3.0 + 6 * seconds, 7)
    curve = spline(breaks, with_ends(breaks, np.zeros((len(breaks) + 4, 3)), begin, end))
    for at, wanted in ((breaks[0], begin), (breaks[-1], end)):
        scale = 1.0 + np.abs(wanted).max()
        assert state_at(curve, at) == pytest.approx(wanted, abs=1e-9 * scale)
    assert np.abs(joint_steps(curve, 2)).max() <= 1e-6 * (1.0 + np.abs(curve.derivative(2).ctrl).max())


def test_a_link_has_the_state_of_the_film_before_and_the_next_film_s_speed() -> None:
    film = RunUp(2.0, np.array([1.0, 2.0, 3.0]), np.array([4.0, -1.0, 0.5]))
    at_cut = np.array([[-20.0, 5.0, 6.0], [3.0, 2.0, -1.0], [0.5, 0.0, 0.2]])
    cut = ClockLeg("s", Piecewise(np.array([0.0, 6.0]), np.zeros((1, 6, 7))), 1.0, 5.5, (), ())
    link = film.begun(Departure(6.0, at_cut, np.zeros((3, 3)), cut), 11.0)
    assert isinstance(link, Link)
    assert link.seconds == 5.0
    assert state_at(link.curve, -5.0) == pytest.approx(at_cut)
    assert state_at(link.curve, 0.0)[:2] == pytest.approx(np.array([film.place, film.velocity]))

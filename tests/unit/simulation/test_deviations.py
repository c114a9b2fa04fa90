"""Warnings of rehearsals: a subject that is faster than the drone, receivers that mislead it, and replanners
that fail.
"""

from __future__ import annotations

import re

import numpy as np
import pytest

from shotc import plugins
from shotc.diag.model import Diagnostic
from shotc.geom.track import Track
from shotc.simulation.blind import held_intervals
from shotc.simulation.conditions import Outage
from shotc.simulation.deviation_faults import deviations
from shotc.simulation.film import film_of
from shotc.simulation.rehearsal import RehearsalOptions, Rehearsed, conditions_of, rehearse
from shotc.simulation.runs import flown as simulated_flights
from shotc.simulation.runs import simulated
from shotc.simulation.truth import Truth
from shotc.simulation.world import at_times
from tests.support.compiled import compiled_text

pytestmark = pytest.mark.slow

BIKE = """\
shotc: 1
mission: bike
targets:
  rider: {track: {start: [0, 0, 0.9], velocity: [3, 0, 0]}, radius: 0.4, height: 1.8}
drones: {cam: {model: x500, home: [20, -12, 0]}}
shots:
  - {id: follow, kind: chase, drone: cam, target: rider, distance: 8, altitude: 3,
     timing: {start: 14, duration: 5}}
"""


def flown(asked: RehearsalOptions, text: str = BIKE) -> Rehearsed:
    plan = compiled_text(text, "none")
    assert plan.plan is not None, plan.diagnostics
    ir = plan.plan.trajectory
    conditions = conditions_of(ir.keyframes.mission, asked)
    return rehearse(ir, conditions, simulated(ir, conditions, 2, 1), lambda _: None)


def rides(speed: float) -> Truth:
    """A true track of the rider that leads along the planned one, and meets it as the shot begins."""
    points = ((42.0 - 14.0 * speed, 0.0, 0.9), (42.0 + 76.0 * speed, 0.0, 0.9))
    return Truth(tracks=(("rider", Track((0.0, 90.0), points)),))


def only(found: list[Diagnostic]) -> Diagnostic:
    (one,) = found
    return one


@pytest.mark.long
def test_a_subject_faster_than_the_drone_is_a_warning_at_its_shot() -> None:
    done = flown(RehearsalOptions(loop="replan", truth=rides(12.0)))
    found = only(list(deviations(done)))
    assert found.code == "W008"
    assert found.labels[0].span.line == 7
    lag = max((lag for run in done.runs for lag in run.lags), key=lambda lag: lag.behind)
    # The rider gains at least 4 m/s on the drone's 8 m/s for nearly 5 s.
    assert 16.0 < lag.behind < 35.0
    assert 18.0 < lag.time < 19.0
    assert lag.speed == pytest.approx(12.0, abs=0.01)
    assert lag.most == pytest.approx(8.0)
    assert "in 2 of 2 runs" in found.message
    assert found.help is not None
    assert float(re.search(r"`limits.speed` of cam over ([\d.]+) m/s", found.help)[1]) == pytest.approx(
        12.0, abs=0.1
    )


@pytest.mark.long
def test_the_proposed_speed_and_the_true_track_end_the_warning() -> None:
    asked = RehearsalOptions(loop="replan", truth=rides(9.0))
    found = only(list(deviations(flown(asked))))
    fast = re.search(r"`limits.speed` of cam over ([\d.]+) m/s", found.help or "")
    assert fast is not None
    limits = f"limits: {{speed: {float(fast[1]) + 1.0} m/s}}"
    text = BIKE.replace("start: [0, 0, 0.9], velocity: [3,", "start: [-84, 0, 0.9], velocity: [9,")
    text = text.replace("model: x500", f"model: x500, {limits}")
    assert list(deviations(flown(asked, text))) == []


@pytest.mark.long
def test_a_subject_that_the_drone_can_follow_is_none() -> None:
    assert list(deviations(flown(RehearsalOptions(loop="replan", truth=rides(4.0))))) == []


@pytest.mark.long
@pytest.mark.parametrize("loop", ["track", "replan"])
def test_a_receiver_10_m_off_is_a_warning_at_the_drone(loop) -> None:
    done = flown(RehearsalOptions(loop=loop, bias=10.0))
    found = only(list(deviations(done)))
    assert found.code == "W009"
    assert found.labels[0].span.line == 5
    assert "in 2 of 2 runs" in found.message
    far = max(run.courses[0].misled.metres for run in done.runs)
    assert 9.5 < far < 12.0
    assert any("target rider" in note or "ground" in note for note in found.notes)


@pytest.mark.long
def test_gusts_and_corrected_positions_are_none() -> None:
    done = flown(RehearsalOptions(loop="replan", gusts=1.0))
    assert list(deviations(done)) == []
    assert all(run.courses[0].misled.metres < 0.2 for run in done.runs)


@pytest.mark.long
@pytest.mark.parametrize("loop", ["replay", "track", "replan"])
def test_a_drone_without_positions_holds_and_comes_back_and_it_is_a_warning(loop) -> None:
    done = flown(RehearsalOptions(loop=loop, outages=(Outage(12.0, 17.0, "cam"),)))
    found = only([each for each in deviations(done) if each.code == "W011"])
    assert found.labels[0].span.line == 5
    assert "cam has no positions of its own from 12 to 17 s" in found.message
    course = done.runs[0].courses[0]
    assert 0.1 < course.unplaced.metres < 4.0
    assert course.unplaced.time == pytest.approx(17.0, abs=0.05)
    ir, conditions = done.ir, done.conditions
    world, (cam,) = simulated_flights(ir, conditions, (0,))
    held = at_times(cam.velocity[:, 0], cam.times, np.array([13.9, 16.0, 16.9]))
    assert np.linalg.norm(held[0]) > 2.0
    assert np.linalg.norm(held[1:], axis=1).max() < 1.0  # as well as it knows its place
    end = ir.drones[0].curve.end
    home = at_times(cam.position[:, 0], cam.times, np.array([end]))[0]
    assert home == pytest.approx(ir.drones[0].curve(np.array([end]))[0, :3], abs=0.5)
    assert "cam" in world.conditions.outages[0]


def test_an_outage_over_its_pad_or_shorter_than_two_seconds_stops_nobody() -> None:
    done = flown(RehearsalOptions())
    film = film_of(done.mission, done.ir.drones[0])
    lands = next(phase.start for phase in film.track.phases if phase.name == "land")
    assert held_intervals(film, ((10.0, 12.0), (lands - 1.0, lands + 5.0))) == ()
    assert held_intervals(film, ((10.0, 12.5),)) == ((12.0, 12.5),)
    risen = next(phase.end for phase in film.track.phases if phase.name == "takeoff")
    assert held_intervals(film, ((0.0, risen - 0.1),)) == ()
    assert held_intervals(film, ((0.0, risen + 1.0),)) == ((risen, risen + 1.0),)


@pytest.mark.long
def test_a_replanner_without_plans_is_a_warning_that_counts_and_says_why(monkeypatch) -> None:
    asked = RehearsalOptions(loop="replan", replanner="theirs")
    compiled_text(BIKE, "none")
    theirs = plugins.Source(None, "theirs", "tests.support.failing_replanners:RAISES")
    monkeypatch.setattr(plugins, "one", lambda _group, _name: theirs)
    found = [each for each in deviations(flown(asked)) if each.code != "W008"]
    assert only(found).code == "W010"
    assert only(found).labels[0].span.line == 5
    assert "`theirs` gives cam no plan in 20 of 20 replans" in only(found).message
    assert "ZeroDivisionError: no plan today" in only(found).notes

"""Smoothing: what it does to each kind of motion, against what the cost says it has to do."""

from __future__ import annotations

from math import pi, sin

import numpy as np
import pytest

from shotc.comparison import Options, compare_source
from shotc.ir.path import ClockLeg, MovingLeg, filmed
from shotc.planning.timing.limits import ceiling_of
from shotc.planning.timing.timed_leg import time_leg
from shotc.plugin_api.replanner import USUAL_FRAMING
from shotc.simulation.film import film_of
from shotc.simulation.situations import replanned
from tests.support.compiled import compiled_text
from tests.support.front_passes import clean, placed

HEAD = """\
shotc: 1
mission: smooth
targets:
  runner: {track: {points: [POINTS], times: [TIMES]}, radius: 0.4, height: 1.8}
  tower: {at: [0, 90, 12], radius: 4, height: 24}
drones:
  cam1: {model: x500, home: [0, -20, 0]}
RULES
shots:
"""
PERIOD_S, WAVE_M = 4.0, 0.8
FRAMING = (
    "  - {id: s, kind: framing, drone: cam1, timing: {start: 10, duration: 12}, EXTRA, subjects: [SUBJECT]}\n"
)
SUBJECT = "{target: runner, frame: center, size: 0.2, view: {azimuth: 180 deg, elevation: 30 deg}}"
PATH = """\
  - id: s
    kind: keyframes
    drone: cam1
    target: tower
    TIMING
    smoothing: HOW
    keyframes:
      - {at: [-40, 40, 20], look_at: tower}
      - {at: [0, 30, 25], look_at: tower}
      - {at: [40, 40, 20], look_at: tower}
"""


def head(rules: str = "") -> str:
    """A runner who goes east at 1 m/s and weaves to the north and the south."""
    times = np.arange(0.0, 30.05, 0.1)
    points = ", ".join(f"[{t:.1f}, {WAVE_M * sin(2 * pi * t / PERIOD_S):.5f}, 0.9]" for t in times)
    return (
        HEAD.replace("POINTS", points)
        .replace("TIMES", ", ".join(f"{t:.1f}" for t in times))
        .replace("RULES", rules)
    )


def framing(extra: str, rules: str = "") -> str:
    return head(rules) + FRAMING.replace("EXTRA, ", extra).replace("SUBJECT", SUBJECT)


def leg_of(mission: str) -> ClockLeg | MovingLeg:
    done = compiled_text(mission, "none", "m.yaml")
    assert done.plan is not None, done.diagnostics
    return filmed(next(r.output for r in done.reports if r.name == "solve-path-qp"), "s")


@pytest.mark.slow
@pytest.mark.parametrize(("how", "seconds"), [("low", 0.25), ("0.5 s", 0.5), ("0.8 s", 0.8)])
def test_a_wave_keeps_the_share_of_its_height_that_the_cost_leaves_it(how: str, seconds: float) -> None:
    """Squared distance plus seconds^6 of squared jerk: a wave w rad/s keeps 1 / (1 + (w seconds)^6)."""
    leg = leg_of(framing(f"smoothing: {how}, "))
    t = np.linspace(14.0, 14.0 + PERIOD_S, 400, endpoint=False)
    wave = np.exp(-2j * pi * t / PERIOD_S)
    kept = 2 * abs((leg.curve(t)[:, 1] * wave).mean()) / WAVE_M
    assert kept == pytest.approx(1 / (1 + (2 * pi / PERIOD_S * seconds) ** 6), abs=0.02)


def test_a_shot_has_its_own_smoothing_or_that_of_the_rules_or_the_normal_one() -> None:
    asked = [
        clean(framing(shot, rules)).mission.shots[0].smoothing
        for shot, rules in (
            ("", ""),
            ("", "rules: {smoothing: high}"),
            ("smoothing: low, ", "rules: {smoothing: high}"),
            ("smoothing: 1200 ms, ", ""),
        )
    ]
    assert asked == [0.5, 1.5, 0.25, 1.2]


@pytest.mark.parametrize(
    ("written", "code", "said"),
    [("calm", "S009", "low"), ("9 s", "S014", "3 s"), ("2 m", "U002", "a duration"), ("[1]", "U005", "list")],
)
def test_a_smoothing_that_is_none_is_told(written: str, code: str, said: str) -> None:
    (found,) = placed(framing(f"smoothing: {written}, "))[1]
    assert found.code == code
    assert said in f"{found.message} {found.help}"


@pytest.mark.slow
def test_accelerations_of_a_shot_on_a_path_build_up_more_slowly() -> None:
    drone = clean(head() + PATH.replace("TIMING", "timing: auto").replace("HOW", "high")).mission.drones[0]
    legs = [
        leg_of(head() + PATH.replace("TIMING", "timing: auto").replace("HOW", how))
        for how in ("normal", "high", "3 s")
    ]
    jerks, times = [], []
    for leg in legs:
        motion = time_leg(leg, ceiling_of(drone)).motion
        t = np.linspace(0.0, motion.duration, 4000)[1:-1]
        jerks.append(np.linalg.norm(motion.curve.channels(0, 1, 2).derivative(3)(t), axis=1).max())
        times.append(motion.duration)
    pace = 0.75
    assert jerks[1] <= pace * drone.limits.jerk / 3 * 1.0001
    assert jerks[2] <= pace * drone.limits.jerk / 6 * 1.0001
    assert times == sorted(times)


@pytest.mark.slow
def test_a_duration_goes_before_smoothing() -> None:
    mission = head() + PATH.replace("TIMING", "timing: {duration: SECONDS}").replace("HOW", "3 s")
    drone = clean(mission.replace("SECONDS", "40")).mission.drones[0]
    free = leg_of(head() + PATH.replace("TIMING", "timing: auto").replace("HOW", "normal"))
    least = time_leg(free, ceiling_of(drone)).motion.duration * 0.8
    for seconds, smooth in ((f"{least:.1f}", False), ("40", True)):
        motion = time_leg(leg_of(mission.replace("SECONDS", seconds)), ceiling_of(drone)).motion
        t = np.linspace(0.0, motion.duration, 4000)[1:-1]
        most = np.linalg.norm(motion.curve.channels(0, 1, 2).derivative(3)(t), axis=1).max()
        assert motion.duration == pytest.approx(float(seconds))
        assert (most <= drone.limits.jerk / 6 * 1.0001) == smooth


@pytest.mark.slow
def test_normal_smoothing_is_what_a_silent_mission_has() -> None:
    silent, normal = leg_of(framing("")), leg_of(framing("smoothing: normal, "))
    assert np.array_equal(silent.curve.ctrl, normal.curve.ctrl)


@pytest.mark.long
def test_compare_shows_a_calmer_camera_farther_from_its_place() -> None:
    mission = framing("").replace("{target: runner, frame: center, ", "{target: runner, frame: left-third, ")
    done = compare_source(mission.encode(), "m.yaml", None, Options(("none", "ours"), (0.25, 0.5, 1.5)))
    assert done.comparison is not None, done.diagnostics
    each = done.comparison.conditions
    assert [c.name for c in each][:3] == [
        "none, smoothing low",
        "ours, smoothing low",
        "none, smoothing normal",
    ]
    for refiner in ("none", "ours"):
        scores = [c.score for c in each if c.refiner == refiner]
        jerk, off = ([getattr(s, name) for s in scores] for name in ("jerk_rms", "off_place"))
        assert jerk == sorted(jerk, reverse=True), refiner
        assert jerk[0] > 3 * jerk[2], refiner
        assert off[2] > 4 * off[1], refiner
    # Who leaves out a wave of its place turns more; who weighs both does neither.
    turning = [c.score.turn_jerk_rms for c in each if c.refiner == "ours"]
    assert turning == sorted(turning, reverse=True)


@pytest.mark.slow
def test_who_plans_anew_weighs_the_rates_of_the_camera_by_the_square_of_the_smoothing() -> None:
    weights = []

    class Seat:
        def framing(self, problem):
            weights.append(problem.weights)

    for how in ("normal", "high"):
        plan = compiled_text(framing(f"smoothing: {how}, "), "none", "m.yaml").plan
        mission, (track,) = plan.trajectory.keyframes.mission, plan.trajectory.drones
        (shot,) = replanned(mission, track)
        shot.planner(Seat(), film_of(mission, track), None)
    assert weights[0] == USUAL_FRAMING
    assert weights[1] == USUAL_FRAMING._replace(turning=pytest.approx(9 * USUAL_FRAMING.turning))

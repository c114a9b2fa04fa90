"""A target whose agility is learned: calm while it keeps to its way, quick when it leaves it."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.bernstein import Array
from shotc.simulation.kalman import MotionModel, PositionFix, predicted
from shotc.simulation.modes import LASTS_S, begun, stepped, updated_modes
from shotc.simulation.seen import WALKS
from shotc.simulation.tracker import Tracker

RUNS, EVERY, NOISE, CORNER_S, END_S = 40, 0.2, 0.3, 12.0, 20.0
CALM, AGILE = WALKS


def truth(time: float) -> tuple[Array, Array]:
    """A runner at 3 m/s who turns left at a corner: place and velocity."""
    after = max(0.0, time - CORNER_S)
    place = np.array([3.0 * (time - after), 3.0 * after, 0.0])
    return place, np.array([0.0, 3.0, 0.0]) if after else np.array([3.0, 0.0, 0.0])


def errors(*models: MotionModel) -> Array:
    """Errors of the velocity after each fix, (T, R), and their times by EVERY."""
    rng = np.random.default_rng(5)
    first, speed = truth(0.0)
    tracker = Tracker.beginning(0.0, np.tile(first, (RUNS, 1)), np.tile(speed, (RUNS, 1)), *models)
    off = []
    for k in range(1, round(END_S / EVERY)):
        place, velocity = truth(k * EVERY)
        seen = place + NOISE * rng.standard_normal((RUNS, 3))
        tracker.take(PositionFix(k * EVERY, seen, NOISE, np.ones(RUNS, dtype=bool)))
        off.append(np.linalg.norm((tracker.now(k * EVERY).velocity - velocity)[:, :2], axis=1))
    return np.array(off)


def mean(off: Array, start: float, end: float) -> float:
    return float(off[round(start / EVERY) : round(end / EVERY)].mean())


@pytest.mark.slow
def test_it_is_calm_on_a_straight_way_and_follows_at_a_corner() -> None:
    both, calm, agile = errors(CALM, AGILE), errors(CALM), errors(AGILE)
    straight, corner = (6.0, CORNER_S - 0.5), (CORNER_S + 1.0, CORNER_S + 4.0)
    assert mean(both, *straight) < 0.6 * mean(agile, *straight)
    assert mean(both, *straight) < 1.3 * mean(calm, *straight)
    assert mean(both, *corner) < 0.7 * mean(calm, *corner)
    assert mean(both, *corner) < 1.3 * mean(agile, *corner)


@pytest.mark.slow
def test_one_model_is_the_filter_itself_and_alike_models_are_one() -> None:
    assert errors(AGILE, AGILE) == pytest.approx(errors(AGILE), abs=1e-9)


def test_shares_are_those_of_bayes_rule() -> None:
    """One fix, two models: believed by the densities of its miss, after one could have followed the other."""
    start = Tracker.beginning(0.0, np.zeros((1, 3)), np.zeros((1, 3)), CALM).now(0.0)
    models = (CALM, AGILE)
    fix = PositionFix(2.0, np.array([[3.0, -1.0, 0.5]]), 0.1, np.array([True]))
    found = updated_modes(stepped(begun(start, models), 2.0, models), fix)
    stays = np.exp(-2.0 / LASTS_S)
    before = np.array([0.5, 0.5]) @ (stays * np.eye(2) + 0.5 * (1.0 - stays))
    density = []
    for model in models:
        spread = predicted(start, 2.0, model).covariance[0, :3, :3] + 0.01 * np.eye(3)
        miss = fix.place[0]
        density.append(np.exp(-0.5 * miss @ np.linalg.solve(spread, miss)) / np.sqrt(np.linalg.det(spread)))
    wanted = before * density / (before @ density)
    assert found.share[0] == pytest.approx(wanted, rel=1e-6)
    # The mixture's covariance holds how far its parts are from each other.
    parts = np.array([each.mean[0] for each in found.estimates])
    between = sum(
        s * np.outer(p - found.whole.mean[0], p - found.whole.mean[0])
        for s, p in zip(found.share[0], parts, strict=True)
    )
    own = sum(s * each.covariance[0] for s, each in zip(found.share[0], found.estimates, strict=True))
    assert found.whole.covariance[0] == pytest.approx(own + between, abs=1e-12)


def test_a_run_without_a_measurement_believes_as_before() -> None:
    start = Tracker.beginning(0.0, np.zeros((2, 3)), np.zeros((2, 3)), CALM).now(0.0)
    models = (CALM, AGILE)
    fix = PositionFix(1.0, np.full((2, 3), 4.0), 0.1, np.array([True, False]))
    found = updated_modes(stepped(begun(start, models), 1.0, models), fix)
    assert found.share[1] == pytest.approx([0.5, 0.5])
    assert found.share[0, 1] > 0.6

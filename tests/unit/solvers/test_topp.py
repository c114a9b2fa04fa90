"""The fastest profile by both solvers, against closed forms, against each other, and in whole missions."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.planning.timing import move
from shotc.planning.timing.grid import lay_grid, rough_profile, sample
from shotc.planning.timing.leg import timed_once
from shotc.planning.timing.move import axes_of, topp_limits
from shotc.solvers import topp, topp_lp, topp_ra
from shotc.solvers.conic import Status
from shotc.solvers.topp_problem import FastestProfile, LinearLimits
from tests.support.few import few
from tests.support.timing_paths import CEILING, smooth

SPECS = Path(__file__).parents[3] / "specs"
FILMS = sorted(p.stem for p in SPECS.glob("*.yaml") if "fleets:" not in p.read_text(encoding="utf-8"))

ROUNDING = {"shotc.solvers.topp_ra": 4e-4, "shotc.solvers.topp_lp": 1e-6}
"""Share of a time in closed form: toppra's own linear programs have wide absolute tolerances."""


@pytest.fixture(params=["toppra", "clarabel"])
def fastest(request: pytest.FixtureRequest) -> Callable[[LinearLimits], FastestProfile]:
    """One solver after the other."""
    pytest.importorskip(request.param)
    return {"toppra": topp_ra, "clarabel": topp_lp}[request.param].fastest


def straight(grid: np.ndarray, speed: float, acceleration: float) -> LinearLimits:
    """A straight line: |a| <= acceleration and b <= speed^2."""
    rows = np.tile([1.0, -1.0], (len(grid), 1)) / acceleration
    return LinearLimits(grid, rows, np.zeros_like(rows), np.full(len(grid), speed**2))


def excess(limits: LinearLimits, b: np.ndarray) -> float:
    """By how much the worst row of a profile is above its bound, which is 1."""
    a = np.diff(b) / (2 * limits.widths)
    starts = limits.on_a[:-1] * a[:, None] + limits.on_b[:-1] * b[:-1, None]
    ends = limits.on_a[1:] * a[:, None] + limits.on_b[1:] * b[1:, None]
    return float(max(starts.max(), ends.max()) - 1.0)


@pytest.mark.parametrize("length", [1e-6, 1e-3, 0.4, 10.0, 300.0, 20_000.0])
def test_a_straight_line_is_flown_bang_bang(fastest, length: float) -> None:
    speed, acceleration = 8.0, 3.0
    ramp = min(speed**2 / (2 * acceleration), length / 2)
    peak = np.sqrt(2 * acceleration * ramp)
    # Cells from a thousandth of a ramp, with nodes where the acceleration changes.
    up = ramp * np.linspace(0.0, 1.0, 33) ** 2
    grid = np.unique(np.concatenate([up, np.linspace(ramp, length - ramp, 9), length - up]))
    grid = grid[np.concatenate([[True], np.diff(grid) > 1e-12 * length])]
    found = fastest(straight(grid, speed, acceleration))
    assert found.status is Status.SOLVED
    best = 2 * peak / acceleration + (length - 2 * ramp) / peak
    assert found.time == pytest.approx(best, rel=ROUNDING[fastest.__module__])
    assert (found.b[0], found.b[-1]) == (0.0, 0.0)


def test_a_slow_place_is_braked_for_and_left_at_full_acceleration(fastest) -> None:
    grid = np.linspace(0.0, 40.0, 161)
    limits = straight(grid, 100.0, 2.0)
    limits.cap[80] = 1.0
    found = fastest(limits)
    # b = 1 + 4 |s - 20| about the slow place, 4 s from rest: they meet 10.125 m along.
    expected = np.minimum(np.minimum(4 * grid, 4 * (40 - grid)), 1 + 4 * np.abs(grid - 20))
    assert found.b[1:-1] == pytest.approx(expected[1:-1], rel=2e-3)


def test_a_bend_takes_its_share_of_the_acceleration(fastest) -> None:
    # |a| + b / 10 <= 3: towards b = 30 with a slope that falls as b grows, b = 30 (1 - exp(-s / 5)).
    grid = np.linspace(0.0, 100.0, 1001)
    rows = np.tile([1.0, -1.0], (len(grid), 1)) / 3.0
    bend = np.full_like(rows, 1.0 / 30.0)
    found = fastest(LinearLimits(grid, rows, bend, np.full(len(grid), 1e6)))
    assert found.b[1:400] == pytest.approx(30 * (1 - np.exp(-grid[1:400] / 5)), rel=0.02)
    assert found.b[500] == pytest.approx(30.0, rel=1e-4)


def test_at_constant_speed_the_strictest_row_decides() -> None:
    on_b = np.array([[0.5, 0.1], [0.1, 0.25], [0.0, -1.0]])
    limits = LinearLimits(np.arange(3.0), np.ones((3, 2)), on_b, np.array([9.0, 3.0, 7.0]))
    assert limits.ceiling.tolist() == [2.0, 3.0, 7.0]


def test_units_are_what_full_acceleration_and_full_braking_leave_of_the_ceiling() -> None:
    # 2 m/s^2 from the start, 0.5 m/s^2 to the end, cells of different widths.
    grid = np.concatenate([np.linspace(0.0, 10.0, 41), np.linspace(10.5, 40.0, 60)])
    limits = straight(grid, 6.0, 2.0)
    limits.on_a[:, 1] = -2.0
    expected = np.minimum(np.minimum(4.0 * grid, 40.0 - grid), 36.0)
    assert topp_lp._units(limits)[1:-1] == pytest.approx(expected[1:-1])


@pytest.mark.parametrize("fails", [Status.FAILED, Status.INFEASIBLE, Status.UNBOUNDED])
def test_a_solver_that_gives_nothing_gives_no_profile(fails: Status, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(topp_lp.ConeRows, "solve", lambda self, *_: (fails, np.full(self.unknowns, np.nan)))
    found = topp_lp.fastest(straight(np.linspace(0.0, 1.0, 9), 1.0, 1.0))
    assert (found.status, found.time) == (Status.FAILED, float("inf"))
    assert not found.b.any()


@pytest.mark.parametrize("seed", range(5))
def test_on_random_paths_the_linear_programme_keeps_every_row_and_is_no_slower(seed: int) -> None:
    pytest.importorskip("toppra")
    path = smooth(seed)
    span = (0.0, path.end)
    limits = axes_of(path, span, CEILING)
    grid = lay_grid(path, *rough_profile(path, *span, limits), np.empty(0))
    rows = topp_limits(sample(path, grid), limits)
    other, mine = topp_ra.fastest(rows), topp_lp.fastest(rows)
    assert excess(rows, mine.b) < 1e-6
    # TOPP-RA takes the most of each cell in its turn; on a coarse grid that is not quite the best.
    assert -1e-6 < other.time / mine.time - 1.0 < 5e-4


@pytest.mark.slow
@pytest.mark.parametrize("name", few(FILMS, ["pisa-campanile", "river-path", "tower-reveal"]))
def test_missions_are_planned_without_toppra(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[LinearLimits] = []

    def by_lp(limits: LinearLimits) -> FastestProfile:
        asked.append(limits)
        return topp_lp.fastest(limits)

    monkeypatch.setattr(topp, "solver", lambda: by_lp)
    assert move.fastest is topp.fastest
    timed_once.cache_clear()  # what another test has timed is not asked for again
    text = (SPECS / f"{name}.yaml").read_bytes()
    done = compile_source(text, f"{name}.yaml", SPECS, PlanOptions(refiner="none"))
    assert done.plan is not None, done.diagnostics
    assert done.plan.certificate
    pytest.importorskip("toppra")
    assert asked
    for limits in asked:
        assert topp_lp.fastest(limits).time == pytest.approx(topp_ra.fastest(limits).time, rel=1e-4)


def test_the_solver_is_toppra_where_it_can_be_imported(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing() -> None:
        raise ModuleNotFoundError("No module named 'toppra'", name="toppra")

    monkeypatch.setattr(topp_ra, "load", lambda: None)
    assert topp.solver.__wrapped__() is topp_ra.fastest
    monkeypatch.setattr(topp_ra, "load", missing)
    assert topp.solver.__wrapped__() is topp_lp.fastest

"""Paths that are drawn by points: flown near their lines, told where they are not, and held to that."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from math import cos, dist, exp, log, pi, sin
from pathlib import Path

import numpy as np
import pytest

from shotc.api import Compilation, PlanOptions, compile_source
from shotc.cli.summary import summary
from shotc.ir.drawn import half_widths
from shotc.ir.trajectory import VerifiedIR
from shotc.planning.path import shots
from shotc.rounding import at_least
from tests.support.few import few

Point = tuple[float, float, float]
SURVEY = [(0, 0, 40), (80, 0, 40), (80, 15, 40), (0, 15, 40), (0, 30, 40), (80, 30, 40)]
CORNER = [(0, 0, 40), (80, 0, 40), (80, 80, 40)]
MAST = "mast: {keep: out, cylinder: {center: [40, 0], radius: 2, height: [0, 60]}}"


def mission(points: list[Point], extra: str = "", zones: str = "") -> str:
    return f"""\
shotc: 1
mission: drawn
world: {{zones: {{{zones}}}}}
drones: {{cam: {{model: x500, home: [-20, -30, 0]}}}}
rules: {{allow: [fast-pan]}}
shots:
  - {{id: lines, kind: follow-path, drone: cam, points: {[list(p) for p in points]}{extra}}}
"""


@lru_cache
def compiled(text: str, refiner: str = "none") -> Compilation:
    return compile_source(text.encode(), "drawn.yaml", None, PlanOptions(refiner=refiner))


def planned(text: str, refiner: str = "none") -> VerifiedIR:
    done = compiled(text, refiner)
    assert done.plan is not None, [d.message for d in done.diagnostics]
    return done.plan


def told(done: Compilation) -> list[str]:
    return [d.message for d in done.diagnostics if d.code == "Q006"]


def off_legs(plan: VerifiedIR, points: list[Point]) -> list[float]:
    """Return the largest distance from each leg, at samples between the times of its ends, metres."""
    (track,) = plan.trajectory.drones
    times = [k.time for k in track.keyframes]
    found = []
    for (start, end), (a, b) in zip(pairwise(times), pairwise(np.array(points, dtype=float)), strict=True):
        flown = track.curve(np.linspace(start, end, 2001))[:, :3]
        share = np.clip((flown - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        found.append(float(np.linalg.norm(flown - a - share[:, None] * (b - a), axis=1).max()))
    return found


def anything(seed: int) -> list[Point]:
    """Return a polyline of legs of 3 to 500 m with turns of any angle, back on itself as well."""
    rng = np.random.default_rng([seed, 80, 15])
    scale, heading = exp(rng.uniform(log(5.0), log(500.0))), rng.uniform(-pi, pi)
    points: list[Point] = [(0.0, 0.0, 40.0)]
    for _ in range(int(rng.integers(2, 7))):
        heading += rng.choice([0.0, 0.3, pi / 4, pi / 2, -pi / 2, 0.9 * pi, pi, rng.uniform(-pi, pi)])
        length = max(3.0, scale * exp(rng.uniform(-1.5, 0.0)))
        x, y, z = points[-1]
        climb = float(rng.choice([0.0, rng.uniform(-0.3, 0.3) * length]))
        ahead = (x + length * cos(heading), y + length * sin(heading), min(90.0, max(20.0, z + climb)))
        points.append((round(ahead[0], 2), round(ahead[1], 2), round(ahead[2], 2)))
    return points


@pytest.mark.parametrize(
    ("points", "widths"),
    [
        (CORNER, [5.0, 5.0]),
        (SURVEY, [1.5] * 5),
        ([(0, 0, 9), (3, 0, 9), (3, 40, 9), (43, 40, 9)], [0.5, 0.5, 4.0]),
        ([(0, 0, 9), (20, 0, 9), (20, 0, 9), (20, 30, 9)], [2.0, 0.5, 2.0]),
    ],
)
def test_a_leg_may_be_left_by_a_tenth_of_the_shortest_beside_it(
    points: list[Point], widths: list[float]
) -> None:
    assert half_widths(points) == pytest.approx(widths)


@pytest.mark.long
@pytest.mark.parametrize("refiner", ["none", "ours"])
@pytest.mark.parametrize("seed", few(range(24), range(2)))
def test_whatever_is_drawn_is_flown_near_its_lines(seed: int, refiner: str) -> None:
    points = anything(seed)
    smoothing = ("low", "normal", "high")[seed % 3]
    plan = planned(mission(points, f", smoothing: {smoothing}"), refiner)
    lengths = [dist(a, b) for a, b in pairwise(points)]
    for k, off in enumerate(off_legs(plan, points)):
        assert off <= min(5.0, max(0.5, 0.1 * min(lengths[max(k - 1, 0) : k + 2]))) + 2e-3


@pytest.mark.slow
@pytest.mark.parametrize("refiner", ["none", "ours"])
@pytest.mark.parametrize("metres", [1500.0, 9000.0])
def test_a_long_path_passes_its_points(metres: float, refiner: str) -> None:
    """Legs of kilometres with half-widths of 5 m have pieces of a few metres beside long ones."""
    points = [(metres * x, metres * y, 60.0) for x, y in ((-1, -0.4), (-0.6, -0.6), (0.2, -0.5), (0.7, -0.6))]
    text = mission(points).replace("-20, -30, 0", f"{-0.98 * metres}, {-0.4 * metres}, 0")
    (track,) = planned(text.replace("x500,", "x500, endurance: 200 min,"), refiner).trajectory.drones
    flown = track.curve(np.array([k.time for k in track.keyframes]))[:, :3]
    assert np.abs(flown - np.array(points)).max() < 1e-4


@pytest.mark.slow
@pytest.mark.parametrize("refiner", ["none", "ours"])
def test_what_is_told_is_what_is_flown(refiner: str) -> None:
    plan = planned(mission(SURVEY), refiner)
    flown = max(off_legs(plan, SURVEY))
    (deviation,) = plan.trajectory.deviations
    assert deviation.distance == pytest.approx(flown, abs=0.01)
    line = f"leaves its ideal by up to {at_least(deviation.distance)} m: the turns at its points"
    assert line in " ".join(summary(plan, [Path("plan.json")], []).split())
    assert told(compiled(mission(SURVEY), refiner)) == []


@pytest.mark.slow
def test_a_path_that_nobody_holds_is_told_and_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shots, "_widths", lambda *_: None)
    done = compile_source(mission(CORNER).encode(), "drawn.yaml", None, PlanOptions(refiner="none"))
    assert done.plan is None
    assert told(done) == ["shot `lines` leaves the lines between its points by up to 11.24 m"]
    assert any(d.code == "V044" and "way between keyframes" in str(d) for d in done.diagnostics)


@pytest.mark.slow
def test_a_leg_that_leads_round_an_obstacle_is_told_and_the_others_keep_their_lines() -> None:
    done = compiled(mission(CORNER, zones=MAST))
    assert done.plan is not None
    round_it, kept = off_legs(done.plan, CORNER)
    assert kept <= 5.0
    (message,) = told(done)
    assert message.endswith("round zone `mast`")
    largest = next(d for d in done.plan.trajectory.deviations if d.cause == "zone mast")
    assert largest.distance == pytest.approx(round_it, abs=0.01)

"""Seeded scenes in which others walk into the way of a camera, flown with and without what keeps it away.

``python -m tests.experiments.crowd`` measures them and prints the table in the plugin's README.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

import numpy as np
from shotc_casadi.clock import rounds, weights

from shotc.api import PlanOptions, compile_source
from shotc.ir.path import CAM_PITCH, CAM_YAW, ClockLeg, PathIR

SCENES = range(12)
WALKERS = 3
MISSION = """\
shotc: 1
mission: crowd
targets:
  runner: {{track: {{points: [[0, 0, 0.9], [60, 0, 0.9]], speed: 1.5 m/s}}, radius: 0.4, height: 1.8}}
{walkers}drones: {{cam: {{model: x500, home: [10, -20, 0]}}}}
rules: {{allow: [fast-pan]}}
shots:
  - {{id: s, kind: {kind}, drone: cam, target: runner, {shot}, timing: {{start: 12, duration: 12}}}}
"""


class Flown(NamedTuple):
    """What a scene came to.

    nearest : to the solid of anybody, metres, the clearance being 1.3 or so; screen : largest error, half
        frames; off : from the ideal place, metres
    turning : root of the mean square of the camera's angular acceleration, rad/s^2
    jerk : that of the place's jerk, m/s^3
    milliseconds : of all solves, warm; iterations : of those
    """

    nearest: float
    screen: float
    off: float
    turning: float
    jerk: float
    milliseconds: float
    iterations: int


def scene(seed: int) -> str:
    """Return a mission: a runner is filmed from the side, and walkers cross the camera's way."""
    rng = np.random.default_rng(seed)
    apart, height = rng.uniform(2.2, 5.0), rng.uniform(2.5, 3.0)
    walkers = []
    for i in range(WALKERS):
        meets = rng.uniform(13.0, 23.0)
        at = np.array([1.5 * meets, -apart]) + rng.uniform(-1.5, 1.5, 2)
        heading, pace = rng.uniform(0, 2 * np.pi), rng.uniform(0.5, 1.8)
        velocity = pace * np.array([np.cos(heading), np.sin(heading)])
        first, last = at - meets * velocity, at + 40 * velocity
        track = f"[[{first[0]:.2f}, {first[1]:.2f}, 0.9], [{last[0]:.2f}, {last[1]:.2f}, 0.9]]"
        walkers.append(
            f"  w{i}: {{track: {{points: {track}, speed: {pace:.3f} m/s}}, radius: 0.4, height: 1.8}}\n"
        )
    shot = f"side: right, distance: {apart:.2f}, altitude: {height:.2f}"
    return MISSION.format(walkers="".join(walkers), kind="lateral", shot=shot)


@contextmanager
def only(field: bool, ellipsoid: bool, reach: float = weights.RANGE_M) -> Iterator[None]:
    """Leave out the potential field, the ellipsoids or both, or have the field end elsewhere."""
    before = rounds.bodies_of, weights.FIELD_WEIGHT, weights.RANGE_M
    if not ellipsoid:
        rounds.bodies_of = lambda _around, _breaks: ()
    weights.FIELD_WEIGHT, weights.RANGE_M = before[1] if field else 0.0, reach
    try:
        yield
    finally:
        rounds.bodies_of, weights.FIELD_WEIGHT, weights.RANGE_M = before


def fly(text: str) -> Flown | None:
    """Plan a mission and measure its refined shot; None where there is no plan."""
    solved: list[tuple[float, int]] = []
    true = rounds.solve

    def timed(*given):  # type: ignore[no-untyped-def]
        found = true(*given)
        solved.append((found.seconds, found.iterations))
        return found

    rounds.solve = timed
    try:
        done = compile_source(text.encode(), "crowd.yaml", None, PlanOptions(refiner="ours"))
    finally:
        rounds.solve = true
    if done.plan is None:
        return None
    path: PathIR = next(report.output for report in done.reports if report.name == "refine-path")
    leg = next(one for one in path.timed[0].legs if isinstance(one, ClockLeg))
    t = np.linspace(leg.start, leg.end, 600)
    eyes = leg.curve(t)[:, :3]
    claims = {c.constraint: c.worst for c in done.plan.certificate if c.shot in (None, "s")}
    second, third = leg.curve.derivative(2)(t), leg.curve.derivative(3)(t)
    return Flown(
        min(_gap(path, name, t, eyes) for name in [target.name for target in path.keyframes.mission.targets]),
        claims["runner screen error"],
        claims["distance from its place"],
        float(np.sqrt((second[:, [CAM_YAW, CAM_PITCH]] ** 2).sum(axis=1).mean())),
        float(np.sqrt((third[:, :3] ** 2).sum(axis=1).mean())),
        1e3 * sum(seconds for seconds, _ in solved),
        sum(count for _, count in solved),
    )


def _gap(path: PathIR, name: str, t: np.ndarray, eyes: np.ndarray) -> float:
    target = path.keyframes.mission.target(name)
    away = eyes - np.array([target.at(float(u)) for u in t])
    across = np.maximum(0.0, np.hypot(away[:, 0], away[:, 1]) - target.radius)
    return float(np.hypot(across, np.maximum(0.0, np.abs(away[:, 2]) - target.height / 2)).min())


def main() -> None:
    """Print what every combination comes to, over all scenes that can be flown."""
    texts = [text for text in map(scene, SCENES) if fly(text) is not None]
    print(f"{len(texts)} of {len(SCENES)} scenes are flown")  # noqa: T201
    for name, parts in {
        "neither": (False, False),
        "ellipsoid": (False, True),
        "both": (True, True),
        "both, in a range of 1 m": (True, True, 1.0),
    }.items():
        with only(*parts):
            rows = np.array([found for text in texts if (found := fly(text)) is not None])
        mean = rows.mean(axis=0)
        cells = [f"{rows[:, 0].min():.3f} m", f"{mean[0]:.3f} m", f"{mean[1]:.4f}", f"{mean[2]:.2f} m"]
        cells += [f"{mean[3]:.3f} rad/s^2", f"{mean[4]:.2f} m/s^3", f"{mean[6]:.0f}"]
        print(f"| {name} | {' | '.join(cells)} | {np.median(rows[:, 5]):.0f} ms |")  # noqa: T201


if __name__ == "__main__":
    main()

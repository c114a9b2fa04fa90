"""Missions that film several who walk in one picture, drawn by seeds: the guide beside what is refined.

``python -m tests.experiments.faces`` measures them and prints the table in the README of shotc-casadi.
"""

from __future__ import annotations

import time
from typing import NamedTuple

import numpy as np

from shotc.api import PlanOptions, compile_source
from shotc.ir.path import CAM_PITCH, CAM_YAW, ClockLeg, PathIR
from shotc.ir.sampling import seen
from shotc.ir.trajectory import DroneTrajectory

SCENES = range(24)
MISSION = """\
shotc: 1
mission: faces
{world}targets:
  a: {{{a}, radius: 0.4, height: 1.8}}
  b: {{{b}, radius: 0.4, height: 1.8}}
drones: {{cam: {{model: x500, home: [20, -20, 0]}}}}
rules: {{allow: [fast-pan]}}
shots:
  - {{id: s, kind: framing, drone: cam, timing: {{{start}duration: {lasts}}}, subjects: [{subjects}]}}
"""


def drawn(seed: int) -> str:
    """Two or three who walk along a way of their own each, framed with or without size and view."""
    rng = np.random.default_rng(seed)
    speed, number = rng.uniform(0.5, 3), int(rng.integers(2, 4))
    course = np.cumsum(np.vstack([[0.0, 0.0], rng.uniform(8, 25, (3, 2))]), axis=0)
    tracks, asked = [], []
    for name, u in zip("abc"[:number], (-0.35, 0.35, 0.0), strict=False):
        way = course + rng.uniform(-4, 4, course.shape)
        points = ", ".join(f"[{x:.2f}, {y:.2f}, 0.9]" for x, y in way)
        tracks.append(f"track: {{points: [{points}], speed: {speed:.2f} m/s}}")
        size = f", size: {rng.uniform(0.15, 0.4):.2f}" if name == "a" or rng.random() < 0.3 else ""
        view = f", view: {{azimuth: {rng.uniform(0, 360):.0f} deg}}" if rng.random() < 0.3 else ""
        asked.append(f"{{target: {name}, frame: [{u}, 0]{size}{view}}}")
    text = MISSION.format(world="", a=tracks[0], b=tracks[1], start="", lasts=6, subjects=", ".join(asked))
    if number < 3:
        return text
    third = f"  c: {{{tracks[2]}, radius: 0.4, height: 1.8}}\ndrones"
    return text.replace("drones", third, 1)


class Looks(NamedTuple):
    """How all subjects of a shot appear.

    screen, size : roots of the mean squares of what is off, half frames and logarithm
    hidden, cropped : shares of the frames in which somebody is; turning : as in tests.experiments.crowd
    """

    screen: float
    size: float
    hidden: float
    cropped: float
    turning: float


def looks(path: PathIR) -> Looks:
    """Return how the subjects of the one shot of a path appear."""
    leg = next(one for one in path.timed[0].legs if isinstance(one, ClockLeg))
    (placed,), mission = path.keyframes.shots, path.keyframes.mission
    t = np.linspace(leg.start, leg.end, 200)
    flight = DroneTrajectory("cam", leg.curve, (), (), ())
    screen, size, hidden, cropped = [], [], np.zeros(len(t), dtype=bool), np.zeros(len(t), dtype=bool)
    for subject in placed.subjects:
        found = seen(mission, flight, subject.target, t, ())
        u, v = subject.reference or (0.0, 0.0)
        screen.append((found.u - u) ** 2 + (found.v - v) ** 2)
        if subject.size is not None:
            size.append(np.log(found.size / subject.size) ** 2)
        hidden |= found.hidden.astype(bool)
        cropped |= ~found.in_frame.astype(bool)
    second = leg.curve.derivative(2)(t)[:, [CAM_YAW, CAM_PITCH]]
    roots = [float(np.sqrt(np.mean(part))) for part in (screen, size, (second**2).sum(axis=1))]
    return Looks(roots[0], roots[1], float(hidden.mean()), float(cropped.mean()), roots[2])


def main() -> None:
    """Print what the guide shows and what is flown instead, over all scenes that can be flown."""
    found, seconds, kept = [], [], 0
    for text in map(drawn, SCENES):
        began = time.perf_counter()
        done = compile_source(text.encode(), "faces.yaml", None, PlanOptions(refiner="ours"))
        if done.plan is None:
            continue
        seconds.append(time.perf_counter() - began)
        paths = {report.name: report.output for report in done.reports}
        pair = [looks(paths[step]) for step in ("solve-path-qp", "refine-path")]
        kept += pair[0] == pair[1]
        found.append(pair)
    print(f"{len(found)} of {len(SCENES)} scenes; {kept} keep their guide")  # noqa: T201
    for name, rows in zip(("guide", "refined"), np.moveaxis(np.array(found), 1, 0), strict=True):
        cells = [f"{value:.4f}" for value in rows.mean(axis=0)]
        print(f"| {name} | {' | '.join(cells)} |")  # noqa: T201
    better = sum(b.screen < a.screen for a, b in found)
    plain = [(a, b) for a, b in found if a.hidden == 0.0]
    for name, rows in zip(("guide", "refined"), np.moveaxis(np.array(plain), 1, 0), strict=True):
        cells = [f"{value:.4f}" for value in rows.mean(axis=0)]
        print(f"| {name}, where nobody is hidden | {' | '.join(cells)} |")  # noqa: T201
    print(f"better on screen {better}; planned in {np.median(seconds):.1f} s, {max(seconds):.1f} s at most")  # noqa: T201


if __name__ == "__main__":
    main()

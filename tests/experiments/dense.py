"""Moves between pictures as dense as the separation allows: are they all apart, and what do arcs cost.

A ball and a cube full of the densest lattice, turned at random, and a text full of a hexagonal one, matched
and moved as `plan` does. Straight ways between the same places are timed for comparison: they break the
separation. Run it by `python -m tests.experiments.dense`; `--drones 300 --seeds 3` for less of it. `--show
16000` plans a whole show of so many drones by the command, with plan.json written, and prints its CPU
seconds and its memory.
"""

from __future__ import annotations

import argparse
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from math import ceil, pi, sqrt
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from shotc.geom.apart import spacing, stretch
from shotc.geom.bernstein import Array
from shotc.geom.separation import closest
from shotc.ir.limits import Limits
from shotc.ir.show import Apart, Fleet, Lettering, Sphere
from shotc.show.assignment.moves import Mover
from shotc.show.geom.lattice import Mould, lattice, widest
from shotc.show.geom.push_apart import nearest_pair
from shotc.show.goals.flat import FlatBody
from shotc.show.goals.lettering import lettering_body
from shotc.show.solvers.match import matched
from shotc.show.solvers.move import fastest
from tests.support.display_missions import display, fleet, picture, show

APARTS = {"ellipsoid": Apart("ellipsoid", 1.5, 2.5, 0.0), "cylinder": Apart("cylinder", 1.5, 2.5, 0.0)}
LIMITS = Limits(5.0, 2.5, 2.0, 2.5, 8.0, 1.0, 1.0)
DRONES, SEEDS = (300, 1000), 20
HIGH_M = 120.0
SEEN = 25


class Moved(NamedTuple):
    """One move: its proved least distance, metres; its seconds, and those of straight ways; CPU seconds."""

    proven: float
    seconds: float
    straight: float
    cpu: float


def full(solid: str, apart: Apart, count: int, rng: np.random.Generator) -> Array:
    """Return places of the densest lattice, turned, in a ball or a cube that just holds so many, (n, 3)."""
    step = spacing(apart)
    side = 1.5 * step * (count + 20) ** (1 / 3)
    size = np.full(3, side)
    points = lattice(-size, size, step, apart.shape == "cylinder")
    if apart.shape == "ellipsoid":
        points = points @ np.linalg.qr(rng.normal(size=(3, 3)))[0]
    points = points + rng.uniform(0.0, step, 3)
    away = np.linalg.norm(points, axis=1) if solid == "ball" else np.abs(points).max(axis=1)
    return np.asarray(points[np.argsort(away, kind="stable")[:count]] / (1.0, 1.0, stretch(apart)))


def written(text: str, apart: Apart, count: int, rng: np.random.Generator) -> Array:
    """Return the widest lattice of so many places in a text, made just so small that it is as dense as may
    be, (n, 3).
    """
    step = spacing(apart)
    height = 1.1 * sqrt(count * step**2 / stretch(apart))
    body = lettering_body(Lettering(text, (0.0, 0.0, 0.0), height, float(rng.uniform(0.0, 6.0)), None), {})
    assert isinstance(body, FlatBody)
    points = body.draw("volume", SEEN * count, rng)
    assert points is not None
    scale = np.array([1.0, stretch(apart)])
    mould = Mould(cKDTree(body.flat(points) * scale), 0.25 * step, apart.shape == "cylinder")
    found = widest(mould, count, step)
    assert found is not None
    return body.standing(found / scale) * (step / nearest_pair(found))


def moves(count: int, seed: int, apart: Apart) -> Iterator[Moved]:
    """Yield the moves from the ball to the text and from the text to the cube, at one height."""
    rng = np.random.default_rng(seed)
    drawn = display(picture(Sphere((0.0, 0.0, HIGH_M), 10.0)))
    swarm: Fleet = fleet(count, apart)._replace(limits=LIMITS)
    mover = Mover(show(drawn, swarm).mission, swarm)
    scale = np.array([1.0, 1.0, stretch(apart)])
    here = full("ball", apart, count, rng)
    for there in (written("SHOTC", apart, count, rng), full("cube", apart, count, rng)):
        began = time.process_time()
        goals = there[matched(here * scale, there * scale)]
        up = np.array([0.0, 0.0, HIGH_M])
        move = mover.move(here + up, goals + up, 1.0, None)
        cpu = time.process_time() - began
        between = [np.round(points, 6) for points in move.between(here + up, goals + up)]
        coef = np.stack([*[here + up] * 3, *between, *[goals + up] * 3], axis=1)
        breaks = np.arange(coef.shape[1] - 2) * (move.duration / move.pieces)
        proven = closest(breaks, coef, apart).proven
        yield Moved(proven, move.duration, fastest(goals - here, LIMITS, 1.0).duration, cpu)
        here = goals
    assert not mover.faults


def mission(count: int) -> str:
    """Return a show of a ball, a text, a cube and a ring that just hold so many drones, pads as near as
    they may."""
    step, upright = 1.5, 0.6
    room = 1.08 * count * step**3 / sqrt(2.0) / upright
    ball, cube, tube = (3 * room / 4 / pi) ** (1 / 3), room ** (1 / 3), (room / 6 / pi**2) ** (1 / 3)
    text = 1.03 * sqrt(0.85 * count * step**2 / upright)
    high = 30.0 + max(ball, text / 2)
    at = f"center: [0, 20, {high:.1f}]"
    corner = -0.76 * ceil(sqrt(count))
    return f"""\
shotc: 1
mission: dense-{count}
fleets:
  swarm:
    count: {count}
    layout: {{grid: {{spacing: 1.52, origin: [{corner:.1f}, {corner:.1f}, 0]}}}}
    separation: {{horizontal: 1.5 m, vertical: 2.5 m}}
    rise: 8 m
    endurance: 60 min
    limits: {{speed: 5, climb: 2.5, descent: 2, acceleration: 2.5, jerk: 8}}
rules: {{max_height: off}}
shots:
  - id: shapes
    kind: display
    fleet: swarm
    frames:
      - {{sphere: {{{at}, radius: {ball:.2f}}}, hold: 4, color: orange}}
      - {{text: {{text: SHOTC, {at}, height: {text:.1f}}}, hold: 4}}
      - {{cube: {{{at}, size: {cube:.2f}}}, hold: 4, color: blue}}
      - {{torus: {{{at}, radius: {3 * tube:.2f}, tube: {tube:.2f}}}, hold: 4, color: lime}}
"""


def planned(count: int, emit: str) -> None:
    """Plan a show by the command, and print what it took."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "show.yaml"
        path.write_text(mission(count))
        command = [
            sys.executable,
            "-m",
            "shotc",
            "plan",
            str(path),
            "-o",
            folder,
            "--emit",
            emit,
            "--jobs",
            "1",
        ]
        subprocess.run(command, check=True)
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        size = (Path(folder) / "plan.json").stat().st_size
    print(
        f"{count} drones: {used.ru_utime + used.ru_stime:.1f} s of CPU, {used.ru_maxrss / 2**20:.2f} GiB, "
        f"plan.json of {size / 1e6:.0f} MB"
    )


def main() -> None:
    """Print a row for each number of drones and shape of what they keep free."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--drones", type=int, nargs="+", default=DRONES)
    asked.add_argument("--seeds", type=int, default=SEEDS)
    asked.add_argument("--shapes", nargs="+", default=list(APARTS), choices=list(APARTS))
    asked.add_argument("--show", type=int, help="drones of a whole show to plan by the command")
    asked.add_argument("--emit", default="skyc", help="outputs of that show besides plan.json")
    options = asked.parse_args()
    if options.show is not None:
        planned(options.show, options.emit)
        return
    print("| drones | keep free | moves apart | least | arcs | straight | ratio: mean, most | CPU |")
    print("|---|---|---|---|---|---|---|---|")
    for shape in options.shapes:
        apart = APARTS[shape]
        for count in options.drones:
            done = [m for seed in range(options.seeds) for m in moves(count, seed, apart)]
            kept = sum(m.proven >= apart.across for m in done)
            ratios = [m.seconds / m.straight for m in done]
            seconds, straight, cpu = (statistics.mean(column) for column in list(zip(*done, strict=True))[1:])
            print(
                f"| {count} | {shape} | {kept} of {len(done)} | {min(m.proven for m in done):.4f} m of "
                f"{apart.across} m | {seconds:.1f} s | {straight:.1f} s | {statistics.mean(ratios):.2f}, "
                f"{max(ratios):.2f} | {cpu:.2f} s |"
            )


if __name__ == "__main__":
    main()

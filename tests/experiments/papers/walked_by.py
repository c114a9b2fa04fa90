"""Framings planned anew past walkers: the viewpoint paper's Experiments 2 and 3.

Run it by `python -m tests.experiments.papers --only replanning`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from shotc_casadi.replan.framing import Framing

from shotc.geom.bernstein import Array
from shotc.geom.solid_arrays.segments import blocks
from shotc.geom.solids import Cylinder
from shotc.plugin_api.replanner import Appearance, FilmedSubject, Plan
from tests.experiments.papers.report import Table
from tests.experiments.papers.viewpoint import LASTS, PERSON_SIZE, START, crossing, roaming
from tests.support.framings import BENEATH, NOISE_M, PIXELS, appears, problem, seen_from, situation, subject
from tests.support.replans import DT

STAGES, SEEDS = 25, (0, 1, 2)
HEAD = np.array([0.0, 0.0, 1.6])
STAND = np.array([0.0, -3.9, 1.6])
SIZE = 0.084  # of a head, over the picture's height: a person half as high as it
WALKS = {"2, they cross and stop": crossing, "3, they walk at the camera": roaming}
COLUMNS = (
    "experiment, seed",
    "frames hidden",
    "screen error px, mean",
    "95 %",
    "head in frame",
    "least ellipsoid value",
    "stalled, opened",
)
NOTES = (
    "The walks of Experiments 2 and 3 above, 30 s at 0.9 m/s, but planned anew at 10 Hz over N = 25, as in "
    "the paper: a walker is believed to go on as in the last 0.2 s, places are known to 1 cm, and a head is "
    "framed, from in front.",
    "Hidden: the line to the head runs through another's cylinder of 0.3 m and 1.8 m. The ellipsoid is that "
    "of 0.6 x 0.6 x 1.1 m about every person; below 1 is inside.",
)


@dataclass(frozen=True, eq=False)
class Shown:
    """Frame by frame: hidden or not, pixels off, least x^T Omega x of all persons; what replans did."""

    hidden: Array
    off: Array
    value: Array
    told: list[str]


def table(say: Callable[[str], None]) -> Table:
    """Fly both experiments."""
    rows = []
    for name, walks in WALKS.items():
        say(f"walked by: {name}")
        for seed in SEEDS:
            one = fly(walks(seed), seed)
            rows.append(
                (
                    f"{name}: {seed}",
                    f"{100 * one.hidden.mean():.1f} %",
                    f"{one.off.mean():.1f}",
                    f"{np.percentile(one.off, 95):.1f}",
                    f"{100 * (one.off < PIXELS[1]).mean():.1f} %",
                    f"{one.value.min():.2f}",
                    f"{one.told.count('stalled')}, {one.told.count('opened')}",
                )
            )
    return Table("Framings past walkers (viewpoint, Experiments 2 and 3)", COLUMNS, tuple(rows), NOTES)


def fly(walks: dict[str, Array], seed: int, seconds: float = LASTS) -> Shown:
    """Film the head for so long; walks : rows t, x, y of the others, by name."""
    rng = np.random.default_rng(seed)
    planner, asked = Framing(problem(STAGES)), Appearance((0.0, 0.0), SIZE, seen_from(0.0, STAGES))
    place, velocity, aim = STAND, np.zeros(3), (np.pi / 2, 0.0)
    plan: Plan | None = None
    rows, told = [], []
    for k in range(round(seconds / DT)):
        t = START + DT * k
        others = [_walker(walk, t, rng) for walk in walks.values()]
        filmed = subject(HEAD + NOISE_M * rng.standard_normal(3), np.zeros(3), STAGES, asked)
        seen = place + NOISE_M * rng.standard_normal(3)
        known = situation(STAGES, (filmed, *others), place=seen, velocity=velocity, aim=aim, time=t)
        done = planner.replan(known, plan)
        plan = done.plan
        assert plan is not None
        assert plan.aim is not None
        told.append(done.status)
        place = place + DT * (velocity + 0.5 * DT * plan.accelerations[0])
        velocity = velocity + DT * plan.accelerations[0]
        aim = (float(plan.aim[1, 0]), float(plan.aim[1, 1]))
        feet = [_at(walk, t + DT) for walk in walks.values()]
        rows.append((_hidden(place, feet), appears(place, aim, HEAD, asked)[1], _value(place, feet)))
    hidden, off, value = np.array(rows).T
    return Shown(hidden, off, value, told)


def _walker(walk: Array, t: float, rng: np.random.Generator) -> FilmedSubject:
    now, before = _at(walk, t), _at(walk, t - 0.2)
    head = np.append(now, HEAD[2]) + NOISE_M * rng.standard_normal(3)
    return subject(head, np.append((now - before) / 0.2, 0.0), STAGES, None)


def _at(walk: Array, t: float) -> Array:
    return np.array([np.interp(t, walk[:, 0], walk[:, k]) for k in (1, 2)])


def _hidden(place: Array, feet: list[Array]) -> bool:
    radius, height = PERSON_SIZE
    bodies = (Cylinder((float(x), float(y)), radius, 0.0, height) for x, y in feet)
    return any(bool(blocks(body, place[None], HEAD)[0]) for body in bodies)


def _value(place: Array, feet: list[Array]) -> float:
    middles = [np.append(xy, HEAD[2] - BENEATH[2]) for xy in (*feet, HEAD[:2])]
    return min(float((((place - middle) / (0.6, 0.6, 1.1)) ** 2).sum()) for middle in middles)

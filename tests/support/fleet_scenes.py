"""Fleets and goal sets made by hand, for the tests of what flies them."""

from __future__ import annotations

from typing import Any

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.fleet import FleetGoals, Frame, GoalIR
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.limits import Limits, Timing
from shotc.ir.mission import MissionIR
from shotc.ir.origin import OriginMap
from shotc.ir.rules import Rules
from shotc.ir.show import Apart, Display, Fleet, Model, Picture, Sphere

LIMITS = Limits(5.0, 3.0, 2.0, 3.0, 8.0, 1.0, 1.0)
APART = Apart("ellipsoid", 0.9, 1.9, 0.1)


def grid(count: int, spacing: float = 3.0) -> Array:
    side = int(np.ceil(np.sqrt(count)))
    flat = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)[:count]
    return np.column_stack([spacing * (flat - (side - 1) / 2.0), np.zeros(count)])


def lattice(count: int, centre: Any, spacing: float, norm: float, apart: Apart = APART) -> Array:
    """Return the points of a lattice nearest to a centre: a ball (norm 2), a cube (norm inf)."""
    half = int(np.ceil(count ** (1 / 3))) + 1
    cells = np.stack(np.meshgrid(*[np.arange(-half, half + 1)] * 3), axis=-1).reshape(-1, 3)
    cells = cells[np.argsort(np.linalg.norm(cells, norm, axis=1), kind="stable")[:count]]
    return np.asarray(cells * spacing * [1.0, 1.0, apart.upright / apart.across] + centre)


def ring(count: int, centre: Any, spacing: float) -> Array:
    """Return an upright ring of two strands."""
    strand = (count + 1) // 2
    angles = 2 * np.pi * np.arange(strand) / strand
    around = np.stack([np.cos(angles), 0 * angles, np.sin(angles)], axis=1)
    radius = spacing / (2 * np.sin(np.pi / strand))
    both = [radius * around + [0, side * spacing, 0] for side in (-0.5, 0.5)]
    return np.asarray((np.concatenate(both)[:count] * [1.0, 1.0, 2.0]) + centre)


def picture(**changes: Any) -> Picture:
    return Picture(Sphere((0.0, 0.0, 40.0), 10.0), "volume", None, None, 2.0, ())._replace(**changes)


def animation(frames: int, period: float) -> Picture:
    names = tuple(f"{k}.ply" for k in range(frames))
    return picture(source=Model(names, period, None, None, 0.0), hold=1.0)


def fleet(count: int, **changes: Any) -> Fleet:
    pads = tuple(map(tuple, grid(count).tolist()))
    made = Fleet("swarm", "show-drone", pads, 10.0, LIMITS, 0.3, 900.0, APART, ("fleets", "swarm"))
    return made._replace(**changes)


def display(*pictures: Picture, **changes: Any) -> Display:
    return Display("show", "swarm", pictures, None, 0.5, Timing(), 0.75, ("shots", 0))._replace(**changes)


def goals(
    fleets: tuple[Fleet, ...], displays: tuple[Display, ...], frames: dict[str, list[list[Array]]]
) -> GoalIR:
    """Return the level; frames : of every display, picture by picture, its goal sets."""
    mission = MissionIR(
        "made", None, 0.0, (), (), (), Rules(1.0, 2.0, 1.0), (), 5.0, (), "", (),
        OriginMap("made.yaml", {}, {}), fleets, displays,
    )  # fmt: skip
    made = []
    for one in fleets:
        shown = [
            Frame(d.id, p, k, points, np.full((len(points), 3), 255 - 20 * p, dtype=np.uint8))
            for d in displays
            if d.fleet == one.name
            for p, sets in enumerate(frames[d.id])
            for k, points in enumerate(sets)
        ]
        made.append(FleetGoals(one.name, tuple(shown)))
    return GoalIR(KeyframeIR(mission, ()), tuple(made), ())


def morph(count: int, **changes: Any) -> GoalIR:
    """Return a ball, a cube and a ring, each held for 2 s."""
    spacing = 1.5
    sets = [
        [lattice(count, [0, 0, 40], spacing, 2)],
        [lattice(count, [0, 0, 40], spacing, np.inf)],
        [ring(count, [0, 0, 60], spacing)],
    ]
    shown = display(picture(), picture(), picture())
    return goals((fleet(count, **changes),), (shown,), {"show": sets})

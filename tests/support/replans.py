"""Scenes for replanners: a lateral shot past a tree, and a vehicle that flies what is planned, and lags."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.solids import Cylinder, Solid, signed_distance
from shotc.ir.limits import Limits
from shotc.ir.owners import Owner
from shotc.planning.clearances import Clearance
from shotc.plugin_api.replanner import (
    NO_TRAFFIC,
    ChasePlanner,
    ChaseProblem,
    ChaseSituation,
    ChaseWeights,
    Horizon,
    Keeping,
    Plan,
    Replan,
    Traffic,
)

DT = 0.1
PLANT_S = 0.01
LAG_S = 0.3
LIMITS = Limits(10.0, 5.0, 5.0, 5.0, 10.0, 3.0, 3.0)
WALK = np.array([1.5, 0.0, 0.0])
BESIDE = np.array([0.0, -8.0, 3.0])
TREE = Cylinder((15.0, -7.5), 2.0, -np.inf, np.inf)


def zone(solid: Solid, metres: float = 0.0, inside: bool = False) -> Clearance:
    return Clearance(Owner("zone", "it", ()), solid, metres, inside)


def problem(stages: int, *zones: Clearance, weights: ChaseWeights | None = None, **keeping) -> ChaseProblem:
    kept = Keeping(**{"limits": LIMITS, "zones": zones, **keeping})
    return ChaseProblem(Horizon(stages, DT), kept, weights or ChaseWeights())


def situation(stages: int, time: float = 0.0, **given) -> ChaseSituation:
    """Of a lateral shot: the target walks along x, the drone 8 m beside it and 3 m up, as it is to be."""
    target = given.get("at", WALK * time) + DT * np.arange(stages + 1)[:, None] * WALK
    usual = {
        "place": WALK * time + BESIDE,
        "velocity": WALK,
        "target": target,
        "target_velocity": np.tile(WALK, (stages + 1, 1)),
        "wanted": target[-1] + BESIDE,
        "wanted_velocity": WALK,
        "height": 3.0,
        "traffic": NO_TRAFFIC,
    }
    return ChaseSituation(time, **{**usual, **{k: v for k, v in given.items() if k != "at"}})


@dataclass
class Flown:
    """A flight, a row each plant step: times, places, velocities, accelerations; and every replan."""

    times: Array
    places: Array
    velocities: Array
    accelerations: Array
    replans: list[Replan]

    def nearest(self, solid: Solid) -> float:
        return min(signed_distance(solid, tuple(p)) for p in self.places)


def fly(
    planner: ChasePlanner,
    known: Callable[[float, Array, Array], ChaseSituation],
    seconds: float,
    every: float = 0.5,
    state: tuple[Array, Array] = (BESIDE, WALK),
) -> Flown:
    """Fly what is planned anew every so many seconds: a velocity that lags, with feed-forward.

    known : situation by time, place and velocity
    """
    p, v = (np.array(part, dtype=np.float64) for part in state)
    rows, replans, plan = [], [], None
    for i in range(round(seconds / PLANT_S)):
        t = i * PLANT_S
        if i % round(every / PLANT_S) == 0:
            replans.append(planner.replan(known(t, p.copy(), v.copy()), plan))
            plan = replans[-1].plan
            assert plan is not None, replans[-1].reason
        at, along, a = sampled(plan, t)
        steered = (along + (at - p) + LAG_S * a - v) / LAG_S
        v = v + PLANT_S * steered
        p = p + PLANT_S * v
        rows.append((t + PLANT_S, p, v, steered))
    return Flown(*(np.array(column) for column in zip(*rows, strict=True)), replans)  # type: ignore[arg-type]


def sampled(plan: Plan, t: float) -> tuple[Array, Array, Array]:
    """Place, velocity and acceleration of a plan; past its end it flies on as it is."""
    k = int(np.clip(np.searchsorted(plan.times, t, side="right") - 1, 0, len(plan.times) - 1))
    a = plan.accelerations[k] if k < len(plan.accelerations) else np.zeros(3)
    h = t - plan.times[k]
    return (
        plan.places[k] + h * (plan.velocities[k] + 0.5 * h * a),
        plan.velocities[k] + h * a,
        a,
    )


def lateral(stages: int, seed: int | None = None) -> Callable[[float, Array, Array], ChaseSituation]:
    """Situations of the lateral shot; seed : of 2 cm of noise of the target and of the drone."""
    rng = np.random.default_rng(seed)
    noise = 0.0 if seed is None else 0.02

    def known(t: float, p: Array, v: Array) -> ChaseSituation:
        off, seen = noise * rng.normal(size=(2, 3))
        return situation(stages, t, at=WALK * t + off, place=p + seen, velocity=v)

    return known


def beside(places: Array, velocities: Array | None = None) -> Traffic:
    """Another drone at places (N + 1, 3), or many, (D, N + 1, 3)."""
    return Traffic(places if places.ndim == 3 else places[None])

"""Two drones planned anew while they fly, one after the other: the moving-target paper's Sec. 5.3 at 2 Hz.

Run it by `python -m tests.experiments.papers --only replanning`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import degrees, radians

import numpy as np
from shotc_casadi.replan.chase import ShotChase

from shotc.geom.bernstein import Array
from shotc.ir.limits import Limits
from shotc.plugin_api.replanner import (
    ChaseProblem,
    ChaseSituation,
    ChaseWeights,
    Cone,
    Horizon,
    Keeping,
    Plan,
    Replan,
    Traffic,
)
from shotc.simulation.vehicle import Vehicle, VehicleSetpoint, VehicleState
from tests.experiments.papers.report import Table
from tests.support.plant_steps import moved
from tests.support.replans import DT, PLANT_S, WALK, sampled

STAGES, EVERY, SECONDS, APPROACH = 80, 0.5, 20.0, 5.0
LATERAL = np.array([0.0, 4.0, 2.0])
FLYBY = np.array([0.0, 6.0, 4.0])
BEHIND, AHEAD = -5.0, 5.0
APART, HALF_ANGLE, RADIUS = 2.0, radians(30.0), 0.5
WEIGHTS = ChaseWeights(end=20.0)
LIMITS = Limits(5.0, 3.0, 3.0, 5.0, 20.0, 3.0, 3.0)
COLUMNS = (
    "coordination",
    "nearest, centres",
    "2 in 1's cone, least angle",
    "1 in 2's cone, least angle",
    "flyby ends off its ideal",
    "failed, stalled, opened",
)
NOTES = (
    f"The mission of the table of Sec. 5.3 below, planned anew at 2 Hz over N = {STAGES}, as in the paper, "
    "and flown by the vehicle of `simulate`, with its weights (the state at the end by 20): the lateral "
    "first, the flyby then, which knows what the other sent one cycle ago.",
    f"With coordination it keeps {APART:g} m and a margin of 0.15 m apart, out of the other's cone and the "
    f"other out of its own. It begins {APPROACH:g} s before the shot, with the other in its picture.",
    "Measured in the shot, at every one of 2000 steps: angles from the optical axis to the nearest point of "
    "a ball of 0.5 m.",
)


@dataclass(frozen=True, eq=False)
class Record:
    """Both flights, a row each plant step: places (F, 3) of lateral and flyby; what replans did."""

    lateral: Array
    flyby: Array
    told: list[Replan]

    @property
    def nearest(self) -> float:
        """The least distance between the two centres."""
        return float(np.linalg.norm(self.lateral - self.flyby, axis=1).min())


@dataclass(slots=True)
class _Drone:
    """A drone, its planner, what it flies and what it sent before."""

    planner: ShotChase
    state: VehicleState
    plan: Plan | None = None
    sent: Plan | None = None


def table(say: Callable[[str], None]) -> Table:
    """Fly it with and without coordination."""
    rows = []
    for title, together in (("without", False), ("with", True)):
        say(f"two drones planned anew: {title}")
        one = fly(coordinated=together)
        status = [each.status for each in one.told]
        off = np.linalg.norm(one.flyby[-1] - walker(SECONDS) - _offset(SECONDS))
        rows.append(
            (
                title,
                f"{one.nearest:.2f} m",
                _cell(one.lateral, one.flyby),
                _cell(one.flyby, one.lateral),
                f"{off:.2f} m",
                ", ".join(str(status.count(kind)) for kind in ("failed", "stalled", "opened")),
            )
        )
    return Table("Two drones planned anew (Sec. 5.3)", COLUMNS, tuple(rows), NOTES)


def fly(*, coordinated: bool) -> Record:
    """Fly the lateral and the flyby once, in calm air."""
    first, second = (_begun(Keeping(LIMITS)), _begun(_together() if coordinated else Keeping(LIMITS)))
    begin = walker(-APPROACH)
    first.state, second.state = _at(begin + LATERAL, WALK), _at(begin + _offset(0.0), WALK)
    places, told = [], []
    still = np.zeros((1, 3))
    for i in range(round((APPROACH + SECONDS) / PLANT_S)):
        now = i * PLANT_S - APPROACH
        if i % round(EVERY / PLANT_S) == 0:
            told += _replanned(first, _known(now, first, LATERAL, WALK, ()))
            others = (first.sent,) if coordinated and first.sent is not None else ()
            ahead = _offset(now + STAGES * DT)
            told += _replanned(second, _known(now, second, ahead, WALK + _passing(), others))
        for each in (first, second):
            assert each.plan is not None
            asked = VehicleSetpoint(*(part[None] for part in sampled(each.plan, now)))
            each.state = moved(Vehicle(), each.state, asked, still)
        places.append((first.state.position[0], second.state.position[0]))
    filmed = places[round(APPROACH / PLANT_S) :]
    lateral, flyby = (np.array(rows) for rows in zip(*filmed, strict=True))
    return Record(lateral, flyby, told)


def walker(t: Array | float) -> Array:
    """Return where the walker is at times (...), shape (..., 3), metres."""
    return np.asarray(np.asarray(t)[..., None] * WALK)


def off_axis(camera: Array, ball: Array) -> Array:
    """Return the angles, rad, (F,), from a camera's line to the walker to the nearest point of a ball.

    camera, ball : places (F, 3), a row each plant step
    """
    to_walker = walker(PLANT_S * np.arange(1, len(camera) + 1)) - camera
    to_ball = ball - camera
    far = np.linalg.norm(to_ball, axis=1)
    cosine = np.einsum("fi,fi->f", to_walker, to_ball) / far / np.linalg.norm(to_walker, axis=1)
    return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)) - np.arcsin(RADIUS / np.maximum(far, RADIUS)))


def _cell(camera: Array, ball: Array) -> str:
    angle = off_axis(camera, ball)
    return f"{100 * float((angle < HALF_ANGLE).mean()):.1f} %, {degrees(float(angle.min())):.1f} deg"


def _offset(t: float) -> Array:
    """Return where beside the walker the flyby is to be at a time; out of the shot it goes on so."""
    return FLYBY + np.array([BEHIND + (AHEAD - BEHIND) * t / SECONDS, 0.0, 0.0])


def _passing() -> Array:
    return np.array([(AHEAD - BEHIND) / SECONDS, 0.0, 0.0])


def _together() -> Keeping:
    # A ball that is to be out of a cone: its centre is out of one that is wider by what the ball takes up.
    wider = HALF_ANGLE + np.arcsin(RADIUS / APART)
    return Keeping(LIMITS, separation=APART, half_angle=float(wider))


def _begun(keeping: Keeping) -> _Drone:
    return _Drone(ShotChase(ChaseProblem(Horizon(STAGES, DT), keeping, WEIGHTS)), _at(LATERAL, WALK))


def _at(place: Array, velocity: Array) -> VehicleState:
    still = np.zeros((1, 3))
    return VehicleState(place[None], velocity[None], still, still)


def _replanned(drone: _Drone, known: ChaseSituation) -> list[Replan]:
    done = drone.planner.replan(known, drone.plan)
    drone.sent, drone.plan = drone.plan, done.plan or drone.plan
    return [done]


def _known(
    now: float, drone: _Drone, beside: Array, velocity: Array, others: tuple[Plan, ...]
) -> ChaseSituation:
    stages = now + DT * np.arange(STAGES + 1)
    target = walker(stages)
    places = np.array([[sampled(plan, t)[0] for t in stages] for plan in others]).reshape(-1, len(stages), 3)
    return ChaseSituation(
        time=now,
        place=drone.state.position[0],
        velocity=drone.state.velocity[0],
        target=target,
        target_velocity=np.tile(WALK, (len(stages), 1)),
        wanted=target[-1] + beside,
        wanted_velocity=velocity,
        height=float(beside[2]),
        traffic=Traffic(places, tuple(_cone(each, target) for each in places)),
    )


def _cone(places: Array, target: Array) -> Cone:
    axis = target - places
    wider = HALF_ANGLE + np.arcsin(RADIUS / APART)
    return Cone(places, axis / np.linalg.norm(axis, axis=1)[:, None], float(wider))

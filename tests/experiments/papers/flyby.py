"""The flyby of the moving-target paper (Sec. 5.1) and its measures.

A reading settles what the paper leaves open.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from tests.experiments.papers.chase import DT, Chase, Flight, Weights, solve

ASIDE = 6.0  # metres that the first guess of a whole flyby goes round the circle


@dataclass(frozen=True)
class Scene:
    """What is filmed.

    steps : of DT; speed : of the target, m/s; height, behind, ahead, radius : of the circle, metres
    """

    steps: int = 100
    speed: float = 1.5
    height: float = 3.0
    behind: float = 10.0
    ahead: float = 10.0
    radius: float = 2.0

    @property
    def phase(self) -> float:
        """Return the velocity at which the shot's phase goes on, m/s."""
        return self.speed + (self.behind + self.ahead) / (DT * self.steps)

    @property
    def zone(self) -> tuple[float, float, float]:
        """Return centre and radius of the no-fly circle, about the target's first place."""
        return 0.0, 0.0, self.radius

    def at(self, x: float, speed: float) -> Array:
        """Return a state (6,) on the target's path."""
        return np.array([x, 0.0, self.height, speed, 0.0, 0.0])


@dataclass(frozen=True)
class Reading:
    """What the paper leaves open.

    weight : w4; moving : start at the target's velocity and want that of the phase at the end, else 0 and 0
    """

    name: str
    weight: float
    moving: bool

    def start(self, scene: Scene) -> Array:
        """Return the first state (6,)."""
        return scene.at(-scene.behind, scene.speed if self.moving else 0.0)

    def wanted(self, scene: Scene, step: int) -> Array:
        """Return the state (6,) of the shot's phase; at the end with the velocity wanted there."""
        there = -scene.behind + scene.phase * DT * step
        return scene.at(there, 0.0 if step == scene.steps and not self.moving else scene.phase)

    def baseline(self, scene: Scene) -> Array:
        """Return the places (steps + 1, 3) without cost of the camera and without the circle."""
        return cubic(self.start(scene), self.wanted(scene, scene.steps), scene.steps)


@dataclass(frozen=True, eq=False)
class Measured:
    """A flight with the paper's measures.

    measures : least distance to the circle's border, RMSE off the baseline, m; mean acceleration, m/s^2; mean
    jerk of yaw and of pitch, rad/s^3
    missed : metres from the wanted place at the end; iterations : of the longest solve; seconds : of each
    """

    measures: tuple[float, ...]
    missed: float
    solved: bool
    states: Array
    iterations: int
    seconds: tuple[float, ...]


def whole(weights: Weights, reading: Reading, scene: Scene, repeats: int = 1) -> Measured:
    """Return the flyby planned in one."""
    task = from_step(weights, reading, scene, (0, scene.steps), reading.start(scene))
    flights = [solve(task) for _ in range(repeats)]
    flown = flights[0].states, flights[0].inputs
    return measured(flights, flown, reading.baseline(scene), scene.speed, scene.zone)


def receding(weights: Weights, reading: Reading, scene: Scene) -> Measured:
    """Return the flyby planned anew each second, 5 s ahead."""
    every, horizon = 10, 50
    state = reading.start(scene)
    states, inputs, flights = [state], [], []
    for first in range(0, scene.steps, every):
        steps = min(horizon, scene.steps - first)
        made = [solve(from_step(weights, reading, scene, (first, steps), state)) for _ in range(3)]
        flights += made
        states += list(made[0].states[1 : every + 1])
        inputs += list(made[0].inputs[:every])
        state = states[-1]
    flown = np.array(states), np.array(inputs)
    return measured(flights, flown, reading.baseline(scene), scene.speed, scene.zone)


def from_step(weights: Weights, reading: Reading, scene: Scene, part: tuple[int, int], state: Array) -> Chase:
    """Return a part of the flyby, its first step and how many, from a state on.

    The first guess is the cubic to the wanted state, swung aside in half a sine as wide as the part is long.
    """
    first, steps = part
    moves, wanted = np.array([scene.speed, 0.0, 0.0]), reading.wanted(scene, first + steps)
    guess = cubic(state, wanted, steps)
    guess[:, 1] += ASIDE * steps / scene.steps * np.sin(np.linspace(0.0, np.pi, steps + 1))
    return Chase(
        state,
        wanted,
        (moves * DT * first, moves),
        scene.zone,
        scene.height,
        weights._replace(end=reading.weight),
        guess,
    )


def cubic(start: Array, end: Array, n: int) -> Array:
    """Return the places (n + 1, 3) of the cubic in time from one state to another, n steps later."""
    s = np.linspace(0.0, 1.0, n + 1)[:, None]
    places = (1 + 2 * s) * (1 - s) ** 2 * start[:3] + s**2 * (3 - 2 * s) * end[:3]
    velocities = s * (1 - s) ** 2 * start[3:] - s**2 * (1 - s) * end[3:]
    return np.asarray(places + DT * n * velocities)


def measured(
    flights: Sequence[Flight],
    flown: tuple[Array, Array],
    baseline: Array,
    speed: float,
    zone: tuple[float, float, float],
) -> Measured:
    """Return the paper's measures of flown states and inputs.

    speed : of the target along x, from 0 on, m/s; zone : centre and radius of the circle
    """
    states, inputs = flown
    ray = -states[:, :3]
    ray[:, 0] += speed * DT * np.arange(len(states))
    yaw = np.unwrap(np.arctan2(ray[:, 1], ray[:, 0]))
    pitch = np.arctan2(ray[:, 2], np.hypot(ray[:, 0], ray[:, 1]))
    jerks = (float(np.abs(np.diff(angle, 3)).mean()) / DT**3 for angle in (yaw, pitch))
    clear = float(np.hypot(states[:, 0] - zone[0], states[:, 1] - zone[1]).min()) - zone[2]
    off = float(np.sqrt(((states[:, :3] - baseline) ** 2).sum(axis=1).mean()))
    effort = float(np.linalg.norm(inputs, axis=1).mean())
    return Measured(
        (clear, off, effort, *jerks),
        float(np.linalg.norm(states[-1, :3] - baseline[-1])),
        all(f.solved for f in flights),
        states,
        max(f.iterations for f in flights),
        tuple(f.seconds for f in flights),
    )

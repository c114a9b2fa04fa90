"""Scenes for replanners of framings: persons who sway, in a room, and setpoints that change every second."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.solids import box
from shotc.ir.limits import Limits
from shotc.plugin_api.replanner import (
    Appearance,
    FilmedSubject,
    FramingPlanner,
    FramingProblem,
    FramingSituation,
    FramingWeights,
    Horizon,
    Keeping,
    Plan,
    Replan,
)
from tests.support.replans import DT, zone

HALF = (0.8, 0.46)
"""Tan of half the fields of view: 640 x 368 pixels at a focal length of 400."""
PIXELS = np.array([320.0, 184.0])
SLOW = Limits(2.0, 1.0, 1.0, 4.0, 10.0, 3.0, 3.0)
ROOM = box((0.0, 0.0, 2.0), (10.0, 10.0, 4.0), 0.0)
HEADS = np.array([[-0.8, 0.0, 1.6], [0.8, 0.2, 1.6], [0.0, 1.2, 1.6]])
PLACES = np.array([[-0.4, 0.0], [0.4, 0.0], [0.0, 0.1]])
BODY, SIZE = (0.6, 0.6, 1.1), 0.3
BENEATH = np.array([0.0, 0.0, 0.7])
STAND, AIM = np.array([0.0, -3.5, 1.6]), (np.pi / 2, 0.0)
NOISE_M = 0.01


def problem(stages: int, **given) -> FramingProblem:
    weights = given.pop("weights", FramingWeights())
    keeping = {"limits": SLOW, "zones": (zone(ROOM, 0.0, inside=True),), "margin": 0.05, "floor": 0.4}
    kept = Keeping(**{**keeping, "pitch": (-1.2, 0.8), **given})
    return FramingProblem(Horizon(stages, DT), kept, HALF, (2.0, 2.0), weights)


def subject(head: Array, velocity: Array, stages: int, wanted: Appearance | None) -> FilmedSubject:
    """A person whose head is framed, and who goes on as now."""
    point = head + DT * np.arange(stages + 1)[:, None] * velocity
    return FilmedSubject(point, point - BENEATH, BODY, SIZE, wanted)


def seen_from(azimuth: float, stages: int) -> Array:
    """The unit vector to a camera at an angle from straight in front, W, at all stages."""
    angle = azimuth - np.pi / 2
    return np.tile([np.cos(angle), np.sin(angle), 0.0], (stages + 1, 1))


def situation(stages: int, subjects: tuple[FilmedSubject, ...], **given) -> FramingSituation:
    usual = {"place": STAND, "velocity": np.zeros(3), "aim": AIM, "time": 0.0}
    return FramingSituation(subjects=subjects, **{**usual, **given})


class Swaying:
    """K persons and what is wanted of them; seed : of their ways and of the setpoints, one a second."""

    def __init__(self, count: int, seed: int, seconds: float) -> None:
        rng = np.random.default_rng(seed)
        self._count = count
        self._phase, self._pace = (
            rng.uniform(0.0, 2 * np.pi, (2, count, 2)),
            rng.uniform(0.4, 0.9, (count, 2)),
        )
        changes = int(np.ceil(seconds)) + 1
        self._shift, self._size = rng.uniform(-0.2, 0.2, (changes, 2)), rng.uniform(0.12, 0.25, changes)
        self._azimuth = rng.uniform(-0.6, 0.6, changes)

    def heads(self, t: float) -> tuple[Array, Array]:
        """Places and velocities, (K, 3) each."""
        at = self._pace * t + self._phase[0]
        places, moves = HEADS[: self._count].copy(), np.zeros((self._count, 3))
        places[:, :2] += 0.3 * np.sin(at)
        moves[:, :2] = 0.3 * self._pace * np.cos(at)
        return places, moves

    def wanted(self, t: float, stages: int) -> list[Appearance]:
        """How they are to appear; of the first the side, too."""
        k = int(t + 1e-9)
        middle = np.zeros((1, 2)) if self._count == 1 else PLACES
        view = seen_from(self._azimuth[k], stages)
        return [
            Appearance(tuple(middle[i] + self._shift[k]), float(self._size[k]), view if i == 0 else None)
            for i in range(self._count)
        ]


@dataclass(frozen=True, eq=False)
class Film:
    """A flight, frame by frame: framing cost, pixels off a place in the mean, least value of an ellipsoid."""

    cost: Array
    off: Array
    nearest: Array
    replans: list[Replan]
    asked: list[tuple[FramingSituation, Plan | None]]


def film(planner: FramingPlanner, stages: int, people: Swaying, steps: int, seed: int = 0) -> Film:
    """Fly what is planned anew at every step, as it is planned; places are known to 1 cm."""
    rng = np.random.default_rng(seed)
    place, velocity, aim = STAND, np.zeros(3), AIM
    rows, replans, asked = [], [], []
    plan: Plan | None = None
    for k in range(steps):
        t = DT * k
        heads, moves = people.heads(t)
        wanted = people.wanted(t, stages)
        known = tuple(
            subject(head + NOISE_M * rng.standard_normal(3), way, stages, one)
            for head, way, one in zip(heads, moves, wanted, strict=True)
        )
        measured = place + NOISE_M * rng.standard_normal(3)
        asked.append((situation(stages, known, place=measured, velocity=velocity, aim=aim, time=t), plan))
        replans.append(planner.replan(*asked[-1]))
        plan = replans[-1].plan
        assert plan is not None
        assert plan.aim is not None
        place = place + DT * (velocity + 0.5 * DT * plan.accelerations[0])
        velocity = velocity + DT * plan.accelerations[0]
        aim = (float(plan.aim[1, 0]), float(plan.aim[1, 1]))
        after = people.heads(t + DT)[0]
        judged = [appears(place, aim, head, one) for head, one in zip(after, wanted, strict=True)]
        bodies = np.linalg.norm((place - after + BENEATH) / np.array(BODY), axis=1)
        rows.append((sum(c for c, _ in judged), float(np.mean([off for _, off in judged])), bodies.min()))
    return Film(*np.array(rows).T, replans, asked)


def appears(place: Array, aim: tuple[float, float], head: Array, wanted: Appearance) -> tuple[float, float]:
    """Framing cost of one subject by Naegeli et al., Eq. 7 to 9, and how many pixels it is off its place."""
    w, (yaw, pitch), d = FramingWeights(), aim, head - place
    ahead = np.array([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)])
    right = np.array([np.sin(yaw), -np.cos(yaw), 0.0])
    inside = np.array([d @ right, d @ np.cross(right, ahead), d @ ahead])
    far = float(np.linalg.norm(d))
    cost = 0.0
    off = np.nan
    if wanted.uv is not None:
        ray = np.array([wanted.uv[0] * HALF[0], wanted.uv[1] * HALF[1], 1.0])
        apart = (inside / far - ray / np.linalg.norm(ray)) / np.array([*HALF, HALF[0]])
        cost += w.place * float(apart @ apart)
        uv = inside[:2] / inside[2] / np.array(HALF)
        off = float(np.linalg.norm((uv - wanted.uv) * PIXELS)) if inside[2] > 0 else np.inf
    if wanted.size is not None:
        cost += w.size * float(np.log(2 * HALF[1] * far * wanted.size / SIZE)) ** 2
    if wanted.view is not None:
        cost += w.view * float(((-d / far - wanted.view[0]) ** 2).sum())
    return cost, off

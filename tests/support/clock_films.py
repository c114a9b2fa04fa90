"""Missions of keyframes on the clock: somebody walks between blocks, all of it seen from each keyframe."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.surface.boards import upright
from shotc.geom.surface.near import nearest
from shotc.geom.surface.occlusion import hidden
from shotc.geom.surface.tree import surface_of
from tests.support.scenes import house, turned
from tests.support.village_films import ply

SCENE_FILE = "blocks.ply"
START_S = 20.0
BLOCKS_PER_WAY, TRIES = 2, 40
FROM_KEYFRAMES_M = 4.0
"""Metres between blocks and keyframes at least: the clearance, the body's radius and a margin."""


class ClockFilm(NamedTuple):
    """A mission, and the file of its scene; empty where its blocks are zones."""

    text: str
    scene: bytes


class _Block(NamedTuple):
    """A block on the ground: its middle, width, depth and height, metres, and how it is turned, rad."""

    at: Array
    size: tuple[float, float, float]
    turn: float

    @property
    def triangles(self) -> Array:
        wide, deep, tall = self.size
        return turned(house(wide, deep, tall, tall), self.turn, self.at)


class _Walk(NamedTuple):
    """Somebody who walks straight on from the origin: a velocity in the plan, m/s, and a cylinder, metres."""

    velocity: Array
    radius: float
    height: float

    def at(self, t: Array) -> Array:
        """Return the centre at times of the shot, (M, 3)."""
        along = (START_S + t)[:, None] * self.velocity
        return np.column_stack([along, np.full(len(t), self.height / 2)])


def some_clock_film(random: np.random.Generator, blocks: Literal["scene", "zones"]) -> ClockFilm:
    """Return a film by three or four keyframes, with blocks between the subject and the ways of the camera.

    Sizes, headings, lenses, paces and sides are drawn. Keyframes count from the subject, or from the world.
    """
    scale, heading, side = random.uniform(0.7, 2.0), random.uniform(0, 2 * np.pi), random.choice([-1.0, 1.0])
    ahead = np.array([np.cos(heading), np.sin(heading)])
    walk = _Walk(random.uniform(0.8, 1.8) * ahead, round(0.4 * scale, 2), round(1.8 * scale, 2))
    count = int(random.integers(3, 5))
    times = np.concatenate([[0.0], np.cumsum(random.uniform(8.0, 13.0, count - 1))]).round(1)
    turns = heading + np.pi / 2 + side * np.cumsum(np.radians(random.uniform(25.0, 60.0, count)))
    away, up = random.uniform(9.0, 14.0, count) * scale, random.uniform(1.5, 4.5, count) * scale
    offsets = np.column_stack([away * np.cos(turns), away * np.sin(turns), np.maximum(up, 3.0)]).round(2)
    eyes = walk.at(times) + offsets - [0.0, 0.0, walk.height / 2]
    found = _blocks(random, walk, (times, offsets), scale)
    if not found:
        return some_clock_film(random, blocks)
    rows = []
    for t, eye, offset in zip(times, eyes, offsets, strict=True):
        numbers = offset if random.uniform() < 0.6 else eye
        place = f"[{', '.join(f'{c:.3f}' for c in numbers)}]"
        place = f"{{from: walker, offset: {place}}}" if numbers is offset else place
        lens = random.uniform(45.0, 75.0)
        rows.append(f"      - {{at: {place}, look_at: walker, hfov: {lens:.0f} deg, time: {t:.1f} s}}\n")
    home = eyes[0, :2] + 8.0 * np.array([np.cos(turns[0]), np.sin(turns[0])])
    if blocks == "zones":
        return ClockFilm(_text(walk, home, _zones(found), rows), b"")
    scene = ply(np.concatenate([block.triangles for block in found]))
    return ClockFilm(_text(walk, home, f"  scene: {{file: {SCENE_FILE}, units: m}}\n", rows), scene)


def _blocks(
    random: np.random.Generator, walk: _Walk, keyframes: tuple[Array, Array], scale: float
) -> list[_Block]:
    """Return blocks beside the walk that hide nothing from keyframes; these are times and offsets."""
    times, offsets = keyframes
    eyes = walk.at(times) + offsets - [0.0, 0.0, walk.height / 2]
    walked = walk.at(np.linspace(-START_S, times[-1] + START_S, 400))
    boards = upright(eyes, walk.at(times), walk.radius, walk.height)
    found: list[_Block] = []
    for _ in range(TRIES):
        if len(found) == BLOCKS_PER_WAY * (len(times) - 1):
            break
        t = random.uniform(times[0] + 1.5, times[-1] - 1.5)
        sight = np.array([np.interp(t, times, offsets[:, k]) for k in range(2)])
        at = walk.at(np.array([t]))[0, :2] + random.uniform(0.3, 0.7) * sight
        wide, deep, tall = random.uniform([1.0, 1.0, 3.0], [3.0, 3.0, 9.0]) * scale
        block = _Block(at, (wide, deep, tall), random.uniform(0.0, np.pi))
        surface = surface_of(block.triangles)
        beside = nearest(surface, walked).distance.min() > 1.5 * scale + walk.radius
        if (
            beside
            and nearest(surface, eyes).distance.min() > FROM_KEYFRAMES_M
            and not hidden(surface, boards).any()
        ):
            found.append(block)
    return found


def _zones(blocks: list[_Block]) -> str:
    rows = []
    for i, (at, (wide, deep, tall), turn) in enumerate(blocks):
        centre = f"[{at[0]:.3f}, {at[1]:.3f}, {tall / 2:.3f}]"
        size = f"[{wide:.3f}, {deep:.3f}, {tall:.3f}]"
        box = f"{{center: {centre}, size: {size}, heading: {90.0 - np.degrees(turn):.3f} deg}}"
        rows.append(f"    block{i}: {{keep: out, box: {box}}}\n")
    return f"  zones:\n{''.join(rows)}"


def _text(walk: _Walk, home: Array, world: str, rows: list[str]) -> str:
    centre = f"{walk.height / 2:.3f}"
    east, north = 300.0 * walk.velocity
    speed = float(np.linalg.norm(walk.velocity))
    return (
        f"shotc: 1\nmission: blocks\nworld:\n{world}targets:\n  walker:\n"
        f"    track: {{points: [[0, 0, {centre}], [{east}, {north}, {centre}]], speed: {speed}}}\n"
        f"    radius: {walk.radius}\n    height: {walk.height}\n"
        f"drones: {{cam: {{model: x500, home: [{home[0]:.2f}, {home[1]:.2f}]}}}}\n"
        f"shots:\n  - id: film\n    kind: keyframes\n    drone: cam\n    target: walker\n"
        f"    composition: center\n    timing: {{start: {START_S}}}\n"
        f"    allow: [fast-pan]\n    keyframes:\n{''.join(rows)}"
        "output: {rate: 10}\n"
    )

"""Pads, zones and fences round what is filmed, and whether shots leave each other room."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import cos, radians, sin
from typing import Any, NamedTuple

import numpy as np

from tests.support.generated.cameras import Camera
from tests.support.generated.dice import Dice
from tests.support.generated.subjects import Subject
from tests.support.generated.takes import Array, Rules, Take

APART = 2.5  # metres beside the separation between the places of two shots
PAD_ROOM = 8.0  # metres from a pad to any subject's side, at any time
PADS_APART = 4.0  # metres beside the separation between two pads
ZONE_ROOM = 4.0  # metres from a zone to places and pads, beside the body
WAY_ROOM = 3.0  # metres from a zone to the sides of subjects
RUN_UP = 15.0  # metres by which ways are drawn out at both ends before zones are put
FENCE_ROOM = (35.0, 60.0)  # metres between a fence and all places, and over the highest
BODY = 0.8  # metres from a line of sight, at which a drone is not between
NOWHERE = 1e6  # metres from everything
HIDDEN = 0.25  # share of a shot's places from which something hides what is filmed, at most
STEP = 1.0  # metres, or half a second, between places that are looked at


class Solid(NamedTuple):
    """A keep-out box or cylinder on the map; wanted : its YAML.

    half : half its sizes along its own axes, both the radius of a cylinder; top, m; turn, rad clockwise
    """

    centre: tuple[float, float]
    half: tuple[float, float]
    top: float
    turn: float
    round: bool
    wanted: dict[str, Any]

    def away(self, points: Array) -> Array:
        """Return the distance of points (n, 3) from it, 0 inside."""
        d = points[:, :2] - np.array(self.centre)
        over = np.maximum(points[:, 2] - self.top, 0.0)
        if self.round:
            level = np.maximum(np.hypot(d[:, 0], d[:, 1]) - self.half[0], 0.0)
        else:
            c, s = cos(self.turn), sin(self.turn)
            own = np.column_stack([c * d[:, 0] - s * d[:, 1], s * d[:, 0] + c * d[:, 1]])
            level = np.linalg.norm(np.maximum(np.abs(own) - np.array(self.half), 0.0), axis=1)
        return np.hypot(level, over)

    def aside(self, points: Array) -> Array:
        """Return the level distance of points (n, 2 or more) from its sides."""
        return self.away(np.column_stack([points[:, :2], np.zeros(len(points))]))


def dense(places: Array) -> Array:
    """Return places with more between them, a metre apart or nearer."""
    rows = [places[:1]]
    for a, b in pairwise(places):
        n = max(1, int(np.linalg.norm(b - a) / STEP))
        rows.append(a + np.linspace(0.0, 1.0, n + 1)[1:, None] * (b - a))
    return np.concatenate(rows)


def ways(subjects: Sequence[Subject], until: float) -> list[tuple[Subject, Array]]:
    """Return where every subject is until a time, (n, 3)."""
    t = np.arange(0.0, until, 0.5)
    return [(s, s.at(t) if s.moves else s.points) for s in subjects]


def apart(a: Take, b: Take, rules: Rules) -> bool:
    """Tell whether two shots of different drones leave each other room."""
    need = rules.separation + APART
    if a.times is not None and b.times is not None:
        start, end = max(a.times[0], b.times[0]), min(a.times[-1], b.times[-1])
        if start > end:
            return True
        t = np.append(np.arange(start, end, 0.2), end)  # one may begin in the moment in which the other ends
        one, other = (
            np.column_stack([np.interp(t, x.times, x.places[:, k]) for k in range(3)])
            for x in (a, b)
            if x.times is not None
        )
        return bool(np.linalg.norm(one - other, axis=1).min(initial=np.inf) >= need)
    one, other = dense(a.places), dense(b.places)
    return bool(np.linalg.norm(one[:, None] - other[None], axis=2).min() >= need)


def clear_of_subjects(take: Take, camera: Camera, subjects: Sequence[Subject], rules: Rules) -> bool:
    """Tell whether a shot's places keep clear of all subjects, where they are then."""
    need = rules.target + camera.radius + 1.0
    for subject in subjects:
        if subject.moves and take.times is None and subject.name in take.subjects:
            continue  # its places go along with it
        places = take.places if subject.name in take.subjects else dense(take.places)
        if subject.moves and take.times is not None:
            places, centres = take.places, subject.at(take.times)
        elif subject.moves:
            way = ways([subject], 120.0)[0][1]
            centres = way[np.linalg.norm(places[:, None] - way[None], axis=2).argmin(axis=1)]
        else:
            centres = subject.points
        d = places - centres
        level = np.maximum(np.hypot(d[:, 0], d[:, 1]) - subject.radius, 0.0)
        over = np.maximum(np.abs(d[:, 2]) - subject.height / 2, 0.0)
        if np.hypot(level, over).min() < need:
            return False
    return True


def in_sight(take: Take, subjects: Sequence[Subject]) -> bool:
    """Tell whether what a shot films is hidden behind other subjects from few of its places at most."""
    for filmed, sight in _sights(take, subjects):
        for other in (s for s in subjects if s is not filmed and (take.times is not None or not s.moves)):
            d = sight - (other.points if take.times is None else other.at(take.times))
            inside = (np.hypot(d[..., 0], d[..., 1]) < other.radius) & (np.abs(d[..., 2]) < other.height / 2)
            if inside.any(axis=0).mean() > HIDDEN:
                return False
    return True


def _sights(take: Take, subjects: Sequence[Subject]) -> list[tuple[Subject, Array]]:
    """Return what a shot films whose place is known, and places on the lines to it, (60, n, 3)."""
    along = np.linspace(0.0, 1.0, 60)[:, None, None]
    found = []
    for filmed in (s for s in subjects if s.name in take.subjects):
        if take.times is not None or not filmed.moves:
            centre = filmed.points if take.times is None else filmed.at(take.times)
            found.append((filmed, take.places + along * (centre - take.places)))
    return found


def _hides(solid: Solid, takes: Sequence[Take], subjects: Sequence[Subject]) -> bool:
    """Tell whether a solid hides what a shot films from many of its places."""
    for take in takes:
        for _, sight in _sights(take, subjects):
            inside = solid.away(sight.reshape(-1, 3)).reshape(sight.shape[:2]) <= 0.0
            if inside.any(axis=0).mean() > HIDDEN:
                return True
    return False


def in_between(take: Take, other: Take, subjects: Sequence[Subject]) -> bool:
    """Tell whether another drone, in its shot, may be between a camera and what it films for long."""
    for filmed, sight in _sights(take, subjects):
        here, ray = sight[0], sight[-1] - sight[0]
        there = _meanwhile(take, other)
        along = np.einsum("mnk,nk->mn", there - here, ray) / np.maximum((ray * ray).sum(axis=1), 1e-9)
        beside = np.linalg.norm(there - here - np.clip(along, 0.0, 1.0)[..., None] * ray, axis=2)
        if (beside.min(axis=0) < BODY + 0.1 * filmed.radius).mean() > HIDDEN:
            return True
    return False


def _meanwhile(take: Take, other: Take) -> Array:
    """Return where another drone may be while a shot is at its places, (m, n, 3)."""
    if take.times is None or other.times is None:
        return np.tile(dense(other.places)[:, None], (1, len(take.places), 1))
    there = np.column_stack([np.interp(take.times, other.times, other.places[:, k]) for k in range(3)])
    there[(take.times < other.times[0]) | (take.times > other.times[-1])] = NOWHERE
    return there[None]


def pad(
    dice: Dice,
    first: Take,
    takes: Sequence[Take],
    pads: Sequence[Array],
    subjects: Sequence[Subject],
    rules: Rules,
) -> Array | None:
    """Draw a drone's pad near its first place, away from all else; None where there was no room."""
    places = np.concatenate([dense(t.places) for t in takes])
    passing = ways(subjects, 120.0)
    for _ in range(40):
        angle, far = radians(dice.whole(0, 359)), dice.between(4.0, 30.0)
        at = np.round(
            np.array([*first.places[0][:2], 0.0]) + far * np.array([cos(angle), sin(angle), 0.0]), 1
        )
        if any(np.linalg.norm(at - p) < rules.separation + PADS_APART for p in pads):
            continue
        if np.linalg.norm(places - at, axis=1).min() < rules.separation + APART:
            continue
        if all(np.hypot(*(way - at)[:, :2].T).min() >= s.radius + PAD_ROOM for s, way in passing):
            return at
    return None


def zones(
    dice: Dice,
    takes: Sequence[Take],
    pads: Sequence[Array],
    subjects: Sequence[Subject],
    cameras: Sequence[Camera],
) -> dict[str, Any]:
    """Draw keep-out zones, on the way and elsewhere, and a fence."""
    found: dict[str, Any] = {}
    body = max(c.radius for c in cameras)
    passing = ways(subjects, 120.0)
    if dice.chance(0.35):
        solid = _in_the_way(dice, takes, pads)
        free = solid is not None and _stands_free(solid, _bound(takes, solid), pads, passing, body)
        if solid is not None and free and not _hides(solid, takes, subjects):
            found["mast"] = {"keep": "out", **solid.wanted}
    for i in range(dice.weighted({0: 3, 1: 2, 2: 1, 3: 1})):
        solid = _somewhere(dice, takes)
        free = _stands_free(solid, [dense(_drawn_out(t)) for t in takes], pads, passing, body)
        if free and not _hides(solid, takes, subjects):
            found[f"{dice.pick(('tree', 'house', 'shed', 'pylon'))}{i + 1}"] = {"keep": "out", **solid.wanted}
    if dice.chance(0.3):
        found["field"] = _fence(dice, takes, pads)
    return found


def _bound(takes: Sequence[Take], solid: Solid) -> list[Array]:
    """Return the places that a zone on the way keeps off: keyframes, and ends of shots it stands in."""
    kept = []
    for take in takes:
        if "keyframes" in take.wanted or "points" in take.wanted:
            kept.append(take.places)
            continue
        stands_in = solid.away(take.places).min() < ZONE_ROOM
        kept.append(take.places[[0, -1]] if stands_in and take.times is None else dense(_drawn_out(take)))
    return kept


def _stands_free(
    solid: Solid,
    places: Sequence[Array],
    pads: Sequence[Array],
    passing: Sequence[tuple[Subject, Array]],
    body: float,
) -> bool:
    return (
        all(solid.away(p).min() >= body + ZONE_ROOM for p in places)
        and solid.aside(np.array(pads)).min() >= body + ZONE_ROOM
        and all(solid.aside(way).min() >= s.radius + WAY_ROOM for s, way in passing)
    )


def _drawn_out(take: Take) -> Array:
    """Return the places of a shot with its run-up and its way out."""
    if len(take.places) < 2 or take.times is None:
        return take.places
    (a, b), (y, z) = take.places[:2], take.places[-2:]
    first, last = (a - b) / max(np.linalg.norm(a - b), 1e-6), (z - y) / max(np.linalg.norm(z - y), 1e-6)
    return np.concatenate([(a + RUN_UP * first)[None], take.places, (z + RUN_UP * last)[None]])


def _in_the_way(dice: Dice, takes: Sequence[Take], pads: Sequence[Array]) -> Solid | None:
    """Return a small thing between two keyframes, on a way round, or between a pad and a shot."""
    take = dice.pick(takes)
    if len(take.places) > 1 and take.times is None:
        k = dice.whole(0, len(take.places) - 2) if "keyframes" in take.wanted else (len(take.places) - 1) // 2
        middle = 0.5 * (take.places[k] + take.places[k + 1])
    else:
        start = min(pads, key=lambda p: float(np.linalg.norm(p - take.places[0])))
        middle = 0.5 * (start + take.places[0])
    top = round(float(middle[2]) + dice.between(1.0, 8.0), 1)
    centre = (round(float(middle[0]), 1), round(float(middle[1]), 1))
    return _cylinder(centre, dice.between(0.5, 2.5, 1), top)


def _somewhere(dice: Dice, takes: Sequence[Take]) -> Solid:
    places = np.concatenate([t.places for t in takes])
    low, high = places.min(axis=0) - 25.0, places.max(axis=0) + 25.0
    centre = (dice.between(low[0], high[0], 1), dice.between(low[1], high[1], 1))
    top = dice.between(4.0, 25.0, 1)
    if dice.chance(0.5):
        return _cylinder(centre, dice.between(1.0, 5.0, 1), top)
    size, heading = (dice.between(3.0, 15.0, 1), dice.between(3.0, 15.0, 1)), dice.whole(0, 89)
    half = (size[0] / 2, size[1] / 2)
    if dice.chance(0.7):
        box = {"center": [*centre, top / 2], "size": [*size, top], "heading": f"{heading} deg"}
        return Solid(centre, half, top, radians(heading), False, {"box": box})
    x, y = half
    corners = [
        [round(centre[0] + a, 1), round(centre[1] + b, 1)] for a, b in ((-x, -y), (x, -y), (x, y), (-x, y))
    ]
    return Solid(centre, half, top, 0.0, False, {"polygon": {"points": corners, "height": [0, top]}})


def _cylinder(centre: tuple[float, float], radius: float, top: float) -> Solid:
    wanted = {"cylinder": {"center": list(centre), "radius": radius, "height": [0, top]}}
    return Solid(centre, (radius, radius), top, 0.0, True, wanted)


def _fence(dice: Dice, takes: Sequence[Take], pads: Sequence[Array]) -> dict[str, Any]:
    every = np.concatenate([*(t.places for t in takes), np.array(pads)])
    room = dice.between(*FENCE_ROOM, digits=0)
    (x0, y0, _), (x1, y1, top) = np.floor(every.min(axis=0) - room), np.ceil(every.max(axis=0) + room)
    corners = [[float(x), float(y)] for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
    return {"keep": "in", "polygon": {"points": corners, "height": [0, float(top)]}}

"""What hides a target from a camera, and who is in whose picture."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from tests.support.second_opinion.case import Case, Finding, Findings
from tests.support.second_opinion.flight import Array, Phase
from tests.support.second_opinion.picture import Camera
from tests.support.second_opinion.solids import Solid
from tests.support.second_opinion.targets import Target, touch

Nearness = Callable[[Array], Array]
"""How near lines of sight (M, K, 3) come to a body, metres, shape (M,): negative where they go through."""

LINE = 400  # points of a line of sight
RAYS = 300  # to a target's outline and about it
PER_SECOND = 50.0
MISSED = 0.3  # metres by which a body may move between two looks
LOOSE = 0.02  # of a claimed value: a bound is closed to a part of it


def hidden(case: Case, drone: str, target: str, t: Array) -> tuple[Array, Array]:
    """Return at which times something surely stands before the target's centre, and at which it may.

    Between two points of the line of sight a body may be touched unseen: such times are not sure.
    """
    camera, centre = case.place(drone, t), case.mission.targets[target].at(t)
    share = np.linspace(0.0, 1.0, LINE)
    line = camera[:, None] + share[:, None] * (centre - camera)[:, None]
    step = np.linalg.norm(centre - camera, axis=1) / (LINE - 1)
    surely, maybe = np.zeros(len(t), dtype=bool), np.zeros(len(t), dtype=bool)
    for depth in (near(line) for near in _others(case, drone, target, t)):
        surely |= depth < -1e-6
        maybe |= depth < step + 1e-6
    return surely, maybe


def covered(case: Case, drone: str, target: str, t: Array) -> tuple[Array, Array]:
    """Return between which shares of the target's outline something stands before it, shapes (M,).

    Rays are even over a plane across the line of sight; of each it is looked, step by step, where it comes
    to the target, and whether it comes to anything else before.
    """
    camera, mine = case.place(drone, t), case.mission.targets[target]
    outline, centre = mine.outline(t), mine.at(t)
    away = centre - camera
    far = np.linalg.norm(away, axis=1)
    wide = np.linalg.norm(outline - centre[:, None], axis=2).max(axis=1)
    side = np.column_stack([away[:, 1], -away[:, 0], np.zeros(len(t))])
    side /= np.maximum(np.linalg.norm(side, axis=1), 1e-9)[:, None]
    up = np.cross(side, away / far[:, None])
    grown = wide * far / np.maximum(far - wide, 0.2 * far)  # as large as its nearest part can be seen
    steps = np.linspace(0.0, 1.0, LINE)
    bodies, others = mine.parts or (mine,), _others(case, drone, target, t)
    own, surely, maybe = np.zeros(len(t)), np.zeros(len(t)), np.zeros(len(t))
    for a, b in np.random.default_rng(1).uniform(-1.0, 1.0, (RAYS, 2)):
        way = away + (grown * a)[:, None] * side + (grown * b)[:, None] * up
        line = camera[:, None] + steps[:, None] * (way * (1.0 + wide / far)[:, None])[:, None]
        met = np.min([body.distance(line, t) for body in bodies], axis=0) < 0.0
        first = np.where(met.any(axis=1), met.argmax(axis=1), 0)
        line = np.where((np.arange(LINE) < first[:, None])[..., None], line, camera[:, None])
        depths = np.min([np.full(len(t), np.inf), *(near(line) for near in others)], axis=0)
        step = np.linalg.norm(way, axis=1) * (1.0 + wide / far) / (LINE - 1)
        own += met.any(axis=1)
        surely += met.any(axis=1) & (depths < -1e-6)
        maybe += met.any(axis=1) & (depths < step + 1e-6)
    return surely / np.maximum(own, 1.0), maybe / np.maximum(own, 1.0)


def _others(case: Case, drone: str, target: str, t: Array) -> list[Nearness]:
    """Return what may stand before a target: how near lines of sight (M, K, 3) at times (M,) come to each.

    A body that overlaps the target does not hide it; nor does a part of the same group.
    """
    mine = case.mission.targets[target]
    bodies = mine.parts or (mine,)
    groups = [{part.name for part in other.parts} for other in case.mission.targets.values()]
    one = {body.name for body in bodies}.union(*(g for g in groups if g & {body.name for body in bodies}))
    targets = [o for o in case.mission.targets.values() if not o.parts and o.name not in one]
    return [
        *(partial(_near_solid, zone.solid) for zone in case.mission.zones if not zone.keeps_in),
        *(partial(_near_body, o, t, np.any([touch(b, o, t) for b in bodies], axis=0)) for o in targets),
        *(
            partial(_near_ball, case.place(name, t), found["radius"])
            for name, found in case.drones.items()
            if name != drone
        ),
    ]


def _near_solid(solid: Solid, line: Array) -> Array:
    return solid.distance(line.reshape(-1, 3)).reshape(line.shape[:2]).min(axis=1)


def _near_body(other: Target, t: Array, touched: Array, line: Array) -> Array:
    return np.where(touched, np.inf, other.distance(line, t).min(axis=1))


def _near_ball(centre: Array, radius: float, line: Array) -> Array:
    return np.asarray(np.linalg.norm(line - centre[:, None], axis=2).min(axis=1) - radius)


def company(case: Case) -> Findings:
    """Where it is required no body of another drone is in a picture; what is claimed of it is so."""
    rule = case.mission.rules.get("mutual_visibility")
    strength = (
        rule.get("strength", "require") if isinstance(rule, dict) else "prefer" if rule is None else rule
    )
    if strength is False or strength == "off":
        return
    claims = {(c["constraint"], c["shot"]): c for c in case.plan["certificate"]}
    angled = isinstance(rule, dict) and "half_angle" in rule
    for flight in case.flights.values():
        for phase in (p for p in flight.phases if p.shot is not None):
            for other in (name for name in case.drones if name != flight.drone):
                name = f"{other} out of the picture"
                value, time = (0.0, None) if angled else _deepest(case, flight.drone, phase, other)
                claim = claims.get((name, phase.shot))
                if strength == "require" and value < -1e-6:
                    yield Finding(f"required: {name}", str(phase.shot), value, 0.0, time)
                if claim is None:
                    yield Finding(f"no claim: {name}", str(phase.shot), value, 0.0, time)
                elif not angled:
                    yield from _claimed(phase, claim, (value, time))


def _claimed(phase: Phase, claim: dict[str, Any], found: tuple[float, float | None]) -> Findings:
    """What is proved of every instant is nowhere worse, nor far better where a body is in the picture."""
    worst, (value, time) = float(claim["worst"]), found
    beyond = claim["method"] == "bounded" and value < worst - 1e-6
    if beyond or (worst < 0 and value - worst > MISSED + LOOSE * abs(worst)):
        yield Finding(f"claimed {claim['constraint']}", str(phase.shot), value, worst, time)


def _deepest(case: Case, drone: str, phase: Phase, other: str) -> tuple[float, float]:
    """Return the least distance of another's sphere from the frame's pyramid in a shot, metres, and when."""
    t = np.linspace(phase.start, phase.end, int((phase.end - phase.start) * PER_SECOND) + 2)
    camera = Camera.of(case.flights[drone].at(t), float(case.drones[drone]["aspect"]))
    away = case.place(other, t) - camera.place
    x, y, z = (np.einsum("mc,mc->m", away, axis) for axis in (camera.right, camera.down, camera.ahead))
    outside = (
        pyramid_distance(np.abs(x), np.abs(y), z, camera.wide, camera.high) - case.drones[other]["radius"]
    )
    k = int(outside.argmin())
    return float(outside[k]), float(t[k])


def pyramid_distance(x: Array, y: Array, z: Array, wide: Array, high: Array) -> Array:
    """Return how far points right of and above the axis are outside the pyramid |x| <= wide z, |y| <= high z.

    Inside it is how far they are from its nearest side, negative; outside the nearest of its apex and of the
    feet on its edge and its two sides, of those that lie on it.
    """
    beside = [(x - wide * z) / np.hypot(1, wide), (y - high * z) / np.hypot(1, high)]
    edge = np.stack([wide, high, np.ones_like(z)], axis=1)
    point = np.stack([x, y, z], axis=1)
    along = np.maximum((point * edge).sum(axis=1) / (edge**2).sum(axis=1), 0.0)
    near = np.linalg.norm(point - along[:, None] * edge, axis=1)  # the apex where the foot is behind it
    for foot_z, other, limit, distance in (
        ((z + wide * x) / (1 + wide**2), y, high, beside[0]),
        ((z + high * y) / (1 + high**2), x, wide, beside[1]),
    ):
        near = np.where((foot_z >= 0) & (other <= limit * foot_z), np.minimum(near, np.abs(distance)), near)
    return np.where(np.max(beside, axis=0) <= 0, np.max(beside, axis=0), near)

"""Pads and pictures beside scenes and buildings: out of what is closed, and far enough from every triangle.

Of a picture that is known as balls and points these are judged; planning judges every goal. It needs numpy,
as meshes do.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic, Label
from shotc.geom.bernstein import Array
from shotc.geom.surface.near import within
from shotc.geom.surface.triangles import segment_distances
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.owners import part_owner
from shotc.ir.show import Display, Fleet, Picture, whole_fleets
from shotc.passes.resolve.checks.show.pads import rises
from shotc.passes.resolve.checks.show.pictures import is_clear
from shotc.planning.clearances import ROUNDING_M, clearances_of
from shotc.planning.take_off import take_off_of
from shotc.rounding import at_least
from shotc.show.geom.shape import Ball, balls
from shotc.show.labels import centre_label, pads_path, word_of

PAD_RADII = 1.5
"""Times the body's radius over its pad from which nothing may come into it: below is what it stands on."""
MOVES_M = tuple(range(1, 61))
"""Metres by which a layout or a picture is moved to be free."""
WAYS = (((1.0, 0.0), "east"), ((-1.0, 0.0), "west"), ((0.0, 1.0), "north"), ((0.0, -1.0), "south"))


class _Over(NamedTuple):
    """How much room is missing over pads, (n,), metres, at most 0 where there is enough, and what is near.

    place : of the pad that has least
    """

    lack: Array
    place: Vec3


def check_pads_beside(mission: MissionIR) -> Iterator[Diagnostic]:
    """Yield the fleets of which drones stand in something, or take off into something."""
    for fleet in whole_fleets(mission.fleets):
        for mesh in mission.meshes:
            over = _over_pads(fleet, mesh)
            if (over.lack > ROUNDING_M).any():
                yield _blocked(mission, fleet, mesh, over)
                break


def _over_pads(fleet: Fleet, mesh: ObstacleMesh) -> _Over:
    """Return how something stands to the ways straight up from pads."""
    pads, body = np.array(fleet.pads), fleet.radius + mesh.spacing
    tops = take_off_of(fleet)
    rise = np.array([tops.top(i) for i in range(len(pads))])
    foot = np.minimum(PAD_RADII * fleet.radius + mesh.spacing, rise)
    low, high = pads.copy(), pads.copy()
    low[:, 2] += foot
    high[:, 2] += rise
    distance = np.full(len(pads), body)
    pairs = within(mesh.surface, low, high, body)
    triangles = mesh.surface.triangles[pairs.triangle]
    np.minimum.at(distance, pairs.item, segment_distances(triangles, low[pairs.item], high[pairs.item]))
    lack = body - distance
    inside = mesh.holds(pads)
    if inside.any():
        lack[inside] = body - mesh.signed_distance(pads[inside])
    x, y, z = pads[int(lack.argmax())].tolist()
    return _Over(lack, (x, y, z))


def _blocked(mission: MissionIR, fleet: Fleet, mesh: ObstacleMesh, over: _Over) -> Diagnostic:
    lacking, worst = int((over.lack > ROUNDING_M).sum()), int(over.lack.argmax())
    owner = part_owner(mesh, over.place)
    labels = (
        mission.origins.value(pads_path(mission, fleet)),
        mission.origins.key(mesh.path, "the obstacle"),
    )
    x, y, _ = over.place
    note = (
        f"worst is pad {worst + 1} at [{x:.1f}, {y:.1f}]: {at_least(float(over.lack[worst]))} m are missing "
        f"of the body radius of {fleet.radius:.2f} m that must be free on its way up"
    )
    message = f"{lacking} of {len(fleet.pads)} drones of {fleet.words} cannot rise clear of {owner.words}"
    return Diagnostic("D006", message, labels, (note,), _elsewhere(mission, fleet))


def _elsewhere(mission: MissionIR, fleet: Fleet) -> str:
    """Say how far a layout is to be moved, at most as far as is tried."""
    over = [z - mission.ground(x, y) for x, y, z in fleet.pads]
    for metres in MOVES_M:
        for (dx, dy), word in WAYS:
            pads = tuple(
                (x + metres * dx, y + metres * dy, height + mission.ground(x + metres * dx, y + metres * dy))
                for (x, y, _), height in zip(fleet.pads, over, strict=True)
            )
            there = fleet._replace(pads=pads)
            free = all((_over_pads(there, mesh).lack <= ROUNDING_M).all() for mesh in mission.meshes)
            if free and rises(mission, there):
                return f"move the layout {metres} m {word}"
    return "move the layout to a free place"


def check_pictures_beside(mission: MissionIR, display: Display, fleet: Fleet) -> Iterator[Diagnostic]:
    """Yield the pictures that reach into something, as far as their shapes are known without a solver."""
    for picture in display.pictures:
        shape = balls(picture.source)
        if not shape:
            continue
        for mesh in mission.meshes:
            lack = _lacks(mission, fleet, mesh, shape)
            if lack.max() > ROUNDING_M:
                yield _reaching(mission, fleet, picture, _Reach(mesh, shape, lack))
                break


def _lacks(mission: MissionIR, fleet: Fleet, mesh: ObstacleMesh, shape: tuple[Ball, ...]) -> Array:
    """Return by how much balls come too near to a mesh, or reach into it, metres, (n,)."""
    centres, radii = np.array([b.centre for b in shape]), np.array([b.radius for b in shape])
    need = _free(mission, fleet, mesh)
    reach = need + float(radii.max())
    return np.asarray(need + radii - mesh.signed_distance(centres, reach))


class _Reach(NamedTuple):
    """A picture's shape that is too near to a mesh; lack : of each ball, metres, (n,)."""

    mesh: ObstacleMesh
    shape: tuple[Ball, ...]
    lack: Array


def _reaching(mission: MissionIR, fleet: Fleet, picture: Picture, reach: _Reach) -> Diagnostic:
    mesh, shape, lack = reach
    worst = shape[int(lack.argmax())]
    owner, word = part_owner(mesh, worst.centre), word_of(picture)
    labels: tuple[Label, ...] = (
        centre_label(mission, picture),
        mission.origins.key(mesh.path, "the obstacle"),
    )
    help_ = _raised(mission, fleet, picture, shape)
    if (lack >= 2.0 * np.array([ball.radius for ball in shape]) + _free(mission, fleet, mesh)).all():
        message = f"this {word} is inside {owner.words}"
        return Diagnostic("D016", message, labels, ("no drone can stand in it",), help_)
    free = _free(mission, fleet, mesh)
    note = f"by {at_least(float(lack.max()))} m, the {free:.2f} m included that must be free"
    message = f"this {word} reaches into {owner.words}"
    help_text = f"{help_}; the plan refuses drones that stand there"
    return Diagnostic("D017", message, labels, (note,), help_text)


def _free(mission: MissionIR, fleet: Fleet, mesh: ObstacleMesh) -> float:
    """Return the metres about the centre of a drone that must be free of a mesh."""
    return mission.rules.beside_obstacle(fleet.radius) + mesh.spacing


def _raised(mission: MissionIR, fleet: Fleet, picture: Picture, shape: tuple[Ball, ...]) -> str:
    """Say by how much a picture is to be raised to be clear of every mesh, or else moved."""
    centre = picture.source.centre
    assert centre is not None
    for by, word in ((b, w) for m in MOVES_M for b, w in _by(float(m))):
        there = tuple(ball._replace(centre=_plus(ball.centre, by)) for ball in shape)
        low = all(b.centre[2] - b.radius >= mission.lowest(b.centre, fleet.radius) for b in there)
        clear = low and all(is_clear(there, around, fleet.radius) for around in clearances_of(mission, fleet))
        if clear and all(_lacks(mission, fleet, mesh, there).max() <= 0.0 for mesh in mission.meshes):
            to = ", ".join(f"{c + 0.0:.2f}" for c in _plus(centre, by))
            return f"move it {word}, to `center: [{to}]`"
    return "move it clear"


def _by(metres: float) -> Iterator[tuple[Vec3, str]]:
    yield (0.0, 0.0, metres), f"{metres:.0f} m up"
    for (dx, dy), word in WAYS:
        yield (metres * dx, metres * dy, 0.0), f"{metres:.0f} m {word}"


def _plus(p: Vec3, by: Vec3) -> Vec3:
    return (p[0] + by[0], p[1] + by[1], p[2] + by[2])

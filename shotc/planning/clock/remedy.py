"""Remedies for a shot on its own clock that a scene or buildings block. Each is planned before it is
proposed.

The lack that a programme reports is no remedy: it is measured from linearised half-spaces, and a mesh cannot
move. A smaller clearance or a higher path can be written into the mission, and planned.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.owners import Owner
from shotc.planning.clock.aims import CameraTask
from shotc.planning.clock.ideals import ideal_places
from shotc.planning.clock.itinerary import Itinerary
from shotc.planning.clock.shot import NoMotion, timed_shot
from shotc.planning.free_space import FreeSpace, bounds_slack
from shotc.planning.obstacles import free_spaces_of

STEP_S = 0.25  # seconds between samples of a shot
FINE_M = 0.1  # metres, resolution of a proposed clearance
SHARES = (1, 2, 4)  # multiples of the lack by which the clearance is lowered
LIFTS_M = (1, 2, 3, 5, 8, 12, 18, 25, 35, 50)
"""Metres by which a shot is raised."""


class MeshConflict(NamedTuple):
    """The sample of a shot that lacks the most clearance from a mesh: time, lack in metres, and the mesh's
    owner.
    """

    t: float
    lack: float
    owner: Owner


class Remedy(NamedTuple):
    """A change with which the shot can be planned: a clearance from meshes, or a rise of the path, metres."""

    clearance: float | None = None
    higher: float | None = None


class BesideMeshes(NamedTuple):
    """The report on a shot that meshes block; remedy : None if none was found."""

    blocked: MeshConflict | None
    remedy: Remedy | None


def beside_meshes(itinerary: Itinerary, placed: PlacedShot, trouble: NoMotion) -> BesideMeshes | None:
    """Return where meshes block a shot and what helps; None if no mesh blocks it."""
    mission, space = itinerary.mission, itinerary.flight.space
    lacks = {owner: lack for owner, lack in trouble.lacks if any(m.owner == owner for m in space.meshes)}
    if not lacks or placed.shot.ideal is None:
        return None
    places = _places(mission, placed, trouble.start)
    blocked, lack = _blocked(space, *places), max(lacks.values())
    # The transfers to and from the shot need slightly more free space than the shot.
    drops = [share * lack + FINE_M / 2 for share in SHARES]
    drops += [] if blocked is None else [blocked.lack + FINE_M]
    closer = _closer(itinerary, placed, trouble.start, drops)
    return BesideMeshes(blocked, closer or _higher(itinerary, placed, trouble.start, places[1]))


def _places(mission: MissionIR, placed: PlacedShot, start: float) -> tuple[Array, Array]:
    """Return times of a shot's film, (M,), and its ideal positions at those times, (M, 3)."""
    duration = placed.shot.timing.duration or 0.0
    times = start + np.linspace(0.0, duration, max(2, int(duration / STEP_S)))
    return times, ideal_places(mission, placed.shot, start, times)


def _blocked(space: FreeSpace, times: Array, places: Array) -> MeshConflict | None:
    worst: MeshConflict | None = None
    for mesh in space.meshes:
        lacks = -mesh.slack(places)
        i = int(lacks.argmax())
        if lacks[i] > 0.0 and (worst is None or lacks[i] > worst.lack):
            worst = MeshConflict(float(times[i]), float(lacks[i]), mesh.owner_at(places[i]))
    return worst


def _closer(itinerary: Itinerary, placed: PlacedShot, start: float, drops: list[float]) -> Remedy | None:
    """Return a smaller clearance with which the shot is feasible; drops : candidate reductions, metres."""
    mission = itinerary.mission
    for drop in sorted(drops):
        steps = np.floor((mission.rules.obstacle_clearance - drop) / FINE_M)
        if steps < 0:
            return None
        clearance = round(float(steps) * FINE_M, 1)
        lower = mission._replace(rules=mission.rules._replace(obstacle_clearance=clearance))
        if _flown(itinerary, lower, placed, start):
            return Remedy(clearance=clearance)
    return None


def _higher(itinerary: Itinerary, placed: PlacedShot, start: float, places: Array) -> Remedy | None:
    """Return the rise with which the shot is feasible; only rises that leave its ideal in free space are
    tried.
    """
    mission, shot = itinerary.mission, placed.shot
    ideal, space = shot.ideal, itinerary.flight.space
    if ideal is None or (*shot.path, "altitude") not in mission.origins.values:
        return None
    for lift in LIFTS_M:
        if float(bounds_slack(space, places + np.array([0.0, 0.0, lift])).min()) < 0.0:
            continue
        points = tuple((share, (x, y, z + lift)) for share, (x, y, z) in ideal.points)
        raised = shot._replace(ideal=ideal._replace(points=points))
        shots = tuple(raised if s.id == shot.id else s for s in mission.shots)
        if _flown(itinerary, mission._replace(shots=shots), placed._replace(shot=raised), start):
            return Remedy(higher=float(lift))
    return None


def _flown(itinerary: Itinerary, mission: MissionIR, placed: PlacedShot, start: float) -> bool:
    """Return whether a shot has a motion in another mission, and a transfer to it."""
    spaces = free_spaces_of(mission, itinerary.drone)
    task = CameraTask(mission, itinerary.drone, placed.subjects)
    if isinstance(timed_shot(task, (spaces, itinerary.others), placed, start), NoMotion):
        return False
    flight = replace(itinerary.flight, spaces=spaces)
    return itinerary.copied(mission, flight).film(placed) is None

"""The course of a shot led round meshes: the cheapest way through layers of places about its ideal.

Each moment has a layer: its ideal place, and places about it. A way takes one place of each layer; it costs
how far its places are from the ideal, and by how much that changes (a layered graph as of Jeon, Lee and Kim,
Integrated Motion Planner for Real-time Aerial Videography with a Drone, 2020). Straight ways between places
of a course that was found are tested; where one is not free, all ways between its two layers are tested, and
the search is repeated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.pieces import Mask
from shotc.geom.sampling import directions
from shotc.geom.solid_arrays.points import distances
from shotc.planning.clock.moving import Moving
from shotc.planning.free_space import MARGIN_M, FreeSpace, blocked, bounds_slack

RINGS_M = (1.0, 2.0, 3.5, 5.5, 8.0, 11.0, 15.0, 20.0)  # metres of places from their ideal
TURNS, RISES_RAD = 12, (0.0, 0.5, 1.0)
CHANGE_S = 2.0  # seconds: a change of so many times a distance from the ideal costs as much as that distance
FASTEST_M_S = 12.0  # by which a distance from the ideal may change
BLOCKED = 1e9  # cost of what is not free
LEAST_S = 0.4  # seconds between layers at least


def led_round(space: FreeSpace, near: Sequence[Moving], times: Array, ideal: Array) -> Array:
    """Return places (N, 3) of a course at mission times (N,) that is led round meshes; the ideal if it can.

    space : what a drone is held to but for what moves and for solids; near : those
    ideal : its places at those times, shape (N, 3). It is returned where it is free, and where no course is.
    """
    if not space.meshes or not _stopped(space, ideal[:-1], ideal[1:]).any():
        return ideal
    layers = np.unique(np.append(np.arange(0, len(times) - 1, _stride(times)), len(times) - 1))
    offsets = _course(space, near, times[layers], ideal[layers])
    if offsets is None:
        return ideal
    between = [np.interp(times, times[layers], offsets[:, axis]) for axis in range(3)]
    return np.asarray(ideal + np.column_stack(between))


def _stride(times: Array) -> int:
    return max(1, round(LEAST_S * (len(times) - 1) / float(times[-1] - times[0])))


def _course(space: FreeSpace, near: Sequence[Moving], times: Array, ideal: Array) -> Array | None:
    """Return offsets (L, 3) from the ideal at the layers' times; None where no course is free."""
    rings = np.array(RINGS_M)[:, None, None] * directions(TURNS, RISES_RAD)
    shifts = np.concatenate([np.zeros((1, 3)), rings.reshape(-1, 3)])
    places, step = ideal[:, None] + shifts, np.diff(times)
    room = _room(space, near, times, places)
    stay = np.where(room >= 0.0, (shifts**2).sum(axis=1) * np.gradient(times)[:, None], BLOCKED)
    apart = np.linalg.norm(shifts[:, None] - shifts[None], axis=2)
    change = np.where(apart <= FASTEST_M_S * step.max(), (CHANGE_S * apart) ** 2, BLOCKED)
    shut = np.zeros((len(step), len(shifts), len(shifts)), dtype=bool)
    tested = np.zeros(len(step), dtype=bool)
    while True:
        chosen, cost = _cheapest(stay, change, step, shut)
        if cost >= BLOCKED:
            return None
        at = places[np.arange(len(times)), chosen]
        stopped = np.flatnonzero(_stopped(space, at[:-1], at[1:]) & ~tested)
        if not len(stopped):
            return np.asarray(shifts[chosen])
        for k in stopped:
            shut[k] = _shut(space, places[k : k + 2], room[k : k + 2], change < BLOCKED)
        tested[stopped] = True


def _room(space: FreeSpace, near: Sequence[Moving], times: Array, places: Array) -> Array:
    """Return how much room beyond what is needed places of layers (L, C, 3) have at their times; (L, C)."""
    room = bounds_slack(space, places.reshape(-1, 3)).reshape(places.shape[:2])
    for what in near:
        beside = places - what.at(times)[:, None]
        far = distances(what.part, beside.reshape(-1, 3)).reshape(room.shape)
        room = np.minimum(room, far - what.clearance)
    return np.asarray(room - MARGIN_M)


def _cheapest(stay: Array, change: Array, step: Array, shut: Mask) -> tuple[Array, float]:
    """Return the place of each layer on the cheapest course, (L,), and what it costs (Viterbi 1967)."""
    cost, before = stay[0], []
    for k in range(len(step)):
        ways = cost[:, None] + change / step[k]
        ways[shut[k]] = BLOCKED
        before.append(ways.argmin(axis=0))
        cost = ways.min(axis=0) + stay[k + 1]
    chosen = [int(cost.argmin())]
    for came in reversed(before):
        chosen.append(int(came[chosen[-1]]))
    return np.array(chosen[::-1]), float(cost.min())


def _shut(space: FreeSpace, places: Array, room: Array, near: Mask) -> Mask:
    """Tell which ways from places of one layer to those of the next one are stopped; (C, C).

    places : (2, C, 3), and their room (2, C), metres; near : the ways that count, (C, C)
    A way between two places that have more room than it is long is free.
    """
    long = np.linalg.norm(places[0][:, None] - places[1][None], axis=2)
    free = near & (room[0] >= 0.0)[:, None] & (room[1] >= 0.0)
    shut: Mask = ~free
    i, j = np.nonzero(free & (room[0][:, None] + room[1] < long))
    shut[i, j] = _stopped(space, places[0][i], places[1][j])
    return shut


def _stopped(space: FreeSpace, a: Array, b: Array) -> Mask:
    """Tell which straight ways a-b, shapes (N, 3), come too near to a mesh; (N,)."""
    meshes = replace(space, obstacles=(), terrain=())
    stopped: Mask = np.any(blocked(meshes, a, b, MARGIN_M), axis=1)
    return stopped

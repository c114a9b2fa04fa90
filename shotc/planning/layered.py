"""The course of a shot around meshes, and to where they do not hide its subject.

It is the cheapest path through layers of places. Each sampled time has a layer: the ideal position, and
places around it. A path takes one place of each layer. Its cost is the distance of its places from the ideal,
the change of that distance, and the hidden share of the subject (a layered graph as of Jeon, Lee and Kim,
Integrated Motion Planner for Real-time Aerial Videography with a Drone, 2020). The segments of a course are
tested after it is found. If one is blocked, all segments between its two layers are tested, and the search is
repeated.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, Protocol

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.bspline import IntArray
from shotc.geom.pieces import Mask
from shotc.geom.sampling import directions
from shotc.geom.solid_arrays.points import distances
from shotc.geom.solids import Solid
from shotc.geom.surface.tree import Surface
from shotc.ir.hiding_surfaces import share_behind, share_hidden
from shotc.planning.free_space import MARGIN_M, FreeSpace, blocked, bounds_slack

RINGS_M = (1.0, 2.0, 3.5, 5.5, 8.0, 11.0, 15.0, 20.0)  # metres of places from the ideal
TURNS, RISES_RAD = 12, (0.0, 0.5, 1.0)
CHANGE_S = 2.0  # seconds, weight of the rate of change of the offset over the offset
FASTEST_M_S = 12.0  # fastest change of the offset from the ideal
BLOCKED_COST = 1e9  # cost of a blocked place or segment
UNSEEN_SHARE = 0.7  # offset, over the distance to the subject, that costs as much as hiding it
FOR_SIGHT_SHARE = 0.4  # largest offset, over that distance, to see the subject
SPREAD_S = 1.0  # seconds around a hidden sample in which the course is led
LEAST_S = 0.4  # least seconds between layers


class Passing(Protocol):
    """A moving obstacle of a course: a solid about the origin of a motion."""

    @property
    def part(self) -> Solid:
        """The solid."""

    @property
    def clearance(self) -> float:
        """The clearance from it, metres."""

    @property
    def at(self) -> Callable[[Array], Array]:
        """A function from times (M,) to positions (M, 3) of its origin."""


@dataclass(frozen=True, slots=True, eq=False)
class VisibleSubject:
    """A subject that a shot should see.

    places : positions of its centre at the times of a course, (N, 3)
    filmed : at which of these times it is filmed, (N,)
    radius, height : of the vertical cylinder around it, metres
    surfaces, solids : possible occluders, at least one
    """

    places: Array
    filmed: Mask
    radius: float
    height: float
    surfaces: tuple[Surface, ...]
    solids: tuple[Solid, ...] = ()

    def hidden(self, eyes: Array) -> Array:
        """Return the hidden share of the subject from places (L, C, 3), one layer a time; (L, C).

        Occluders within its own radius belong to it.
        """
        centres = np.broadcast_to(self.places[:, None], eyes.shape).reshape(-1, 3)
        at, size = (eyes.reshape(-1, 3), centres), (self.radius, self.height)
        shares = [share_hidden(surface, *at, *size) for surface in self.surfaces]
        if self.solids:
            shares.append(share_behind(self.solids, *at, *size))
        most: Array = np.max(shares, axis=0).reshape(eyes.shape[:2])
        return most * self.filmed[:, None]

    def at(self, which: IntArray) -> VisibleSubject:
        """Return it at some of the times, by index."""
        return replace(self, places=self.places[which], filmed=self.filmed[which])


@dataclass(frozen=True, slots=True, eq=False)
class VisiblePath:
    """Positions over time, (N, 3), and how far the course is led there to see the subject, (N,), 0 to 1."""

    places: Array
    for_sight: Array


def led_round(
    space: FreeSpace,
    near: Sequence[Passing],
    course: tuple[Array, Array],
    watched: VisibleSubject | None = None,
    held: Mask | None = None,
    *,
    joined: bool = True,
) -> VisiblePath:
    """Return a course around surfaces; the ideal where that is free and sees the subject.

    If no course is found, the ideal is returned.

    course : mission times (N,), and the ideal positions, (N, 3)
    space : walls, discs, terrain and meshes of the drone
    near : standing and moving obstacles
    held : times at which it stays at its ideal where that is free, (N,)
    joined : whether the segments between its places have to be free; otherwise the caller joins them
    """
    times, ideal = course
    still = VisiblePath(ideal, np.zeros(len(times)))
    covered = np.zeros(len(times)) if watched is None else watched.hidden(ideal[:, None])[:, 0]
    stopped = joined and bool(_stopped(space, ideal[:-1], ideal[1:]).any())
    if not stopped and not covered.any():
        return still
    layers = np.unique(np.append(np.arange(0, len(times) - 1, _stride(times)), len(times) - 1))
    seen = None if watched is None else watched.at(layers)
    fixed = None if held is None else held[layers]
    offsets = _course(space, near, _Layers(times[layers], ideal[layers], fixed), seen, joined=joined)
    if offsets is None:
        return still
    between = [np.interp(times, times[layers], offsets[:, axis]) for axis in range(3)]
    unseen = times[covered > 0.0]
    seconds = np.abs(times[:, None] - unseen).min(axis=1, initial=np.inf)
    return VisiblePath(ideal + np.column_stack(between), np.clip(2.0 - seconds / SPREAD_S, 0.0, 1.0))


def _stride(times: Array) -> int:
    return max(1, round(LEAST_S * (len(times) - 1) / float(times[-1] - times[0])))


class _Layers(NamedTuple):
    """Mission times (L,) and ideal positions (L, 3); held : which of these stay where they are free, (L,)."""

    times: Array
    ideal: Array
    held: Mask | None


def _course(
    space: FreeSpace,
    near: Sequence[Passing],
    layers: _Layers,
    watched: VisibleSubject | None,
    *,
    joined: bool,
) -> Array | None:
    """Return offsets (L, 3) from the ideal at the layers' times; None where no course is free.

    joined : as in ``led_round``
    """
    times, at_ideal, held = layers
    rings = np.array(RINGS_M)[:, None, None] * directions(TURNS, RISES_RAD)
    shifts = np.concatenate([np.zeros((1, 3)), rings.reshape(-1, 3)])
    places, step = at_ideal[:, None] + shifts, np.diff(times)
    slack = _slack(space, near, times, places)
    price = (shifts**2).sum(axis=1) + np.zeros((len(times), 1))
    if watched is not None:
        far = np.linalg.norm(shifts, axis=1)
        distances = np.linalg.norm(watched.places - at_ideal, axis=1)[:, None]
        # A blocked ideal is left anyway.
        most = np.where(slack[:, :1] >= 0.0, FOR_SIGHT_SHARE * distances, np.inf)
        unseen = np.where(far <= most, watched.hidden(places), watched.filmed[:, None])
        price += (UNSEEN_SHARE * distances) ** 2 * unseen
    stay = np.where(slack >= 0.0, price * np.gradient(times)[:, None], BLOCKED_COST)
    if held is not None:
        stay[held & (slack[:, 0] >= 0.0), 1:] = BLOCKED_COST
    apart = np.linalg.norm(shifts[:, None] - shifts[None], axis=2)
    change = np.where(apart <= FASTEST_M_S * step.max(), (CHANGE_S * apart) ** 2, BLOCKED_COST)
    shut = np.zeros((len(step), len(shifts), len(shifts)), dtype=bool)
    tested = np.zeros(len(step), dtype=bool)
    while True:
        chosen, cost = _cheapest(stay, change, step, shut)
        if cost >= BLOCKED_COST:
            return None
        if not joined:
            return np.asarray(shifts[chosen])
        at = places[np.arange(len(times)), chosen]
        stopped = np.flatnonzero(_stopped(space, at[:-1], at[1:]) & ~tested)
        if not len(stopped):
            return np.asarray(shifts[chosen])
        for k in stopped:
            shut[k] = _shut(space, places[k : k + 2], slack[k : k + 2], change < BLOCKED_COST)
        tested[stopped] = True


def _slack(space: FreeSpace, near: Sequence[Passing], times: Array, places: Array) -> Array:
    """Return the slack of places of layers (L, C, 3) over their clearances and a margin; (L, C), metres."""
    slack = bounds_slack(space, places.reshape(-1, 3)).reshape(places.shape[:2])
    for what in near:
        beside = places - what.at(times)[:, None]
        far = distances(what.part, beside.reshape(-1, 3)).reshape(slack.shape)
        slack = np.minimum(slack, far - what.clearance)
    return np.asarray(slack - MARGIN_M)


def _cheapest(stay: Array, change: Array, step: Array, shut: Mask) -> tuple[Array, float]:
    """Return the place of each layer on the cheapest course, (L,), and its cost (Viterbi 1967)."""
    cost, before = stay[0], []
    for k in range(len(step)):
        costs = cost[:, None] + change / step[k]
        costs[shut[k]] = BLOCKED_COST
        before.append(costs.argmin(axis=0))
        cost = costs.min(axis=0) + stay[k + 1]
    chosen = [int(cost.argmin())]
    for came in reversed(before):
        chosen.append(int(came[chosen[-1]]))
    return np.array(chosen[::-1]), float(cost.min())


def _shut(space: FreeSpace, places: Array, slack: Array, near: Mask) -> Mask:
    """Return which segments from places of one layer to those of the next are blocked; (C, C).

    A segment is free if the slacks of its ends together are at least its length.

    places : (2, C, 3)
    slack : their slack (2, C), metres
    near : segments that count, (C, C)
    """
    long = np.linalg.norm(places[0][:, None] - places[1][None], axis=2)
    free = near & (slack[0] >= 0.0)[:, None] & (slack[1] >= 0.0)
    shut: Mask = ~free
    i, j = np.nonzero(free & (slack[0][:, None] + slack[1] < long))
    shut[i, j] = _stopped(space, places[0][i], places[1][j])
    return shut


def _stopped(space: FreeSpace, a: Array, b: Array) -> Mask:
    """Return which segments a-b, shapes (N, 3), are too near to a mesh; (N,)."""
    if not space.meshes:
        return np.zeros(len(a), dtype=bool)
    meshes = replace(space, obstacles=(), terrain=())
    stopped: Mask = np.any(blocked(meshes, a, b, MARGIN_M), axis=1)
    return stopped

"""The lens of a shot on its own clock: the field of view over mission time for a known position.

No cost of the position depends on the lens, so the two are found one after the other. The lens is a convex
programme with one channel: near the reference, wide enough for whole subjects, smooth, and within its range
and rate at every instant. Keyframes bind it, and so do both ends of the leg.
"""

from __future__ import annotations

from dataclasses import replace
from math import log
from typing import NamedTuple

import numpy as np
import piqp
from scipy import sparse

from shotc.plugin_api.refiner import (
    CAM_PITCH,
    CAM_YAW,
    HFOV,
    Array,
    ClockLeg,
    IntArray,
    Mask,
    PlacedSubject,
    View,
    quintic_hermite,
    shapes,
    viewpoint,
)
from shotc_casadi.clock.curve import filmed
from shotc_casadi.clock.references import ClockSubject, filmed_at, seen_at
from shotc_casadi.clock.shown import cropped_on_purpose
from shotc_casadi.lens import SAME_SHARE, lens_bounds

# Weights of mean squares over the film, of shares of the field of view.
WHOLE_WEIGHT = 300.0  # of a share by which it is too narrow for a subject; the same in the framing of paths
SMOOTH_S = 1.0  # shorter wiggles vanish with normal smoothing, seconds
FAINT_SHARE = 1e-3  # on run-up and run-out, relative to the film
NEARLY_SHARE = 0.999  # of its rate that is used
SIZED_SHARE = 0.05  # of a size that is asked for: the position corrects smaller errors
NARROW_SHARE = 1e-3  # of a field of view: a zoom is worth it from this lack on
SAME_S = 1e-6  # seconds
SOLVER_TOLERANCE = 1e-9  # of the solver
VALUE, RATE, BEND = range(3)  # indices of the states of a node


class _Lens(NamedTuple):
    """The task of a lens at the nodes, shapes (N + 1,), fields of view in rad.

    reference : field of view to follow, rad
    least : smallest field of view that shows all subjects whole
    weight : of each node
    given : field of view of the guide
    bound : where the given one binds
    """

    reference: Array
    least: Array
    weight: Array
    given: Array
    bound: Mask


def zoomed(subject: ClockSubject, leg: ClockLeg) -> ClockLeg | None:
    """Return a leg with a lens that zooms, None if it cannot zoom or zooming gains nothing.

    leg : of the subject's shot, refined or not; its position stays, its camera is computed again
    """
    drone = subject.drone
    if not drone.zooms or not subject.framed:
        return None
    t = leg.curve.breaks
    task = _task(subject, leg, t)
    if task is None:
        return None
    states = _solved(subject, t, task)
    if states is None:
        return None
    lens = quintic_hermite(t, *(states[:, [k]] for k in (VALUE, RATE, BEND)))
    camera = leg.curve.channels(CAM_YAW, CAM_PITCH) if subject.together else None
    return filmed(replace(subject, lens=lens), leg.curve.channels(0, 1, 2), camera)


def _task(subject: ClockSubject, leg: ClockLeg, t: Array) -> _Lens | None:
    """Return the task of the lens, None if the given field of view is as good."""
    film = filmed_at(leg, t)
    pose = leg.curve(t)
    given = pose[:, HFOV]
    reference = np.where(film, _reference(subject, leg, t, pose), given)
    unasked = subject.drone.zooms_unasked or not (reference == given).all()
    least = np.where(film, _least(subject, t, pose), 0.0) if unasked else np.zeros(len(t))
    low, high = lens_bounds(subject.drone, given)
    reference, least = np.clip(reference, low, high), np.minimum(least, high)
    if (reference == given).all() and (least <= given * (1.0 + NARROW_SHARE)).all():
        return None
    length = np.diff(t)
    weight = 0.5 * (np.append(length, 0.0) + np.append(0.0, length)) * np.where(film, 1.0, FAINT_SHARE)
    return _Lens(reference, least, weight / (leg.end - leg.start), given, _bound(subject, t))


def _bound(subject: ClockSubject, t: Array) -> Mask:
    """Return where keyframes bind the lens: at their times, and while the camera holds there."""
    bound = np.zeros(len(t), dtype=bool)
    keyed = subject.camera_task.keyed
    for stretch in () if keyed is None else keyed.stretches:
        inside = (t >= stretch.start - SAME_S) & (t <= stretch.end + SAME_S)
        ends = (np.abs(t - stretch.start) <= SAME_S) | (np.abs(t - stretch.end) <= SAME_S)
        bound |= inside if stretch.a is stretch.b else ends
    return bound


def _reference(subject: ClockSubject, leg: ClockLeg, t: Array, pose: Array) -> Array:
    """Return the reference field of view, rad, shape (N + 1,).

    Between two keyframes of one target with different lenses, the logarithm of the target's size moves
    linearly with the progress from the one to the other. If sizes are asked for and missed, the reference
    meets them. Otherwise it is the given field of view.
    """
    keyed = subject.camera_task.keyed
    reference = np.array(pose[:, HFOV])
    if keyed is None and not subject.drone.zooms_unasked:
        return reference
    if keyed is None:
        factor = _factor(subject, t, pose)
        return 2.0 * np.arctan(np.tan(reference / 2) * factor) if (factor != 1.0).any() else reference
    distance = np.linalg.norm(seen_at(subject, t)[:, 0] - pose[:, :3], axis=1)
    for stretch in keyed.stretches:
        a, b = stretch.a, stretch.b
        if not stretch.follows or abs(a.hfov - b.hfov) <= SAME_SHARE * max(a.hfov, b.hfov):
            continue
        inside = (t > stretch.start + SAME_S) & (t < stretch.end - SAME_S)
        ends = np.array([stretch.start, stretch.end])
        there = np.linalg.norm(seen_at(subject, ends)[:, 0] - leg.curve(ends)[:, :3], axis=1)
        first, last = (log(d * np.tan(k.hfov / 2)) for d, k in zip(there, (a, b), strict=True))
        spread = first + (last - first) * stretch.share(t[inside])
        reference[inside] = 2.0 * np.arctan(np.exp(spread) / distance[inside])
    return reference


def _factor(subject: ClockSubject, t: Array, pose: Array) -> Array:
    """Return how much wider the picture has to be to meet the sizes asked for on average, (N + 1,)."""
    off = []
    for one in subject.framed:
        sizes = np.array([one.asked(float(u) - subject.leg.start).size or np.nan for u in t])
        _, _, low, high = _outline(subject, one, t, pose)
        off.append(np.log(0.5 * (high - low) / sizes))
    known = np.isfinite(off)
    mean = np.where(known, off, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
    return np.where((np.abs(mean) > SIZED_SHARE).any(), np.exp(mean), 1.0)


def _least(subject: ClockSubject, t: Array, pose: Array) -> Array:
    """Return the smallest field of view that shows all subjects whole, rad, shape (N + 1,); 0 if any does.

    If there is one subject, the camera keeps its place on screen, so its outline shrinks about that place.
    """
    factor = np.zeros(len(t))
    for one in subject.framed:
        if cropped_on_purpose(one):
            continue
        box = _outline(subject, one, t, pose)
        middle = np.zeros((2, len(t))) if subject.together else _places(subject, one, t)
        for axis, edge, inwards in ((0, 0, -1.0), (0, 1, 1.0), (1, 2, -1.0), (1, 3, 1.0)):
            margin = viewpoint.EDGE_SHARE - inwards * middle[axis]
            grows = inwards * (box[edge] - middle[axis])
            need = np.where(margin > 0.0, grows / np.maximum(margin, 1e-9), np.inf)
            factor = np.fmax(factor, need)
    return np.asarray(2.0 * np.arctan(np.tan(pose[:, HFOV] / 2) * factor))


def _places(subject: ClockSubject, one: PlacedSubject, t: Array) -> Array:
    """Return the place on screen asked for a subject at times, the middle if none, shape (2, N + 1)."""
    places = np.zeros((2, len(t)))
    for span in subject.leg.framing:
        if span.target == one.target and span.reference is not None:
            inside = (t >= span.start - SAME_S) & (t <= span.end + SAME_S)
            places[:, inside] = span.reference(t[inside]).T
    return places


def _outline(subject: ClockSubject, one: PlacedSubject, t: Array, pose: Array) -> Array:
    """Return left, right, low and high of a subject's outline at times, half frames, shape (4, N + 1).

    They are NaN behind the camera.
    """
    target = subject.mission.target(one.target)
    offset = (np.array([target.at(float(u)) for u in t]) - pose[:, :3]).T
    yaw, pitch, half = pose[:, CAM_YAW], pose[:, CAM_PITCH], np.tan(pose[:, HFOV] / 2)
    camera = View(np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch), half, half / subject.drone.aspect)
    x, y, z = offset
    return np.array(shapes(target, t).bounds(camera, (x, y, z)))


def _solved(subject: ClockSubject, t: Array, task: _Lens) -> Array | None:
    """Return field of view, rate and acceleration at the nodes, (N + 1, 3), None if infeasible."""
    n, h, smoother = len(t) - 1, np.diff(t), subject.placed.shot.smoother
    scale = 1.0 / np.sin(task.reference)
    drawn, narrow = 2.0 * task.weight * scale**2, 2.0 * WHOLE_WEIGHT * task.weight * scale**2
    bend = 2.0 * (SMOOTH_S * smoother) ** 6 * h / (t[-1] - t[0]) * scale[:-1] ** 2
    states = np.zeros((n + 1, 3))
    states[:, VALUE] = drawn
    square = np.concatenate([states.ravel(), bend, narrow])
    states[:, VALUE] = -drawn * task.reference
    linear = np.concatenate([states.ravel(), np.zeros(n + n + 1)])
    rows = _Unknowns(n)
    low, high = lens_bounds(subject.drone, task.given)
    assert subject.drone.lens is not None
    rate = NEARLY_SHARE * subject.drone.lens.rate
    value, first, second = (rows.state(k) for k in (VALUE, RATE, BEND))
    inner, after = slice(0, n), slice(1, n + 1)
    widths = [sparse.diags(h / 3) @ first[inner], sparse.diags(h / 3) @ first[after]]
    bounded = sparse.vstack(
        [
            value,
            value[inner] + widths[0],
            value[after] - widths[1],
            first,
            first[inner] + sparse.diags(h / 2) @ second[inner],
            value + rows.slack,
        ]
    ).tocsc()
    ranges = [(low, high, 3 * n + 1), (-rate, rate, 2 * n + 1)]
    least, most = (np.concatenate([np.full(r[2], r[side]) for r in ranges]) for side in (0, 1))
    least, most = np.append(least, task.least), np.append(most, np.full(n + 1, np.inf))
    held = np.flatnonzero(task.bound | np.isin(np.arange(n + 1), (0, n)))
    ends = [0, n]
    equal = sparse.vstack([rows.motion(h), value[held], first[ends], second[ends]]).tocsc()
    right = np.concatenate([np.zeros(3 * n), task.given[held], np.zeros(4)])
    solver = piqp.SparseSolver()
    solver.settings.eps_abs, solver.settings.eps_rel = SOLVER_TOLERANCE, SOLVER_TOLERANCE
    solver.setup(sparse.diags(square).tocsc(), linear, equal, right, bounded, least, most)
    if solver.solve() != piqp.PIQP_SOLVED:
        return None
    solution = np.asarray(solver.result.x)[: 3 * (n + 1)].reshape(n + 1, 3).copy()
    solution[[0, -1]] = [[task.given[0], 0.0, 0.0], [task.given[-1], 0.0, 0.0]]
    return solution


class _Unknowns:
    """The order of the unknowns: three states a node, then an input a stage, then a slack a node."""

    def __init__(self, stages: int) -> None:
        self.n = stages
        self.size = 3 * (stages + 1) + stages + stages + 1

    def state(self, which: int) -> sparse.csr_matrix:
        """Return the rows that select a state at all nodes."""
        return self._picked(3 * np.arange(self.n + 1) + which)

    @property
    def slack(self) -> sparse.csr_matrix:
        """Return the rows that select the slacks."""
        return self._picked(3 * (self.n + 1) + self.n + np.arange(self.n + 1))

    def motion(self, h: Array) -> sparse.csr_matrix:
        """Return the rows that are zero if a constant jerk leads from each node to the next."""
        jerk = self._picked(3 * (self.n + 1) + np.arange(self.n))
        value, first, second = (self.state(k) for k in (VALUE, RATE, BEND))
        by = sparse.diags
        before, after = slice(0, self.n), slice(1, self.n + 1)
        return sparse.vstack(
            [
                value[after]
                - value[before]
                - by(h) @ first[before]
                - by(h**2 / 2) @ second[before]
                - by(h**3 / 6) @ jerk,
                first[after] - first[before] - by(h) @ second[before] - by(h**2 / 2) @ jerk,
                second[after] - second[before] - by(h) @ jerk,
            ]
        )

    def _picked(self, at: IntArray) -> sparse.csr_matrix:
        ones = np.ones(len(at))
        return sparse.csr_matrix((ones, (np.arange(len(at)), at)), shape=(len(at), self.size))

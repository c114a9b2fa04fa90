"""The camera of a shot with keyframes at every instant: its lens, its angles, and references on screen.

At a keyframe the camera has that keyframe's field of view. It puts the keyframe's target at its place, or
looks along the keyframe's angles. Between keyframes everything changes smoothly (minimum jerk): the reference
on screen of a target that both keyframes share, or else the angles themselves, from one target to the other.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from shotc.geom.bernstein import Array, Piecewise, concatenate
from shotc.geom.bspline import IntArray, restrict
from shotc.geom.camera import View, aim_at
from shotc.geom.ease import MOST_PARTS, control, minimum_jerk
from shotc.geom.vec import wrapped
from shotc.ir.bodies import centres
from shotc.ir.drone import Drone, LensRange
from shotc.ir.keyed import arrivals, is_keyed, zoom_parts
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.phases import KeyframeTime, Reference

STEEP_SHARE = 0.1  # horizontal share of a line of sight, below which its bearing is undefined
CALM_WEIGHT = 1e-4  # half frames squared per rad^2, damping of turns off the keyframes' angles there
MOST_ROUNDS = 8  # Gauss-Newton iterations
NUDGE_RAD = 1e-6  # rad
MOST_RAD = 0.2  # rad, largest step of an iteration
SAME_S = 1e-9  # seconds


@dataclass(frozen=True, slots=True, eq=False)
class KeyframeSegment:
    """The interval from a keyframe to the next one, or a hold (then ``a`` is ``b``); mission time, seconds.

    parts : number of parts in which the lens zooms, as in ``geom.ease``
    """

    start: float
    end: float
    a: PlacedKeyframe
    b: PlacedKeyframe
    parts: int

    @property
    def follows(self) -> bool:
        """Whether one target moves from a place on screen to another."""
        same = self.a.target is not None and self.a.target == self.b.target
        return same and self.a.reference is not None and self.b.reference is not None

    def share(self, times: Array) -> Array:
        """Return the progress from 0 to 1 at mission times (M,), shape (M,)."""
        x = np.clip((times - self.start) / (self.end - self.start), 0.0, 1.0)
        return minimum_jerk(x)

    @property
    def lens(self) -> Piecewise:
        """The field of view over mission time, rad."""
        steps = control(self.parts)
        knots = [self.start + step.start * (self.end - self.start) for step in steps]
        ctrl = [[(1.0 - y) * self.a.hfov + y * self.b.hfov for y in step.points] for step in steps]
        return Piecewise(np.array([*knots, self.end]), np.array(ctrl)[:, :, None])


@dataclass(frozen=True, slots=True, eq=False)
class Keyed:
    """A shot with keyframes, for one start.

    stretches : in order and without gaps, from the first frame to the last
    chosen : field of view over mission time, rad, if a refiner chose it
    """

    mission: MissionIR
    drone: Drone
    stretches: tuple[KeyframeSegment, ...]
    chosen: Piecewise | None = None

    def hfov(self, times: Array) -> Array:
        """Return the field of view at mission times (M,), rad, shape (M,)."""
        if self.chosen is not None:
            return np.asarray(self.chosen(times)[:, 0])
        ends = np.array([[s.a.hfov, s.b.hfov] for s in self.stretches])
        share, of = self._shares(times)
        wide = np.asarray(ends[of, 0] + share * (ends[of, 1] - ends[of, 0]))
        for k, stretch in enumerate(self.stretches):
            if stretch.parts > 1:
                here, lens = of == k, stretch.lens
                wide[here] = lens(np.clip(times[here], lens.start, lens.end))[:, 0]
        return wide

    def lens(self, breaks: Array) -> Piecewise:
        """Return the field of view as a curve on given breaks, constant outside the film.

        breaks : shape (P + 1,), mission times in seconds; they contain all knots
        """
        film = self._lens
        knots = np.concatenate([breaks[:1], film.breaks, breaks[-1:]])
        first, last = (np.full((1, 6, 1), k.hfov) for k in (self.stretches[0].a, self.stretches[-1].b))
        return restrict(Piecewise(knots, np.concatenate([first, film.ctrl, last])), breaks)

    @property
    def _lens(self) -> Piecewise:
        """The field of view over the film, rad."""
        return concatenate([stretch.lens for stretch in self.stretches])

    def aims(self, times: Array, places: Array) -> Array:
        """Return yaw and pitch at times (M,) from camera positions (M, 3), shape (M, 2), rad."""
        angles, (share, of) = np.zeros((len(times), 2)), self._shares(times)
        for k in np.unique(of):
            here = of == k
            angles[here] = self._aims(self.stretches[k], share[here], times[here], places[here])
        return angles

    def framing(self, shot: str) -> tuple[Reference, ...]:
        """Return the references over time; a change from one target to another is split in its middle."""
        return tuple(_joined([span for stretch in self.stretches for span in _spans(shot, stretch)]))

    def _shares(self, times: Array) -> tuple[Array, IntArray]:
        starts = np.array([s.start for s in self.stretches[1:]])
        of = np.asarray(np.searchsorted(starts, times, side="right"))
        share = np.zeros(len(times))
        for k in np.unique(of):
            share[of == k] = self.stretches[k].share(times[of == k])
        return share, of

    def _aims(self, stretch: KeyframeSegment, share: Array, times: Array, places: Array) -> Array:
        a, b = stretch.a, stretch.b
        first = np.array([a.yaw, a.pitch])
        step = np.array([wrapped(b.yaw - a.yaw) if b.turn is None or a is b else b.turn, b.pitch - a.pitch])
        own: Array = first + share[:, None] * step
        if stretch.follows:
            ends = np.array([a.reference, b.reference])
            references = ends[0] + share[:, None] * (ends[1] - ends[0])
            return self._following(str(a.target), references, (times, places), own)
        if a is b:
            return own
        here, there = (np.tile(end, (len(times), 1)) for end in (first, first + step))
        here, there = (self._at(k, (times, places), angles) for k, angles in ((a, here), (b, there)))
        return np.asarray(here + share[:, None] * (there - here))

    def _at(self, keyframe: PlacedKeyframe, where: tuple[Array, Array], own: Array) -> Array:
        """Return the angles that a keyframe asks for at given positions, (M, 2); own : its own angles, (M,
        2).
        """
        if keyframe.target is None or keyframe.reference is None:
            return own
        references = np.tile(np.array(keyframe.reference), (len(own), 1))
        angles = self._following(keyframe.target, references, where, own)
        return np.column_stack([own[:, 0] + wrapped(angles[:, 0] - own[:, 0]), angles[:, 1]])

    def _following(self, name: str, references: Array, where: tuple[Array, Array], own: Array) -> Array:
        """Return the angles that put a target at its places on screen, (M, 2).

        Straight above or below the target the yaw is undefined: there the angles stay near ``own``.
        """
        times, places = where
        offsets = centres(self.mission.target(name), times) - places
        hfov, angles = self.hfov(times), own.copy()
        level = np.linalg.norm(offsets[:, :2], axis=1) >= STEEP_SHARE * np.linalg.norm(offsets, axis=1)
        for i in np.flatnonzero(level):
            x, y, z = map(float, offsets[i])
            uv = (float(references[i, 0]), float(references[i, 1]))
            angles[i] = aim_at((x, y, z), uv, float(hfov[i]), self.drone.aspect, own[i, 0]) or own[i]
        steep = ~level
        if steep.any():
            lens = np.tan(hfov[steep] / 2), np.tan(hfov[steep] / 2) / self.drone.aspect
            angles[steep] = _calmly(offsets[steep], references[steep], lens, own[steep])
        return angles


def keyed_of(mission: MissionIR, drone: Drone, placed: PlacedShot, start: float) -> Keyed | None:
    """Return the camera of a shot placed for its start; None where it has no keyframes."""
    if not is_keyed(placed.shot):
        return None
    return Keyed(mission, drone, tuple(_stretches(placed, start, drone.lens)))


def keyframe_times(placed: PlacedShot, start: float) -> tuple[KeyframeTime, ...]:
    """Return the mission times at which the keyframes of a shot on its own clock are reached."""
    if not is_keyed(placed.shot):
        return ()
    return tuple(KeyframeTime(placed.shot.id, i, start + t) for i, t in enumerate(arrivals(placed.shot)))


def _stretches(placed: PlacedShot, start: float, lens: LensRange | None) -> Iterator[KeyframeSegment]:
    keyframes, duration = placed.keyframes, placed.shot.timing.duration or 0.0
    arrive = arrivals(placed.shot)
    parts = zoom_parts(placed.shot, lens)
    stops = [(0.0, arrive[0], keyframes[0], keyframes[0], 1)]
    for i, (a, b) in enumerate(pairwise(keyframes)):
        leave = arrive[i] + a.hold
        stops += [(arrive[i], leave, a, a, 1), (leave, arrive[i + 1], a, b, parts[i] or MOST_PARTS)]
    stops += [(arrive[-1], duration, keyframes[-1], keyframes[-1], 1)]
    long = [stop for stop in stops if stop[1] - stop[0] > SAME_S]
    ends = [*(stop[0] for stop in long[1:]), duration]
    begin = 0.0
    for (_, _, a, b, n), end in zip(long, ends, strict=True):
        yield KeyframeSegment(start + begin, start + end, a, b, n)
        begin = end


def _spans(shot: str, stretch: KeyframeSegment) -> Iterator[Reference]:
    a, b = stretch.a, stretch.b
    if stretch.follows:
        ctrl = np.array([[a.reference] * 3 + [b.reference] * 3], dtype=np.float64)
        reference = Piecewise(np.array([stretch.start, stretch.end]), ctrl)
        yield Reference(shot, str(a.target), stretch.start, stretch.end, reference)
        return
    if a.target is not None and a.target == b.target:
        yield Reference(shot, a.target, stretch.start, stretch.end, None)
        return
    middle = 0.5 * (stretch.start + stretch.end)
    if a.target is not None:
        yield Reference(shot, a.target, stretch.start, middle, None)
    if b.target is not None:
        yield Reference(shot, b.target, middle, stretch.end, None)


def _joined(spans: Sequence[Reference]) -> Iterator[Reference]:
    """Yield the references with consecutive ones of the same target joined."""
    last: Reference | None = None
    for span in spans:
        if last is not None and last.target == span.target and last.end == span.start:
            a, b = last.reference, span.reference
            if (a is None) == (b is None):
                joined = None
                if a is not None and b is not None:
                    joined = Piecewise(np.append(a.breaks, b.breaks[1:]), np.concatenate([a.ctrl, b.ctrl]))
                last = Reference(last.shot, last.target, last.start, span.end, joined)
                continue
        if last is not None:
            yield last
        last = span
    if last is not None:
        yield last


def _calmly(offsets: Array, references: Array, lens: tuple[Array, Array], own: Array) -> Array:
    """Return the angles near ``own`` that put points at places on screen, (M, 2), by damped least squares."""
    turned = np.zeros_like(own)
    for _ in range(MOST_ROUNDS):
        here = _off(offsets, references, lens, own + turned)
        slopes = np.stack(
            [
                (_off(offsets, references, lens, own + turned + NUDGE_RAD * step) - here) / NUDGE_RAD
                for step in np.eye(2)
            ],
            axis=2,
        )
        normal = np.einsum("mri,mrj->mij", slopes, slopes) + CALM_WEIGHT * np.eye(2)
        down = np.einsum("mri,mr->mi", slopes, here) + CALM_WEIGHT * turned
        turned = turned - np.clip(np.linalg.solve(normal, down[:, :, None])[:, :, 0], -MOST_RAD, MOST_RAD)
    return own + turned


def _off(offsets: Array, references: Array, lens: tuple[Array, Array], aim: Array) -> Array:
    """Return the distances of points from their places on screen, half frames, (M, 2)."""
    yaw, pitch = aim.T
    camera = View(np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch), *lens)
    x, y, z = offsets.T
    right, down, forward = camera.to_camera((x, y, z))
    forward = np.maximum(forward, 0.1 * np.linalg.norm(offsets, axis=1))
    return np.column_stack(
        [right / (forward * lens[0]) - references[:, 0], -down / (forward * lens[1]) - references[:, 1]]
    )

"""Camera angles along a shot that keep the composition between keyframes, not only at them.

Where two neighbouring keyframes frame a target, its reference on screen moves from one to the other (C2 in
the path parameter). The angles that put the target there follow in closed form. A spline is fitted to them,
exact at the keyframes. Elsewhere the camera turns monotonically from one keyframe to the next.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import restrict, spline, subdivide
from shotc.geom.camera import aim_at
from shotc.geom.ease import minimum_jerk
from shotc.geom.pieces import Mask
from shotc.geom.vec import wrapped
from shotc.ir.drone import Drone
from shotc.ir.keyframes import PlacedKeyframe
from shotc.ir.mission import MissionIR
from shotc.ir.path import FramingSpan
from shotc.planning.path.lines import SAME_PLACE_M
from shotc.planning.path.monotone import lens_line, steady
from shotc.planning.path.unwrapping import Known, PlannedTurn, UnwrappedTurn, turned, turning
from shotc.solvers.conic import Status
from shotc.solvers.headings import DEFAULT
from shotc.solvers.spline_fit import Fit, fit, within

PIECES_PER_STRETCH = 3  # per stretch between keyframes, at least
SAMPLES_PER_PIECE = 6  # per piece
PIECE_FACTORS = (1, 2, 4, 8)
CLOSE_RAD = 1.5e-3  # rad on the sphere, error of the fit above which the grid is refined
STIFF_WEIGHT = 1e-13  # weight of smoothness over that of samples, both without dimension
FAINT_WEIGHT = 1e-2  # weight of samples where nothing is framed, over the others
NEAR_SHARE = 1e-3  # share of a piece, least distance of a keyframe from a break
NOTICE_RAD = 5e-3  # rad beyond the gimbal's range, above which there is a warning


@dataclass(frozen=True, slots=True, eq=False)
class KeyedPath:
    """The keyframes of one shot on its path, in order.

    s : path parameters, shape (K,), not decreasing
    exact : whether the path passes each keyframe itself, so that its angles hold there
    position : p_WC over s
    pace : share of the drone's limits
    headings : method of ``solvers.headings`` that chooses turns
    """

    keyframes: tuple[PlacedKeyframe, ...]
    s: Array
    exact: tuple[bool, ...]
    position: Piecewise
    pace: float = 1.0
    headings: str = DEFAULT


@dataclass(frozen=True, slots=True, eq=False)
class UnreachableAngles:
    """The interval in which the gimbal cannot show the target at its place.

    index : keyframe before it
    s : worst path parameter
    excess : rad beyond the pitch range, or None where no camera without roll could
    """

    index: int
    s: float
    excess: float | None


@dataclass(frozen=True, slots=True, eq=False)
class CameraLine:
    """Camera yaw, pitch and field of view over s: the three channels of ``angles``.

    error : largest error of the fitted direction, rad, at path parameter ``worst``
    unsolved : intervals whose yaw the headings method did not plan; there the camera turns monotonically
    """

    angles: Piecewise
    status: Status
    error: float
    worst: float
    cuts: tuple[UnreachableAngles, ...]
    unsolved: int = 0


class _KnownAngles(NamedTuple):
    """Angles at a path parameter; ``group`` as in ``unwrapping.Known``, ``keyframe`` its index or -1."""

    s: float
    yaw: float
    pitch: float
    group: int
    keyframe: int = -1


@dataclass(frozen=True, slots=True, eq=False)
class _Samples:
    """Reference angles on framed intervals (s, yaw, pitch, shape (M,)), and fixed ones at keyframes, (A,).

    planned, unsolved : as in ``unwrapping.Turned``
    """

    s: Array
    yaw: Array
    pitch: Array
    anchor_s: Array
    anchor_yaw: Array
    anchor_pitch: Array
    cuts: tuple[UnreachableAngles, ...]
    planned: tuple[PlannedTurn, ...] = ()
    unsolved: int = 0

    def planned_at(self, s: Array) -> tuple[Mask, Array]:
        """Return where a yaw is planned, and that yaw, both of the shape of s; the yaw is 0 elsewhere."""
        where, yaw = np.zeros(len(s), dtype=bool), np.zeros(len(s))
        for turn in self.planned:
            here = turn.covers(s) & ~where
            yaw[here] = turn.at(s[here])
            where |= here
        return where, yaw

    def steady(self, limits: tuple[float, float]) -> Piecewise:
        """Return the monotone turn through the fixed angles alone: yaw and pitch."""
        pitch = np.clip(self.anchor_pitch, *limits)
        yaw, pitch = (steady(self.anchor_s, v).ctrl for v in (self.anchor_yaw, pitch))
        return Piecewise(self.anchor_s, np.concatenate([yaw, pitch], axis=2))


def camera_line(mission: MissionIR, drone: Drone, keyed: KeyedPath) -> CameraLine:
    """Return the camera's angles along a shot, on breaks that contain those of the position curve.

    Where the fit is infeasible on every grid, or is the worse one, the result is the monotone turn between
    keyframes.
    """
    base = _grid(keyed)
    hfov = lens_line(keyed.keyframes, keyed.s)
    samples = _sample(mission, drone, keyed, base, hfov)
    turn = samples.steady(drone.gimbal.pitch)
    best = _line(restrict(turn, base), samples, hfov, Status.SOLVED)
    if not len(samples.s) and not samples.planned:
        return best
    fitted: CameraLine | None = None
    for finer in PIECE_FACTORS:
        breaks = subdivide(base, finer)
        samples = _sample(mission, drone, keyed, breaks, hfov)
        status, curve = _fitted(drone, samples, breaks, turn)
        if status not in {Status.SOLVED, Status.INACCURATE}:
            continue
        fitted = _line(curve, samples, hfov, status)
        if max(fitted.error, _off_plan(curve, samples)) < CLOSE_RAD:
            break
    return best if fitted is None or best.error < fitted.error else fitted


def _line(curve: Piecewise, samples: _Samples, hfov: Piecewise, status: Status) -> CameraLine:
    ctrl = np.concatenate([curve.ctrl, restrict(hfov, curve.breaks).ctrl], axis=2)
    error, worst = 0.0, curve.start
    if len(samples.s):
        at = curve(samples.s)
        miss = np.hypot(_across(samples.pitch) * (at[:, 0] - samples.yaw), at[:, 1] - samples.pitch)
        error, worst = float(miss.max()), float(samples.s[int(miss.argmax())])
    return CameraLine(Piecewise(curve.breaks, ctrl), status, error, worst, samples.cuts, samples.unsolved)


def _off_plan(curve: Piecewise, samples: _Samples) -> float:
    """Return the largest error of a fit against the planned yaw where nothing is framed, rad."""
    loose = _untracked(samples.s, curve.breaks)
    where, yaw = samples.planned_at(loose)
    at = curve(loose)
    return float(np.where(where, np.abs(at[:, 0] - yaw) * _across(at[:, 1]), 0.0).max(initial=0.0))


def _across(pitch: Array) -> Array:
    """Return the factor from an error in yaw to an error on the sphere: cos(pitch), bounded away from
    zero.
    """
    return np.asarray(np.maximum(np.cos(pitch), 0.03))


def framing_spans(keyed: KeyedPath) -> tuple[FramingSpan, ...]:
    """Return the intervals with one target each; a change of target is split in its middle."""
    spans: list[FramingSpan] = []
    run: list[int] = []
    last = len(keyed.keyframes) - 1
    for i in range(last):
        a, b = keyed.keyframes[i], keyed.keyframes[i + 1]
        if keyed.s[i + 1] <= keyed.s[i]:
            continue
        same = a.target is not None and a.target == b.target
        composed = a.reference is not None and b.reference is not None
        if same and composed:
            run.append(i)
            continue
        spans += _composed(keyed, run)
        run = []
        spans += _watched(keyed, i)
    return (*spans, *_composed(keyed, run))


def _composed(keyed: KeyedPath, run: list[int]) -> list[FramingSpan]:
    if not run:
        return []
    ends = [(keyed.keyframes[i], keyed.keyframes[i + 1]) for i in run]
    breaks = np.array([keyed.s[i] for i in run] + [keyed.s[run[-1] + 1]])
    ctrl = np.array([[a.reference] * 3 + [b.reference] * 3 for a, b in ends], dtype=np.float64)
    target = ends[0][0].target
    assert target is not None
    return [FramingSpan(target, float(breaks[0]), float(breaks[-1]), Piecewise(breaks, ctrl))]


def _watched(keyed: KeyedPath, i: int) -> list[FramingSpan]:
    a, b = keyed.keyframes[i].target, keyed.keyframes[i + 1].target
    start, end = float(keyed.s[i]), float(keyed.s[i + 1])
    middle = 0.5 * (start + end)
    if a is not None and a == b:
        return [FramingSpan(a, start, end, None)]
    first = [FramingSpan(a, start, middle, None)] if a is not None else []
    second = [FramingSpan(b, middle, end, None)] if b is not None else []
    return first + second


def _grid(keyed: KeyedPath) -> Array:
    """Return breaks that contain those of the position and the keyframes, with several pieces per
    interval.
    """
    merged = [float(b) for b in keyed.position.breaks]
    near = NEAR_SHARE * float(np.diff(merged).min())
    for s in keyed.s:
        if min(abs(s - b) for b in merged) > near:
            merged.append(float(s))
    breaks = np.array(sorted(merged))
    keys = np.unique(keyed.s)
    inside = np.histogram(0.5 * (breaks[:-1] + breaks[1:]), keys)[0] if len(keys) > 1 else np.array([1])
    parts = int(np.ceil(PIECES_PER_STRETCH / max(1, int(inside[inside > 0].min()))))
    return subdivide(breaks, parts) if parts > 1 else breaks


def _fitted(drone: Drone, samples: _Samples, breaks: Array, turn: Piecewise) -> tuple[Status, Piecewise]:
    """Return yaw and pitch fitted to the samples, and to the monotone turn where there are none."""
    spacing = float(breaks[-1] - breaks[0]) / max(len(turn.breaks) - 1, 1)
    density = (breaks[-1] - breaks[0]) / (len(breaks) - 1) / SAMPLES_PER_PIECE / spacing
    stiff = (1e-3 * STIFF_WEIGHT * spacing, STIFF_WEIGHT * spacing**5)
    loose = _untracked(samples.s, breaks)
    at = np.concatenate([samples.s, loose])
    yaw, pitch = (np.concatenate(p) for p in zip((samples.yaw, samples.pitch), turn(loose).T, strict=True))
    tracked = np.arange(len(at)) < len(samples.s)
    weight = density * np.where(tracked, 1.0, FAINT_WEIGHT)
    where, planned = samples.planned_at(at)
    where &= ~tracked
    yaw, heavy = np.where(where, planned, yaw), np.where(where, density, weight)
    low, high = drone.gimbal.pitch
    shape = (len(breaks) - 1, 6)
    bounds = np.full(shape, low), np.full(shape, high)
    ends = samples.anchor_s, np.clip(samples.anchor_pitch, low, high)
    yaw_fit = Fit(breaks, at, yaw, heavy * _across(pitch) ** 2, samples.anchor_s, samples.anchor_yaw, stiff)
    yaw_status, yaw_coef = fit(yaw_fit)
    pitch_status, pitch_coef = fit(Fit(breaks, at, pitch, weight, *ends, stiff, *bounds))
    curve = spline(breaks, np.column_stack([yaw_coef, pitch_coef]))
    ctrl = curve.ctrl.copy()
    ctrl[:, :, 1] = within(ctrl[:, :, 1], low, high)
    return yaw_status if yaw_status is not Status.SOLVED else pitch_status, Piecewise(breaks, ctrl)


def _untracked(tracked: Array, breaks: Array) -> Array:
    """Return sample parameters on the pieces without samples."""
    silent = np.histogram(tracked, breaks)[0] == 0
    every = subdivide(breaks, SAMPLES_PER_PIECE)[:-1].reshape(-1, SAMPLES_PER_PIECE)
    half = 0.5 * np.diff(breaks)[:, None] / SAMPLES_PER_PIECE
    return np.asarray((every + half)[silent].ravel())


def _sample(mission: MissionIR, drone: Drone, keyed: KeyedPath, breaks: Array, hfov: Piecewise) -> _Samples:
    """Return the reference angles on framed intervals and the fixed ones, with the yaw unwrapped."""
    samples: list[_KnownAngles] = []
    anchors: list[_KnownAngles] = []
    cuts: list[UnreachableAngles] = []
    last_yaw, group = keyed.keyframes[0].yaw, 0
    for i, keyframe in enumerate(keyed.keyframes):
        free = i > 0 and keyed.s[i] > keyed.s[i - 1] and (keyframe.placed or keyed.keyframes[i - 1].placed)
        if i > 0 and keyed.s[i] > keyed.s[i - 1]:
            at = _inner(breaks, float(keyed.s[i - 1]), float(keyed.s[i]))
            aims, cut = _aims(mission, drone, keyed, i - 1, at, hfov)
            if cut is not None:
                cuts.append(cut)
            for s, aim in zip(at, aims, strict=True):
                if aim is not None:
                    last_yaw, free = _near(aim[0], last_yaw), False
                    samples.append(_KnownAngles(float(s), last_yaw, aim[1], group))
        group += free
        anchor = _anchor(mission, drone, keyed, i)
        if anchor is not None and not (anchors and keyed.s[i] <= anchors[-1].s):
            last_yaw = _near(anchor[0], last_yaw)
            anchors.append(_KnownAngles(float(keyed.s[i]), last_yaw, anchor[1], group, i))
    turns = UnwrappedTurn([0.0], (), 0)
    if group:
        turns = turned(_places(keyed, samples, anchors), turning(drone, keyed.pace, keyed.headings))
        samples, anchors = (
            [k._replace(yaw=k.yaw + turns.shifts[k.group]) for k in part] for part in (samples, anchors)
        )
    references, fixed = (np.array([k[:3] for k in part]).reshape(-1, 3) for part in (samples, anchors))
    columns = references[:, 0], references[:, 1], references[:, 2], fixed[:, 0], fixed[:, 1], fixed[:, 2]
    return _Samples(*columns, tuple(cuts), turns.planned, turns.unsolved)


def _places(keyed: KeyedPath, samples: list[_KnownAngles], anchors: list[_KnownAngles]) -> list[Known]:
    """Return the yaws that fix the turns: those of keyframes, and the first and last of each framed
    interval.
    """
    ends: dict[int, list[_KnownAngles]] = {}
    for k in samples:
        ends[k.group] = [ends.get(k.group, [k])[0], k]
    at = {k.s: k for k in (*(k for pair in ends.values() for k in pair), *anchors)}
    places = []
    for k in sorted(at.values()):
        turn = keyed.keyframes[k.keyframe].turn if k.keyframe >= 0 else None
        places.append(Known(k.s, k.yaw, k.group, turn, k.keyframe >= 0 and _rests(keyed, k.keyframe)))
    return places


def _rests(keyed: KeyedPath, i: int) -> bool:
    """Return whether the camera stands still at a keyframe: it holds there, or turns on the spot."""
    near = [j for j in (i - 1, i + 1) if 0 <= j < len(keyed.s)]
    lengths = [
        np.linalg.norm(keyed.position(float(keyed.s[j])) - keyed.position(float(keyed.s[i]))) for j in near
    ]
    return keyed.keyframes[i].hold > 0 or any(length < SAME_PLACE_M for length in lengths)


def _inner(breaks: Array, start: float, end: float) -> Array:
    """Return sample parameters in an interval, evenly spaced on each of its pieces."""
    eps = 1e-9 * (breaks[-1] - breaks[0])
    inside = breaks[(breaks >= start - eps) & (breaks <= end + eps)]
    return subdivide(inside, SAMPLES_PER_PIECE)[1:-1] if len(inside) > 1 else np.empty(0)


def _anchor(mission: MissionIR, drone: Drone, keyed: KeyedPath, i: int) -> tuple[float, float] | None:
    keyframe = keyed.keyframes[i]
    if keyed.exact[i] or keyframe.target is None or keyframe.reference is None:
        return keyframe.yaw, keyframe.pitch
    if i not in {0, len(keyed.keyframes) - 1}:
        return None
    target = mission.target(keyframe.target)
    p = keyed.position(float(keyed.s[i]))
    d = (target.centre[0] - p[0], target.centre[1] - p[1], target.centre[2] - p[2])
    aim = aim_at(d, keyframe.reference, keyframe.hfov, drone.aspect, keyframe.yaw)
    low, high = drone.gimbal.pitch
    return (keyframe.yaw, keyframe.pitch) if aim is None else (aim[0], min(max(aim[1], low), high))


def _aims(
    mission: MissionIR, drone: Drone, keyed: KeyedPath, i: int, at: Array, hfov: Piecewise
) -> tuple[list[tuple[float, float] | None], UnreachableAngles | None]:
    a, b = keyed.keyframes[i], keyed.keyframes[i + 1]
    if a.target is None or b.target is None or a.reference is None or b.reference is None:
        return [None] * len(at), None
    x = minimum_jerk((at - keyed.s[i]) / (keyed.s[i + 1] - keyed.s[i]))[:, None]
    uv = (1 - x) * np.array(a.reference) + x * np.array(b.reference)
    ends = np.array([mission.target(a.target).centre, mission.target(b.target).centre])
    offset = (1 - x) * ends[0] + x * ends[1] - keyed.position(at)
    wide = hfov(at)[:, 0]
    low, high = drone.gimbal.pitch
    aims: list[tuple[float, float] | None] = []
    worst: UnreachableAngles | None = None
    for k, s in enumerate(at):
        d, ref = offset[k], uv[k]
        aim = aim_at(
            (float(d[0]), float(d[1]), float(d[2])),
            (float(ref[0]), float(ref[1])),
            float(wide[k]),
            drone.aspect,
            a.yaw,
        )
        excess = None if aim is None else max(low - aim[1], aim[1] - high)
        if excess is None or excess > NOTICE_RAD:
            worst = _worse(worst, UnreachableAngles(i, float(s), excess))
        aims.append(None if aim is None else (aim[0], min(max(aim[1], low), high)))
    return aims, worst


def _worse(old: UnreachableAngles | None, new: UnreachableAngles) -> UnreachableAngles:
    if old is None or new.excess is None:
        return new
    return new if old.excess is not None and new.excess > old.excess else old


def _near(angle: float, to: float) -> float:
    return to + wrapped(angle - to)

"""What the camera sees in every shot: samples at the output rate, closed between them where they can be."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.framing import Frames, margin_rate
from shotc.geom.pieces import Pieces, cut
from shotc.geom.proof import norm, sup_convex, sup_norm
from shotc.ir.mission import Promise, Shot
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.sampling import clock, framed, references, seen, subjects
from shotc.ir.trajectory import Claim, Method, Phase
from shotc.passes.verify_claims import Flight, Limit, Worst, claim

HALVINGS = 10
"""How often the time between two samples is halved to close it."""


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """The samples of one target in one shot, as far as the shot frames it.

    times : ticks of the output clock and both ends, shape (M,); error : distance to the reference on
    screen, infinite behind the camera, NaN where nothing is wanted
    """

    shot: Shot
    target: str
    times: Array
    frames: Frames
    error: Array


def framing(flight: Flight) -> Iterator[Claim]:
    """Claim what every shot promises of its targets; without a promise the same claims are soft."""
    for phase in flight.track.phases:
        if phase.shot is None:
            continue
        shot = next(s for s in flight.mission.shots if s.id == phase.shot)
        views = [v for v in (_view(flight, shot, t, phase) for t in _targets(flight, shot)) if v is not None]
        yield from _unframed(flight, shot, views)
        for view in views:
            yield _in_frame(flight, view)
            yield from _screen_error(flight, view)
            yield from _size(flight, view)
            yield _visible(flight, view)


def _targets(flight: Flight, shot: Shot) -> tuple[str, ...]:
    return subjects(flight.mission, flight.track, shot.id)


def _view(flight: Flight, shot: Shot, target: str, phase: Phase) -> View | None:
    ticks = clock(flight.mission.rate, phase.end)
    spans = [f for f in flight.track.framing if f.shot == shot.id and f.target == target]
    ends = [t for f in spans for t in (f.start, f.end)]
    times = np.unique(np.concatenate([ticks, np.array(ends)]))
    times = times[(times >= phase.start) & (times <= phase.end)]
    times = times[framed(flight.track, shot.id, target, times)]
    if not len(times):
        return None
    frames = seen(flight.mission, flight.track, target, times)
    wanted = references(flight.track, shot.id, target, times)
    error = np.hypot(frames.u - wanted[:, 0], frames.v - wanted[:, 1])
    error = np.where(np.isnan(frames.u) & ~np.isnan(wanted[:, 0]), inf, error)
    return View(shot, target, times, frames, error)


def _unframed(flight: Flight, shot: Shot, views: list[View]) -> Iterator[Claim]:
    """Claim that what the keyframes frame is framed in flight, too."""
    wanted = {k.target for k in shot.keyframes if k.target is not None}
    missing = wanted - {view.target for view in views}
    if wanted:
        promised = shot.promise != Promise()
        limit = Limit("targets not framed", 0.0, "of them", shot.path, hard=promised, shot=shot.id)
        yield claim(flight, limit, Worst(float(len(missing)), None, "exact"))


def _in_frame(flight: Flight, view: View) -> Claim:
    asked = view.shot.promise.in_frame
    share = float(view.frames.in_frame.mean())
    k = int(np.argmin(view.frames.margin))
    path = (*view.shot.path, "require", "in_frame") if asked is not None else view.shot.path
    limit = Limit(
        f"{view.target} in frame",
        1.0 if asked is None else asked,
        "of samples",
        path,
        upper=False,
        hard=asked is not None,
        shot=view.shot.id,
    )
    method: Method = "bounded" if share == 1.0 and _closes(flight, view) else "sampled"
    return claim(flight, limit, Worst(share, float(view.times[k]), method))


def _closes(flight: Flight, view: View) -> bool:
    """Prove that the target stays whole in the frame between samples, too.

    With L the fastest rate of a margin, it stays above the mean of two neighbours less L dt / 2.
    """
    fastest = _fastest_margin(flight, view)
    times, margins = view.times, view.frames.margin
    spans = np.diff(times) < 2.5 / flight.mission.rate
    low, high, a, b = times[:-1][spans], times[1:][spans], margins[:-1][spans], margins[1:][spans]
    for _ in range(HALVINGS):
        is_open = a + b < fastest * (high - low)
        if not is_open.any():
            return True
        low, high, a, b = low[is_open], high[is_open], a[is_open], b[is_open]
        middle = 0.5 * (low + high)
        m = seen(flight.mission, flight.track, view.target, middle).margin
        if (m < 0).any():
            return False
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
        a, b = np.concatenate([a, m]), np.concatenate([m, b])
    return False


def _fastest_margin(flight: Flight, view: View) -> float:
    pieces = cut(flight.track.curve, float(view.times[0]), float(view.times[-1]))
    if not len(pieces):
        return 0.0
    target = flight.mission.target(view.target)
    centre = np.array(target.centre)
    far = sup_convex(pieces.channels(0, 1, 2), lambda c: norm(c - centre), _roughly).proven
    rate = pieces.derivative()
    turn = _sup(rate, CAM_YAW) + _sup(rate, CAM_PITCH)
    speed = sup_norm(rate.channels(0, 1, 2), _roughly).proven
    reach = far + target.height / 2 + target.radius
    return margin_rate(reach, speed, turn, _sup(rate, HFOV), flight.drone.aspect)


def _sup(rate: Pieces, channel: int) -> float:
    return sup_norm(rate.channels(channel), _roughly).proven


def _roughly(best: float) -> float:
    return max(1e-3, 0.05 * abs(best))


def _screen_error(flight: Flight, view: View) -> Iterator[Claim]:
    asked = view.shot.promise.screen_error
    known = ~np.isnan(view.error)
    if not known.any():
        return
    error = np.where(known, view.error, -inf)
    k = int(np.argmax(error))
    yield _sampled(flight, view, ("screen error", "screen_error", asked), (float(error[k]), k))


def _size(flight: Flight, view: View) -> Iterator[Claim]:
    asked = view.shot.promise.size
    size = view.frames.size
    for name, pick, unseen in (("smallest", np.argmin, -inf), ("largest", np.argmax, inf)):
        known = np.where(np.isnan(size), unseen, size)
        k = int(pick(known))
        bound = None if asked is None else asked[name == "largest"]
        yield _sampled(flight, view, (f"size {name}", "size", bound), (float(known[k]), k))


def _sampled(
    flight: Flight, view: View, what: tuple[str, str, float | None], worst: tuple[float, int]
) -> Claim:
    name, key, asked = what
    upper = name != "size smallest"
    limit = Limit(
        f"{view.target} {name}",
        (inf if upper else -inf) if asked is None else asked,
        "of the frame" if key == "size" else "of half a frame",
        view.shot.path if asked is None else (*view.shot.path, "require", key),
        upper=upper,
        hard=asked is not None,
        shot=view.shot.id,
    )
    return claim(flight, limit, Worst(worst[0], float(view.times[worst[1]]), "sampled"))


def _visible(flight: Flight, view: View) -> Claim:
    hidden = view.frames.hidden
    limit = Limit(
        f"{view.target} visible",
        1.0,
        "of samples",
        view.shot.path,
        upper=False,
        hard=False,
        shot=view.shot.id,
    )
    k = int(np.argmax(hidden))
    return claim(flight, limit, Worst(float(1.0 - hidden.mean()), float(view.times[k]), "sampled"))

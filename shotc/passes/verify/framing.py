"""What the camera sees in every shot: samples at the output rate, with the gaps closed where possible."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf
from typing import NamedTuple

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.framing import Frames
from shotc.geom.pieces import Mask
from shotc.ir.coverage import coverage
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import Shot
from shotc.ir.phases import Phase
from shotc.ir.sampling import clock, projected, references, share_of_frames, subjects
from shotc.ir.trajectory import Claim, Method, TrajectoryIR
from shotc.passes.verify.claims import JudgedFlight, Limit, WorstValue, claim, flown_shots
from shotc.passes.verify.close import errors_close, margins_close
from shotc.passes.verify.pictured import asked
from shotc.passes.verify.reference import reference_framing
from shotc.passes.verify.visible import visible
from shotc.planning.framing.moments import placed_at


@dataclass(frozen=True, slots=True, eq=False)
class FramingSamples:
    """The samples of one target in one shot, at the times at which the mission has it framed.

    times : ticks of the output clock and the ends of what is framed, shape (M,)
    counted : those of them that shares count: ticks and the ends of the shot, shape (M,)
    error : distance to the reference on screen; infinite behind the camera, NaN without a reference
    covered : share of the outline that something covers, shape (M,)
    """

    shot: Shot
    target: str
    times: Array
    counted: Mask
    frames: Frames
    error: Array
    covered: Array


@dataclass(frozen=True, slots=True, eq=False)
class Filmed:
    """A flown shot, and the samples of each target that it frames."""

    placed: PlacedShot
    phase: Phase
    views: tuple[FramingSamples, ...]


def filmed(flight: JudgedFlight, ir: TrajectoryIR) -> Iterator[Filmed]:
    """Yield the shots that a drone films, with the samples of all their targets."""
    for placed, phase in flown_shots(flight, ir):
        every = subjects(flight.mission, flight.track, placed.shot.id)
        views = (view_of(flight, placed, target, phase) for target in every)
        yield Filmed(placed, phase, tuple(view for view in views if view is not None))


def framing(flight: JudgedFlight, shot: Filmed) -> Iterator[Claim]:
    """Yield claims on what a shot promises of its targets; without a promise they are soft."""
    yield from reference_framing(flight, placed_at(flight.mission, shot.placed, shot.phase.start), shot.phase)
    for view in shot.views:
        yield _in_frame(flight, view)
        yield from _screen_error(flight, view)
        yield from _size(flight, view)
        yield from visible(flight, view.shot, view.target, view.times, (view.covered, view.counted))


def view_of(flight: JudgedFlight, placed: PlacedShot, target: str, phase: Phase) -> FramingSamples | None:
    """Return the samples of a target in a shot's phase; None where the mission never asks for it there."""
    shot = placed.shot
    ticks = clock(flight.mission.rate, phase.end)
    spans = [f for f in flight.track.framing if f.shot == shot.id and f.target == target]
    ends = [t for f in spans for t in (f.start, f.end)]
    times = np.unique(np.concatenate([ticks, np.array(ends)]))
    times = times[(times >= phase.start) & (times <= phase.end)]
    times = times[asked(flight, placed, phase, target, times)]
    if not len(times):
        return None
    frames = projected(flight.mission, flight.track, target, times)
    reference = references(flight.track, shot.id, target, times)
    error = np.hypot(frames.u - reference[:, 0], frames.v - reference[:, 1])
    error = np.where(np.isnan(frames.u) & ~np.isnan(reference[:, 0]), inf, error)
    eyes = flight.track.curve(times)[:, :3]
    covered = coverage(flight.mission, flight.others, target, eyes, times).share
    counted = np.isin(times, [*ticks, phase.start, phase.end])
    return FramingSamples(shot, target, times, counted, frames, error, covered)


def _in_frame(flight: JudgedFlight, view: FramingSamples) -> Claim:
    promised = view.shot.promise.in_frame
    share = share_of_frames(view.frames.in_frame, view.counted)
    k = int(np.argmin(view.frames.margin))
    path = (*view.shot.path, "require", "in_frame") if promised is not None else view.shot.path
    limit = Limit(
        f"{view.target} in frame",
        1.0 if promised is None else promised,
        "of samples",
        path,
        upper=False,
        hard=promised is not None,
        shot=view.shot.id,
    )
    method: Method = "sampled"
    if share == 1.0 and margins_close(flight, view.target, view.times):
        method = "bounded"
    return claim(flight, limit, WorstValue(share, float(view.times[k]), method))


def _screen_error(flight: JudgedFlight, view: FramingSamples) -> Iterator[Claim]:
    promised = view.shot.promise.screen_error
    known = ~np.isnan(view.error)
    if not known.any():
        return
    error = np.where(known, view.error, -inf)
    k = int(np.argmax(error))
    claim = _sampled(flight, view, _Promise("screen error", "screen_error", promised), (float(error[k]), k))
    if promised is not None and claim.holds:
        times = view.times[known]
        if errors_close(flight, view.shot.id, view.target, times, promised):
            claim = replace(claim, method="bounded")
    yield claim


def _size(flight: JudgedFlight, view: FramingSamples) -> Iterator[Claim]:
    promised = view.shot.promise.size
    size = view.frames.size
    for name, pick, unseen in (("smallest", np.argmin, -inf), ("largest", np.argmax, inf)):
        known = np.where(np.isnan(size), unseen, size)
        k = int(pick(known))
        bound = None if promised is None else promised[name == "largest"]
        yield _sampled(flight, view, _Promise(f"size {name}", "size", bound), (float(known[k]), k))


class _Promise(NamedTuple):
    """What is claimed, the key of ``require`` about it, and its value, None where the mission has none."""

    name: str
    key: str
    value: float | None


def _sampled(
    flight: JudgedFlight, view: FramingSamples, promise: _Promise, worst: tuple[float, int]
) -> Claim:
    """Return the claim of the worst value, given with the index of its sample."""
    name, key, promised = promise
    upper = name != "size smallest"
    limit = Limit(
        f"{view.target} {name}",
        (inf if upper else -inf) if promised is None else promised,
        "of the frame" if key == "size" else "of half a frame",
        view.shot.path if promised is None else (*view.shot.path, "require", key),
        upper=upper,
        hard=promised is not None,
        shot=view.shot.id,
    )
    return claim(flight, limit, WorstValue(worst[0], float(view.times[worst[1]]), "sampled"))

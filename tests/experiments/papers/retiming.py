"""What the bound on jerk costs: the flown profile against TOPP-RA, which knows none, on the same path."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import islice
from statistics import fmean, median

import numpy as np

from shotc import plugins
from shotc.ir.passes import PassContext
from shotc.ir.path import MovingLeg, PathIR
from shotc.passes.refine_path import RefinePath, Seat
from shotc.pipeline import run
from shotc.planning.timing.grid import lay_grid, rough_profile, sample, split_cells
from shotc.planning.timing.limits import Ceiling, ceiling_of
from shotc.planning.timing.move import axes_of, time_move, topp_limits
from shotc.solvers.conic import Status
from shotc.solvers.topp import fastest
from tests.experiments.papers.missions import Draft, convex_path
from tests.experiments.papers.report import Section, Table

JERKS = (10.0, 20.0, 5.0)
MISSIONS = 12
FULL_SIZE = (300.0, 700.0)  # metres of path
HALVINGS = 2  # of the time pass's first grid, for TOPP-RA to be measured finely


def section(drafts: Sequence[Draft], say: Callable[[str], None]) -> Section:
    """Time the shots of the first full-size missions, on their convex and on their refined paths."""
    rows = []
    paths = list(islice(_full_size(drafts), MISSIONS))
    if not paths:
        return Section("Retiming", (), ("none of the missions is of full size",))
    for refiner in ("none", "ours"):
        say(f"retiming: paths of {refiner}")
        refined = [out for path in paths if (out := _refined(refiner, path)) is not None]
        rows += [_row(refiner, refined, jerk, say) for jerk in JERKS]
    table = Table(
        "Duration of the flown profile against TOPP-RA",
        (
            "paths of",
            "jerk limit",
            "paths",
            "length, m",
            "TOPP-RA, s",
            "slower, mean",
            "95th percentile",
            "worst",
            "final scaling, worst",
            "seconds, median",
        ),
        tuple(rows),
        (
            "full limits of the x500 (8 m/s, 3 m/s^2, body and gimbal rates and accelerations, as norms); "
            "no pace; rest to rest",
            f"the first {len(paths)} missions with {FULL_SIZE[0]:g} to {FULL_SIZE[1]:g} m of film",
            "TOPP-RA on the same path and limits without a jerk limit, on the first grid of the time pass "
            f"with every cell cut into {2**HALVINGS}; the flown profile also eases the camera's turns",
            "final scaling: the last slowdown that makes every limit hold between gridpoints",
        ),
    )
    return Section("Retiming", (table,))


def _full_size(drafts: Sequence[Draft]) -> Iterator[PathIR]:
    """Give the convex paths whose shot has the length of a real one."""
    for draft in drafts:
        path = convex_path(draft)
        if path is not None and FULL_SIZE[0] <= _length(_filmed(path)) <= FULL_SIZE[1]:
            yield path


def _filmed(path: PathIR) -> MovingLeg:
    (leg,) = (leg for leg in path.drones[0].legs if leg.shot is not None)
    return leg


def _length(leg: MovingLeg) -> float:
    return leg.curve.end - leg.curve.start


def topp_time(leg: MovingLeg, ceiling: Ceiling) -> float:
    """Return TOPP-RA's seconds for a shot that rests at its ends only."""
    span = (leg.curve.start, leg.curve.end)
    limits = axes_of(leg.curve, span, ceiling)
    grid = lay_grid(leg.curve, *rough_profile(leg.curve, *span, limits), np.empty(0))
    for _ in range(HALVINGS):
        grid = split_cells(grid, np.ones(len(grid) - 1, dtype=np.bool_))
    found = fastest(topp_limits(sample(leg.curve, grid), limits))
    if found.status is not Status.SOLVED:
        raise RuntimeError("TOPP-RA gives no profile")
    return found.time


def _refined(name: str, path: PathIR) -> PathIR | None:
    found = plugins.one("refiners", name)
    assert found.plugin is not None
    seat = Seat(found.plugin, found.package, found.reference)
    done = run((RefinePath(seat),), path, PassContext())
    return done.value if isinstance(done.value, PathIR) else None


def _row(refiner: str, paths: Sequence[PathIR], jerk: float, say: Callable[[str], None]) -> tuple[str, ...]:
    losses, lengths, fast, scales, seconds = [], [], [], [], []
    for path in paths:
        leg = _filmed(path)
        ceiling = replace(ceiling_of(path.keyframes.mission.drones[0]), jerk=jerk)
        quickest = topp_time(leg, ceiling)
        began = time.perf_counter()
        move = time_move(leg.curve, (leg.curve.start, leg.curve.end), ceiling)
        seconds.append(time.perf_counter() - began)
        losses.append(100 * (move.duration / quickest - 1))
        lengths.append(_length(leg))
        fast.append(quickest)
        scales.append(move.scale)
    say(f"retiming: {refiner}, {jerk:g} m/s^3, {fmean(losses):.2f} % slower")
    return (
        refiner,
        f"{jerk:g} m/s^3",
        str(len(losses)),
        f"{fmean(lengths):.0f}",
        f"{fmean(fast):.1f}",
        f"{fmean(losses):.2f} %",
        f"{float(np.quantile(losses, 0.95)):.2f} %",
        f"{max(losses):.2f} %",
        f"{max(scales):.4f}",
        f"{median(seconds):.2f}",
    )

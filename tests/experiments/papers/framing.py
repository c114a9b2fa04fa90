"""The framing paper's comparison: the same missions under every condition."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from statistics import fmean, median, stdev

import numpy as np

from shotc import plugins
from shotc.diag.registry import has_errors
from shotc.ir.passes import PassContext
from shotc.ir.path import MovingLeg, PathIR
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR
from shotc.passes.parameterize_time import ParameterizeTime
from shotc.passes.refine_path import RefinePath, Seat
from shotc.passes.verify import Verify
from shotc.pipeline import run
from tests.experiments.papers import plots
from tests.experiments.papers.missions import SEED, Draft, convex_path, keyframes_of
from tests.experiments.papers.report import Section, Table
from tests.experiments.papers.shown import Shown, shown

CONDITIONS = ("none", "ang", "look-at", "ours-4pt", "ours")
FILMED = "film"
"""The shot that is measured."""
KEPT_CONVEX = "R003"
PAPER_TIMES = (
    ("paper: its method", "14.16 s", "6.63 s"),
    ("paper: the method it compares with, which interpolates angles", "5.87 s", "2.88 s"),
)


@dataclass(frozen=True, eq=False)
class Solve:
    """One shot refined again, with its programmes built.

    solver : seconds inside the solver, all rounds; all : seconds with everything around it
    """

    solver: float
    all: float
    rounds: int
    stages: int
    by: str


@dataclass(frozen=True, eq=False)
class Result:
    """One mission under one condition.

    shown : None where it was not solved, and then ``faults`` are the codes that say why
    """

    mission: str
    condition: str
    shown: Shown | None
    solve: Solve | None
    faults: tuple[str, ...]


def compare(
    drafts: Sequence[Draft], conditions: Sequence[str], say: Callable[[str], None]
) -> dict[str, list[Result]]:
    """Return the results of every condition, a result a mission."""
    results: dict[str, list[Result]] = {name: [] for name in conditions}
    for number, draft in enumerate(drafts, 1):
        say(f"framing: mission {number} of {len(drafts)}")
        path = convex_path(draft)
        for name in conditions:
            missing = Result(draft.name, name, None, None, ("no convex path",))
            results[name].append(missing if path is None else one(draft.name, name, path))
    return results


def one(mission: str, condition: str, path: PathIR) -> Result:
    """Refine, time, verify and measure one mission under one condition."""
    flown = fly(condition, path)
    if isinstance(flown, tuple):
        return Result(mission, condition, None, None, flown)
    refiner = plugins.one("refiners", condition).plugin
    return Result(mission, condition, flown.shown, _solved_again(refiner, path), ())


@dataclass(frozen=True, eq=False)
class Flown:
    """One mission refined, timed and verified, and what its film shows; leg : its path, which was timed."""

    plan: VerifiedIR
    leg: MovingLeg
    flight: DroneTrajectory
    shown: Shown


def fly(condition: str, path: PathIR) -> Flown | tuple[str, ...]:
    """Refine, time and verify one mission under one condition; codes of faults where that fails."""
    found = plugins.one("refiners", condition)
    assert found.plugin is not None
    seat = Seat(found.plugin, found.package, found.reference)
    done = run((RefinePath(seat), ParameterizeTime(), Verify()), path, PassContext())
    faults = tuple(d.code for d in done.diagnostics if has_errors([d]) or d.code == KEPT_CONVEX)
    if not isinstance(done.value, VerifiedIR) or faults:
        return faults
    refined, trajectory = done.reports[0].output, done.value.trajectory
    paths = (*refined.drones, *refined.timed)
    (leg,) = (leg for path in paths for leg in path.legs if isinstance(leg, MovingLeg) and leg.shot == FILMED)
    (placed,) = (placed for placed in trajectory.keyframes.shots if placed.shot.id == FILMED)
    (flight,) = (flight for flight in trajectory.drones if flight.drone == placed.shot.drone)
    seen = shown(trajectory.keyframes.mission, placed.keyframes, leg, flight)
    return Flown(done.value, leg, flight, seen)


def _solved_again(refiner: object, path: PathIR) -> Solve | None:
    condition = getattr(refiner, "condition", None)
    if condition is None:
        return None
    from shotc_casadi.refiner import subjects
    from shotc_casadi.rounds import refine_shot

    if len(path.drones) + len(path.timed) > 1:  # in company a shot is solved beside the others, not alone
        return None
    (subject,) = subjects(path)
    began = time.perf_counter()
    refined = refine_shot(subject, condition)
    seconds = time.perf_counter() - began
    solution = refined.solution
    return Solve(refined.seconds, seconds, refined.rounds, len(solution.inputs), solution.solver)


def section(drafts: Sequence[Draft], conditions: Sequence[str], say: Callable[[str], None]) -> Section:
    """Run the comparison and return its tables."""
    results = compare(drafts, conditions, say)
    return Section(
        "Framing", (quality(results), solve_times(results)), (*described(drafts), *_unsolved(results))
    )


def described(drafts: Sequence[Draft]) -> tuple[str, ...]:
    """Return what the missions are, in numbers."""
    placed = [keyframes_of(draft) for draft in drafts]
    moved, meant = [], []
    for draft, ir in zip(drafts, placed, strict=True):
        assert ir is not None
        for keyframe, intended in zip(ir.shots[0].keyframes, draft.intended, strict=True):
            assert keyframe.asked is not None
            assert keyframe.reference is not None
            moved.append(float(np.hypot(*np.subtract(keyframe.reference, keyframe.asked))))
            meant.append(float(np.hypot(*np.subtract(keyframe.reference, intended))) < 1e-6)
    several = sum(draft.targets > 1 for draft in drafts)
    return (
        f"{len(drafts)} missions, seed {SEED}, {len(moved)} keyframes, {several} missions with several "
        f"targets; {sum(d.rejected for d in drafts)} drafts were drawn again because check refused them",
        f"composition gives {_share(fmean(meant))} of the keyframes the place that was meant, and moves the "
        f"target by {fmean(moved):.3f} half frames on average",
    )


def quality(results: dict[str, list[Result]]) -> Table:
    """Return what the conditions show."""
    rows = []
    for name, found in results.items():
        seen = [r.shown for r in found if r.shown is not None]
        cells: tuple[str, ...] = ("-",) * 7
        if seen:
            means = [float(s.error.mean()) for s in seen]
            frames = np.concatenate([s.margin for s in seen])
            points = np.concatenate([s.points for s in seen])
            cells = (
                f"{fmean(means):.4f}",
                f"{fmean(s.p95 for s in seen):.4f}",
                _share(float((frames >= 0).mean())),
                _share(float((points >= 0).mean())),
                f"{max(0.0, -float(frames.min())):.4f}",
                f"{fmean(s.jerk for s in seen):.2f}",
                f"{fmean(s.duration for s in seen):.1f}",
            )
        rows.append((name, *cells, _share(len(seen) / len(found))))
    return Table(
        "What each condition shows",
        (
            "condition",
            "screen error, mean",
            "95th percentile",
            "whole target in frame",
            "four points in frame",
            "worst crop",
            "jerk RMS, m/s^3",
            "duration, s",
            "solved",
        ),
        tuple(rows),
        (
            "error: distance on screen from the composed place, half frames; means over missions of each "
            "mission's mean and 95th percentile",
            "whole target: by the exact silhouette, share of all frames; four points: those of the paper's "
            "Eq. 4-7; no tolerance in either",
            "worst crop: how far the target sticks out of the frame at worst, as a share of its distance",
            "solved: refined, timed and verified, every limit of the drone held at all times",
            "the paper gives no such figures: it judged its films by a study with viewers",
        ),
        plots.errors({n: [r.shown.error for r in f if r.shown is not None] for n, f in results.items()}),
    )


def solve_times(results: dict[str, list[Result]]) -> Table:
    """Return the times of the refiners beside the paper's."""
    rows, histogram = [], {}
    for name, found in results.items():
        solves = [r.solve for r in found if r.solve is not None]
        if not solves:
            continue
        inside = [s.solver for s in solves]
        histogram[name] = inside
        again = sum(s.by != "fatrop" for s in solves)
        rows.append(
            (
                name,
                f"{median(inside):.3f} s",
                f"{fmean(inside):.3f} s",
                f"{stdev(inside) if len(inside) > 1 else 0.0:.3f} s",
                f"{max(inside):.3f} s",
                f"{median(s.all for s in solves):.3f} s",
                f"{fmean(s.rounds for s in solves):.2f} (at most {max(s.rounds for s in solves)})",
                f"{min(s.stages for s in solves)}-{max(s.stages for s in solves)}",
                str(again),
            )
        )
    rows += [(name, "-", mean, sd, "-", "-", "-", "100", "-") for name, mean, sd in PAPER_TIMES]
    return Table(
        "Solve time of one mission, solver warm",
        (
            "condition",
            "median",
            "mean",
            "SD",
            "worst",
            "with all around it, median",
            "rounds, mean",
            "stages",
            "by IPOPT",
        ),
        tuple(rows),
        (
            "median, mean, SD and worst are of the seconds inside the solver, all rounds together; around it "
            "are the set-up of the problem, the spline and its proof",
            "the paper's: FORCES Pro, N = 100, Intel Core i7 at 4 GHz, 60 missions of its own users; another "
            "machine, other missions, other solver: an order of magnitude, not a race",
        ),
        plots.times(histogram) if histogram else None,
    )


def _unsolved(results: dict[str, list[Result]]) -> tuple[str, ...]:
    return tuple(
        f"not solved: {r.mission} under {r.condition}, {', '.join(r.faults)}"
        for found in results.values()
        for r in found
        if r.shown is None
    )


def _share(value: float) -> str:
    return f"{100 * value:.2f} %"

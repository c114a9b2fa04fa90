"""What the papers fly, flown by `simulate`'s loop: films in wind, and targets that keep to no plan.

Run it alone by `python -m tests.experiments.papers --only flown`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.rehearsal import Loop
from shotc.simulation.conditions import Conditions
from shotc.simulation.judge import cameras_of
from shotc.simulation.runs import flown
from shotc.simulation.wind import WindField
from tests.experiments.papers import framing, tracked, weaving
from tests.experiments.papers.missions import Draft, convex_path
from tests.experiments.papers.report import Section, Table
from tests.experiments.papers.shown import Pictures, percentile, pictures

WIND = WindField(3.0, None, 1.0)
RUNS = 3
LOOPS: tuple[Loop, ...] = ("replay", "track")


@dataclass(frozen=True, eq=False)
class Rehearsed:
    """One mission in one run; stray : the farthest that the drone was from its plan, m."""

    mission: str
    seen: Pictures
    stray: float
    roll: float


def section(drafts: Sequence[Draft], say: Callable[[str], None]) -> Section:
    """Run all of it."""
    tables = (in_wind(drafts, RUNS, say), *weaving.tables(say), tracked.table(say))
    return Section("Films as they are flown", tables)


def in_wind(drafts: Sequence[Draft], runs: int, say: Callable[[str], None]) -> Table:
    """Return what the framing missions show in wind, by what the camera goes by."""
    planned: list[Rehearsed] = []
    found: dict[Loop, list[Rehearsed]] = {loop: [] for loop in LOOPS}
    for number, draft in enumerate(drafts, 1):
        say(f"flown: mission {number} of {len(drafts)}")
        path = convex_path(draft)
        made = None if path is None else framing.fly("ours", path)
        if not isinstance(made, framing.Flown):
            continue
        seen = made.shown
        planned.append(Rehearsed(draft.name, Pictures(seen.error, seen.margin, seen.points), 0.0, 0.0))
        for loop in LOOPS:
            found[loop] += rehearse(draft.name, made, Conditions(loop=loop, wind=WIND), runs)
    return Table(
        "The framing missions in wind (framing, Sec. 4.4)",
        (
            "loop",
            "screen error, mean",
            "worst mission",
            "95th percentile",
            "largest",
            "whole target in frame",
            "worst mission",
            "worst crop",
            "farthest from the plan, m",
        ),
        (
            _row("as planned", planned),
            *(_row(f"flown, `{loop}`", each) for loop, each in found.items()),
        ),
        (
            f"{len(planned)} of {len(drafts)} missions that `ours` plans, {runs} runs each; wind of "
            f"{WIND.speed:g} m/s from a direction drawn for each run, gusts of {WIND.gusts:g} m/s (standard "
            "deviation of each axis), RTK, the default vehicle and gimbal",
            "`replay` points the camera as planned; `track` from where the drone takes itself to be at where "
            "the target is to be on screen",
            "error and whole target as in the first table, by the same code: frames in which one target is "
            "handed over to the next count; to be reached were a mean of 0.02 and 99 %",
            f"the largest roll of a picture is {np.degrees(_roll(found)):.2f} deg; errors leave it out",
            "the paper flew such plans outdoors and gives no figure",
        ),
    )


def rehearse(name: str, made: framing.Flown, conditions: Conditions, runs: int) -> list[Rehearsed]:
    """Fly a planned mission some times and measure each run."""
    ir = made.plan.trajectory
    mission, (placed,) = ir.keyframes.mission, ir.keyframes.shots
    (plan,) = ir.drones
    _, (track,) = flown(ir, conditions, range(runs))
    off = np.linalg.norm(track.position - plan.curve(track.times)[:, None, :3], axis=2).max(axis=0)

    def states(run: int, times: Array) -> Array:
        at = cameras_of(mission, plan, track, run, times)
        return np.column_stack([at.position, at.yaw, at.pitch, at.yaw, at.hfov])

    return [
        Rehearsed(
            name,
            pictures(mission, placed.keyframes, made.leg, plan, partial(states, r)),
            float(off[r]),
            float(np.abs(track.roll[:, r]).max()),
        )
        for r in range(runs)
    ]


def _roll(found: dict[Loop, list[Rehearsed]]) -> float:
    return max((each.roll for runs in found.values() for each in runs), default=0.0)


def _row(name: str, runs: list[Rehearsed]) -> tuple[str, ...]:
    if not runs:
        return (name, *("-",) * 8)
    means = [float(each.seen.error.mean()) for each in runs]
    margins = [each.seen.margin for each in runs]
    every = np.concatenate(margins)
    return (
        name,
        f"{np.mean(means):.4f}",
        f"{max(means):.4f}",
        f"{np.mean([percentile(each.seen.error, 0.95) for each in runs]):.4f}",
        f"{max(float(each.seen.error.max()) for each in runs):.4f}",
        f"{100 * (every >= 0.0).mean():.2f} %",
        f"{100 * min((m >= 0.0).mean() for m in margins):.2f} %",
        f"{max(0.0, -float(every.min())):.4f}",
        f"{max(each.stray for each in runs):.2f}",
    )

"""Warnings of rehearsals: drones that fall behind their subjects, drones that receivers mislead, and
replanners that fail.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

from shotc import plugins
from shotc.diag.model import Diagnostic
from shotc.rounding import at_least, at_most, up
from shotc.simulation.blind import BLIND_S
from shotc.simulation.conditions import Conditions
from shotc.simulation.deviations import RECEIVER_SHARE, Lag, LargestDeviation, needed
from shotc.simulation.judge import Run
from shotc.simulation.rehearsal import Rehearsed
from shotc.simulation.sensors import Gps, Interval


def deviations(rehearsed: Rehearsed) -> Iterator[Diagnostic]:
    """Yield the warnings of a rehearsal."""
    yield from _left_behind(rehearsed)
    yield from _misled(rehearsed)
    yield from _unplaced(rehearsed)
    yield from _unplanned(rehearsed)


def _left_behind(rehearsed: Rehearsed) -> Iterator[Diagnostic]:
    """Yield one warning for each shot and subject that a drone falls behind."""
    every = [
        (lag, run)
        for run in rehearsed.runs
        for lag in run.lags
        if lag.left and not _by_receiver(rehearsed, run, lag)
    ]
    every.sort(key=lambda pair: _of(pair[0]))
    for _, group in groupby(every, key=lambda pair: _of(pair[0])):
        pairs = list(group)
        lag, run = max(pairs, key=lambda pair: pair[0].behind)
        yield Diagnostic(
            "W008",
            f"{lag.drone} falls up to {at_least(lag.behind)} m behind `{lag.target}` in shot `{lag.shot}`, "
            f"in {len(pairs)} of {len(rehearsed.runs)} runs",
            (rehearsed.mission.origins.value(rehearsed.mission.shot(lag.shot).path),),
            (
                f"in run {run.number} it is {at_least(lag.behind + lag.planned)} m from it "
                f"at {lag.time:.1f} s; {lag.planned:.2f} m are planned",
                *_causes(rehearsed, lag, run),
            ),
            _remedy(rehearsed, lag),
        )


def _by_receiver(rehearsed: Rehearsed, run: Run, lag: Lag) -> bool:
    """Return whether a lag is a stray that the other warning reports: the shot begins with it."""
    led = max((course.misled.metres for course in run.courses if course.drone == lag.drone), default=0.0)
    return not lag.outrun and led > max(needed(rehearsed.mission), RECEIVER_SHARE * lag.behind)


def _of(lag: Lag) -> tuple[str, str, str]:
    return lag.drone, lag.shot, lag.target


def _causes(rehearsed: Rehearsed, lag: Lag, run: Run) -> Iterator[str]:
    """Yield what is known about the reason of a lag."""
    own = f"{lag.drone} at most at {at_most(lag.most)} m/s"
    yield f"`{lag.target}` moves at up to {at_least(lag.speed)} m/s, {own}"
    for start, end in _lost_before(rehearsed.conditions, lag):
        yield f"there are no positions of `{lag.target}` from {start:g} to {end:g} s"
    for course in run.courses:
        counts = course.replans
        if course.drone == lag.drone and counts is not None:
            if counts.failed:
                yield f"{counts.failed} replans of {lag.drone} failed: {counts.reason}"
            if counts.lost:
                yield f"{counts.lost} replans of {lag.drone} were left out: {counts.blind}"


def _lost_before(conditions: Conditions, lag: Lag) -> tuple[Interval, ...]:
    return tuple(each for each in conditions.lost(lag.target) if each[0] <= lag.time)


def _remedy(rehearsed: Rehearsed, lag: Lag) -> str:
    track = f"give `{lag.target}` the track on which it really moves"
    if lag.outrun:
        limits = rehearsed.mission.drone(lag.drone).limits
        fast = up(limits.speed + rehearsed.mission.wind_taken + lag.speed - lag.most, 1)
        track = f"raise `limits.speed` of {lag.drone} over {fast:g} m/s if it can fly that, and {track}"
    elif _lost_before(rehearsed.conditions, lag):
        track = f"film where positions are not lost, or {track}"
    return f"{track}; with a larger `distance` and a longer lens, a lag costs less of the size on screen"


def _misled(rehearsed: Rehearsed) -> Iterator[Diagnostic]:
    """Yield one warning for each drone that its receiver leads off its plan by more than a clearance."""
    least = needed(rehearsed.mission)
    for i, first in enumerate(rehearsed.runs[0].courses):
        every = [(run.courses[i].misled, run) for run in rehearsed.runs]
        strays = [pair for pair in every if pair[0].metres > least]
        if not strays:
            continue
        led, run = max(strays, key=lambda pair: pair[0].metres)
        yield Diagnostic(
            "W009",
            f"its receiver leads {first.drone} up to {at_least(led.metres)} m off its plan, "
            f"in {len(strays)} of {len(rehearsed.runs)} runs; up to {least:g} m are covered by its "
            "clearances",
            (rehearsed.mission.origins.value(rehearsed.mission.drone(first.drone).path),),
            tuple(_circumstances(led, run, i)),
            f"fly with receivers that err less: {_receivers(rehearsed.conditions.gps)}; or plan with "
            f"clearances over {at_least(led.metres)} m (`rules`)",
        )


def _unplaced(rehearsed: Rehearsed) -> Iterator[Diagnostic]:
    """Yield one warning for each drone that has no positions of its own for a while."""
    for i, first in enumerate(rehearsed.runs[0].courses):
        lost = rehearsed.conditions.lost(first.drone)
        off, run = max((run.courses[i].unplaced.metres, run.number) for run in rehearsed.runs)
        if off == 0.0:
            continue
        worst = rehearsed.run(run).courses[i].unplaced
        spans = " and ".join(f"{start:g} to {end:g} s" for start, end in lost)
        yield Diagnostic(
            "W011",
            f"{first.drone} has no positions of its own from {spans}: it takes itself to be up to "
            f"{at_least(off)} m from where it is",
            (rehearsed.mission.origins.value(rehearsed.mission.drone(first.drone).path),),
            (
                f"worst in run {run}, at {worst.time:.1f} s",
                f"after {BLIND_S:g} s without positions it brakes and holds; then {_way_back(rehearsed, i)}",
            ),
            "read what your autopilot does without positions: some land where they are",
        )


def _way_back(rehearsed: Rehearsed, drone: int) -> str:
    """Return how a drone comes back to its plan after an outage, in words."""
    straight = [
        (way, run.number) for run in rehearsed.runs if (way := run.courses[drone].straight) is not None
    ]
    if not straight:
        return "it plans its way back to its plan, clear of what the plan keeps clear of"
    lack, run = max(straight)
    if lack.clear:
        return "it flies straight back to its plan, and the way keeps its clearances"
    off = sum(not way.clear for way, _ in straight)
    return (
        f"it flies straight back to its plan: in {off} of {len(rehearsed.runs)} runs the way lacks up to "
        f"{at_least(lack.metres)} m of its clearance from {lack.to}, most in run {run} at {lack.time:.1f} s; "
        "a drone that replans (`--loop replan`) flies round it"
    )


def _unplanned(rehearsed: Rehearsed) -> Iterator[Diagnostic]:
    """Yield one warning for each drone whose replanner gave no plan that can be flown."""
    name = rehearsed.conditions.replanner
    package = plugins.package_of("replanners", name)
    for i, first in enumerate(rehearsed.runs[0].courses):
        every = [(c, run) for run in rehearsed.runs if (c := run.courses[i].replans) is not None]
        failed = [(counts, run) for counts, run in every if counts.failed]
        if not failed:
            continue
        reasons = dict.fromkeys(counts.reason for counts, _ in failed)
        yield Diagnostic(
            "W010",
            f"the replanner `{name}` gives {first.drone} no plan in {sum(c.failed for c, _ in failed)} of "
            f"{sum(c.requested for c, _ in every)} replans",
            (rehearsed.mission.origins.value(rehearsed.mission.drone(first.drone).path),),
            (
                f"in {len(failed)} of {len(rehearsed.runs)} runs, the first of them run "
                f"{failed[0][1].number}",
                *reasons,
                f"{first.drone} flies its last plan to the end, brakes and holds until there is a new one",
            ),
            f"report it to the authors of {package}, or fly with another replanner (`--replanner`)",
        )


def _circumstances(led: LargestDeviation, run: Run, drone: int) -> Iterator[str]:
    yield f"worst in run {run.number}, at {led.time:.1f} s"
    near = run.courses[drone].nearest
    if near is not None:
        yield f"there its body comes within {at_least(near.distance)} m of {near.to}, at {near.time:.1f} s"


def _receivers(gps: Gps) -> str:
    if any(gps.offset):
        return "measure their constant error on the pad, and rehearse with what is left (`--bias`)"
    return "`gps: rtk` under `rehearse`"

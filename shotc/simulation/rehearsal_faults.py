"""Diagnostics of rehearsals: conditions that cannot be flown, and requirements that too few runs keep."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import dist, isfinite

from shotc.diag.model import Diagnostic, Label
from shotc.geom.track import Track
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.trajectory import TrajectoryIR
from shotc.rounding import at_least, at_most, down, up
from shotc.simulation.conditions import Conditions
from shotc.simulation.judge import Run
from shotc.simulation.rehearsal import Rehearsed
from shotc.simulation.verdict import RequirementVerdict
from shotc.spec.presets import TOP_SPEED_M_S

WORDS = {
    "in_frame": "the whole target is in {} of a shot's frames",
    "in_sight": "the target is in sight at {} of a shot's instants",
    "mean_error": "the target is on average {} of half a frame off its place in a shot",
    "clearance": "a drone's body comes within {}",
    "stray": "a drone strays {} from its plan",
}


def unflyable(ir: TrajectoryIR, conditions: Conditions) -> Iterator[Diagnostic]:
    """Yield the faults of conditions: too strong a wind, or an impossible true track."""
    mission, wind = ir.keyframes.mission, conditions.wind.speed
    end = max((track.curve.end for track in ir.drones), default=0.0)
    taken = mission.wind_taken
    carried = [(f"drone `{d.name}`", d.limits.speed + taken, d.path) for d in mission.drones]
    carried += [(f.words, f.limits.speed + mission.wind, f.path) for f in mission.fleets]
    for name, most, path in carried:
        if wind >= most:
            yield Diagnostic(
                "W003",
                f"a wind of {wind:g} m/s carries {name} away: it flies {most:g} m/s",
                (mission.origins.value(path),),
                help=f"rehearse with less than {most:g} m/s of wind, or, if it flies that, raise its "
                f"`limits.speed` over {at_least(wind)} m/s",
            )
    for name, track in conditions.truth.tracks:
        yield from _untrue(mission, name, track, end)


def not_kept(rehearsed: Rehearsed) -> Iterator[Diagnostic]:
    """Yield the requirements that too few runs keep."""
    if rehearsed.kept:
        return
    failing = [each for each in rehearsed.verdicts if each.held < rehearsed.needed]
    for each in failing:
        yield _touches(rehearsed, each) if not each.written else _broken(rehearsed, each)
    if not failing:
        mission, total = rehearsed.mission, len(rehearsed.runs)
        yield Diagnostic(
            "W001",
            f"{rehearsed.held} of {total} runs keep all that is required; {rehearsed.needed} have to",
            (mission.origins.value(_require(mission)),),
            tuple(f"`{each.key}` holds in {each.held}" for each in rehearsed.verdicts),
            "ask for less, or for a smaller share of the runs with `of`",
        )


def _broken(rehearsed: Rehearsed, each: RequirementVerdict) -> Diagnostic:
    total = len(rehearsed.runs)
    return Diagnostic(
        "W001",
        f"{_words(each, each.worst)} in run {each.run}; {_amount(each, each.limit)} is required "
        f"in {rehearsed.needed} of {total} runs, and {each.held} keep it",
        (rehearsed.mission.origins.value((*_require(rehearsed.mission), each.key)),),
        tuple(_where(rehearsed.run(each.run), each)),
        _help(rehearsed, each),
    )


def _touches(rehearsed: Rehearsed, each: RequirementVerdict) -> Diagnostic:
    return Diagnostic(
        "W002",
        f"a drone's body is {at_least(-each.worst)} m into something in run {each.run}",
        tuple(_touched(rehearsed, each)),
        tuple(_where(rehearsed.run(each.run), each)),
        f"plan with {at_least(-each.worst)} m more clearance (`rules`), or fly in less wind",
    )


def _where(run: Run, each: RequirementVerdict) -> Iterator[str]:
    if each.key in ("in_frame", "in_sight", "mean_error"):
        yield from (_picture(run, each),)
    elif each.key == "clearance":
        near = [(c.drone, n) for c in run.courses for n in c.near if n.distance == each.worst]
        yield from (f"drone `{drone}` and {n.to}, at {n.time:.1f} s" for drone, n in near)
        pairs = [(f, f.nearest) for f in run.fleets if f.clearance == each.worst]
        yield from (f"two drones of `{f.fleet}`, at {n.time:.1f} s" for f, n in pairs if n is not None)
    else:
        yield from (f"drone `{c.drone}`, at {c.time:.1f} s" for c in run.courses if c.farthest == each.worst)
        yield from (
            f"a drone of `{f.fleet}`, at {f.flown.time:.1f} s"
            for f in run.fleets
            if f.flown.farthest == each.worst
        )


def _picture(run: Run, each: RequirementVerdict) -> str:
    if each.key == "in_frame":
        worst = min(run.pictures, key=lambda p: p.in_frame)
    elif each.key == "in_sight":
        worst = min(run.pictures, key=lambda p: p.in_sight)
        return f"target `{worst.target}` in shot `{worst.shot}`"
    else:
        worst = max(run.pictures, key=lambda p: p.error or 0.0)
    return f"target `{worst.target}` in shot `{worst.shot}`, worst at {worst.time:.1f} s"


def _help(rehearsed: Rehearsed, each: RequirementVerdict) -> str:
    share = f"{rehearsed.needed} of {len(rehearsed.runs)} runs keep"
    if not isfinite(each.kept) or (each.unit == "share" and each.kept <= 0.0):
        return "plan for less wind, or with better receivers: in this many runs the camera looks away"
    better = ""
    if each.key in ("in_frame", "mean_error") and rehearsed.conditions.loop == "replay":
        better = "let the camera follow what it sees with `loop: track`, or "
    return f"{better}ask for what {share}: `{each.key}: {_proposed_bound(each)}`"


def _proposed_bound(each: RequirementVerdict) -> str:
    if each.unit == "share":
        return f"{max(0.0, down(100 * each.kept, 1)):g} %"
    return f"{up(each.kept, 3):g}" if each.upper else f"{max(0.0, down(each.kept)):g}"


def _words(each: RequirementVerdict, value: float) -> str:
    return WORDS[each.key].format(_amount(each, value))


def _amount(each: RequirementVerdict, value: float) -> str:
    if each.unit == "share":
        return f"{at_most(100 * value, 1)} %"
    if each.unit == "half frames":
        return at_least(value, 3) if isfinite(value) else "infinitely many times"
    return f"{at_least(value) if each.upper else at_most(value)} m"


def _touched(rehearsed: Rehearsed, each: RequirementVerdict) -> Iterator[Label]:
    run, mission = rehearsed.run(each.run), rehearsed.mission
    for course in run.courses:
        if course.nearest is not None and course.nearest.distance == each.worst:
            yield mission.origins.value(mission.drone(course.drone).path)
            return
    for fleet in run.fleets:
        if fleet.clearance == each.worst:
            yield mission.origins.value(mission.fleet(fleet.fleet).path)
            return


def _require(mission: MissionIR) -> KeyPath:
    return () if mission.rehearsal is None else (*mission.rehearsal.path, "require")


def _untrue(mission: MissionIR, name: str, track: Track, end: float) -> Iterator[Diagnostic]:
    label = mission.origins.value(mission.target(name).path)
    if track.times[-1] < end:
        yield Diagnostic(
            "W004",
            f"the true track of `{name}` ends at {track.times[-1]:g} s, and the plan lands at {end:.1f} s",
            (label,),
            help=f"give it rows until {at_least(end, 1)} s",
        )
    for i, (a, b) in enumerate(pairwise(track.points)):
        start, duration = track.times[i], track.times[i + 1] - track.times[i]
        if dist(a, b) > TOP_SPEED_M_S * duration:
            yield Diagnostic(
                "W004",
                f"the true track of `{name}` jumps {dist(a, b):.1f} m in {duration:.3g} s at {start:g} s",
                (label,),
                help=f"nothing that is filmed moves faster than {TOP_SPEED_M_S:g} m/s: correct these rows",
            )
            return

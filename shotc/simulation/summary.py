"""The result of a rehearsal in tables and sentences for people."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees, isfinite
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from shotc.geom.camera import heading_of
from shotc.ir.show import drone_names
from shotc.rounding import as_minutes, at_least, at_most, plain, up
from shotc.simulation.fleets.near import ClosestPair
from shotc.simulation.judge import Run, TargetFraming, TrackingError
from shotc.simulation.outages import Outage
from shotc.simulation.rehearsal import Rehearsed, alike
from shotc.simulation.shows import FleetCourse, FleetPair
from shotc.simulation.situations import replanned
from shotc.simulation.verdict import RequirementVerdict

if TYPE_CHECKING:
    from shotc.ir.show import Fleet
    from shotc.simulation.sensors import Gps

PICTURES = (
    "shot",
    "target",
    "whole in frame",
    "in the worst run",
    "in sight",
    "off on screen",
    "95 %",
    "worst",
)
COURSES = ("drone", "strays, RMS", "farthest", "run", "nearest", "to", "at", "run")
LOOPS = {
    "replay": "camera as planned",
    "track": "camera follows what it sees",
    "replan": "drone and camera follow what they see",
}
LARGEST_MARGIN_RATIO = 2.0
"""Largest useful margin over the separation; with a larger one a show has no pictures left."""
FLEETS = ("fleet", "drones", "strays, RMS", "99 %", "farthest", "nearest", "asked", "margin")


Rows = tuple[tuple[str, ...], ...]


class Summary(NamedTuple):
    """The result of a rehearsal.

    flown : number of runs, and the conditions
    tables : of framing, cameras and fleets, without empty ones; the first row of each is its head
    requirements : the mission's requirements, with the number of runs that keep them
    notes : further remarks
    """

    flown: str
    tables: tuple[Rows, ...]
    requirements: tuple[str, ...]
    notes: tuple[str, ...]


def summary(rehearsed: Rehearsed) -> Summary:
    """Return the summary of a rehearsal."""
    total = len(rehearsed.runs)
    tables = (tuple(rows) for rows in (_pictures(rehearsed), _courses(rehearsed), _fleets(rehearsed)))
    return Summary(
        f"{total} run{'s' if total > 1 else ''}, {_conditions(rehearsed)}",
        tuple(rows for rows in tables if len(rows) > 1),
        tuple(_requirement_lines(rehearsed, total)),
        tuple(_remarks(rehearsed)),
    )


def _requirement_lines(rehearsed: Rehearsed, total: int) -> Iterator[str]:
    for each in rehearsed.verdicts:
        requirement = f"{each.key} {_limit(each)}" if each.written else "touch nothing"
        yield f"{requirement}: {each.held} of {total} runs"
    if rehearsed.promise.of < 1.0 or len(rehearsed.verdicts) > 1:
        yield f"all of it in {rehearsed.needed} of {total} runs: {rehearsed.held} keep it"


def _conditions(rehearsed: Rehearsed) -> str:
    conditions = rehearsed.conditions
    wind, gps = conditions.wind, conditions.gps
    blows = f"wind {plain(wind.speed, 1)} m/s"
    if wind.speed and wind.toward is not None:
        blows += f" from {degrees(heading_of(wind.toward) + np.pi) % 360:.0f} deg"
    elif wind.speed:
        blows += " from any side"
    if not wind.speed:
        blows = "no steady wind"
    parts = [f"gusts {plain(wind.gusts, 2)} m/s" if wind.gusts else "no gusts"]
    if rehearsed.ir.drones:
        parts.insert(0, blows)
        parts.append(f"positions within {plain(gps.deviation, 2)} m{_beside(gps)}")
        parts += [_without(each) for each in conditions.outages]
        parts.append(LOOPS[conditions.loop])
    if conditions.truth.wander:
        parts.append(f"targets {plain(conditions.truth.wander, 2)} m off their tracks")
    return ", ".join(parts)


def _beside(gps: Gps) -> str:
    """Return the constant error of positions in words."""
    east = gps.offset[0]
    return f" of {plain(abs(east), 2)} m too far {'east' if east > 0 else 'west'}" if east else ""


def _without(outage: Outage) -> str:
    whose = f"none of {outage.who}" if outage.who else "none"
    return f"{whose} from {plain(outage.start, 1)} to {plain(outage.end, 1)} s"


def _pictures(rehearsed: Rehearsed) -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = [PICTURES]
    for i, first in enumerate(rehearsed.runs[0].pictures):
        rows.append(_picture_row(first, [run.pictures[i] for run in rehearsed.runs]))
    return rows


def _picture_row(first: TargetFraming, every: list[TargetFraming]) -> tuple[str, ...]:
    shares = [p.in_frame for p in every]
    sight = min(p.in_sight for p in every)
    whole = tuple(f"{at_most(100 * share, 1)} %" for share in (float(np.mean(shares)), min(shares), sight))
    if first.error is None:
        return (first.shot, first.target, *whole, "-", "-", "-")
    off = (
        float(np.mean([p.error for p in every if p.error is not None])),
        max(p.usual for p in every if p.usual is not None),
        max(p.worst for p in every if p.worst is not None),
    )
    return (first.shot, first.target, *whole, *(_size(value) for value in off))


def _size(value: float) -> str:
    return at_least(value, 3) if isfinite(value) else "behind it"


def _courses(rehearsed: Rehearsed) -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = [COURSES]
    for i, first in enumerate(rehearsed.runs[0].courses):
        every = [(run, run.courses[i]) for run in rehearsed.runs]
        rows.append(_course_row(first, every))
    return rows


def _course_row(first: TrackingError, every: list[tuple[Run, TrackingError]]) -> tuple[str, ...]:
    stray = float(np.sqrt(np.mean([course.stray**2 for _, course in every])))
    strayed, far = max(every, key=lambda pair: pair[1].farthest)
    row = (first.drone, f"{at_least(stray)} m", f"{at_least(far.farthest)} m", str(strayed.number))
    near = [(run, course.nearest) for run, course in every if course.nearest is not None]
    if not near:
        return (*row, "-", "-", "-", "-")
    run, nearest = min(near, key=lambda pair: pair[1].distance if pair[1] else 0.0)
    return (*row, f"{at_most(nearest.distance)} m", nearest.to, as_minutes(nearest.time), str(run.number))


def _fleets(rehearsed: Rehearsed) -> list[tuple[str, ...]]:
    count = len(rehearsed.runs[0].fleets)
    return [FLEETS, *(_fleet_row(rehearsed, [run.fleets[i] for run in rehearsed.runs]) for i in range(count))]


def _fleet_row(rehearsed: Rehearsed, every: list[FleetCourse]) -> tuple[str, ...]:
    fleet = rehearsed.mission.fleet(every[0].fleet)
    near = [each.flown.near.distance for each in every if each.flown.near is not None]
    sizes = (
        float(np.sqrt(np.mean([each.flown.rmse**2 for each in every]))),
        max(each.flown.usual for each in every),
        max(each.flown.farthest for each in every),
    )
    nearest = f"{at_most(min(near))} m" if near else "-"
    apart = fleet.apart
    texts = (f"{at_least(value)} m" for value in sizes)
    return (
        fleet.name,
        str(len(fleet.pads)),
        *texts,
        nearest,
        f"{apart.horizontal:g} m",
        f"{apart.margin:g} m",
    )


def _limit(each: RequirementVerdict) -> str:
    if each.unit == "share":
        return f"{plain(100 * each.limit, 1)} %"
    return f"{plain(each.limit)}{' m' if each.unit == 'm' else ''}"


def _remarks(rehearsed: Rehearsed) -> Iterator[str]:
    """Yield remarks on shots without replanning, on failures, and on the margin of a show."""
    yield from _planned_anew(rehearsed)
    unasked = [p.shot for p in rehearsed.runs[0].pictures if p.error is None]
    if unasked and rehearsed.conditions.loop != "replay":
        names = ", ".join(f"`{shot}`" for shot in dict.fromkeys(unasked))
        yield f"no place on screen is asked in {names}: the camera keeps its planned angles there"
    yield from _spoiled(rehearsed)
    yield from _landed(rehearsed)
    if rehearsed.runs[0].fleets and rehearsed.conditions.wind.speed:
        yield "fleets fly in gusts alone: their drones hold their speed over ground in any steady wind"
    if alike(rehearsed.ir, rehearsed.conditions):
        yield "without gusts all runs are the same, so one is flown; `--gusts 1` shows what gusts do"
    for i in range(len(rehearsed.runs[0].fleets)):
        yield from _margin(rehearsed, [run.fleets[i] for run in rehearsed.runs])
    for i in range(len(rehearsed.runs[0].fleet_pairs)):
        yield _nearest_remark(rehearsed, [run.fleet_pairs[i] for run in rehearsed.runs])


def _spoiled(rehearsed: Rehearsed) -> Iterator[str]:
    """Yield remarks on pictures with other drones, unless the mission switches this off."""
    if rehearsed.mission.rules.visibility == "off":
        return
    for i, first in enumerate(rehearsed.runs[0].courses):
        share, run = max((run.courses[i].spoiled, run.number) for run in rehearsed.runs)
        if share > 0.0:
            seen = f"{at_least(100 * share, 1)} % of its pictures"
            yield f"{first.drone}: another drone is in {seen} in run {run}"


def _landed(rehearsed: Rehearsed) -> Iterator[str]:
    """Yield a remark on how far off its pad each drone lands."""
    for i, first in enumerate(rehearsed.runs[0].courses):
        every = [(run.courses[i].landed, run.number) for run in rehearsed.runs]
        landed = [(off, run) for off, run in every if off is not None]
        if landed:
            off, run = max(landed)
            yield f"{first.drone}: lands up to {at_least(off)} m off its pad, in run {run}"
        if len(landed) < len(every):
            lacks = len(every) - len(landed)
            yield f"{first.drone}: is still in the air when its plan ends, in {lacks} of {len(every)} runs"


def _planned_anew(rehearsed: Rehearsed) -> Iterator[str]:
    """Yield remarks on the shots that were replanned, and on failed replans."""
    if rehearsed.conditions.loop != "replan":
        return
    mission = rehearsed.mission
    anew = {each.phase.shot for track in rehearsed.ir.drones for each in replanned(mission, track)}
    rest = [f"`{shot.id}`" for shot in mission.shots if shot.id not in anew]
    if rest:
        why = "they film nothing that moves, or a pose of their own binds them"
        yield f"not planned anew, but flown as planned: {', '.join(rest)}; {why}"
    for i, first in enumerate(rehearsed.runs[0].courses):
        counts = [c for c in (run.courses[i].replans for run in rehearsed.runs) if c is not None]
        if not counts:
            continue
        yield (
            f"{first.drone}: planned anew {sum(c.requested for c in counts)} times, "
            f"{sum(c.failed for c in counts)} in vain, "
            f"{sum(c.opened for c in counts)} from beyond its limits, "
            f"{sum(c.stalled for c in counts)} no better than before"
        )
        if lost := sum(c.lost for c in counts):
            yield f"{first.drone}: not planned anew {lost} times, for lack of a target's position"
        reasons = [reason for c in counts for reason in (c.reason, c.blind) if reason]
        yield from (f"{first.drone}: {reason}" for reason in dict.fromkeys(reasons))
        late = [c.late for c in counts if c.late]
        if late:
            yield (
                f"{first.drone}: in {len(late)} of {len(rehearsed.runs)} runs it is not back on its plan for "
                f"{late[0]}, because no way there is clear"
            )


def _margin(rehearsed: Rehearsed, every: list[FleetCourse]) -> Iterator[str]:
    """Yield remarks on the largest stray, the nearest pair, and a sufficient margin."""
    fleet = rehearsed.mission.fleet(every[0].fleet)
    names, far = drone_names(fleet), max(every, key=lambda each: each.flown.farthest).flown
    yield f"{fleet.name}: {names[far.drone]} strays farthest, at {as_minutes(far.time)}"
    near = min(
        (each.flown.near for each in every if each.flown.near is not None),
        key=lambda n: n.distance,
        default=None,
    )
    if near is not None:
        pair = f"{names[near.first]} and {names[near.second]}"
        in_air = " in the air" if far.beside is not None else ""
        yield f"{fleet.name}: {pair} come nearest{in_air}, at {as_minutes(near.time)}"
    yield from _beside_pads(fleet, [each.flown.beside for each in every if each.flown.beside is not None])
    yield f"{fleet.name}: {_enough(fleet, far.farthest, 0 if near is None else near.below)}"


def _nearest_remark(rehearsed: Rehearsed, every: list[FleetPair]) -> str:
    """Return the remark on the nearest drones of two fleets, or of a fleet and a camera."""
    worst = min(every, key=lambda each: each.near.distance)
    near, names = worst.near, {fleet.name: drone_names(fleet) for fleet in rehearsed.mission.fleets}
    one, other = names[worst.one][near.first], names.get(worst.other, (worst.other,))[near.second]
    text = f"{worst.one} and {worst.other}: {one} and {other} come nearest"
    how = f"{at_most(near.distance)} m at {as_minutes(near.time)}"
    return f"{text}, {how}" + (f", nearer than the {worst.required:g} m asked" if near.below else "")


def _beside_pads(fleet: Fleet, every: list[ClosestPair]) -> Iterator[str]:
    """Yield the remark on the nearest pair while one of them stands on its pad."""
    if not every:
        return
    names, near = drone_names(fleet), min(every, key=lambda n: n.distance)
    text = (
        f"{fleet.name}: {names[near.first]} and {names[near.second]} come nearest while one stands on its "
        f"pad, {at_most(near.distance)} m at {as_minutes(near.time)}"
    )
    touching = f"; bodies touch below {2 * fleet.radius:.2f} m" if near.below else ""
    yield f"{text}{touching}"


def _enough(fleet: Fleet, farthest: float, below: int) -> str:
    if not below and fleet.apart.margin >= 2 * farthest:
        return "no two drones can come too near in this wind: the margin is twice the farthest stray, or more"
    stray, safe = f"a drone strays up to {at_least(farthest)} m from its place", up(2 * farthest, 1)
    margin = f"`separation: {{margin: {safe:g}}}`"
    if safe > LARGEST_MARGIN_RATIO * fleet.apart.horizontal:
        remedy = f"{stray}, too far for any margin: do not fly this show in such wind"
    elif below:
        remedy = f"{stray}: plan with {margin}, which keeps any two apart in such wind"
    else:
        remedy = f"{stray}: {margin} keeps any two apart that stray so far"
    if not below:
        return f"the margin was enough in these runs; {remedy}"
    return f"{'1 pair comes' if below == 1 else f'{below} pairs come'} nearer than the separation; {remedy}"

"""Verifies flight files against a mission: bytes in, a certificate and diagnostics out."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from shotc.api import MissionFile
from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.flightfiles import film, tell
from shotc.flightfiles.aligned import Aligned, aligned
from shotc.flightfiles.clocked import ClockedFlight, inside, leaves, of_rows, of_show
from shotc.flightfiles.course import UntimedFlight, course_of
from shotc.flightfiles.judge import FileClaim, apart_at_any_time
from shotc.flightfiles.judge import judged as waypoints_judged
from shotc.flightfiles.match import Owned, named, owners
from shotc.flightfiles.swarm import Swarm
from shotc.flightfiles.swarm import judged as swarm_judged
from shotc.geom.pieces import pieces
from shotc.importers.cameras.takes import Refused
from shotc.importers.flights.points import BROKEN, NOBODY, NOWHERE, Unread, Waypoints
from shotc.importers.flights.read import Read, read
from shotc.importers.flights.rows import SHOT, DroneRows
from shotc.importers.flights.skyc import SkycShow
from shotc.importers.flights.wpml import WAYLINES
from shotc.importers.notes import label
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import MissionIR
from shotc.ir.show import drone_names, kept_from_cameras, whole_fleets
from shotc.ir.trajectory import Claim
from shotc.lowering import lower_for_flights
from shotc.source.file import SourceFile


class FlightFile(NamedTuple):
    """The bytes of a file, and its displayed name."""

    data: bytes
    name: str


@dataclass(frozen=True, slots=True)
class FlightsReport:
    """The result of verifying flight files.

    holds : whether all claims hold
    certificate : all claims, broken ones included
    notes : how the flights were rebuilt, and what is not judged and why
    """

    holds: bool
    certificate: tuple[Claim, ...]
    diagnostics: tuple[Diagnostic, ...]
    sources: dict[str, SourceFile]
    notes: tuple[str, ...] = ()


def verify_flights(
    files: Sequence[FlightFile], against: MissionFile, drones: Sequence[str] = ()
) -> FlightsReport:
    """Return the report on flight files, which any tool may have written, against a mission.

    drones : the drone of each file, or empty; see ``owners``
    """
    reads = [read(file.data, Path(file.name).as_posix()) for file in files]
    lowered = lower_for_flights(*against, partial(_filmed, reads))
    sources = {against.name: lowered.file}
    if lowered.keyframes is None:
        return FlightsReport(False, (), lowered.diagnostics, sources)
    sources |= {each.file: SourceFile(each.file, each.text) for each in reads}
    faults = [_refused(each.file, each.content) for each in reads if isinstance(each.content, Refused)]
    if drones and len(drones) != len(files):
        text = f"{len(drones)} drones are named for {len(files)} files"
        faults.append(Diagnostic(NOBODY, text, help="give `--drone` once for every file, in their order"))
    if faults:
        return FlightsReport(False, (), tuple(faults), sources)
    return _with_members(_owned(lowered.keyframes, reads, drones, sources), reads)


def _filmed(reads: Sequence[Read]) -> dict[str, str]:
    """Return the drone of every shot that a table names."""
    tables = [each.content for each in reads if isinstance(each.content, tuple) and not _is_other(each)]
    rows = [one for table in tables for one in table if isinstance(one, DroneRows)]
    return {shot: one.drone for one in rows for shot in one.texts(SHOT) or () if shot}


def _is_other(each: Read) -> bool:
    return isinstance(each.content, Waypoints | Refused)


def _with_members(report: FlightsReport, reads: Sequence[Read]) -> FlightsReport:
    """Return a report with the archives' tables to which its diagnostics refer."""
    labelled = {label.file for diagnostic in report.diagnostics for label in diagnostic.labels}
    tables = {
        inside(each.file, rows): rows
        for each in reads
        if isinstance(each.content, tuple) and not _is_other(each)
        for rows in each.content
        if isinstance(rows, DroneRows) and rows.member
    }
    more = {file: SourceFile(file, tables[file].text) for file in labelled.intersection(tables)}
    return replace(report, sources={**report.sources, **more})


def _owned(
    keyframes: KeyframeIR, reads: Sequence[Read], drones: Sequence[str], sources: dict[str, SourceFile]
) -> FlightsReport:
    """Return the report after assigning flights to drones."""
    mission = keyframes.mission
    plain = [i for i, each in enumerate(reads) if isinstance(each.content, Waypoints)]
    names = [reads[i].file.removesuffix(f"/{WAYLINES}") for i in plain]
    owned, faults = owners(mission, names, [drones[i] for i in plain] if drones else ())
    faults = (*faults, *(_nowhere(mission) if plain else ()))
    courses: list[UntimedFlight] = []
    for own in owned if not faults else ():
        course = _course(mission, own, [reads[plain[i]] for i in own.files])
        if isinstance(course, UntimedFlight):
            courses.append(course)
        else:
            faults = (*faults, course)
    flights: list[ClockedFlight] = []
    for i, each in enumerate(reads):
        made_of = _clocked(mission, each, drones[i] if drones else "")
        if isinstance(made_of, Diagnostic):
            faults = (*faults, made_of)
        else:
            flights += made_of
    clocked, unfit = named(mission, flights, {own.drone.name for own in owned})
    if faults or unfit:
        return FlightsReport(False, (), (*faults, *unfit), sources)
    return _proved(keyframes, courses, clocked, sources)


def _clocked(mission: MissionIR, each: Read, chosen: str) -> list[ClockedFlight] | Diagnostic:
    """Return the flights with a clock in a file.

    chosen : name of its drone by the user's options, or ""
    """
    if isinstance(each.content, SkycShow):
        return [of_show(flight, each.content, each.file, mission.origin) for flight in each.content.flights]
    if not isinstance(each.content, tuple) or isinstance(each.content, Waypoints | Refused):
        return []
    if len(each.content) == 1 and (chosen or not each.content[0].drone):
        owned, faults = owners(mission, [each.file], [chosen] if chosen else ())
        if faults:
            return faults[0]
        names = [owned[0].drone.name]
    else:
        names = [rows.drone for rows in each.content]
    limits = {f"{name}": fleet.limits for fleet in mission.fleets for name in drone_names(fleet)}
    limits |= {drone.name: drone.limits for drone in mission.drones}
    usual = next(iter(limits.values()))
    try:
        return [
            of_rows(rows, name, each.file, limits.get(name, usual))
            for rows, name in zip(each.content, names, strict=True)
        ]
    except Unread as stopped:
        return _refused(each.file, stopped.refused)


def _proved(
    keyframes: KeyframeIR,
    courses: Sequence[UntimedFlight],
    flights: dict[str, ClockedFlight],
    sources: dict[str, SourceFile],
) -> FlightsReport:
    mission = keyframes.mission
    swarms = [
        Swarm.of(mission, fleet, tuple(flights[name] for name in drone_names(fleet)))
        for fleet in whole_fleets(f for f in mission.fleets if drone_names(f)[0] in flights)
    ]
    films = [flights[drone.name] for drone in mission.drones if drone.name in flights]
    try:
        tracks = [_aligned(keyframes, flown) for flown in films]
        beside = _beside_pads(keyframes, swarms)
        claims = [*waypoints_judged(mission, courses, beside)]
        unclocked = frozenset(course.drone.name for course in courses)
        claims += film.judged(beside, films, tracks, unclocked)
    except Unread as stopped:  # a faulty cell in a column that only filming drones need
        return FlightsReport(False, (), (_refused(films[0].file, stopped.refused),), sources)
    for swarm in swarms:
        claims += swarm_judged(swarm)
    claims += _between(mission, courses, films, swarms)
    diagnostics = tuple(tell.diagnostics(mission, claims))
    notes = (
        *tell.models(courses),
        *tell.rebuilt(films, swarms),
        *tell.unjudged(mission, courses, swarms),
        *(f"not judged: {what}" for each in tracks for what in film.unkept(keyframes, each, claims)),
        *_others(mission, {*(course.drone.name for course in courses), *flights}),
    )
    certificate = tuple(each.claim for each in claims)
    return FlightsReport(not has_errors(diagnostics), certificate, diagnostics, sources, notes)


def _beside_pads(keyframes: KeyframeIR, swarms: Sequence[Swarm]) -> KeyframeIR:
    """Return the mission with only those fleets that have no files and stand on their pads."""
    flown = {flight.name for swarm in swarms for flight in swarm.flights}
    fleets = tuple(fleet for fleet in keyframes.mission.fleets if drone_names(fleet)[0] not in flown)
    return keyframes._replace(mission=keyframes.mission._replace(fleets=fleets))


def _aligned(keyframes: KeyframeIR, flown: ClockedFlight) -> Aligned:
    drone = keyframes.mission.drone(flown.name)
    pad = np.array(drone.home)
    return aligned(keyframes, drone, flown, leaves(flown.curve, pad, pad[None]))


def _between(
    mission: MissionIR,
    courses: Sequence[UntimedFlight],
    films: Sequence[ClockedFlight],
    swarms: Sequence[Swarm],
) -> Iterator[FileClaim]:
    """Yield the claims on the separation of flights of different kinds."""
    for course in courses:
        for flown in films:
            yield apart_at_any_time(mission, course, flown.name, pieces(flown.curve))
        for swarm in swarms:
            yield apart_at_any_time(mission, course, swarm.fleet.name, swarm.whole.pieces)
    for swarm in swarms:
        least = kept_from_cameras(mission.rules.separation, swarm.fleet)
        yield from film.beside_fleets(least, films, swarm.flights)


def _course(mission: MissionIR, own: Owned, reads: Sequence[Read]) -> UntimedFlight | Diagnostic:
    """Return the flight of a drone from all its files, joined in order."""
    plans = [each.content for each in reads if isinstance(each.content, Waypoints)]
    of_file = [each.file for each, plan in zip(reads, plans, strict=True) for _ in plan.points]
    plan = plans[-1]._replace(points=tuple(p for each in plans for p in each.points), climb=plans[0].climb)
    if any(each.family != plan.family for each in plans):
        message = f"the files of `{own.drone.name}` are of different machines"
        return Diagnostic(BROKEN, message, (label(reads[-1].file, plans[-1].node),))
    course = course_of(mission, own.drone, plan, of_file)
    return course if isinstance(course, UntimedFlight) else _refused(*course)


def _refused(file: str, why: Refused) -> Diagnostic:
    message = f"`{file}` cannot be judged: {why.message}"
    return Diagnostic(why.code, message, (label(file, why.node),), (), why.help)


def _nowhere(mission: MissionIR) -> tuple[Diagnostic, ...]:
    """Return a fault if the mission has no origin to compare latitudes with."""
    if mission.origin is not None:
        return ()
    text = "these files have latitudes and longitudes, and the mission has no place on earth"
    help_ = "write `world: {origin: {lat: ..., lon: ..., alt: ...}}`"
    return (Diagnostic(NOWHERE, text, (mission.origins.value(()),), help=help_),)


def _others(mission: MissionIR, flown: Collection[str]) -> tuple[str, ...]:
    """Return the note on drones without a file, which are taken to stand at home."""
    names = [f"`{drone.name}`" for drone in mission.drones if drone.name not in flown]
    names += [f"`{fleet.name}`" for fleet in mission.fleets if drone_names(fleet)[0] not in flown]
    if not names:
        return ()
    return (f"{', '.join(names)}: without a file, taken to stand at home all the time",)

"""Files of flights, proved against a mission: bytes in, a certificate and diagnostics out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from shotc.api import MissionFile
from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.flightfiles import tell
from shotc.flightfiles.course import Course, course_of
from shotc.flightfiles.judge import judged
from shotc.flightfiles.match import Owned, owners
from shotc.importers.cameras.takes import Refused
from shotc.importers.flights.points import BROKEN, NOWHERE, Waypoints
from shotc.importers.flights.read import Read, read
from shotc.importers.notes import label
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import MissionIR
from shotc.ir.source import Chosen
from shotc.ir.trajectory import Claim
from shotc.lowering import lower
from shotc.source.file import SourceFile


class FlightFile(NamedTuple):
    """A file: its bytes, and how to show it."""

    data: bytes
    name: str


@dataclass(frozen=True, slots=True)
class FlightsReport:
    """What became of files of flights.

    holds : whether all that was judged holds
    certificate : every claim that was made, broken ones included
    notes : how the flights were rebuilt, and what is not judged of them and why
    """

    holds: bool
    certificate: tuple[Claim, ...]
    diagnostics: tuple[Diagnostic, ...]
    sources: dict[str, SourceFile]
    notes: tuple[str, ...] = ()


def verify_flights(
    files: Sequence[FlightFile], against: MissionFile, drones: Sequence[str] = ()
) -> FlightsReport:
    """Prove flights that any tool may have written against a mission; the files' drones as of ``owners``."""
    asked = lower(*against, Chosen())
    sources = {against.name: asked.file}
    if asked.keyframes is None:
        return FlightsReport(False, (), asked.diagnostics, sources)
    reads = [read(file.data, Path(file.name).as_posix()) for file in files]
    sources |= {each.file: SourceFile(each.file, each.text) for each in reads}
    faults = [_refused(each.file, each.found) for each in reads if isinstance(each.found, Refused)]
    owned, nobody = owners(asked.keyframes.mission, [file.name for file in files], drones)
    found = (*faults, *nobody, *_nowhere(asked.keyframes.mission))
    if found:
        return FlightsReport(False, (), found, sources)
    return _proved(asked.keyframes, reads, owned, sources)


def _proved(
    keyframes: KeyframeIR, reads: Sequence[Read], owned: Sequence[Owned], sources: dict[str, SourceFile]
) -> FlightsReport:
    mission = keyframes.mission
    courses: list[Course] = []
    faults: list[Diagnostic] = []
    for own in owned:
        made = _course(mission, own, [reads[i] for i in own.files])
        if isinstance(made, Course):
            courses.append(made)
        else:
            faults.append(made)
    if faults:
        return FlightsReport(False, (), tuple(faults), sources)
    claims = judged(mission, courses, keyframes)
    diagnostics = tuple(tell.told(mission, claims))
    notes = (*tell.models(courses), tell.unjudged(mission), *_others(mission, courses))
    certificate = tuple(each.claim for each in claims)
    return FlightsReport(not has_errors(diagnostics), certificate, diagnostics, sources, notes)


def _course(mission: MissionIR, own: Owned, reads: Sequence[Read]) -> Course | Diagnostic:
    """Return the flight of a drone by all its files, one after another."""
    plans = [each.found for each in reads if isinstance(each.found, Waypoints)]
    of_file = [each.file for each in reads for _ in _points(each)]
    plan = plans[-1]._replace(points=tuple(p for each in plans for p in each.points), climb=plans[0].climb)
    if any(each.family != plan.family for each in plans):
        message = f"the files of `{own.drone.name}` are of different machines"
        return Diagnostic(BROKEN, message, (label(reads[-1].file, plans[-1].node),))
    made = course_of(mission, own.drone, plan, of_file)
    return made if isinstance(made, Course) else _refused(*made)


def _points(each: Read) -> Sequence[object]:
    return each.found.points if isinstance(each.found, Waypoints) else ()


def _refused(file: str, why: Refused) -> Diagnostic:
    message = f"`{file}` cannot be judged: {why.message}"
    return Diagnostic(why.code, message, (label(file, why.node),), (), why.help)


def _nowhere(mission: MissionIR) -> tuple[Diagnostic, ...]:
    """Say that a mission without a place on earth cannot be held against latitudes."""
    if mission.origin is not None:
        return ()
    text = "these files have latitudes and longitudes, and the mission has no place on earth"
    help_ = "write `world: {origin: {lat: ..., lon: ..., alt: ...}}`"
    return (Diagnostic(NOWHERE, text, (mission.origins.value(()),), help=help_),)


def _others(mission: MissionIR, courses: Sequence[Course]) -> tuple[str, ...]:
    """Say who is taken to stand, for want of a file."""
    flown = {course.drone.name for course in courses}
    names = [f"`{d.name}`" for d in mission.drones if d.name not in flown]
    if not names:
        return ()
    return (f"{', '.join(names)}: without a file, taken to stand at home all the time",)

"""Diagnostics for broken claims on files: the file's line, the mission's limit, the position, and
a remedy.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.flightfiles.clocked import ClockedFlight
from shotc.flightfiles.course import UntimedFlight
from shotc.flightfiles.judge import FileClaim
from shotc.flightfiles.swarm import Swarm
from shotc.importers.flights.rows import VELOCITY
from shotc.ir.measures import OUT_OF_PICTURE, distinct_measures, measure
from shotc.ir.mission import MissionIR
from shotc.ir.trajectory import Claim
from shotc.passes.verify.promises import PROMISES, broken_promise, promise_help
from shotc.passes.verify.report import limit_label, rule_of, side_of, state_of
from shotc.rounding import at_least, plain, up

SEEN = "V025"
"""Code of a drone in another one's picture."""
HELPS = {
    "V002": "change speed more gently there, by {lack} at least",
    "V003": "change speed more gently there, by {lack} at least",
    "V004": "turn slower there, by {lack} at least",
    "V006": "turn the camera slower there, by {lack} at least",
    SEEN: "film from elsewhere, or fly the other drone elsewhere then",
    "V035": "lead the way between shots {lack} farther away",
    "V055": "fly {lack} less",
    "V001": "fly slower there, by {lack} at least, or raise the limit",
    "V005": "turn the camera back there, by {lack} at least",
    "V007": "keep {lack} farther away there",
    "V008": "keep {lack} farther inside there",
    "V009": "fly {lack} higher there",
    "V010": "keep {lack} farther away there",
    "V012": "begin and land where the mission has the drone's home",
    "V013": "fly {lack} less, or faster",
    "V022": "keep {lack} farther apart; files without a clock keep no drones apart by time",
    "V047": "fly {lack} lower there",
    "V052": "keep {lack} farther away there",
}
"""Remedies for the author of a file.

lack : by how much the limit is missed
"""


def diagnostics(mission: MissionIR, claims: Sequence[FileClaim]) -> Iterator[Diagnostic]:
    """Yield an error for every broken claim."""
    certificate = tuple(each.claim for each in claims)
    for each in claims:
        if not each.claim.holds and each.claim.hard:
            yield _broken(mission, each, certificate)


def _broken(mission: MissionIR, broken: FileClaim, certificate: tuple[Claim, ...]) -> Diagnostic:
    claim = broken.claim
    seen = claim.constraint.endswith(OUT_OF_PICTURE)
    code = SEEN if seen else rule_of(claim.constraint, mission).code
    limit = f"{side_of(claim)} {distinct_measures(claim.worst, claim.limit, claim.unit)[1]}"
    labels = [limit_label(mission, claim, limit)]
    if broken.where is not None:
        labels.insert(0, broken.where)
    if code in PROMISES and claim.shot is not None:
        message = broken_promise(claim, code)
        help_ = promise_help(claim, code, mission.shot(claim.shot), certificate)
    else:
        lack = measure(abs(claim.worst - claim.limit), claim.unit)
        message = f"{_who(claim)}: {state_of(claim, code)}"
        help_ = HELPS.get(code, "correct the file, or the mission").format(lack=lack)
    return Diagnostic(code, message, tuple(labels), tuple(_notes(claim, broken)), help_)


def _who(claim: Claim) -> str:
    return claim.subject if not claim.drones else f"{' and '.join(claim.drones)} of {claim.subject}"


def _notes(claim: Claim, file_claim: FileClaim) -> Iterator[str]:
    if claim.position is not None:
        yield "worst at ({:.2f}, {:.2f}, {:.2f}) m".format(*claim.position)
    yield from file_claim.notes
    if claim.method == "bounded":
        yield "proved between the file's places, too"


def models(courses: Sequence[UntimedFlight]) -> Iterator[str]:
    """Yield notes on how each waypoint flight was rebuilt, and what is not judged."""
    for course in courses:
        name, files = course.drone.name, ", ".join(f"`{file}`" for file in course.files)
        names = [curve_name for curve_name, _ in course.ways]
        curves = (
            ""
            if len(names) == 1
            else f" and on {len(names) - 1} curves more ({names[1]}, ...), the worst counts"
        )
        yield f"{name}: {files}, {len(course.plan.points)} waypoints, flown by {course.plan.pilot}"
        yield f"{name}: up straight from the pad, over to the first waypoint, then on {names[0]}{curves}"
        if len(names) > 1:
            yield f"{name}: speeds are judged on straight legs; nobody has published them on curves"
        slow = sum(leg.speed is None for leg in course.legs if leg.phase == "transit" and leg.within)
        if slow:
            yield f"{name}: not judged: the speed of {slow} legs, for which the file has none"
        if course.plan.ending:
            yield f"{name}: not judged: what comes after the last waypoint: {course.plan.ending}"


def rebuilt(films: Sequence[ClockedFlight], swarms: Sequence[Swarm]) -> Iterator[str]:
    """Yield notes on how flights with a clock were rebuilt, and how accurate their files are."""
    groups = [(flown.name, [flown]) for flown in films]
    groups += [(swarm.fleet.name, list(swarm.flights)) for swarm in swarms]
    for name, flights in groups:
        files = ", ".join(f"`{file}`" for file in dict.fromkeys(flight.file for flight in flights))
        tables = [flight.rows for flight in flights if flight.rows is not None]
        count = f"{len(flights)} drones, " if len(flights) > 1 else ""
        if not tables:
            points = sum(len(flight.curve.ctrl) for flight in flights)
            yield f"{name}: {files}, {count}{points} curves of its show, as they are in the file"
            continue
        step = max(float(np.diff(rows.time).max()) for rows in tables)
        straight = any(rows.velocity is None for rows in tables)
        how = "straight from row to row" if straight else "on cubics by the places and velocities of its rows"
        yield f"{name}: {files}, {count}rows up to {plain(up(step, 3))} s apart, flown {how}"
        between = max(flight.leeway.between for flight in flights)
        off = at_least(between, 3)
        yield f"{name}: between its rows a flight within its limits is within {off} m of that"
        if straight:
            yield f"{name}: not judged: the acceleration, for want of the columns {', '.join(VELOCITY)}"


def unjudged(mission: MissionIR, courses: Sequence[UntimedFlight], swarms: Sequence[Swarm]) -> Iterator[str]:
    """Yield notes on what is not judged for files without a clock and for shows."""
    moving = [f"`{target.name}`" for target in mission.targets if target.track is not None]
    words = ["acceleration, jerk and rates of turning", "framing, visibility and promises of shots"]
    if moving:
        words.append(f"the distance from what moves ({', '.join(moving)})")
    if courses:
        why = "files of waypoints have no clock, so the times of its positions are unknown"
        yield f"not judged: {'; '.join(words)}: {why}"
    if swarms:
        yield "not judged: which picture a fleet shows when; files of flights do not name pictures"

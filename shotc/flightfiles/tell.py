"""Broken claims of files in the user's terms: the file's line, the mission's limit, where, and what helps."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from shotc.diag.model import Diagnostic
from shotc.flightfiles.course import Course, Leg
from shotc.flightfiles.judge import Found
from shotc.importers.notes import label
from shotc.ir.measures import measure, told_apart
from shotc.ir.mission import MissionIR
from shotc.ir.trajectory import Claim
from shotc.passes.verify.report import limit_label, rule_of, side_of, state_of

HELPS = {
    "V001": "let the file fly this leg slower, by {lack} at least, or raise the limit",
    "V005": "ask for an angle that the gimbal reaches",
    "V007": "move the waypoints of this leg {lack} farther away",
    "V008": "move the waypoints of this leg {lack} into the zone",
    "V009": "fly this leg {lack} higher",
    "V010": "move the waypoints of this leg {lack} farther away",
    "V012": "let it land where the mission has its home",
    "V013": "fly {lack} less, or faster",
    "V022": "move one of the two ways by {lack}: nothing in files without a clock keeps drones apart by time",
    "V047": "fly this leg {lack} lower",
    "V052": "move the waypoints of this leg {lack} farther away",
}
"""What helps whoever wrote the file; lack : by how much the limit is missed."""


def told(mission: MissionIR, found: Sequence[Found]) -> Iterator[Diagnostic]:
    """Yield an error for every broken claim."""
    for each in found:
        if not each.claim.holds and each.claim.hard:
            yield _broken(mission, each)


def _broken(mission: MissionIR, found: Found) -> Diagnostic:
    claim = found.claim
    code = rule_of(claim.constraint, mission).code
    limit = f"{side_of(claim)} {told_apart(claim.worst, claim.limit, claim.unit)[1]}"
    labels = [limit_label(mission, claim, limit)]
    if found.leg is not None:
        labels.insert(0, label(found.leg.file, found.leg.to.node)._replace(text=_on(found.leg)))
    lack = measure(abs(claim.worst - claim.limit), claim.unit)
    help_ = HELPS.get(code, "mend the file, or the mission").format(lack=lack)
    message = f"{claim.subject}: {state_of(claim, code)}"
    return Diagnostic(code, message, tuple(labels), tuple(_notes(claim, found)), help_)


def _on(leg: Leg) -> str:
    words = {"takeoff": "on the climb before", "land": "on the landing at"}.get(leg.phase, "on the way to")
    return f"{words} {leg.to.name}"


def _notes(claim: Claim, found: Found) -> Iterator[str]:
    if claim.position is not None:
        where = "worst at ({:.2f}, {:.2f}, {:.2f}) m".format(*claim.position)
        when = "" if claim.time is None else f", {claim.time:.1f} s from take-off at the file's speeds"
        yield f"{where}{when}"
    if found.way:
        yield f"on {found.way}, which its machine may fly"
    if claim.method == "bounded":
        yield "proved for the whole way"


def models(courses: Sequence[Course]) -> Iterator[str]:
    """Yield how each flight was rebuilt, and what is not judged of it."""
    for course in courses:
        name, files = course.drone.name, ", ".join(f"`{file}`" for file in course.files)
        ways = [way for way, _ in course.ways]
        curves = (
            ""
            if len(ways) == 1
            else f" and on {len(ways) - 1} curves more ({ways[1]}, ...), the worst counts"
        )
        yield f"{name}: {files}, {len(course.plan.points)} waypoints, flown by {course.plan.pilot}"
        yield f"{name}: up straight from the pad, over to the first waypoint, then on {ways[0]}{curves}"
        if len(ways) > 1:
            yield f"{name}: speeds are judged on straight legs; nobody has published them on curves"
        slow = sum(leg.speed is None for leg in course.legs if leg.phase == "transit" and leg.within)
        if slow:
            yield f"{name}: not judged is the speed of {slow} legs, for which the file has none"
        if course.plan.ending:
            yield f"{name}: not judged is what comes after the last waypoint: {course.plan.ending}"


def unjudged(mission: MissionIR) -> str:
    """Return what a file without a clock leaves open."""
    moving = [f"`{target.name}`" for target in mission.targets if target.track is not None]
    words = ["acceleration, jerk and rates of turning", "framing, visibility and promises of shots"]
    if moving:
        words.append(f"the distance from what moves ({', '.join(moving)})")
    return (
        f"not judged: {'; '.join(words)}. These files have no clock, so nothing tells when a drone is where"
    )

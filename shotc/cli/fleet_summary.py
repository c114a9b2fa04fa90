"""What a finished plan tells of its fleets at a glance: displays, and how near two drones come."""

from __future__ import annotations

from collections.abc import Iterator

from shotc.cli.table import clock
from shotc.geom.apart import stretch
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.measures import measure
from shotc.ir.phases import Phase
from shotc.ir.trajectory import Claim, VerifiedIR

PAIR = 2


def display_rows(plan: VerifiedIR) -> list[tuple[str, ...]]:
    """Return a heading and one row a display: fleet, when, how long, and what it shows; or nothing."""
    rows = [
        (phase.shot, f"{track.fleet} ({len(track.coef)} drones)", *_shown(track, phase))
        for track in plan.trajectory.fleets
        for phase in track.phases
        if phase.shot is not None
    ]
    return [("display", "fleet", "from", "lasts", "pictures"), *rows] if rows else []


def _shown(track: FleetTrajectory, phase: Phase) -> tuple[str, ...]:
    shown = [s for s in track.shown if s.display == phase.shot]
    pictures = len({s.picture for s in shown})
    frames = "" if len(shown) == pictures else f", {len(shown)} frames"
    return clock(phase.start), f"{phase.end - phase.start:.2f} s", f"{pictures}{frames}"


def headline(plan: VerifiedIR) -> str:
    """Return how many displays and drones there are."""
    ir = plan.trajectory
    shows, drones = len(ir.keyframes.mission.displays), sum(len(track.coef) for track in ir.fleets)
    return f"{shows} display{'s' * (shows != 1)} of {drones} drone{'s' * (drones != 1)}"


def nearest(plan: VerifiedIR) -> Iterator[str]:
    """Yield, for each fleet and every two of them, which drones come nearest, how near, and when."""
    for claim in plan.certificate:
        if len(claim.drones) == PAIR:
            yield _pair(plan, claim)


def _pair(plan: VerifiedIR, claim: Claim) -> str:
    found, needed = measure(claim.worst, claim.unit), measure(claim.limit, claim.unit)
    when = "" if claim.time is None else f", at {clock(claim.time)}"
    text = f"{' and '.join(claim.drones)} come nearest, {found}, {needed} needed{when}"
    if claim.constraint != "separation":
        return text
    apart = plan.trajectory.keyframes.mission.fleet(claim.subject).apart
    return f"{text}; heights count {stretch(apart):.2g} times ({apart.shape})"

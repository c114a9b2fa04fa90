"""Texts of the recording: the mission in numbers, the current phase, and the certificate."""

from __future__ import annotations

from math import degrees, isfinite

from shotc.emit.screen import percent, screen_tracks, summary
from shotc.ir.phases import Phase
from shotc.ir.trajectory import Claim, DroneTrajectory, VerifiedIR

HOW = {"bounded": "every instant", "exact": "arithmetic", "sampled": "samples"}
BOOKKEEPING = ("jump", "rate at", "distance from", "drift", "depth", "times", "error of", "targets not")
"""Beginnings of claims that no author asks for, which check the plan's own consistency."""

SHOWN = {
    "takeoff": "Taking off",
    "transit": "Flying to the next shot",
    "return": "Flying home",
    "land": "Landing",
}


def phase_texts(plan: VerifiedIR, flight: DroneTrajectory) -> list[tuple[float, str]]:
    """Return texts with their start times, seconds: the phase, then mission and certificate."""
    body = f"{mission_text(plan)}\n\n{certificate_text(plan.certificate)}\n"
    return [(phase.start, f"{_now(plan, phase)}\n\n{body}") for phase in flight.phases]


def mission_text(plan: VerifiedIR) -> str:
    """Return a summary of the mission in a few lines of Markdown."""
    mission = plan.trajectory.keyframes.mission
    total = max((flight.curve.end for flight in plan.trajectory.drones), default=0.0)
    framing = summary(screen_tracks(plan))
    facts = [
        f"**{mission.name}**: {len(mission.shots)} shot{'' if len(mission.shots) == 1 else 's'},"
        f" {total:.1f} s in the air",
        "drones: " + ", ".join(f"{drone.name} ({drone.model})" for drone in mission.drones),
    ]
    if framing.error is not None:
        facts.append(f"worst screen error {framing.error:.3f} at {framing.time:.1f} s ({framing.shot})")
    if framing.in_frame is not None:
        facts.append(f"whole subject in frame {percent(framing.in_frame)} of filmed samples")
    return "\n".join(f"- {fact}" for fact in facts)


def certificate_text(certificate: tuple[Claim, ...]) -> str:
    """Return the certificate as a Markdown table, with broken claims first and consistency checks last."""
    rows = ["| | requirement | asked | worst | when | known |", "|---|---|---|---|---|---|"]
    order = sorted(certificate, key=_rank)
    for claim in order:
        what = claim.constraint if claim.shot is None else f"{claim.constraint} ({claim.shot})"
        when = "" if claim.time is None else f"{claim.time:.1f} s"
        limit = _limit(claim)
        cells = (verdict(claim), what, limit, quantity(claim.worst, claim.unit), when, HOW[claim.method])
        rows.append(f"| {' | '.join(cells)} |")
    return "\n".join(rows)


def _rank(claim: Claim) -> int:
    if claim.hard and not claim.holds:
        return 0
    if claim.constraint.startswith(BOOKKEEPING) or claim.constraint.endswith("at home"):
        return 4
    if not isfinite(claim.limit):
        return 3
    return 1 if claim.shot is None else 2


def _limit(claim: Claim) -> str:
    sign = "≤" if claim.upper else "≥"
    return f"{sign} {quantity(claim.limit, claim.unit)}" if isfinite(claim.limit) else "–"


def verdict(claim: Claim) -> str:
    """Return the verdict on a claim in a word; "" for a claim without a limit."""
    if not isfinite(claim.limit):
        return ""
    if claim.holds:
        return "ok"
    return "**broken**" if claim.hard else "missed"


def quantity(value: float, unit: str) -> str:
    """Return a number with its unit in readable form, with angles in degrees."""
    if not isfinite(value):
        return "–"
    if unit.startswith("rad"):
        return f"{degrees(value):.4g} deg{unit[3:]}"
    return f"{value:.4g} {unit}".strip()


def _now(plan: VerifiedIR, phase: Phase) -> str:
    span = f"{phase.start:.1f} s to {phase.end:.1f} s"
    if phase.shot is None:
        return f"## {SHOWN[phase.name]}\n{span}"
    shot = next(s.shot for s in plan.trajectory.keyframes.shots if s.shot.id == phase.shot)
    subject = f" of {shot.subject}" if shot.subject else ""
    return f"## Filming `{shot.id}`\n{shot.kind}{subject}, {span}"

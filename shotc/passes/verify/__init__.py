"""Pass verify: takes a TrajectoryIR, trusts nobody, and gives a VerifiedIR with its certificate.

Limits, zones and clearances are proved over continuous time by Bernstein hulls (geom.proof); what the
camera sees is sampled at the output rate and closed between samples by bounds on rates. Every claim names
its limit, worst value, time, place and method. A plan that breaks a hard claim is not given on.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.ir.occlusion import others_of
from shotc.ir.trajectory import Claim, TrajectoryIR, VerifiedIR
from shotc.passes.base import Outcome, PassContext
from shotc.passes.verify.claims import Flight
from shotc.passes.verify.framing import framing
from shotc.passes.verify.loss import losses
from shotc.passes.verify.motion import motion
from shotc.passes.verify.pair import separation
from shotc.passes.verify.report import report
from shotc.passes.verify.shape import shape, structure
from shotc.passes.verify.shots import shots
from shotc.passes.verify.sight import sights
from shotc.passes.verify.space import space


@dataclass(frozen=True, slots=True)
class Verdict:
    """All claims about a trajectory, broken ones included, and the diagnostics of those."""

    certificate: tuple[Claim, ...]
    diagnostics: tuple[Diagnostic, ...]


@dataclass(frozen=True, slots=True)
class Verify:
    """Prove that a trajectory may be flown and shows what was promised."""

    name: ClassVar[str] = "verify"

    def run(self, ir: TrajectoryIR, ctx: PassContext) -> Outcome[VerifiedIR]:
        """Give the trajectory with its certificate, or the V diagnostics of what it breaks."""
        verdict = judge(ir, ctx)
        if has_errors(verdict.diagnostics):
            return Outcome(None, verdict.diagnostics)
        return Outcome(VerifiedIR(ir, verdict.certificate), verdict.diagnostics)


def judge(ir: TrajectoryIR, ctx: PassContext) -> Verdict:
    """Return every claim that can be made about a trajectory, in a fixed order, and what is broken."""
    broken = tuple(structure(ir))
    if broken:
        return Verdict((), broken)
    mission = ir.keyframes.mission
    flights = [
        Flight(mission, mission.drone(track.drone), track, others_of(ir.drones, track.drone))
        for track in ir.drones
    ]
    claims: list[Claim] = []
    for flight in flights:
        ctx.progress(f"verify {flight.drone.name}")
        claims += [*shape(flight), *motion(flight), *space(flight), *shots(flight, ir), *framing(flight, ir)]
    claims += [*separation(ir, flights), *sights(flights)]
    certificate = tuple(claims)
    return Verdict(certificate, (*_grounded(ir), *report(ir, certificate), *losses(ir, certificate)))


def _grounded(ir: TrajectoryIR) -> list[Diagnostic]:
    """Report shots whose drone does not fly at all."""
    mission, flying = ir.keyframes.mission, {track.drone for track in ir.drones}
    return [
        Diagnostic(
            "V015",
            f"shot `{shot.id}` is not flown: the plan has no flight of `{shot.drone}`",
            labels=(mission.origins.key(shot.path),),
            help="plan the mission again",
        )
        for shot in mission.shots
        if shot.drone not in flying
    ]

"""Pass verify: it proves a TrajectoryIR, whoever made it, and gives a VerifiedIR with its certificate.

It checks every drone of the mission; one that the plan does not fly is a body on its pad. Limits, zones and
clearances are proved over continuous time by Bernstein hulls (geom.proof). What the camera sees is sampled at
the output rate, and bounds on rates close the gaps between samples. Every claim names its limit, worst value,
time, place and method. A plan that breaks a hard claim is not passed on.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.ir.occlusion import others_of
from shotc.ir.parked import bodies
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.trajectory import Claim, CoveredShares, TrajectoryIR, VerifiedIR
from shotc.passes.verify.ahead import ahead
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.course import course
from shotc.passes.verify.energy import energy
from shotc.passes.verify.filmed_pictures import not_standing
from shotc.passes.verify.fleets import fleet_claims, fleet_structure
from shotc.passes.verify.framing import filmed, framing
from shotc.passes.verify.looking import looking
from shotc.passes.verify.loss import losses
from shotc.passes.verify.lost_time import lost_time, transfers
from shotc.passes.verify.motion import motion
from shotc.passes.verify.paced import pace
from shotc.passes.verify.pair import from_fleets, separation
from shotc.passes.verify.pans import pans
from shotc.passes.verify.promises import unjudged
from shotc.passes.verify.report import report
from shotc.passes.verify.shape import shape, structure
from shotc.passes.verify.sharpness import sharp, unsharp
from shotc.passes.verify.shots import shots
from shotc.passes.verify.sight import sights
from shotc.passes.verify.space import space
from shotc.passes.verify.transits import transits
from shotc.passes.verify.waits import waits


@dataclass(frozen=True, slots=True)
class Verdict:
    """All claims about a trajectory, broken ones included, their diagnostics, and samples of coverage."""

    certificate: tuple[Claim, ...]
    diagnostics: tuple[Diagnostic, ...]
    covered: tuple[CoveredShares, ...] = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class Verify:
    """Prove that a trajectory can be flown and shows what was promised."""

    name: ClassVar[str] = "verify"

    def run(self, ir: TrajectoryIR, ctx: PassContext) -> Outcome[VerifiedIR]:
        """Return the trajectory with its certificate, or the V diagnostics of broken hard claims."""
        verdict = judge(ir, ctx)
        if has_errors(verdict.diagnostics):
            return Outcome(None, verdict.diagnostics)
        return Outcome(VerifiedIR(ir, verdict.certificate, verdict.covered), verdict.diagnostics)


def judge(ir: TrajectoryIR, ctx: PassContext) -> Verdict:
    """Return all claims about a trajectory, in a fixed order, and the diagnostics of broken ones."""
    mission = ir.keyframes.mission
    broken = (*structure(ir), *fleet_structure(ir))
    if broken:
        return Verdict((), broken)
    everyone = bodies(ir)
    present = [
        JudgedFlight(mission, mission.drone(track.drone), track, others_of(everyone, track.drone))
        for track in everyone
    ]
    flights, on_pads = present[: len(ir.drones)], present[len(ir.drones) :]
    claims: list[Claim] = []
    covered: list[CoveredShares] = []
    for flight in flights:
        ctx.progress(f"verify {flight.drone.name}")
        between = transfers(flight)
        claims += [
            *shape(flight),
            *energy(flight),
            *motion(flight),
            *space(flight),
            *transits(flight),
            *ahead(flight),
            *shots(flight, ir),
            *pace(flight, ir),
            *lost_time(flight, ir, between),
            *waits(flight, ir, between),
            *course(flight, ir),
            *looking(flight, ir),
        ]
        for shot in filmed(flight, ir):
            claims += [*framing(flight, shot), *sharp(flight, shot)]
            covered += (
                CoveredShares(flight.drone.name, view.shot.id, view.target, view.times, view.covered)
                for view in shot.views
            )
    claims += [
        *separation(flights, on_pads),
        *from_fleets(ir, flights),
        *sights(present),
        *fleet_claims(ir, ctx.progress),
    ]
    certificate = tuple(claims)
    diagnostics = (*report(ir, certificate), *unjudged(ir, certificate), *losses(ir, certificate), *pans(ir))
    diagnostics += (*unsharp(ir, certificate), *not_standing(ir))
    return Verdict(certificate, (*_grounded(ir), *diagnostics), tuple(covered))


def _grounded(ir: TrajectoryIR) -> list[Diagnostic]:
    """Return errors for shots whose drone or fleet does not fly at all."""
    mission = ir.keyframes.mission
    flying = {track.drone for track in ir.drones} | {track.fleet for track in ir.fleets}
    flown = [(shot.id, shot.drone, shot.path) for shot in mission.shots]
    flown += [(display.id, display.fleet, display.path) for display in mission.displays]
    return [
        Diagnostic(
            "V015",
            f"shot `{shot}` is not flown: the plan has no flight of `{who}`",
            labels=(mission.origins.key(path),),
            help="plan the mission again",
        )
        for shot, who, path in flown
        if who not in flying
    ]

"""Claims about fleets: as about drones with cameras, for all drones of a fleet at once."""

from __future__ import annotations

from collections.abc import Callable

from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.fleets.apart import from_parked, separations
from shotc.passes.verify.fleets.cameras import from_cameras
from shotc.passes.verify.fleets.displays import displays
from shotc.passes.verify.fleets.effects import effects
from shotc.passes.verify.fleets.effects.stays import stays_of
from shotc.passes.verify.fleets.fades import fades
from shotc.passes.verify.fleets.flight import FleetFlight
from shotc.passes.verify.fleets.motion import motion
from shotc.passes.verify.fleets.pyro import pyro
from shotc.passes.verify.fleets.shape import fleet_structure, shape
from shotc.passes.verify.fleets.space import space


def fleet_claims(ir: TrajectoryIR, progress: Callable[[str], None]) -> list[Claim]:
    """Return all claims about the fleets of a trajectory, in a fixed order."""
    claims: list[Claim] = []
    flights = [FleetFlight.of(ir.keyframes.mission, track) for track in ir.fleets]
    for flight in flights:
        progress(f"verify {flight.fleet.name}")
        claims += [*shape(flight), *motion(flight), *space(flight), *displays(flight, ir)]
        stays = stays_of(flight)
        claims += [*fades(flight, stays), *effects(flight, stays)]
    claims += [*separations(flights), *from_parked(ir, flights), *from_cameras(flights, ir.drones)]
    return [*claims, *pyro(ir, flights)]


__all__ = ["fleet_claims", "fleet_structure"]

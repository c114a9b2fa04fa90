"""Ways home that no plan proves: the return after a lost link, and the rally points."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count
from math import ceil, cos, isfinite, radians, sin

from shotc.diag.model import Diagnostic
from shotc.geom.solids import signed_distance
from shotc.ir.drone import Drone, Safety
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR, Zone
from shotc.passes.resolve.checks.home import BEARINGS_DEG
from shotc.planning.clearances import move, outward

RALLY_STEP_M = 1.0  # metres between the distances at which another rally point is searched
RALLY_MOST_M = 300.0  # metres from the present one up to which it is searched


def check_safety(mission: MissionIR) -> Iterator[Diagnostic]:
    """Yield the faults of returns that are too low, and of rally points beside or outside zones."""
    for drone in mission.drones:
        if drone.safety is not None:
            yield from _low(mission, drone, drone.safety)
            yield from _rally(mission, drone, drone.safety)


def _low(mission: MissionIR, drone: Drone, safety: Safety) -> Iterator[Diagnostic]:
    """Yield the fault of the highest obstacle above the return height; the path of a return is not known."""
    if safety.return_height is None:
        return
    tops = [(z.solid.top, f"zone `{z.name}`", z.path) for z in mission.zones if z.keep == "out"]
    tops += [(t.kept_clear.top, f"target `{t.name}`", t.path) for t in mission.targets]
    known = [top for top in tops if isfinite(top[0])]
    if not known:
        return
    top, name, path = max(known)
    needed = top - drone.home[2] + drone.radius + mission.rules.obstacle_clearance
    if safety.return_height >= needed:
        return
    yield Diagnostic(
        "G053",
        f"`{drone.name}` would return lower than {name} is high",
        (
            mission.origins.value((*drone.path, "safety", "return_height")),
            mission.origins.key(path, "the highest"),
        ),
        (
            f"its top is {top - drone.home[2]:.1f} m above the home, and {drone.radius:g} m of body and"
            f" {mission.rules.obstacle_clearance:g} m of clearance are kept",
            "a return is flown straight home, and no plan proves that way",
        ),
        f"write `return_height: {ceil(needed)} m`",
    )


def _rally(mission: MissionIR, drone: Drone, safety: Safety) -> Iterator[Diagnostic]:
    for i, place in enumerate(safety.rally):
        for zone in mission.zones:
            if _wrong(zone, drone, place):
                yield Diagnostic(
                    "G054",
                    f"rally point {i + 1} of `{drone.name}` is {'in' if zone.keep == 'out' else 'outside of'}"
                    f" zone `{zone.name}`, or nearer to its border than the body is wide",
                    (
                        mission.origins.value((*drone.path, "safety", "rally", i)),
                        mission.origins.key(zone.path, "the zone"),
                    ),
                    (),
                    _elsewhere(mission, drone, place),
                )


def _wrong(zone: Zone, drone: Drone, place: Vec3) -> bool:
    """Return whether a rally point is in a keep-out zone or outside of a keep-in zone, or nearly so."""
    # It is approached from above, so its height is not checked.
    level = min(max(place[2], zone.solid.bottom + drone.radius), zone.solid.top - drone.radius)
    apart = signed_distance(zone.solid, (place[0], place[1], level))
    return apart < drone.radius if zone.keep == "out" else apart > -drone.radius


def _elsewhere(mission: MissionIR, drone: Drone, place: Vec3) -> str:
    """Return the move of a rally point to the nearest place that was found, in words."""
    x, y, z = place
    for ring in count(1):
        reach = ring * RALLY_STEP_M
        for turn in BEARINGS_DEG:
            there = outward(place, (x + reach * cos(radians(turn)), y + reach * sin(radians(turn)), z))
            if not any(_wrong(zone, drone, there) for zone in mission.zones):
                return move(place, there)
        if reach > RALLY_MOST_M:
            return "move it, or the zone"
    raise AssertionError

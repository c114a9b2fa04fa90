"""Ways home that no plan proves: the return after a lost link, and the rally points."""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil, isfinite

from shotc.diag.model import Diagnostic
from shotc.geom.solids import signed_distance
from shotc.ir.drone import Drone, Safety
from shotc.ir.mission import MissionIR


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
            # It is approached from above, so its height is not checked.
            level = min(max(place[2], zone.solid.bottom + drone.radius), zone.solid.top - drone.radius)
            apart = signed_distance(zone.solid, (place[0], place[1], level))
            if (apart < drone.radius) if zone.keep == "out" else (apart > -drone.radius):
                yield Diagnostic(
                    "G054",
                    f"rally point {i + 1} of `{drone.name}` is {'in' if zone.keep == 'out' else 'outside of'}"
                    f" zone `{zone.name}`, or nearer to its border than the body is wide",
                    (
                        mission.origins.value((*drone.path, "safety", "rally", i)),
                        mission.origins.key(zone.path, "the zone"),
                    ),
                    (),
                    "move it",
                )

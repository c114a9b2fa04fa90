"""Checks of homes: on the ground, clear of zones and targets, with a free vertical above."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from math import atan2, cos, dist, inf, radians, sin, sqrt

from shotc.diag.model import Diagnostic
from shotc.geom.solids import signed_distance
from shotc.ir.drone import Drone
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR
from shotc.planning.clearances import NUDGE_M, ROUNDING_M, Clearance, clearances_of, move, outward
from shotc.rounding import at_least, nearer_than

BEARINGS_DEG = (0, 30, -30, 60, -60, 90, -90, 120, -120, 150, -150, 180)
"""Degrees from straight on at which a place around another home is searched, nearest first."""


def check_homes(mission: MissionIR) -> list[Diagnostic]:
    """Return the faults of each drone's home.

    Take-off and landing are vertical there, up to the height from which clearances hold. Only the clearances
    and the floors of keep-in zones do not apply below it.
    """
    faults: list[Diagnostic] = []
    for drone in mission.drones:
        label = mission.origins.value((*drone.path, "home"))
        ground = mission.ground(drone.home[0], drone.home[1])
        under = ground - drone.home[2]
        if under > ROUNDING_M:
            z = f"{round(ground, 2) + 0.0:g}"
            note = f"it is {under:.2f} m under z = {z}, the ground"
            help_ = f"raise it by {at_least(under)} m, to z = {z}"
            message = f"the home of `{drone.name}` is underground"
            faults.append(Diagnostic("G006", message, (label,), (note,), help_))
            continue
        for obstacle in clearances_of(mission, drone):
            texts = _obstructed(mission, drone, obstacle)
            if texts is not None:
                labels = (label, mission.origins.key(obstacle.owner.path, "the obstacle"))
                faults.append(
                    Diagnostic("G005", texts[0], labels, (texts[1],), _remedy(mission, drone, obstacle))
                )
    return [*faults, *_too_near(mission)]


def _too_near(mission: MissionIR) -> Iterator[Diagnostic]:
    """Yield the pairs of drones, at least one of which films, whose homes are nearer than the separation.

    The other one is an obstacle on its pad as well, whether or not it ever flies.
    """
    filming = {shot.drone for shot in mission.shots}
    least = mission.rules.separation
    for one, other in combinations(mission.drones, 2):
        distance = dist(one.home, other.home)
        if distance >= least - ROUNDING_M or not filming & {one.name, other.name}:
            continue
        labels = (
            mission.origins.value((*other.path, "home")),
            mission.origins.value((*one.path, "home"), "the other home"),
        )
        note = f"they are {distance:.2f} m apart; `rules.separation` asks for {least:.2f} m, centre to centre"
        help_ = _apart(mission, other, one) or f"move one of them by {at_least(least - distance)} m"
        message = f"the homes of `{one.name}` and `{other.name}` are too near"
        yield Diagnostic("G019", message, labels, (note,), help_)


def _apart(mission: MissionIR, moved: Drone, standing: Drone) -> str:
    """Return the move to the nearest free home at the separation from another one, in words.

    The direction from the other home is tried first, then others around it.
    """
    least, (x, y, z) = mission.rules.separation, standing.home
    straight = atan2(moved.home[1] - y, moved.home[0] - x)
    reach = sqrt(max(0.0, least**2 - (moved.home[2] - z) ** 2)) + NUDGE_M
    for turn in BEARINGS_DEG:
        angle = straight + radians(turn)
        place = outward(standing.home, (x + reach * cos(angle), y + reach * sin(angle), z))
        place = (place[0], place[1], moved.home[2])
        if stands_free(mission, moved._replace(home=place)):
            return move(moved.home, place).replace("move it", f"move `{moved.name}`", 1)
    return ""


def stands_free(mission: MissionIR, drone: Drone) -> bool:
    """Return whether a home, and the vertical above it, is clear of obstacles and apart from the
    other homes.
    """
    others = (other.home for other in mission.drones if other.name != drone.name)
    apart = all(dist(drone.home, home) >= mission.rules.separation - ROUNDING_M for home in others)
    return apart and all(_obstructed(mission, drone, o) is None for o in clearances_of(mission, drone))


def _obstructed(mission: MissionIR, drone: Drone, obstacle: Clearance) -> tuple[str, str] | None:
    """Return the obstacle at a home, and the numbers, as two texts; None where there is none."""
    top = max(drone.home[2], mission.lowest(drone.home, drone.radius))
    distance = take_off_room(drone.home, top, obstacle)
    if distance >= drone.radius - ROUNDING_M:
        return None
    if obstacle.inside:
        where = f"{distance:.2f} m from its border" if distance > 0 else f"{abs(distance):.2f} m outside"
        note = f"the take-off is {where}; the body radius of {drone.radius:.2f} m must be free"
        return f"the home of `{drone.name}` is outside keep-in zone `{obstacle.owner.name}`", note
    where = "in" if signed_distance(obstacle.solid, drone.home) < drone.radius else "under"
    reach = (
        f"comes within {nearer_than(distance, drone.radius)} m"
        if distance > 0
        else f"reaches {-distance:.2f} m into it"
    )
    note = (
        f"between the ground and {top:.2f} m it {reach}; the body radius of {drone.radius:.2f} m must be free"
    )
    return f"the home of `{drone.name}` is {where} {obstacle.owner.words}", note


def take_off_room(home: Vec3, top: float, obstacle: Clearance) -> float:
    """Return the free distance around the vertical from a pad to z = ``top``, metres; negative if blocked.

    The floors of keep-in zones do not apply.
    """
    if obstacle.inside:
        walls = obstacle.solid._replace(bottom=-inf)
        return min(-signed_distance(walls, p) for p in (home, (home[0], home[1], top)))
    return signed_distance(obstacle.solid, _nearest_level(home, top, obstacle))


def _remedy(mission: MissionIR, drone: Drone, obstacle: Clearance) -> str:
    """Return the move to the nearest place at the same height with a free take-off, if there is one
    nearby.
    """
    home = drone.home
    moves = obstacle._replace(metres=drone.radius).ways_out(home)
    places = [outward(home, (x, y, home[2])) for x, y, _ in moves if (x, y) != home[:2]]
    around = clearances_of(mission, drone)
    free = [q for q in places if all(_obstructed(mission, drone._replace(home=q), o) is None for o in around)]
    if not free:
        return "move the home, or the obstacle"
    return move(home, min(free, key=lambda q: dist(home, q)))


def _nearest_level(home: Vec3, top: float, obstacle: Clearance) -> Vec3:
    """Return the place of the vertical take-off that is nearest to an obstacle, or deepest in it."""
    low, high = max(home[2], obstacle.solid.bottom), min(top, obstacle.solid.top)
    if low > high:  # it is wholly above the take-off, or wholly below
        return (home[0], home[1], top if obstacle.solid.bottom > top else home[2])
    return (home[0], home[1], (low + high) / 2)

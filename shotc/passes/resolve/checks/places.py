"""Checks of keyframes: above the ground, outside of keep-out zones and targets, inside keep-in zones.

Keyframes that the user placed bind, so a fault is an error. A generated path is an ideal that the plan may
leave: a part of it in an obstacle is a warning, all of it is an error. Its altitude is the user's number, so
the ground binds it as well.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator
from functools import cache, partial

from shotc.diag.model import Diagnostic, Label
from shotc.ir.drone import Drone
from shotc.ir.mission import Keyframe, MissionIR, Shot
from shotc.ir.origin import KeyPath
from shotc.passes.resolve.checks.clear_path import ParameterChange, clear_path
from shotc.passes.resolve.checks.move_out import move_out
from shotc.planning.clearances import ROUNDING_M, Clearance, clearances_of
from shotc.rounding import at_least

ROOM_M = 0.01
"""Metres above the ground's clearance to which a low keyframe is to be raised.

A way that dips to a keyframe on the clearance itself leaves a refiner no room there (R012).
"""


def check_places(mission: MissionIR, shot: Shot) -> Iterator[tuple[KeyPath, Diagnostic]]:
    """Yield the faults of a shot's keyframes, one per key path and obstacle, with the key path."""
    drone = mission.drone(shot.drone)
    clear = cache(partial(clear_path, mission, shot))
    for path, keyframes in by_line(shot).items():
        for fault in too_low(mission, shot, drone, path, keyframes):
            yield path, fault
        raised = [_raised(k, mission.lowest(k.at, drone.radius)) for k in keyframes]
        for obstacle in clearances_of(mission, drone):
            for fault in blocked(mission, shot, raised, obstacle, clear):
                yield path, fault


def by_line(shot: Shot) -> dict[KeyPath, list[Keyframe]]:
    """Return keyframes grouped by key path; generated ones and those of a file share one."""
    groups: dict[KeyPath, list[Keyframe]] = defaultdict(list)
    for keyframe in shot.keyframes:
        groups[keyframe.path].append(keyframe)
    return groups


def _raised(keyframe: Keyframe, floor: float) -> Keyframe:
    """Return a keyframe raised to the floor, so that each fault is reported once."""
    x, y, z = keyframe.at
    return keyframe if z >= floor else keyframe._replace(at=(x, y, floor))


def too_low(
    mission: MissionIR, shot: Shot, drone: Drone, path: KeyPath, keyframes: list[Keyframe]
) -> Iterator[Diagnostic]:
    """Yield the fault of the keyframe that is nearest to the ground, if it is too near."""
    lowest = min(keyframes, key=lambda k: k.at[2] - mission.ground(k.at[0], k.at[1]))
    floor, need = mission.lowest(lowest.at, drone.radius), mission.rules.over_ground(drone.radius)
    z = lowest.at[2] - floor + need
    if z >= need - ROUNDING_M:
        return
    where = f"{-z:.2f} m underground" if z < 0 else f"{z:.2f} m over the ground"
    note = (
        f"the ground clearance of {mission.rules.ground_clearance:.2f} m and the body radius of "
        f"{drone.radius:.2f} m need {need:.2f} m"
    )
    label = _label(mission, shot, lowest)
    if not lowest.placed and (*shot.path, "altitude") in mission.origins.values:
        label = mission.origins.value((*shot.path, "altitude"))
    message = f"{_what(shot, lowest)} is too low: {where}"
    notes = (note, *_over_ground(mission, lowest, floor))
    to = f"to z = {at_least(floor + ROOM_M)}" if lowest.beside is None else "that is, its offset or altitude"
    help_ = f"raise it by {at_least(need - z + ROOM_M)} m, {to}"
    yield Diagnostic("G001", message, (label,), notes, help_)


def _over_ground(mission: MissionIR, keyframe: Keyframe, floor: float) -> tuple[str, ...]:
    """Return a note if a file's elevation would be valid as a height above ground."""
    alt, z = _altitude(mission), keyframe.at[2]
    if keyframe.path[-1] != "file" or z >= 0 or z + alt < floor:
        return ()
    return (
        f"a GPX file's elevations count from sea level, as the origin's {alt:.0f} m do; "
        f"{z + alt:.1f} m looks like a height over the ground, which a CSV file of lat,lon,height gives",
    )


def _from_sea(mission: MissionIR, z: float, obstacle: Clearance) -> tuple[str, ...]:
    """Return a note if a height would be valid as one above sea level."""
    alt = _altitude(mission)
    if not obstacle.inside or z <= obstacle.solid.top or z - alt < obstacle.solid.bottom:
        return ()
    if z - alt > obstacle.solid.top:
        return ()
    return (
        f"heights count from the ground at the origin; {z:.1f} m above sea level would be z = {z - alt:.1f}",
    )


def _altitude(mission: MissionIR) -> float:
    return 0.0 if mission.origin is None else mission.origin.alt


def blocked(
    mission: MissionIR,
    shot: Shot,
    keyframes: list[Keyframe],
    obstacle: Clearance,
    clear: Callable[[], list[ParameterChange]],
) -> Iterator[Diagnostic]:
    """Yield the fault of keyframes that an obstacle blocks; ``clear`` finds changes that clear a path."""
    drone = mission.drone(shot.drone)
    lacking = [k for k in keyframes if obstacle.lack(k.at) > ROUNDING_M]
    if not lacking:
        return
    worst = max(lacking, key=lambda k: obstacle.lack(k.at))
    ideal = not worst.placed
    changes = clear() if ideal else []
    label = mission.origins.value((*shot.path, changes[0].key)) if changes else _label(mission, shot, worst)
    labels = (label, mission.origins.key(obstacle.owner.path, "the obstacle"))
    free = " or ".join(f"{change}" for change in changes)
    free = f"write {free}" if changes else obstacle.free_of()
    place = ", ".join(f"{c:.1f}" for c in worst.at)
    notes: tuple[str, ...] = (obstacle.measure(worst.at, drone.radius),)
    if len(keyframes) > 1:
        notes = (*notes, f"{len(lacking)} of {len(keyframes)} points have this fault; the worst is [{place}]")
    if ideal and len(lacking) < len(keyframes):
        message = f"the ideal path of this {shot.kind} {obstacle.relation(worst.at)}"
        help_ = f"the plan will leave the ideal here; to keep it, {free}"
        yield Diagnostic("G016", message, labels, notes, help_)
        return
    notes = (*notes, *_from_sea(mission, worst.at[2], obstacle))
    help_ = free if ideal else move_out(mission, shot, worst, obstacle)
    message = f"{_what(shot, worst)} {obstacle.relation(worst.at)}"
    yield Diagnostic(_code(obstacle), message, labels, notes, help_)


def _code(obstacle: Clearance) -> str:
    if obstacle.inside:
        return "G003"
    return "G004" if obstacle.owner.kind == "target" else "G002"


def _what(shot: Shot, keyframe: Keyframe) -> str:
    if not keyframe.placed:
        return f"the path of this {shot.kind}"
    return "the keyframe" if shot.kind == "keyframes" else "the camera"


def _label(mission: MissionIR, shot: Shot, keyframe: Keyframe) -> Label:
    return mission.origins.value((*keyframe.path, "at"))

"""Checks of pads: apart from each other and from other fleets', on the ground, with a free vertical above."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from math import ceil, dist
from typing import NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.geom.apart import spacing
from shotc.geom.colouring import fewest_colours
from shotc.geom.pads import first_nearer, nearest_pair
from shotc.ir.limits import Vec2, Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.origin import KeyPath
from shotc.ir.show import Apart, Fleet, whole_fleets
from shotc.passes.resolve.checks.home import take_off_room
from shotc.planning.clearances import ROUNDING_M, Clearance, clearances_of
from shotc.planning.take_off import MOST_LAYERS, bodies_of, take_off_of
from shotc.rounding import at_least, up
from shotc.show.labels import pads_path, wider

UNEVEN_M = 0.1  # metres below z = 0 that are accepted: lawn, earth curvature within a kilometre
FARTHEST_M = 60  # largest distance of the search for a free place, metres
MANY_DRONES = 400  # most drones for which a free place is searched for


class _Shift(NamedTuple):
    """A move of a fleet's pads by metres along an axis (0: x, 1: y), and the direction in words."""

    by: float
    axis: int
    direction: str


class _Floor(NamedTuple):
    """The least height of drones, the height of their lowest pad, metres, and what asks for it."""

    least: float
    pad: float
    words: str
    path: KeyPath


def check_pads(mission: MissionIR) -> Iterator[Diagnostic]:
    """Yield the faults of each fleet's pads, and of those between different fleets."""
    groups, mission = mission.fleets, mission._replace(fleets=whole_fleets(mission.fleets))
    spaced: list[Fleet] = []
    for fleet in mission.fleets:
        crowded = _crowded(mission, fleet)
        if crowded is not None:
            yield crowded
            continue
        spaced.append(fleet)
        yield from _placed(mission, fleet)
        yield from _mixed(mission, fleet, [part for part in groups if part.path == fleet.path])
    for one, other in combinations(spaced, 2):
        near = _too_near(mission, one, other)
        if near is not None:
            yield near


def _crowded(mission: MissionIR, fleet: Fleet) -> Diagnostic | None:
    """Return the fault of the two nearest pads of a fleet, with a sufficient spacing, or None."""
    if nearest_pair(fleet.pads, fleet.apart) is None:
        return None
    bodies, level = bodies_of(fleet), [(x, y, 0.0) for x, y, _ in fleet.pads]
    nearest = nearest_pair(level, bodies)
    if nearest is None:
        return _many_layers(mission, fleet)
    distance = dist(level[nearest.one], level[nearest.other])
    which = f"pads {nearest.one + 1} and {nearest.other + 1} are {distance:.2f} m apart"
    help_ = wider(mission, fleet, bodies.across)
    if dist(fleet.pads[nearest.one], fleet.pads[nearest.other]) < 2 * fleet.radius:
        note = f"{which}, and each body has a radius of {fleet.radius:.2f} m"
        message = f"drones of {fleet.words} stand inside each other"
        return Diagnostic("D002", message, (_layout(mission, fleet),), (note,), help_)
    note = (
        f"{which}, as seen from above; bodies with a radius of {fleet.radius:.2f} m that rise past each "
        f"other ask for {_needed(bodies)}"
    )
    message = f"the pads of {fleet.words} are too near to each other"
    return Diagnostic("D001", message, (_layout(mission, fleet),), (note,), help_)


def _mixed(mission: MissionIR, fleet: Fleet, groups: Sequence[Fleet]) -> Iterator[Diagnostic]:
    """Yield the first two groups of a fleet whose pads are nearer to each other than the separation.

    Each group takes off in its own layers, for its own pictures, so others have to keep clear of it.
    """
    reach = fleet.apart.across
    for one, other in combinations(groups, 2):
        near = first_nearer(one.pads, other.pads, reach)
        if near is None:
            continue
        message = f"pads of {one.words} and {other.words} are too near to each other"
        labels = (
            _layout(mission, fleet),
            mission.origins.key(max(one.key, other.key, key=len), "the groups"),
        )
        first, second = one.numbers[near.one], other.numbers[near.other]
        note = (
            f"pads {first} and {second} are {near.share * reach:.2f} m apart; {_needed(fleet.apart)} is "
            "asked for between drones that do not take off together"
        )
        help_ = (
            f"{wider(mission, fleet, spacing(fleet.apart))}, or leave that much room between the pads of the "
            "groups, in a layout from a file"
        )
        yield Diagnostic("D137", message, labels, (note,), help_)
        return


def _many_layers(mission: MissionIR, fleet: Fleet) -> Diagnostic | None:
    """Return the fault of so many pads within one separation that there are too many layers, or None."""
    across = fleet.apart.across
    layers = fewest_colours([(x, y) for x, y, _ in fleet.pads], across)
    if layers <= MOST_LAYERS:
        return None
    note = (
        f"within the fleet's separation of {_needed(fleet.apart)} are {layers} pads: it would take off in as "
        f"many layers or more, and {MOST_LAYERS} is the most"
    )
    message = f"the pads of {fleet.words} are too near to each other"
    help_ = f"{wider(mission, fleet, spacing(fleet.apart))}, from where all rise at once, or ask for less"
    return Diagnostic("D001", message, (_layout(mission, fleet),), (note,), help_)


def _needed(apart: Apart) -> str:
    margin = f", its margin of {apart.margin:.2f} m included" if apart.margin else ""
    return f"{apart.across:.2f} m side by side{margin}"


def _layout(mission: MissionIR, fleet: Fleet) -> Label:
    """Return a label on the number, or the file, that determines the distance of pads."""
    path = (*fleet.path, "layout")
    keys = (("grid", "spacing"), ("circle", "radius"), ("file",))
    written = ((*path, *key) for key in keys if (*path, *key) in mission.origins.values)
    return mission.origins.value(next(written, path))


def _place(mission: MissionIR, fleet: Fleet, text: str = "") -> Label:
    """Return a label on what determines the position of the pads."""
    return mission.origins.value(pads_path(mission, fleet), text)


def _too_near(mission: MissionIR, one: Fleet, other: Fleet, *, advise: bool = True) -> Diagnostic | None:
    """Return the fault of pads of two fleets that are nearer than the wider separation of the two, or None.

    advise : whether to search for another place
    """
    apart = max((one.apart, other.apart), key=lambda a: a.across)
    near = first_nearer(one.pads, other.pads, apart.across)
    if near is None:
        return None
    message = f"the pads of fleets `{one.name}` and `{other.name}` are too near to each other"
    labels = (_place(mission, other), _place(mission, one, "the other fleet"))
    which = f"pad {near.one + 1} of `{one.name}` and pad {near.other + 1} of `{other.name}`"
    note = f"{which} are {near.share * apart.across:.2f} m apart; {_needed(apart)} is asked for"
    help_ = _moved(mission, one, other) if advise else ""
    return Diagnostic("D005", message, labels, (note,), help_)


def _moved(mission: MissionIR, one: Fleet, other: Fleet) -> str:
    return _beside(mission, one, other) or _beside(mission, other, one) or "move one of the fleets"


def _beside(mission: MissionIR, standing: Fleet, moved: Fleet) -> str:
    """Return the shortest shift along a grid axis that clears a fleet of all others, in words; empty
    if none.
    """
    reach = max(standing.apart.across, moved.apart.across)
    moves: list[_Shift] = []
    for axis, (back, on) in enumerate((("west", "east"), ("south", "north"))):
        low, high = min(p[axis] for p in standing.pads), max(p[axis] for p in standing.pads)
        first, last = min(p[axis] for p in moved.pads), max(p[axis] for p in moved.pads)
        moves += [
            _Shift(up(high + reach - first), axis, on),
            _Shift(-up(last + reach - low), axis, back),
        ]
    for by, axis, direction in sorted(moves, key=lambda shift: abs(shift.by)):
        x, y = (by, 0.0) if axis == 0 else (0.0, by)
        there = _displaced(mission, moved, (x, y))
        others = [fleet for fleet in mission.fleets if fleet.name != moved.name]
        if not any(_too_near(mission, fleet, there, advise=False) for fleet in others) and rises(
            mission, there
        ):
            return f"move `{moved.name}` {abs(by):.2f} m {direction}{_anchored(mission, moved, there)}"
    return ""


def _anchored(mission: MissionIR, fleet: Fleet, there: Fleet) -> str:
    """Return what to write for a layout that is moved; empty for one from a file."""
    path = (*fleet.path, "layout")
    stand = mission.terrain is not None and all(abs(h) < UNEVEN_M for h in over_ground(mission, there))
    axes = 2 if stand else 3
    if (*path, "grid") in mission.origins.keys:
        return f", to `origin: [{', '.join(f'{c + 0.0:.2f}' for c in there.pads[0][:axes])}]`"
    if (*path, "circle") in mission.origins.keys and len(there.pads) > 1:
        middle = (sum(p[i] for p in there.pads) / len(there.pads) for i in range(axes))
        return f", to `center: [{', '.join(f'{c + 0.0:.2f}' for c in middle)}]`"
    return ""


def _placed(mission: MissionIR, fleet: Fleet) -> Iterator[Diagnostic]:
    """Yield the faults of the position of pads: underground, below obstacles, or with too low a rise."""
    label = _place(mission, fleet)
    over = over_ground(mission, fleet)
    deepest = min(range(len(over)), key=over.__getitem__)
    deep = -over[deepest]
    if deep > UNEVEN_M:
        x, y, z = fleet.pads[deepest]
        ground = f"z = {round(z + deep, 2) + 0.0:g}"
        note = f"pad {deepest + 1} is {deep:.2f} m under {ground}, the ground"
        if mission.terrain is not None:
            note += f" at [{x:.1f}, {y:.1f}]"
        message = f"{fleet.words} stands underground"
        higher = _shifted(fleet, (0.0, 0.0, up(deep)))
        help_ = f"raise the layout by {at_least(deep)} m{_anchored(mission, fleet, higher)}"
        if mission.terrain is not None:
            help_ += ", or leave its height out: every pad then stands on the ground at its place"
        yield Diagnostic("D006", message, (label,), (note,), help_)
        return
    obstacles = clearances_of(mission, fleet)
    blocked = [fault for obstacle in obstacles if (fault := _blocked(mission, fleet, obstacle)) is not None]
    yield from blocked
    if not blocked:
        yield from _low_rise(mission, fleet, obstacles, min(over))
    yield from _high_layers(mission, fleet, over)


def over_ground(mission: MissionIR, fleet: Fleet) -> list[float]:
    """Return how high pads are over the ground at their places, metres, negative below it."""
    return [z - mission.ground(x, y) for x, y, z in fleet.pads]


def _blocked(mission: MissionIR, fleet: Fleet, obstacle: Clearance) -> Diagnostic | None:
    """Return the fault of pads with an obstacle in or above them: how many, and the worst, or None."""
    tops = take_off_of(fleet)
    rooms = [take_off_room(pad, pad[2] + tops.top(i), obstacle) for i, pad in enumerate(fleet.pads)]
    lacking = [i for i, distance in enumerate(rooms) if distance < fleet.radius - ROUNDING_M]
    if not lacking:
        return None
    worst = min(lacking, key=lambda i: rooms[i])
    who = f"{len(lacking)} of {len(fleet.pads)} drones of {fleet.words}"
    if obstacle.inside:
        message = f"{who} do not rise inside keep-in zone `{obstacle.owner.name}`"
    else:
        message = f"{who} cannot rise clear of {obstacle.owner.words}"
    labels = (_place(mission, fleet), mission.origins.key(obstacle.owner.path, "the obstacle"))
    note = _least_room(fleet, obstacle, worst, rooms[worst])
    return Diagnostic("D006", message, labels, (note,), _cleared(mission, fleet))


def _cleared(mission: MissionIR, fleet: Fleet) -> str:
    """Return the shortest shift along a grid axis after which all drones of a fleet can take off, in
    words.
    """
    others = [other for other in mission.fleets if other.name != fleet.name]

    def free(there: Fleet) -> bool:
        return rises(mission, there) and not any(
            _too_near(mission, other, there, advise=False) for other in others
        )

    if len(fleet.pads) > MANY_DRONES:
        return "move the layout, or the obstacle"
    for metres in range(1, FARTHEST_M + 1):
        for x, y, toward in ((1, 0, "east"), (-1, 0, "west"), (0, 1, "north"), (0, -1, "south")):
            there = _displaced(mission, fleet, (float(x * metres), float(y * metres)))
            if free(there):
                return (
                    f"move the layout {metres} m {toward}{_anchored(mission, fleet, there)}, or the obstacle"
                )
    return "move the layout, or the obstacle"


def rises(mission: MissionIR, fleet: Fleet) -> bool:
    """Return whether all drones of a fleet can take off from their pads."""
    least = fleet.radius - ROUNDING_M
    around, tops = clearances_of(mission, fleet), take_off_of(fleet)
    pads = [(pad, pad[2] + tops.top(i)) for i, pad in enumerate(fleet.pads)]
    return all(take_off_room(pad, top, o) >= least for o in around for pad, top in pads)


def _shifted(fleet: Fleet, by: Vec3) -> Fleet:
    x, y, z = by
    return fleet._replace(pads=tuple((px + x, py + y, pz + z) for px, py, pz in fleet.pads))


def _displaced(mission: MissionIR, fleet: Fleet, by: Vec2) -> Fleet:
    """Return a fleet moved on the map, each pad as high over the ground as it was."""
    over, there = over_ground(mission, fleet), _shifted(fleet, (*by, 0.0))
    pads = zip(there.pads, over, strict=True)
    return there._replace(pads=tuple((x, y, mission.ground(x, y) + height) for (x, y, _), height in pads))


def _least_room(fleet: Fleet, obstacle: Clearance, worst: int, distance: float) -> str:
    """Return the numbers of the pad with the least distance, as a note."""
    (x, y, _), top = fleet.pads[worst], take_off_of(fleet).top(worst)
    if obstacle.inside:
        where = f"{distance:.2f} m from its border" if distance > 0 else f"{-distance:.2f} m outside"
    else:
        where = f"{distance:.2f} m away from it" if distance > 0 else f"{abs(distance):.2f} m deep in it"
    return (
        f"worst is pad {worst + 1} at [{x:.1f}, {y:.1f}]: on its {top:.1f} m up it is {where}; the "
        f"body radius of {fleet.radius:.2f} m must be free"
    )


def _high_layers(mission: MissionIR, fleet: Fleet, over: Sequence[float]) -> Iterator[Diagnostic]:
    """Yield the fault of a fleet whose highest layer of take-off is above the mission's height limit.

    over : heights of its pads above the ground, metres
    """
    most, take_off = mission.rules.max_height, take_off_of(fleet)
    if most is None or not take_off.layered:
        return
    high = max(height + take_off.top(i) for i, height in enumerate(over))
    if high <= most + ROUNDING_M:
        return
    layers = len(take_off.heights)
    message = f"{fleet.words} takes off in {layers} layers, the highest above what the mission allows"
    labels = (_layout(mission, fleet), mission.origins.value(("rules", "max_height"), "the rule"))
    note = (
        f"its pads are nearer than its separation, so its layers stand {take_off.step:.2f} m above each "
        f"other, the lowest {fleet.rise:.2f} m above its pads; the highest is {high:.2f} m above the ground"
    )
    at_once = wider(mission, fleet, spacing(fleet.apart))
    help_ = f"{at_once}, from where all rise at once, or write `rules: {{max_height: {ceil(high)}}}`"
    yield Diagnostic("D027", message, labels, (note,), help_)


def _low_rise(
    mission: MissionIR, fleet: Fleet, obstacles: Sequence[Clearance], over: float
) -> Iterator[Diagnostic]:
    """Yield the fault of a rise that ends at a height at which the drones may not fly yet.

    over : height of the lowest pad above the ground, metres
    """
    lowest = min(z for _, _, z in fleet.pads)
    floors = [
        _Floor(mission.rules.ground_clearance, over, "the ground clearance", ("rules", "ground_clearance"))
    ]
    floors += [
        _Floor(o.solid.bottom, lowest, f"the floor of {o.owner.words}", o.owner.path)
        for o in obstacles
        if o.inside
    ]
    least, pad, what, path = max(floors, key=lambda floor: floor.least - floor.pad)
    lacks = least + fleet.radius - pad - fleet.rise
    if lacks <= ROUNDING_M:
        return
    label = mission.origins.value((*fleet.path, "rise"))
    # Over terrain heights are over the ground; elsewhere that is z.
    z = "" if path[-1] == "ground_clearance" and mission.terrain is not None else "z = "
    unit = "" if z else " m over the ground"
    note = (
        f"it rises {fleet.rise:.2f} m to {z}{pad + fleet.rise:.2f}{unit}; {what} of {least:.2f} m and the "
        f"body radius of {fleet.radius:.2f} m need {z}{least + fleet.radius:.2f}{unit}"
    )
    labels = (label, mission.origins.key(path, what)) if path in mission.origins.keys else (label,)
    message = f"{fleet.words} does not rise high enough to fly"
    yield Diagnostic(
        "D007", message, labels, (note,), f"write `rise: {at_least(fleet.rise + lacks)} m` or more"
    )

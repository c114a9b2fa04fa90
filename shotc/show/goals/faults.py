"""Diagnostics of pictures that cannot be flown: too many drones, too few, or an obstacle."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic, Label
from shotc.geom.bernstein import Array
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.owners import GROUND
from shotc.ir.show import Display, Drawing, Fleet, Lettering, Picture
from shotc.planning.clearances import ROUNDING_M, Clearance
from shotc.rounding import at_least, at_most
from shotc.show.goals.body import SourceFault
from shotc.show.goals.remedies import PictureRemedies
from shotc.show.goals.room import DisplaySurroundings, lack_of, least_shift
from shotc.show.goals.spaced import SpacingTask
from shotc.show.goals.surfaces import OverTerrain, Standing
from shotc.show.labels import word_of

BETWEEN_SHARES = (0.0, 0.25, 0.5, 0.75)
"""Shares of the path from a picture's middle to its goals, at which places inside it are examined."""
FEWEST_DRONES = 8
"""Least drones that show a solid: those at the corners of a box."""


def place_of(mission: MissionIR, picture: Picture, key: str = "") -> Label:
    """Return the label on a key of a picture's source, or on the nearest written key."""
    word = word_of(picture)
    paths = [(*picture.path, word, key), (*picture.path, key), (*picture.path, word), picture.path]
    written = next((path for path in paths if path in mission.origins.values), picture.path)
    return mission.origins.value(written)


def of_source(mission: MissionIR, picture: Picture, fault: SourceFault) -> Diagnostic:
    """Return the diagnostic of a faulty source."""
    label = place_of(mission, picture, fault.key)
    return Diagnostic(fault.code, fault.message, (label,), fault.notes, fault.help)


def no_points(mission: MissionIR, picture: Picture) -> Diagnostic:
    """Return D060: the picture has no points for its fill."""
    flat = isinstance(picture.source, Lettering | Drawing)
    help_ = "use `fill: surface`" if picture.fill == "volume" else "use `fill: volume`"
    if flat or picture.fill == "surface":
        help_ = "use `fill: outline`" if flat and picture.fill != "outline" else "draw something else"
    elif picture.fill == "outline":
        help_ = "use `fill: surface`"
    label = mission.origins.value((*picture.path, "fill"))
    name = word_of(picture)
    what = {"volume": "inside", "surface": "surface", "outline": "edges"}[picture.fill]
    note = f"`fill: {picture.fill}` puts drones along the {what}"
    return Diagnostic("D060", f"this {name} has no {what} to stand in", (label,), (note,), help_)


def too_few_points(mission: MissionIR, picture: Picture, points: int, number: int) -> Diagnostic:
    """Return D061: a point cloud has too few points."""
    message = f"a point cloud of {points} points cannot show {number} drones"
    help_ = f"give a denser cloud or a mesh, or at most {points} drones"
    return Diagnostic("D061", message, (place_of(mission, picture, "files"),), (), help_)


def viewpoint_inside(mission: MissionIR, display: Display, picture: Picture) -> Diagnostic:
    """Return D059: the viewpoint is inside the picture."""
    labels = (
        mission.origins.value((*display.path, "viewpoint")),
        place_of(mission, picture)._replace(text="the picture"),
    )
    return Diagnostic(
        "D059",
        "the viewpoint is inside the picture",
        labels,
        ("there is no line of sight to a picture from within",),
        "move the `viewpoint` to where the audience is, or leave it out",
    )


def too_many(
    mission: MissionIR, fleet: Fleet, picture: Picture, remedies: PictureRemedies, setting: SpacingTask
) -> Diagnostic:
    """Return D056: a fleet does not fit into a picture, with the number that would and other remedies."""
    message = f"{len(fleet.pads)} drones do not fit into the picture"
    if remedies.number is not None:
        message += f"; about {remedies.number} would"
    labels = (place_of(mission, picture), mission.origins.key(fleet.path, "the fleet"))
    return Diagnostic(
        "D056", message, labels, (apart(setting),), _remedies(fleet, remedies, "show another picture")
    )


def too_dark(
    mission: MissionIR,
    fleet: Fleet,
    picture: Picture,
    remedies: PictureRemedies,
    number: int,
    setting: SpacingTask,
) -> Diagnostic:
    """Return D062, a warning on drones that stay dark because the picture has no room."""
    dark, full = len(fleet.pads) - number, len(fleet.pads)
    message = f"{dark} of {full} drones find no room in the picture and stay dark, behind it"
    labels = (place_of(mission, picture), mission.origins.key(fleet.path, "the fleet"))
    help_ = _remedies(fleet, remedies, "make it larger")
    return Diagnostic("D062", message, labels, (apart(setting),), help_)


def apart(setting: SpacingTask) -> str:
    """Return the distance of goals and its reason, in words."""
    upright = setting.least / setting.stretch
    far = f"{setting.least:.2f} m apart on a level and {upright:.2f} m one above the other"
    if setting.least < setting.straight:
        return f"goals are as near as the separation allows, {far}"
    return f"so that drones can pass each other on straight ways, goals are {far}"


def _remedies(fleet: Fleet, advice: PictureRemedies, otherwise: str) -> str:
    remedies = []
    if advice.number is not None:
        remedies.append(
            f"use {advice.number} drone{'' if advice.number == 1 else 's'} (`count: {advice.number}`)"
        )
    if advice.size is not None:
        remedies.append(f"make it {at_least(advice.size[1])} times as large (`{advice.size[0]}`)")
    if advice.share is not None:
        full = (fleet.apart.across, fleet.apart.upright)
        level, upright = (at_most(advice.share * distance - fleet.apart.margin) for distance in full)
        remedies.append(f"keep a `separation` of {level} m, {upright} m vertically")
    return ", or ".join(remedies) or otherwise


def too_few(mission: MissionIR, fleet: Fleet, picture: Picture) -> Diagnostic | None:
    """Return D057, a warning on a fleet too small to show a shape; None if it is large enough."""
    number = len(fleet.pads)
    if number >= FEWEST_DRONES:
        return None
    note = f"fewer than {FEWEST_DRONES} lights look alike, whatever they show"
    drones = "drone is" if number == 1 else "drones are"
    message = f"{number} {drones} too few to show a shape"
    label = (place_of(mission, picture),)
    return Diagnostic(
        "D057", message, label, (note,), f"use {FEWEST_DRONES} drones (`count: {FEWEST_DRONES}`) or more"
    )


def in_the_way(
    mission: MissionIR,
    fleet: Fleet,
    picture: Picture,
    frames: Sequence[Array],
    surroundings: DisplaySurroundings,
) -> list[Diagnostic]:
    """Return one fault for each obstacle that contains goals of a picture's frames, (n, 3) each, and one for
    the ground.
    """
    goals = np.concatenate(frames)
    if not (surroundings.lack(goals) > ROUNDING_M).any():
        return []
    # With an obstacle between its goals, drones would have to avoid it during their moves.
    shift = least_shift(_whole(goals), surroundings)
    shift = least_shift(goals, surroundings) if shift is None else shift
    help_ = "make the picture smaller, or place it elsewhere" if shift is None else _moved(picture, shift)
    label = place_of(mission, picture, "center")
    diagnostics: list[Diagnostic] = []
    low = float(goals[:, 2].min())
    if low < surroundings.lowest - ROUNDING_M:
        count = int((goals[:, 2] < surroundings.lowest - ROUNDING_M).sum()) // len(frames) or 1
        note = (
            f"its lowest goal is {low:.2f} m up; `rules.ground_clearance` and the body radius of "
            f"{fleet.radius:.2f} m ask for {surroundings.lowest:.2f} m"
        )
        message = f"the picture is too low: {_of(count, fleet)}"
        diagnostics.append(Diagnostic("D058", message, (label,), (note,), help_))
    about = _Obstructed(mission, fleet, label, help_, len(frames))
    for obstacle in surroundings.obstacles:
        diagnostics += _at_obstacle(obstacle, goals, about)
    for surface in surroundings.surfaces:
        diagnostics += _at_surface(surface, goals, about)
    return diagnostics


class _Obstructed(NamedTuple):
    """A picture with something in its way: the label and the help of its faults, and its number of frames."""

    mission: MissionIR
    fleet: Fleet
    label: Label
    help: str
    frames: int


def _whole(goals: Array) -> Array:
    """Return goals (n, 3) with places between them: towards the middle, and between neighbours."""
    middle = goals.mean(axis=0)
    rays = [middle + share * (goals - middle) for share in BETWEEN_SHARES]
    rows = [goals[np.lexsort((goals[:, (k + 1) % 3], goals[:, k]))] for k in range(3)]
    return np.concatenate([goals, *rays, *(0.5 * (row[1:] + row[:-1]) for row in rows)])


def _at_obstacle(obstacle: Clearance, goals: Array, about: _Obstructed) -> list[Diagnostic]:
    mission, fleet, label, help_, frames = about
    lack = lack_of(obstacle, goals)
    if not (lack > ROUNDING_M).any():
        return []
    worst = goals[int(lack.argmax())]
    place = (float(worst[0]), float(worst[1]), float(worst[2]))
    count = int((lack > ROUNDING_M).sum()) // frames or 1
    message = f"the picture {obstacle.relation(place)}: {_of(count, fleet)}"
    note = f"the worst is at [{place[0]:.2f}, {place[1]:.2f}, {place[2]:.2f}]: "
    labels = (label, mission.origins.key(obstacle.owner.path, "the obstacle"))
    return [Diagnostic("D058", message, labels, (note + obstacle.measure(place, fleet.radius),), help_)]


def _at_surface(surface: Standing, goals: Array, about: _Obstructed) -> list[Diagnostic]:
    mission, fleet, label, help_, frames = about
    lack = surface.lack(goals)
    if not (lack > ROUNDING_M).any():
        return []
    k = int(lack.argmax())
    worst = goals[k]
    x, y, z = (float(c) for c in worst)
    owner = surface.owner_at(worst)
    count = int((lack > ROUNDING_M).sum()) // frames or 1
    labels = (
        label,
        *((mission.origins.key(owner.path, "the obstacle"),) if owner.path != GROUND.path else ()),
    )
    note = f"the worst is at [{x:.2f}, {y:.2f}, {z:.2f}]: "
    if isinstance(surface, OverTerrain):
        message = f"the picture is too {'high' if surface.kept.flipped else 'low'}: {_of(count, fleet)}"
        note += _over_ground(mission, fleet, (x, y, z), highest=surface.kept.flipped)
    else:
        message = f"the picture is too close to {owner.words}: {_of(count, fleet)}"
        note += f"{at_least(float(lack[k]))} m are missing of the {surface.clearance:.2f} m that must be free"
    return [Diagnostic("D058", message, labels, (note,), help_)]


def _over_ground(mission: MissionIR, fleet: Fleet, place: Vec3, *, highest: bool) -> str:
    """Say how high a place is over the ground, and how high it may be."""
    terrain = mission.terrain
    ground = None if terrain is None else terrain.height(place[0], place[1])
    if ground is None:
        return "there is no ground"
    here = f"{place[2] - ground:.2f} m over the ground, which is z = {ground:.2f}"
    if highest:
        return f"{here}; `rules.max_height` allows {mission.rules.max_height or 0.0:.2f} m"
    return (
        f"{here}; `rules.ground_clearance` and the body radius of {fleet.radius:.2f} m ask for "
        f"{mission.rules.over_ground(fleet.radius):.2f} m"
    )


def _of(count: int, fleet: Fleet) -> str:
    return f"{count} of {len(fleet.pads)} goals"


def _moved(picture: Picture, shift: Array) -> str:
    words = ", ".join(f"{c + 0.0:.2f}" for c in shift)
    centre = picture.source.centre
    if centre is None:
        return f"shift it by [{words}]"
    to = ", ".join(f"{c + d + 0.0:.2f}" for c, d in zip(centre, shift, strict=True))
    return f"shift it by [{words}], to `center: [{to}]`"

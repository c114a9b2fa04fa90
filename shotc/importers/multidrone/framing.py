"""What a role says of the picture: which third the target stands in, and how large it is."""

from __future__ import annotations

from math import cos, hypot, sin

from shotc.importers.multidrone.frames import Place
from shotc.importers.multidrone.read import Role
from shotc.importers.multidrone.targets import GroundTrack
from shotc.importers.notes import Notes, plain

THIRDS = "RULE_OF_THIRDS"
CENTRED = frozenset(("", "CENTRAL", "CENTER", "CENTERED", "CENTRED"))
ASIDE = 0.25  # sine of the angle between a view and a motion from which the motion goes to a side

# The dashboard's names of framings, and the nearest name of ours; None where it says no size.
SIZES: dict[str, str | None] = {
    "FRAMING_TYPE_ELS": "establishing",
    "FRAMING_TYPE_VLS": "long",
    "FRAMING_TYPE_LS": "long",
    "FRAMING_TYPE_FS": "full",
    "FRAMING_TYPE_MFS": "medium-full",
    "FRAMING_TYPE_MLS": "medium-full",
    "FRAMING_TYPE_MS": "medium",
    "FRAMING_TYPE_MCU": "medium",
    "FRAMING_TYPE_CU": "close-up",
    "FRAMING_TYPE_BCU": "extreme-close-up",
    "FRAMING_TYPE_ECU": "extreme-close-up",
    "FRAMING_TYPE_OTS": None,  # over the shoulder: what is in the picture, not how large
    "FRAMING_TYPE_2S": None,
    "FRAMING_TYPE_NONE": None,
}


def size_of(role: Role, films: bool, fixed: bool, notes: Notes) -> tuple[str | None, list[str]]:
    """Return the size that a role asks for, and comments.

    films : whether it films a target; fixed : whether it also gives its distance, which then holds
    """
    if not role.framing:
        return None, []
    if not films:
        return None, [f"{plain(role.framing, 30)}: the camera watches no target, so there is no `size`"]
    if role.framing not in SIZES:
        node = role.node.first("framingTypeName") or role.node
        shown = plain(role.framing, 30)
        return None, [notes.assume(node, f"the framing `{shown}` is not known", "no `size` is asked for")]
    size = SIZES[role.framing]
    if size is None:
        return None, [f"{role.framing} says no size"]
    if fixed:
        return None, [f"{role.framing} would be `size: {size}`; the distances of the file hold instead"]
    return size, [f"{role.framing}: the nearest size is {size}"]


def composition_of(
    role: Role, course: GroundTrack, camera: Place, t: float, notes: Notes
) -> tuple[str, list[str]]:
    """Return the point on the screen where a role puts its target, and comments.

    camera : where it is at mission time t, in the middle of the shot
    """
    if role.composition in CENTRED:
        return "center", []
    if role.composition != THIRDS:
        node = role.node.first("shootingTypeName") or role.node
        shown = plain(role.composition, 30)
        return "center", [notes.assume(node, f"the composition `{shown}` is not known", "center")]
    side, why = _third(course, camera, t)
    return side, [f"{THIRDS}: {side}, {why}"]


def _third(course: GroundTrack, camera: Place, t: float) -> tuple[str, str]:
    """Return the third in which the target leaves room on the side to which it moves, and why."""
    if not course.moves(t):
        return "left-third", "for the target stands, and either side will do"
    x, y = course.at(t)
    view, way = (x - camera[0], y - camera[1]), course.heading(t)
    across = (view[0] * sin(way) - view[1] * cos(way)) / max(hypot(*view), 1e-6)
    if abs(across) < ASIDE:
        return "lower-third", "for the target moves along the view, and its way lies above it"
    if across > 0:
        return "right-third", "with the room on the left, where the target moves to"
    return "left-third", "with the room on the right, where the target moves to"

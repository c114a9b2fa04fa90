"""Convert a role's framing: the third of the picture for the target, and its size."""

from __future__ import annotations

from math import cos, hypot, sin

from shotc.importers.multidrone.frames import Place
from shotc.importers.multidrone.read import Role
from shotc.importers.multidrone.targets import GroundTrack
from shotc.importers.notes import Notes, plain

THIRDS = "RULE_OF_THIRDS"
CENTRED = frozenset(("", "CENTRAL", "CENTER", "CENTERED", "CENTRED"))
ASIDE_SINE = 0.25  # least sine of the angle between view and motion at which the motion counts as sideways

# The dashboard's names of framings, and the nearest size of shotc; None if the name implies no size.
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
    "FRAMING_TYPE_OTS": None,  # over the shoulder: it gives the content of the picture, not a size
    "FRAMING_TYPE_2S": None,
    "FRAMING_TYPE_NONE": None,
}


def size_of(role: Role, films: bool, fixed: bool, notes: Notes) -> tuple[str | None, list[str]]:
    """Return the size that a role requires, or None, and comments.

    films : whether it films a target
    fixed : whether it also gives its distance, which has priority
    """
    if not role.framing:
        return None, []
    if not films:
        return None, [f"{plain(role.framing, 30)}: the camera watches no target, so there is no `size`"]
    if role.framing not in SIZES:
        node = role.node.first("framingTypeName") or role.node
        text = plain(role.framing, 30)
        return None, [notes.assume(node, f"the framing `{text}` is not known", "no `size` is asked for")]
    size = SIZES[role.framing]
    if size is None:
        return None, [f"{role.framing} says no size"]
    if fixed:
        return None, [f"{role.framing} would be `size: {size}`; the distances of the file hold instead"]
    return size, [f"{role.framing}: the nearest size is {size}"]


def composition_of(
    role: Role, course: GroundTrack, camera: Place, t: float, notes: Notes
) -> tuple[str, list[str]]:
    """Return the composition of a role, the place of its target on screen, and comments.

    camera : its position at mission time ``t``, in the middle of the shot
    """
    if role.composition in CENTRED:
        return "center", []
    if role.composition != THIRDS:
        node = role.node.first("shootingTypeName") or role.node
        text = plain(role.composition, 30)
        return "center", [notes.assume(node, f"the composition `{text}` is not known", "center")]
    side, why = _third(course, camera, t)
    return side, [f"{THIRDS}: {side}, {why}"]


def _third(course: GroundTrack, camera: Place, t: float) -> tuple[str, str]:
    """Return the third that leaves room on the side to which the target moves, and the reason."""
    if not course.moves(t):
        return "left-third", "for the target stands, and either side will do"
    x, y = course.at(t)
    view, heading = (x - camera[0], y - camera[1]), course.heading(t)
    across = (view[0] * sin(heading) - view[1] * cos(heading)) / max(hypot(*view), 1e-6)
    if abs(across) < ASIDE_SINE:
        return "lower-third", "for the target moves along the view, and its way lies above it"
    if across > 0:
        return "right-third", "with the room on the left, where the target moves to"
    return "left-third", "with the room on the right, where the target moves to"

"""What a mission is lowered from: its text, the files it names, and what planning chose. Plain Python."""

from pathlib import Path
from typing import Literal, NamedTuple

Autopilot = Literal["px4", "ardupilot", "dji-fly", "pilot-2", "litchi"]
"""What flies a drone: an autopilot that speaks MAVLink, an app of DJI's with waypoints, or Litchi's app."""

TAKES: dict[Autopilot, tuple[str, ...]] = {
    "px4": ("mavlink",),
    "ardupilot": ("mavlink",),
    "dji-fly": ("dji", "litchi"),
    "pilot-2": ("dji",),
    "litchi": ("litchi",),
}
"""The emitters whose files each of them flies; the first is used where nothing is asked for."""

ZOOM_COMMANDS: tuple[Autopilot, ...] = ("px4", "ardupilot", "pilot-2")
"""Those whose mission files command the field of view of a lens that zooms."""


def flown_by(autopilot: Autopilot, emit: tuple[str, ...]) -> tuple[str, ...]:
    """Return emitters with those in place whose files an autopilot flies, for those that others fly."""
    others = {name for names in TAKES.values() for name in names} - set(TAKES[autopilot])
    return tuple(dict.fromkeys(TAKES[autopilot][0] if name in others else name for name in emit))


class Chosen(NamedTuple):
    """What planning chose where the mission leaves it open.

    drones : (id of a shot with `drone: auto`, its drone); autopilot : of every drone, None where each keeps
        its own
    """

    drones: tuple[tuple[str, str], ...] = ()
    autopilot: Autopilot | None = None


class MissionSource(NamedTuple):
    """All that a mission is made from: with it, and the kinds that are installed, it is lowered again.

    text : the bytes of the mission file, none of a mission that was made without one
    tables : (name, bytes) of the tracks, paths and layouts that it names
    drawn : (name, SHA-256, hexadecimal) of the files that its displays draw: nothing of a plan but how well a
        picture is drawn depends on what is in them
    linked : (name, SHA-256, hexadecimal) of files that are too large for a plan: scenes, buildings and large
        terrain. To lower the mission again they have to be there, unchanged.
    """

    text: bytes = b""
    tables: tuple[tuple[str, bytes], ...] = ()
    drawn: tuple[tuple[str, str], ...] = ()
    chosen: Chosen = Chosen()
    linked: tuple[tuple[str, str], ...] = ()


class KeptFiles(NamedTuple):
    """The files of a mission that is lowered again, in place of its folder.

    tables : bytes by name; drawn : (name, SHA-256) of the files that displays draw
    linked : SHA-256 by name of files that a plan does not hold; folders : where they are looked for, in turn
    """

    tables: dict[str, bytes]
    drawn: tuple[tuple[str, str], ...]
    linked: dict[str, str]
    folders: tuple[Path, ...] = ()


def kept_files(source: MissionSource, folders: tuple[Path, ...] = ()) -> KeptFiles:
    """Return the files that a source holds; folders : where those that it links to may be."""
    return KeptFiles(dict(source.tables), source.drawn, dict(source.linked), folders)

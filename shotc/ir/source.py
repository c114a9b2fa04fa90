"""The inputs of a mission's lowering: its text, its files, and planning's choices. Plain Python."""

from pathlib import Path
from typing import Literal, NamedTuple

Autopilot = Literal["px4", "ardupilot", "dji-fly", "pilot-2", "litchi"]
"""The autopilot of a drone: one with MAVLink, a DJI app with waypoints, or the Litchi app."""

TAKES: dict[Autopilot, tuple[str, ...]] = {
    "px4": ("mavlink",),
    "ardupilot": ("mavlink",),
    "dji-fly": ("dji", "litchi"),
    "pilot-2": ("dji",),
    "litchi": ("litchi",),
}
"""The emitters whose files each autopilot flies; the first is the default."""

ZOOM_COMMANDS: tuple[Autopilot, ...] = ("px4", "ardupilot", "pilot-2")
"""The autopilots whose mission files command the field of view of a zoom lens."""


def flown_by(autopilot: Autopilot, emit: tuple[str, ...]) -> tuple[str, ...]:
    """Return the emitters with those for other autopilots replaced by the autopilot's own."""
    others = {name for names in TAKES.values() for name in names} - set(TAKES[autopilot])
    return tuple(dict.fromkeys(TAKES[autopilot][0] if name in others else name for name in emit))


class Chosen(NamedTuple):
    """Planning's choices where the mission leaves them open.

    drones : (id of a shot with `drone: auto`, its drone); autopilot : of every drone, None if each keeps its
        own
    """

    drones: tuple[tuple[str, str], ...] = ()
    autopilot: Autopilot | None = None


class MissionSource(NamedTuple):
    """All inputs of a mission: with them and the installed kinds it can be lowered again.

    text : the bytes of the mission file, empty for a mission without one
    tables : (name, bytes) of the tracks, paths and layouts that it names
    drawn : (name, SHA-256, hexadecimal) of the files that its displays draw; only the quality of a picture
        depends on their content
    linked : (name, SHA-256, hexadecimal) of files that are too large for a plan: scenes, buildings and large
        terrain; they must be present and unchanged to lower the mission again
    """

    text: bytes = b""
    tables: tuple[tuple[str, bytes], ...] = ()
    drawn: tuple[tuple[str, str], ...] = ()
    chosen: Chosen = Chosen()
    linked: tuple[tuple[str, str], ...] = ()


class KeptFiles(NamedTuple):
    """The files of a mission that is lowered again; they replace its folder.

    tables : bytes by name; drawn : (name, SHA-256) of the files that displays draw
    linked : SHA-256 by name of files that a plan does not hold; folders : searched for them, in order
    """

    tables: dict[str, bytes]
    drawn: tuple[tuple[str, str], ...]
    linked: dict[str, str]
    folders: tuple[Path, ...] = ()


def kept_files(source: MissionSource, folders: tuple[Path, ...] = ()) -> KeptFiles:
    """Return the files that a source holds; folders : searched for the linked ones."""
    return KeptFiles(dict(source.tables), source.drawn, dict(source.linked), folders)

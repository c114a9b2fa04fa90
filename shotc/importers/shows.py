"""Make missions from drone shows of other tools: zipped CSV and `.skyc`, flown as recorded.

The fleet has one drone for each track of the file, on a pad where the track begins. The flight itself stays
in the file, which the mission names. Planning reads the file, brings the flight within the limits and proves
it.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from math import ceil, sqrt
from pathlib import PurePath

import numpy as np
from scipy.spatial import cKDTree

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.geom.bernstein import Array
from shotc.importers.cameras.takes import Refused
from shotc.importers.flights import skyc
from shotc.importers.flights.names import SHOW, TABLES, suffix_of
from shotc.importers.flights.points import Waypoints
from shotc.importers.flights.read import Found, Read, read
from shotc.importers.mission import Imported
from shotc.importers.names import safe
from shotc.importers.notes import Notes, label, told
from shotc.importers.xml_tree import Node
from shotc.rounding import down, plain
from shotc.source.file import SourceFile
from shotc.spec.presets import PRESETS

MODEL = "show-drone"
SEPARATION_M = 3.0
"""Default separation of a fleet, metres (``rules.separation``)."""
ON_GROUND_M = 1.0
"""Largest height above z = 0 at which a track begins on a pad, metres."""
WIDE_M = 1.0
"""Distance between assumed pads beyond the separation, metres."""
WHOLE = Node("", 1, 1, wide=1)
FOREIGN = Refused(
    "I002", "a show is zipped CSV (.zip) or a `.skyc`", WHOLE, "export it again as one of these"
)


@dataclass(frozen=True, slots=True)
class ImportedShow:
    """A mission and the table of its pads, (name, bytes), None if the pads are a grid."""

    made: Imported
    pads: tuple[str, bytes] | None


@dataclass(frozen=True, slots=True, eq=False)
class _Show:
    """The first positions of the tracks of a file, shape (n, 3), East, North, Up in its frame, metres.

    origin : latitude, longitude (degrees) and altitude (metres) of that frame, or None
    """

    starts: Array
    origin: tuple[float, float, float | None] | None


def imported_show(data: bytes, name: str, file: str, *, strict: bool) -> ImportedShow:
    """Make a mission that flies a show as recorded.

    data   : any bytes
    name   : name of the file for messages
    file   : name of the file in the mission, relative to its folder
    strict : report an error instead of making an assumption
    """
    found = read(data, name) if suffix_of(name) in (SHOW, TABLES) else Read(name, FOREIGN, "")
    sources = {found.file: SourceFile(found.file, found.text)}
    show = _show_of(found.found)
    if not isinstance(show, _Show):
        text = f"`{name}` cannot be imported: {show.message}"
        failed = Diagnostic(show.code, text, (label(found.file, show.node),), (), show.help)
        return ImportedShow(Imported(None, (failed,), sources), None)
    notes = Notes()
    stem = safe(PurePath(file).stem, "show")
    pads = _pads(show.starts, f"{stem}-pads.csv", notes)
    text = _written(stem, file, show, (pads, _separation(show.starts, notes)), notes)
    said = told(name, notes, strict=strict)
    made = Imported(None if has_errors(said) else text, said, sources, len(show.starts), 1)
    return ImportedShow(made, pads)


def _show_of(found: Found | Refused) -> _Show | Refused:
    if isinstance(found, Refused):
        return found
    if isinstance(found, skyc.SkycShow):
        return _Show(np.stack([flight.ctrl[0, 0] for flight in found.flights]), found.origin)
    return FOREIGN if isinstance(found, Waypoints) else _Show(np.stack([r.place[0] for r in found]), None)


def _pads(starts: Array, name: str, notes: Notes) -> tuple[str, bytes] | None:
    """Return the table of the pads on which the tracks begin, or None if they begin in the air."""
    high = float(starts[:, 2].max())
    if high > ON_GROUND_M:
        notes.assume(
            WHOLE, f"a track begins {high:.2f} m high, on no pad", "the pads are a grid below the show"
        )
        return None
    rows = "".join("{:.4f},{:.4f},{:.4f}\n".format(*row) for row in (starts + 0.0).tolist())
    return name, f"x,y,z\n{rows}".encode()


def _separation(starts: Array, notes: Notes) -> float:
    """Return the separation for the mission, m: that of the pads, but within bounds."""
    if len(starts) < 2 or float(starts[:, 2].max()) > ON_GROUND_M:
        return SEPARATION_M
    near = down(float(cKDTree(starts).query(starts, k=2)[0][:, 1].min()), 2)
    if near >= SEPARATION_M:
        return SEPARATION_M
    least = 2.0 * PRESETS[MODEL].radius
    message = f"tracks begin {near:.2f} m apart, and {SEPARATION_M:.1f} m are usual"
    taken = max(near, least)
    notes.assume(WHOLE, message, f"the separation is {taken:.2f} m, for the whole show")
    return taken


def _written(
    stem: str, file: str, show: _Show, ground: tuple[tuple[str, bytes] | None, float], notes: Notes
) -> str:
    pads, separation = ground
    lines = [
        "# A recorded show, by `shotc import show`. `shotc plan` brings it within the limits of its drones",
        "# and proves it; where it is too fast, all drones take more time, and that is told.",
        *(f"# {note.comment}" for note in notes.found),
        "shotc: 1",
        f"mission: {stem}",
    ]
    if show.origin is not None:
        lat, lon, alt = show.origin
        lines.append(f"world: {{origin: {{lat: {lat!r}, lon: {lon!r}, alt: {plain(alt or 0.0)}}}}}")
    layout = f"{{file: {json.dumps(pads[0])}}}" if pads is not None else _grid(show.starts, separation)
    return "\n".join(
        [
            *lines,
            "fleets:",
            "  swarm:",
            f"    count: {len(show.starts)}",
            f"    layout: {layout}",
            f"    model: {MODEL}  # its limits: shotc list models; others: `limits: {{speed: ...}}`",
            f"    separation: {plain(separation)} m",
            "shots:",
            "  - id: show",
            "    kind: display",
            "    fleet: swarm",
            f"    frames: {{flight: {json.dumps(file, ensure_ascii=False)}}}",
            "",
        ]
    )


def _grid(starts: Array, separation: float) -> str:
    spacing = ceil(separation + WIDE_M)
    half = spacing * (ceil(sqrt(len(starts))) - 1) / 2.0
    x, y = starts[:, :2].mean(axis=0) - half
    return f"{{grid: {{spacing: {spacing} m, origin: [{plain(float(x), 1)}, {plain(float(y), 1)}, 0]}}}}"

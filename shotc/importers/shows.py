"""Make missions from drone shows of other tools: zipped CSV and `.skyc`, flown as recorded.

The fleet has one drone for each track of the file, on a pad where the track begins. The flight itself stays
in the file, which the mission names. Planning reads the file, brings the flight within the limits and proves
it.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from math import ceil, inf, sqrt
from pathlib import PurePath

import numpy as np
from scipy.spatial import cKDTree

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.geom.bernstein import Array, Piecewise
from shotc.importers.cameras.takes import Refused
from shotc.importers.flights import skyc
from shotc.importers.flights.endings import SHOW, TABLES, suffix_of
from shotc.importers.flights.points import Waypoints
from shotc.importers.flights.read import Found, Read, read
from shotc.importers.mission import Imported
from shotc.importers.notes import Notes, assumption_diagnostics, label
from shotc.importers.words import safe_name
from shotc.importers.xml_tree import Node
from shotc.rounding import at_most, down, nearer_than, plain
from shotc.source.file import SourceFile
from shotc.spec.presets import PRESETS

MODEL = "show-drone"
SEPARATION_M = 3.0
"""Default separation of a fleet, metres (``rules.separation``)."""
ON_GROUND_M = 1.0
"""Largest height above z = 0 at which a track begins on a pad, metres."""
LOOK_S, MOST_PLACES = 0.5, 2_000_000
"""Interval at which tracks are sampled, and the most samples of all tracks together."""
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
    """The tracks of a file, East, North and Up in its own frame, and the position of that frame.

    starts : where they begin, (n, 3), m
    times : of the samples, (T,), s
    places : all drones at these, (T, n, 3), m
    """

    starts: Array
    origin: skyc.ShowOrigin | None
    times: Array
    places: Array


def imported_show(data: bytes, name: str, file: str, *, strict: bool) -> ImportedShow:
    """Make a mission that flies a show as recorded.

    data   : any bytes
    name   : name of the file for messages
    file   : name of the file in the mission, relative to its folder
    strict : report an error instead of making an assumption
    """
    result = read(data, name) if suffix_of(name) in (SHOW, TABLES) else Read(name, FOREIGN, "")
    sources = {result.file: SourceFile(result.file, result.text)}
    show = _show_of(result.content)
    if not isinstance(show, _Show):
        text = f"`{name}` cannot be imported: {show.message}"
        failed = Diagnostic(show.code, text, (label(result.file, show.node),), (), show.help)
        return ImportedShow(Imported(None, (failed,), sources), None)
    notes = Notes()
    stem = safe_name(PurePath(file).stem, "show")
    pads = _pads(show.starts, f"{stem}-pads.csv", notes)
    text = _written(stem, file, show, (pads, _separation(show, notes)), notes)
    said = assumption_diagnostics(name, notes, strict=strict)
    mission = Imported(None if has_errors(said) else text, said, sources, len(show.starts), 1)
    return ImportedShow(mission, pads)


def _show_of(result: Found | Refused) -> _Show | Refused:
    if isinstance(result, Refused):
        return result
    if isinstance(result, skyc.SkycShow):
        starts = np.stack([flight.ctrl[0, 0] for flight in result.flights])
        times = _times(len(starts), max(float(flight.breaks[-1]) for flight in result.flights))
        curves = (Piecewise(flight.breaks, flight.ctrl) for flight in result.flights)
        places = np.stack([curve(np.clip(times, curve.start, curve.end)) for curve in curves], axis=1)
        return _Show(starts, result.origin, times, places)
    if isinstance(result, Waypoints):
        return FOREIGN
    times = _times(len(result), max(float(rows.time[-1]) for rows in result))
    tracks = [[np.interp(times, rows.time, rows.place[:, k]) for k in range(3)] for rows in result]
    return _Show(
        np.stack([rows.place[0] for rows in result]), None, times, np.array(tracks).transpose(2, 0, 1)
    )


def _times(drones: int, end: float) -> Array:
    """Return the times at which tracks are sampled, s."""
    return np.linspace(0.0, end, max(2, min(ceil(end / LOOK_S) + 1, MOST_PLACES // drones)))


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


def _separation(show: _Show, notes: Notes) -> float:
    """Return the separation to request: at most that of the tracks on their pads and, as sampled,
    in the air.
    """
    if len(show.starts) < 2:
        return SEPARATION_M
    apart = np.array([float(cKDTree(at).query(at, k=2)[0][:, 1].min()) for at in show.places])
    first = int(apart.argmin())
    on_pads = inf
    if float(show.starts[:, 2].max()) <= ON_GROUND_M:
        on_pads = float(cKDTree(show.starts).query(show.starts, k=2)[0][:, 1].min())
    least = min(on_pads, float(apart[first]))
    if down(least) >= SEPARATION_M:
        return SEPARATION_M
    message = f"tracks begin {at_most(least)} m apart"
    if on_pads > apart[first]:
        reached = f"{nearer_than(least, SEPARATION_M)} m of each other"
        message = f"two drones come within {reached} at {show.times[first]:.1f} s"
    taken = max(down(least), 2.0 * PRESETS[MODEL].radius)
    notes.assume(
        WHOLE,
        f"{message}, and {SEPARATION_M:.1f} m are usual",
        f"the separation is {taken:.2f} m, for the whole show",
    )
    return taken


def _written(
    stem: str, file: str, show: _Show, ground: tuple[tuple[str, bytes] | None, float], notes: Notes
) -> str:
    pads, separation = ground
    lines = [
        "# A recorded show, by `shotc import show`. `shotc plan` brings it within the limits of its drones",
        "# and proves it; where it is too fast, all drones take more time, and a warning says so.",
        *(f"# {note.comment}" for note in notes.assumptions),
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

"""Missions with a runner on a track, and what resolve makes of it."""

from __future__ import annotations

from pathlib import Path

from shotc.diag.model import Diagnostic
from shotc.geom.track import Track
from tests.support.front_passes import resolved
from tests.support.resolve_missions import HEAD

EARTH = "world:\n  origin: {lat: 47.3769, lon: 8.5417, alt: 408}\n"
SIDE = "id: side, kind: lateral, target: runner, side: left, distance: 8, altitude: 4"
LINE = HEAD.split("drones:")[0].count("\n") + 1  # of the runner


def written(track: str, more: str = "", timing: str = "duration: 5", *, earth: bool = False) -> str:
    """Return a mission with a runner on a track; ``more`` are other keys of it."""
    runner = f"  runner: {{track: {{{track}}}, radius: 0.4, height: 1.8{more}}}\n"
    head = HEAD.replace("drones:", runner + "drones:")
    text = f"{head}  - {{drone: cam1, {SIDE}, timing: {{{timing}}}}}\n"
    return text.replace("world:\n", EARTH) if earth else text


def track_of(text: str, folder: Path | None = None) -> Track:
    mission, found = resolved(text, folder)
    assert found == []
    assert mission is not None
    track = mission.target("runner").track
    assert track is not None
    return track


def only(text: str, folder: Path | None = None) -> Diagnostic:
    (found,) = resolved(text, folder)[1]
    return found


def recorded(folder: Path, rows: str, name: str = "t.csv") -> str:
    (folder / name).write_text(rows)
    return f"file: {name}"


def gpx(*points: str, ele: str = "<ele>408.9</ele>") -> str:
    """Return a track northward at 1 m a point, with these times; the first point is on line 2."""
    rows = "\n".join(
        f'<trkpt lat="{47.3769 + i * 9e-6:.7f}" lon="8.5417">{ele}{time}</trkpt>'
        for i, time in enumerate(points)
    )
    return f"<gpx><trk><trkseg>\n{rows}\n</trkseg></trk></gpx>"


def stamp(second: float) -> str:
    return f"<time>2024-05-01T12:00:{second:06.3f}Z</time>"

"""The file: a ZIP archive with ``show.json`` in its root and the song beside it; and diagnostics.

The same show gives the same bytes.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from io import BytesIO
from zipfile import ZIP_STORED, ZipFile

from shotc.diag.model import Diagnostic
from shotc.emit.zip_parts import entry
from shotc.ir.mission import MissionIR, Zone
from shotc.show.emit.skyc.show import MOST_DRONES

ASSET = "assets/music.mp3"


@dataclass(frozen=True, slots=True)
class Song:
    """The music entry of a show file, the files that it refers to, and what cannot be carried."""

    media: Mapping[str, object] | None = None
    assets: Mapping[str, bytes] = field(default_factory=dict)
    faults: tuple[Diagnostic, ...] = ()


def song_of(mission: MissionIR) -> Song:
    """Return the song of a mission in the form of show files."""
    music = mission.music
    if music is None or music.file is None:
        return Song()
    data = dict(mission.files).get(music.file)
    if not music.file.lower().endswith(".mp3"):
        return Song(
            faults=(
                _not_carried(mission, "it is no MP3, the only format that they play", "export it as MP3"),
            )
        )
    if data is None:
        note = "a plan does not hold it, and the file was not at hand"
        return Song(faults=(_not_carried(mission, note, "run `shotc plan` on the mission, in its folder"),))
    audio = {
        "data": {"$ref": f"./{ASSET}"},
        "filename": music.file.rpartition("/")[2],
        "mediaType": "audio/mpeg",
        "startTime": round(music.start, 3),
    }
    return Song({"audio": audio}, {ASSET: data})


def _not_carried(mission: MissionIR, why: str, help: str) -> Diagnostic:
    assert mission.music is not None
    label = mission.origins.value((*mission.music.path, "file"))
    message = f"the show file is without its song `{mission.music.file}`"
    return Diagnostic("E150", message, (label,), (why,), help)


def archive(content: Mapping[str, object], assets: Mapping[str, bytes]) -> bytes:
    """Return the archive of a show.

    assets : files that ``content`` refers to, by name
    """
    text = json.dumps(content, separators=(",", ":"), allow_nan=False)
    stream = BytesIO()
    with ZipFile(stream, "w") as zipped:
        zipped.writestr(entry("show.json"), text)
        for name, data in assets.items():
            zipped.writestr(entry(name, ZIP_STORED), data)
    return stream.getvalue()


def no_origin(mission: MissionIR) -> Diagnostic:
    """Return the warning that the show has no origin."""
    return Diagnostic(
        "E111",
        "the show file has no place on the globe: the mission has no world.origin",
        (mission.origins.key(("world",)),),
        ("Skybrush plays it without a place, and asks for the place before the flight",),
        "write `origin: {lat: ..., lon: ..., alt: ...}` under `world`",
    )


def too_large(mission: MissionIR, count: int) -> Diagnostic:
    """Return the warning that no show file is written, because there are too many drones."""
    return Diagnostic(
        "E112",
        f"the show file is skipped: {count} drones are more than the {MOST_DRONES} that one may have",
        tuple(mission.origins.key(fleet.path) for fleet in mission.fleets),
        ("Skybrush refuses to load a larger one",),
        f"fly fleets of no more than {MOST_DRONES} drones together, each from a mission of its own, or write "
        "`--emit zipped-csv`, which holds any number",
    )


def left_out(mission: MissionIR, zone: Zone) -> Diagnostic:
    """Return the warning that a zone is not in the show's geofence."""
    return Diagnostic(
        "E113",
        f"the geofence of the show leaves out zone {zone.name}: the fleet's ground track leaves it",
        (mission.origins.key(zone.path),),
        ("the plan keeps the zone, except while drones rise from their pads and land on them",),
        "draw the zone round the pads, too",
    )

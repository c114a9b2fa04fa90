"""The song of a show in its show file, which can carry only MP3."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR

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

"""How long a song is, against the show that is flown to it."""

from __future__ import annotations

from io import BytesIO

from tinytag import TinyTag, TinyTagException

from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR
from shotc.rounding import at_least, plain


def song_faults(mission: MissionIR, end: float) -> list[Diagnostic]:
    """Return what is wrong with the song of a show; end : of its last picture, s of the mission's clock.

    A plan does not carry the song: nothing is said of it where its file is not at hand.
    """
    music = mission.music
    data = None if music is None or music.file is None else dict(mission.files).get(music.file)
    if music is None or music.file is None or data is None:
        return []
    label = mission.origins.value((*music.path, "file"))
    length = seconds(music.file, data)
    if length is None:
        note = "show files carry it as it is, and players may not play it"
        message = f"nothing tells how long `{music.file}` is: it does not read as music"
        return [Diagnostic("D126", message, (label,), (note,), "export it again, as MP3")]
    silent = end - music.start - length
    if silent <= 0.0:
        return []
    note = f"it begins at {plain(music.start)} s and is {plain(length)} s long"
    message = f"the song ends {at_least(silent)} s before the last picture does"
    help_ = f"shorten the show by {at_least(silent)} s, or take a longer song"
    return [Diagnostic("D127", message, (label,), (note,), help_)]


def seconds(name: str, data: bytes) -> float | None:
    """Return how long a song is, s, or None where its bytes do not tell."""
    try:
        length = TinyTag.get(name, file_obj=BytesIO(data)).duration
    except (TinyTagException, ValueError, ArithmeticError, LookupError, OSError):
        return None
    return length if length is not None and length > 0.0 else None

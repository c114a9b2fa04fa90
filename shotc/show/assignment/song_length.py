"""Compares the length of a song with the show that is flown to it."""

from __future__ import annotations

from io import BytesIO

from tinytag import TinyTag, TinyTagException

from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR
from shotc.rounding import at_least, plain


def song_faults(mission: MissionIR, end: float) -> list[Diagnostic]:
    """Return the faults of a show's song.

    A plan does not contain the song; there is no diagnostic if its file is not available.

    end : end of the last picture, mission time, seconds
    """
    music = mission.music
    data = None if music is None or music.file is None else dict(mission.files).get(music.file)
    if music is None or music.file is None or data is None:
        return []
    label = mission.origins.value((*music.path, "file"))
    length = seconds(music.file, data)
    if length is None:
        note = "show files carry it as it is, and players may not play it"
        message = f"the length of `{music.file}` is unknown: it does not read as music"
        return [Diagnostic("D126", message, (label,), (note,), "export it again, as MP3")]
    silent = end - music.start - length
    if silent <= 0.0:
        return []
    note = f"it begins at {plain(music.start)} s and is {plain(length)} s long"
    message = f"the song ends {at_least(silent)} s before the last picture does"
    help_ = (
        f"shorten the show by {at_least(silent)} s, or take a song of {at_least(length + silent)} s or more"
    )
    return [Diagnostic("D127", message, (label,), (note,), help_)]


def seconds(name: str, data: bytes) -> float | None:
    """Return the length of a song, seconds; None if it cannot be read."""
    try:
        length = TinyTag.get(name, file_obj=BytesIO(data)).duration
    except (TinyTagException, ValueError, ArithmeticError, LookupError, OSError):
        return None
    return length if length is not None and length > 0.0 else None

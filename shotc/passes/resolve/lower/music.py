"""The music of a mission lowered: its beats as times, and the bytes of its song."""

from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.ir.music import Music
from shotc.ir.origin import KeyPath, OriginMap
from shotc.ir.source import KeptFiles
from shotc.kinds.base import bad_file
from shotc.kinds.files import FileFault, finite, utf8_text
from shotc.passes.resolve.lower.files import Files, read_file
from shotc.spec.load import LoadedMission
from shotc.spec.music import MOST_BEATS, MusicSpec

SONGS = (".mp3", ".wav", ".flac", ".ogg", ".m4a")
LARGEST_SONG_BYTES = 100_000_000
"""Bytes of a song: an hour of MP3, ten minutes of WAV."""

PATH: KeyPath = ("music",)


class MusicReading(NamedTuple):
    """The music, its faults, and the song as (name, bytes); None where there is none."""

    music: Music | None = None
    faults: tuple[Diagnostic, ...] = ()
    song: tuple[str, bytes] | None = None


def music_of(ir: LoadedMission, files: Files) -> MusicReading:
    """Resolve the music of a mission and read its files."""
    spec = ir.spec.music
    if spec is None:
        return MusicReading()
    times = _times(spec, files)
    faults = [times] if isinstance(times, Diagnostic) else []
    if not ir.spec.fleets:
        faults.append(_unused(files.origins))
    song = _song(spec, ir, files.origins)
    if isinstance(song, Diagnostic):
        faults.append(song)
    listed = () if isinstance(times, Diagnostic) else times
    period = None if spec.tempo is None else 60.0 / spec.tempo
    music = Music(
        spec.file,
        spec.start,
        listed,
        spec.first_beat or 0.0,
        period,
        spec.beats_per_bar,
        PATH,
        unread=isinstance(times, Diagnostic),
    )
    return MusicReading(music, tuple(faults), None if isinstance(song, Diagnostic) else song)


def _unused(origins: OriginMap) -> Diagnostic:
    """Return the fault of music in a mission without fleets."""
    note, help_ = "cameras take no notice of it", "remove it, or add a `display`"
    return Diagnostic("D128", "no fleet flies to this music", (origins.key(PATH),), (note,), help_)


def _song(spec: MusicSpec, ir: LoadedMission, origins: OriginMap) -> tuple[str, bytes] | Diagnostic | None:
    """Return the song; None where there is none, or where a plan is lowered again, which needs none."""
    if spec.file is None or isinstance(ir.folder, KeptFiles):
        return None
    path = (*PATH, "file")
    if not spec.file.lower().endswith(SONGS):
        *most, last = SONGS
        help_ = f"give a file that ends in {', '.join(most)} or {last}"
        return Diagnostic(
            "D011", f"`{spec.file}` is in no format of music", (origins.value(path),), help=help_
        )
    data = read_file(ir.folder, origins, spec.file, path, LARGEST_SONG_BYTES)
    return data if isinstance(data, Diagnostic) else (spec.file, data)


def _times(spec: MusicSpec, files: Files) -> tuple[float, ...] | Diagnostic:
    """Return the times of the listed beats, seconds in the song, or their fault."""
    if spec.beats_file is None:
        return _rising(spec, files.origins)
    path = (*PATH, "beats_file")
    data = files.read(spec.beats_file, path)
    if isinstance(data, Diagnostic):
        return data
    beats = read_beats(data)
    return bad_file(files.origins, path, spec.beats_file, beats) if isinstance(beats, FileFault) else beats


def _rising(spec: MusicSpec, origins: OriginMap) -> tuple[float, ...] | Diagnostic:
    beats = spec.beats
    back = next((k for k in range(1, len(beats)) if beats[k] <= beats[k - 1]), None)
    if back is None:
        return beats
    later = next((f" and before {beat:g} s" for beat in beats[back:] if beat > beats[back - 1]), "")
    return Diagnostic(
        "D120",
        f"beat {back + 1} falls at {beats[back]:g} s, and the one before it at {beats[back - 1]:g} s",
        (
            origins.value((*PATH, "beats", back)),
            origins.value((*PATH, "beats", back - 1), "the one before it"),
        ),
        help=f"write a time after {beats[back - 1]:g} s{later}, or leave this beat out",
    )


def read_beats(data: bytes) -> tuple[float, ...] | FileFault:
    """Return the times of beats, one per line, seconds: the first number of each; a label may follow it.

    Empty lines and those that begin with # are skipped. Audacity separates the columns of labels by tabs.
    """
    text = utf8_text(data)
    if isinstance(text, FileFault):
        return text
    times: list[float] = []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        word = line.replace("\t", " ").replace(",", " ").split()[0] if line.strip(" \t,") else ""
        time = finite(word)
        if time is None or not 0.0 <= time <= 1e5:
            return FileFault(f"`{word[:20]}` is no time of a beat", number, "begin each line with seconds")
        if times and time <= times[-1]:
            message = f"the beat at {time:g} s is no later than the one before it, at {times[-1]:g} s"
            return FileFault(message, number, "sort the lines by time, every beat once")
        if len(times) == MOST_BEATS:
            return FileFault(f"the file has more than {MOST_BEATS} beats", number, "leave some out")
        times.append(time)
    return (
        tuple(times) if times else FileFault("the file has no beat", None, "write a beat a line, in seconds")
    )

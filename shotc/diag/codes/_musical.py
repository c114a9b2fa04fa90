"""D120 and up: the music of a show, its beats, and pictures that are timed on beats."""

from __future__ import annotations

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes._slips import LOOK, slip
from shotc.diag.model import Severity

_DANCE = """\
shotc: 1
mission: dance
music: {tempo: 120, start: 20 s}
fleets:
  swarm: {count: 20, layout: {grid: {spacing: 4, origin: [0, 0, 0]}}, model: show-drone}
shots:
  - id: dance
    kind: display
    fleet: swarm
    frames:
      - {sphere: {center: [0, 0, 40], radius: 10}, at: {beat: 21}, hold: 4}
      - {cube: {center: [0, 0, 40], size: 16}, at: {bar: 17}, hold: 4}
"""
_LISTED = (
    _DANCE.replace("tempo: 120, start: 20 s", "beats: [20.5, 31, 40, 52]")
    .replace("at: {beat: 21}, hold: 4", "at: {beat: 2}, hold: 4")
    .replace("at: {bar: 17}", "at: {beat: 4}")
)

_IN_FILES = (
    ("D126", "song-not-read", "the length of a song is not known",
     "The length of a song is read from its file, so that a warning names a show that outlasts it. A file that "
     "does not read as music is carried as it is; it is not known whether players play it."),
    ("D127", "song-too-short", "a song ends before the show does",
     "The last picture stands, or the way to it is flown, after the song has ended. `music: {start: ...}` is when the song "
     "begins on the mission's clock."),
)  # fmt: skip

MUSICAL: tuple[CodeInfo, ...] = (
    slip(
        "D120",
        "beats-out-of-order",
        "beats of the music are not in the order in which they fall",
        "`music: {beats: [...]}` lists when every beat falls in the song, so each is later than the one before. In a file of "
        "beats the same holds from line to line.",
        _LISTED,
        ("31, 40", "31, 30"),
    ),
    slip(
        "D121",
        "beat-without-music",
        "a picture stands on a beat, but the mission has no beats",
        "`at: {beat: 32}` and `at: {bar: 9}` count beats of the mission's `music`, which says when they fall: by a `tempo` with "
        "the `first_beat`, by `beats`, or by a `beats_file`.",
        _DANCE,
        ("music: {tempo: 120, start: 20 s}", "music: {start: 20 s}"),
    ),
    slip(
        "D122",
        "beat-after-the-last",
        "a picture stands on a beat after the last one that is listed",
        "Beats and bars are counted from 1. Between two beats there are parts of a beat, after the last one nothing.",
        _LISTED,
        ("at: {beat: 4}", "at: {beat: 5}"),
    ),
    slip(
        "D123",
        "picture-before-its-time",
        "a picture stands before the earlier ones can be over",
        "`at` is when a picture stands. The picture before it is held and the way flown until then, for which the message "
        "gives a lower bound; `plan` knows the exact time.",
        _DANCE,
        ("at: {bar: 17}", "at: {bar: 7}"),
    ),
    slip(
        "D124",
        "picture-too-late",
        "a picture cannot stand at its time",
        "The picture before it is held as long as it asks for, and then the way takes its time: as `transition` says, or "
        "as little as the limits allow, whatever the pace of the display. The message gives the earliest moment, in seconds and in beats.",
        _DANCE,
        ("at: {bar: 17}", "at: {bar: 9}"),
    )._replace(phase="plan"),
    slip(
        "D125",
        "start-said-twice",
        "the start of a display is given twice: by its timing and by its first picture",
        "A display starts when its first picture stands, so `timing: {start: ...}` and `at` of that picture are the same.",
        _DANCE,
        ("    fleet: swarm\n", "    fleet: swarm\n    timing: {start: 30}\n"),
    ),
    slip(
        "D128",
        "music-without-show",
        "a mission has music, and no fleet flies to it",
        "Music is for shows: pictures stand on its beats, and show files carry the song. Cameras take no notice of it.",
        LOOK,
        ("rules: {composition", "music: {tempo: 120}\nrules: {composition"),
    )._replace(severity=Severity.WARNING),
    *(
        CodeInfo(code, slug, Severity.WARNING, summary, words, "", "", "other")
        for code, slug, summary, words in _IN_FILES
    ),
)

"""Helps about the song of a show: the file is exchanged as they say."""

from __future__ import annotations

import re
import wave
from io import BytesIO
from pathlib import Path

import pytest

from shotc.api import PlanOptions, compile_source, emit_plan
from shotc.diag.model import Diagnostic

pytestmark = pytest.mark.slow

SHOW = """\
shotc: 1
mission: song
world: {origin: {lat: 47.3769, lon: 8.5417, alt: 408}}
music: {file: SONG}
fleets: {swarm: {count: 8, layout: {grid: {spacing: 4, origin: [20, 20, 0]}}, model: show-drone}}
shots:
  - {id: ball, kind: display, fleet: swarm, frames: [{sphere: {center: [20, 20, 40], radius: 6}, hold: 4}]}
output: {emit: [skyc]}
"""


def sound(seconds: float) -> bytes:
    """Return silence as WAV."""
    stream = BytesIO()
    with wave.open(stream, "wb") as song:
        song.setnchannels(1)
        song.setsampwidth(1)
        song.setframerate(100)
        song.writeframes(b"\x80" * round(100 * seconds))
    return stream.getvalue()


def told(folder: Path, song: str, data: bytes) -> dict[str, Diagnostic]:
    """Return what planning a show with a song tells, by code."""
    (folder / song).write_bytes(data)
    made = compile_source(SHOW.replace("SONG", song).encode(), "m.yaml", folder, PlanOptions())
    assert made.plan is not None
    return {d.code: d for d in (*made.diagnostics, *emit_plan(made.plan).diagnostics)}


@pytest.mark.long
def test_each_help_about_a_song_does_when_the_file_is_exchanged(tmp_path: Path) -> None:
    unread = told(tmp_path, "song.mp3", b"no music")
    assert unread["D126"].help == "export it again, as MP3"
    short = told(tmp_path, "song.wav", sound(3.0))
    assert "D126" not in short
    assert short["E150"].help == "export it as MP3"
    assert "E150" not in unread
    enough = re.search(r"a song of ([\d.]+) s or more", short["D127"].help or "")
    assert enough is not None
    assert "D127" not in told(tmp_path, "song.wav", sound(float(enough[1])))

"""Pictures that stand on beats: the flight, the claims, the song in the show file, what is told of it."""

from __future__ import annotations

import io
import wave
from zipfile import ZipFile

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.api import PlanOptions, compile_source
from shotc.geom.fleet_spline import places
from shotc.ir.passes import PassContext
from shotc.ir.trajectory import VerifiedIR
from shotc.kinds.files import FileFault
from shotc.passes.resolve.lower.music import read_beats
from shotc.passes.verify import judge
from shotc.show.assignment.song_length import seconds, song_faults
from shotc.show.emit.skyc import EMITTER
from tests.support import skyc_reader
from tests.support.records import replace

MISSION = """\
shotc: 1
mission: dance
music: {file: song.mp3, start: 20 s, beats_file: beats.txt, beats_per_bar: 3}
fleets:
  swarm: {count: 6, layout: {grid: {spacing: 4, origin: [0, 0, 0]}}, separation: 1}
shots:
  - id: dance
    kind: display
    fleet: swarm
    frames:
      - {sphere: {center: [0, 0, 40], radius: 6}, at: {beat: 2}, hold: 2}
      - {sphere: {center: [0, 0, 44], radius: 8}, at: {bar: 2, beat: 2}, transition: 6}
      - {sphere: {center: [0, 0, 40], radius: 6}, at: 65 s, hold: 3}
    effects:
      - {sparkle: {color: gold}, from: {beat: 2}, until: {bar: 2, beat: 2}}
"""
BEATS = "# a label track\n5.5\t5.5\tone\n15.25\t15.25\ttwo\n20\n25,three\n31.125\n44\n"


def wav(length: float) -> bytes:
    stream = io.BytesIO()
    with wave.open(stream, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(1)
        file.setframerate(200)
        file.writeframes(bytes(round(200 * length)))
    return stream.getvalue()


@pytest.fixture(scope="module")
def plan(tmp_path_factory: pytest.TempPathFactory) -> VerifiedIR:
    folder = tmp_path_factory.mktemp("dance")
    (folder / "beats.txt").write_text(BEATS)
    (folder / "song.mp3").write_bytes(b"ID3" + bytes(500))
    found = compile_source(MISSION.encode(), "m.yaml", folder, PlanOptions()).plan
    assert found is not None
    return found


@pytest.mark.slow
def test_every_drone_stands_on_the_beat(plan: VerifiedIR) -> None:
    flight = plan.trajectory.fleets[0]
    assert [shown.start for shown in flight.shown] == pytest.approx([35.25, 51.125, 65.0], abs=1e-6)
    beats = np.array([35.25, 51.125, 65.0])
    for shift in (0.0, -0.02, 0.02):  # at rest: nobody is elsewhere 20 ms before or after
        moved = places(flight.breaks, flight.coef, beats + shift) - places(flight.breaks, flight.coef, beats)
        assert np.abs(moved).max() < 1e-3
    # The first picture is held for longer than it asks, until the way of 6 s begins.
    assert flight.shown[0].end == pytest.approx(51.125 - 6.0)
    claim = next(c for c in plan.certificate if c.constraint == "error of moment")
    assert claim.worst < 1e-6


def test_effects_begin_and_end_on_beats(plan: VerifiedIR) -> None:
    (layer,) = plan.trajectory.fleets[0].lights.over
    assert (layer.span[0], layer.span[-1]) == pytest.approx((35.25, 51.125))


def test_a_plan_whose_picture_stands_off_its_beat_is_refused(plan: VerifiedIR) -> None:
    flight = plan.trajectory.fleets[0]
    later = replace(flight.shown[1], start=flight.shown[1].start + 0.01)
    shown = (flight.shown[0], later, flight.shown[2])
    changed = replace(plan.trajectory, fleets=(replace(flight, shown=shown),))
    verdict = judge(changed, PassContext())
    claim = next(c for c in verdict.certificate if c.constraint == "error of moment")
    assert not claim.holds
    assert claim.worst == pytest.approx(0.01)


@pytest.mark.slow
def test_the_show_file_carries_the_song_and_when_it_begins(plan: VerifiedIR) -> None:
    emission = EMITTER.emit(plan)
    with ZipFile(io.BytesIO(emission.artifacts[0].data)) as zipped:
        audio = skyc_reader.read(emission.artifacts[0].data)["media"]["audio"]
        assert audio["startTime"] == 20.0
        assert audio["mediaType"] == "audio/mpeg"
        assert zipped.read(audio["data"]["$ref"].removeprefix("./")) == b"ID3" + bytes(500)
    mission = plan.trajectory.keyframes.mission
    without = replace(plan.trajectory.keyframes, mission=mission._replace(files=()))
    again = EMITTER.emit(replace(plan, trajectory=replace(plan.trajectory, keyframes=without)))
    assert "E150" in [d.code for d in again.diagnostics]


@pytest.mark.parametrize(("length", "code"), [(44.0, "D127"), (49.0, None), (0.0, "D126")])
def test_a_song_that_ends_early_or_cannot_be_read_is_told(
    plan: VerifiedIR, length: float, code: str | None
) -> None:
    mission = plan.trajectory.keyframes.mission
    assert mission.music is not None
    song = wav(length) if length else b"no music"
    sung = mission._replace(music=mission.music._replace(file="song.wav"), files=(("song.wav", song),))
    told = song_faults(sung, 68.0)  # it begins at 20 s
    assert [d.code for d in told] == ([] if code is None else [code])
    if code == "D127":
        assert "4.00 s before" in told[0].message


@pytest.mark.slow
@given(st.binary(max_size=300))
def test_any_bytes_are_beats_or_a_fault(data: bytes) -> None:
    found = read_beats(data)
    if not isinstance(found, FileFault):
        assert list(found) == sorted(set(found))
    for name in ("a.mp3", "a.wav", "a.flac", "a.ogg", "a.m4a"):
        for head in (b"", b"ID3", b"RIFF\0\0\0\0WAVEfmt ", b"fLaC", b"OggS", b"\0\0\0\x20ftypM4A "):
            assert (seconds(name, head + data) or 1.0) > 0.0


@pytest.mark.parametrize(
    ("text", "line"), [("1\n2\nx\n", 3), ("1\n\n3\n2\n", 4), ("", None), ("-1\n", 1), ("1\nnan\n", 2)]
)
def test_a_bad_file_of_beats_is_told_with_its_line(text: str, line: int | None) -> None:
    found = read_beats(text.encode())
    assert isinstance(found, FileFault)
    assert found.line == line

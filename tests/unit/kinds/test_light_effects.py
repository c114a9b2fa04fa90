"""Effects of lights in missions: what is written well becomes a stack, what is not is told with its place."""

from __future__ import annotations

import zlib
from base64 import b64decode
from io import BytesIO
from pathlib import Path
from struct import pack

import numpy as np
import pytest
from PIL import Image

from shotc.ir.effects import DisplayTime, Fade, Ramp
from shotc.ir.source import Chosen
from shotc.kinds.image_file import MOST_FRAMES, image_fault
from shotc.lowering import lower
from shotc.show.goals.footage import read_frames

MISSION = """\
shotc: 1
mission: show
fleets:
  swarm: {{count: 20, layout: {{grid: {{spacing: 4, origin: [0, 0, 0]}}}}, separation: 1, rise: 10}}
shots:
  - id: shapes
    kind: display
    fleet: swarm
    viewpoint: [0, -100, 2]
    frames:
      - {{sphere: {{center: [8, 8, 40], radius: 12}}, hold: 6, effects: [{frame}]}}
      - {{cube: {{center: [8, 8, 40], size: 20}}, hold: {hold}}}
    effects: [{display}]
"""


def checked(folder: Path, frame: str = "", display: str = "", hold: str = "4"):  # type: ignore[no-untyped-def]
    text = MISSION.format(frame=frame, display=display, hold=hold)
    return lower(text.encode(), "show.yaml", folder, Chosen())


def test_a_stack_is_what_is_written(tmp_path: Path) -> None:
    ramp = "ramp: {colors: [red, gold, blue], along: right, period: 3 s}"
    fade = "{fade: {to: black, time: 2 s}, from: 3 s, until: {frame: 2}}"
    done = checked(tmp_path, f"{{{ramp}, blend: screen, opacity: 50 %, over: hold}}", fade)
    assert done.keyframes is not None
    (display,) = done.keyframes.mission.displays
    (effect,) = display.pictures[0].effects
    assert isinstance(effect.paint, Ramp)
    assert effect.paint.at == (0.0, 0.5, 1.0)
    assert (effect.blend, effect.opacity, effect.over) == ("screen", 0.5, "hold")
    (over,) = display.effects
    assert over.paint == Fade((0, 0, 0), to=True, seconds=2.0)
    assert (over.since, over.until) == (DisplayTime(3.0, None), DisplayTime(None, 1))


@pytest.mark.parametrize(
    ("frame", "display", "code", "says"),
    [
        ("{ramp: {colors: [red, blue], at: [1, 0]}}", "", "D095", "[0, 1]"),
        ("{ramp: {colors: [red, blue], at: [0, 1, 1]}}", "", "D095", "2 places"),
        ("{ramp: {colors: [red, blue], along: upwards}}", "", "S009", "up"),
        ("{chase: {period: 0 s}}", "", "S014", "0.2"),
        ("{sparkle: {period: 0.1 s}}", "", "S014", "0.2"),
        ("{chase: {period: 0.3 s, length: 10 %}}", "", "D096", "`period: 0.80 s`, or `length: 0.27`"),
        ("", "{sparkle: {}, until: {frame: 3}}", "D097", "`until: {frame: 2}`"),
        ("", "{sparkle: {}, from: 5 s, until: 4 s}", "D098", "`until: 6 s`"),
        ("{image: {file: logo.jpg}}", "", "D011", ".png or .gif"),
        ("{fade: {to: red}, fade_in: 1 s}", "", "S005", ""),
    ],
)
def test_what_is_wrong_is_told_with_the_number_that_would_do(
    tmp_path: Path, frame: str, display: str, code: str, says: str
) -> None:
    (found,) = checked(tmp_path, frame, display).diagnostics
    assert found.code == code, (found.code, found.message, found.help)
    assert says in found.help
    assert found.labels[0].span.line == (13 if display else 11)


def png(width: int, height: int) -> bytes:
    """A PNG whose header says that it has so many pixels; it has none."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return pack(">I", len(data)) + kind + data + pack(">I", zlib.crc32(kind + data))

    head = chunk(b"IHDR", pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + head + chunk(b"IDAT", b"") + chunk(b"IEND", b"")


def gif(frames: int, size: tuple[int, int] = (2, 2)) -> bytes:
    stream = BytesIO()
    made = [Image.new("RGB", size, (i % 256, i // 256, 0)) for i in range(frames)]
    made[0].save(stream, "GIF", save_all=True, append_images=made[1:], duration=40)
    return stream.getvalue()


def test_an_image_is_refused_by_its_header(tmp_path: Path) -> None:
    (tmp_path / "huge.png").write_bytes(png(20_000, 5_000))
    (found,) = checked(tmp_path, "{image: {file: huge.png}}").diagnostics
    assert found.code == "D101"
    assert "100 million" in found.notes[0]
    assert "10000 x 2500" in found.help


@pytest.mark.slow
def test_a_film_of_too_many_frames_is_refused(tmp_path: Path) -> None:
    (tmp_path / "long.gif").write_bytes(gif(MOST_FRAMES + 1))
    (found,) = checked(tmp_path, "{image: {file: long.gif}}").diagnostics
    assert found.code == "D101"
    assert f"{MOST_FRAMES} frames" in found.help


@pytest.mark.parametrize("data", [b"no image", gif(3)[:-20], png(4, 4)[:-30], b"GIF89a", png(4, 4)[:8]])
def test_what_is_no_image_or_is_cut_short_is_told(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "bad.gif").write_bytes(data)
    (found,) = checked(tmp_path, "{image: {file: bad.gif}}").diagnostics
    assert (found.code, found.labels[0].span.line) == ("D100", 11)


def test_frames_of_images_are_counted_as_pillow_counts_them() -> None:
    for frames in (1, 2, 7):
        data = gif(frames)
        assert image_fault(data) is None
        with Image.open(BytesIO(data)) as image:
            assert len(read_frames(data, 100).ends) == image.n_frames  # type: ignore[union-attr, attr-defined]


def test_an_image_is_made_small_by_means() -> None:
    stream = BytesIO()
    chance = np.random.default_rng(1).integers(0, 256, (64, 128, 3), dtype=np.uint8)
    Image.fromarray(chance).save(stream, "PNG")
    found = read_frames(stream.getvalue(), 8)
    small = np.frombuffer(zlib.decompress(b64decode(found.rgba)), dtype=np.uint8)  # type: ignore[union-attr]
    assert (found.rows, found.columns) == (4, 8)  # type: ignore[union-attr]
    wanted = chance.reshape(4, 16, 8, 16, 3).mean(axis=(1, 3))
    assert np.abs(small.reshape(4, 8, 4)[..., :3] - wanted).max() <= 1.0


def test_damaged_pixels_are_told_when_they_are_read() -> None:
    assert "Pillow" in read_frames(png(4, 4), 10).message  # type: ignore[union-attr]

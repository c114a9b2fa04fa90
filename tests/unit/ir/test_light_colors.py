"""Effects of lights against what their words say, worked out light by light."""

from __future__ import annotations

import zlib
from base64 import b64encode

import numpy as np
import pytest

from shotc.ir.effects import LIGHT_RATE_HZ
from shotc.ir.light_colors import light_colors, lit_drones, tick_colors
from shotc.ir.light_layers import Axis, Band, Footage, Glints, Gradient, Order, Radius, Screen, Tint
from shotc.ir.light_paints import pixels
from tests.support.lit_shows import GREY, layer, line, lit, standing

EAST = Axis((1.0, 0.0, 0.0), 0.0, 10.0)
RED, BLUE, WHITE = (255, 0, 0), (0, 0, 255), (255, 255, 255)


def at(flight, *times):  # type: ignore[no-untyped-def]
    return light_colors(flight, np.array(times, dtype=float)).astype(int)


def test_a_ramp_is_the_interpolation_of_its_stops() -> None:
    ramp = Gradient((RED, WHITE, BLUE), (0.0, 0.3, 1.0), EAST, 0.0, 0.0, cyclic=False)
    found = at(lit(line(11), layer(ramp)), 10.0)[:, 0]
    share = np.arange(11) / 10
    wanted = np.stack(
        [np.interp(share, (0, 0.3, 1), channel) for channel in ((255, 255, 0), (0, 255, 0), (0, 255, 255))],
        axis=1,
    )
    assert np.abs(found - wanted).max() <= 0.5 + 1e-3


def test_a_ramp_goes_out_from_a_middle_and_along_the_numbers() -> None:
    both = (0.0, 1.0)
    out = Gradient((RED, BLUE), both, Radius((5.0, 0.0, 30.0), 5.0, inward=False), 0.0, 0.0, cyclic=False)
    found = at(lit(line(11), layer(out)), 10.0)[:, 0]
    assert found[5].tolist() == [255, 0, 0]
    assert found[0].tolist() == found[10].tolist() == [0, 0, 255]
    by_number = Gradient((RED, BLUE), both, Order(11), 0.0, 0.0, cyclic=False)
    turned = line(11)[::-1]
    assert at(lit(turned, layer(by_number)), 10.0)[:, 0, 2] == pytest.approx(25.5 * np.arange(11), abs=0.6)


def test_colours_that_go_come_past_at_their_speed() -> None:
    cyclic = Gradient((RED, BLUE, RED), (0.0, 0.5, 1.0), EAST, 1 / 4.0, 10.0, cyclic=True)
    flight = lit(line(11), layer(cyclic))
    # A picture of 10 m in 4 s: what is at 2 m is at 7 m two seconds later.
    assert at(flight, 10.0)[2].tolist() == at(flight, 12.0)[7].tolist()
    assert at(flight, 10.0).tolist() == at(flight, 14.0).tolist()


def test_a_chase_moves_with_its_speed() -> None:
    band = Band(WHITE, Axis((1.0, 0.0, 0.0), 0.0, 40.0), 1 / 4.0, 0.0, 0.25)
    flight = lit(line(41), layer(band, "add"))
    heads = []
    for time in np.arange(8.4, 11.0, 0.04):
        lights = at(flight, time)[:, 0, 0] - GREY[0]
        heads.append(np.average(np.arange(41), weights=lights))
    speed = np.polyfit(np.arange(8.4, 11.0, 0.04)[20:45], heads[20:45], 1)[0]
    assert speed == pytest.approx(10.0, rel=0.02)
    # A light rises over a quarter of the band and falls over the rest: 1 s in all, as 10 m pass at 10 m/s.
    course = at(flight, *np.arange(8.0, 12.0, 0.04))[0, :, 0] - GREY[0]
    assert (course > 0).sum() == pytest.approx(25, abs=1)
    assert np.argmax(course) * 0.04 == pytest.approx(0.25, abs=0.03)


def test_a_share_of_the_lights_sparkles_whoever_is_asked() -> None:
    flight = lit(line(2000), layer(Glints(WHITE, 0.2, 0.8, 7), "add"))
    times = np.arange(3.0, 17.0, 0.4)
    found = at(flight, *times)
    shares = (found[..., 0] > GREY[0]).mean(axis=0)
    assert shares.mean() == pytest.approx(0.2, abs=0.01)
    assert shares.max() < 0.25
    some = light_colors(flight, times, slice(700, 900))
    np.testing.assert_array_equal(some, found[700:900])
    other = at(lit(line(2000), layer(Glints(WHITE, 0.2, 0.8, 8), "add")), *times)
    both = ((found[..., 0] > GREY[0]) & (other[..., 0] > GREY[0])).mean()
    assert both == pytest.approx(0.04, abs=0.01)  # two sparkles know nothing of each other


@pytest.mark.parametrize(
    ("blend", "wanted"),
    [
        ("mix", lambda a, b: b),
        ("add", lambda a, b: min(a + b, 255)),
        ("multiply", lambda a, b: a * b / 255),
        ("screen", lambda a, b: 255 - (255 - a) * (255 - b) / 255),
        ("lighten", max),
        ("darken", min),
    ],
)
def test_blending(blend, wanted) -> None:  # type: ignore[no-untyped-def]
    color = (200, 40, 100)
    for opacity in (1.0, 0.25):
        found = at(lit(line(1), layer(Tint(color), blend, opacity)), 10.0)[0, 0]
        expected = [a + opacity * (wanted(a, b) - a) for a, b in zip(GREY, color, strict=True)]
        assert found == pytest.approx(expected, abs=0.51)


def test_effects_of_a_picture_come_and_go_with_it() -> None:
    flight = lit(line(2), layer(Tint(RED)))
    assert at(flight, 0.0, 1.0, 10.0, 19.0, 20.0)[0, :, 0].tolist() == [0, 128, 255, 128, 0]


def test_an_effect_over_all_rises_and_falls_and_leaves_spare_drones_dark() -> None:
    over = layer(Tint(WHITE), span=(4.0, 6.0, 8.0, 10.0))
    flight = lit(line(3), over=(over,), spare=(1,))
    red = at(flight, 3.96, 5.0, 7.0, 9.0, 10.04)[:, :, 0]
    assert red[0].tolist() == [60, pytest.approx(157.5, abs=1), 255, pytest.approx(157.5, abs=1), 60]
    assert not red[1].any()
    assert lit_drones(flight, np.array([7.0]))[:, 0].tolist() == [True, False, True]


def test_nothing_shines_on_the_pads_whatever_lies_over_it() -> None:
    flight = lit(line(2), over=(layer(Tint(WHITE)),))
    assert not at(flight, 0.0, 20.0).any()


def test_lights_change_evenly_between_moments() -> None:
    flight = lit(line(50), layer(Glints(WHITE, 0.5, 0.3, 1)))
    one, other = tick_colors(flight, np.array([100, 101])).astype(float).transpose(1, 0, 2)
    found = at(flight, (100 + 0.25) / LIGHT_RATE_HZ)[:, 0]
    assert np.abs(found - (0.75 * one + 0.25 * other)).max() <= 0.51


def test_lights_without_effects_are_as_they_were() -> None:
    assert at(standing(line(2)), 1.0)[0, 0].tolist() == [30, 40, 50]


SCREEN = Screen((0.0, -50.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 1.0, 0.0), -0.2, -0.1, 0.4, 0.2)


def footage(frames: np.ndarray, ends: tuple[float, ...]) -> Footage:
    packed = b64encode(zlib.compress(frames.tobytes())).decode()
    return Footage(packed, frames.shape[1], frames.shape[2], ends, 0.0, SCREEN)


def test_an_image_is_what_a_projector_throws() -> None:
    chance = np.random.default_rng(3)
    image = chance.integers(0, 256, (1, 9, 16, 4), dtype=np.uint8)
    places = np.stack(
        [chance.uniform(-14, 14, 300), chance.uniform(-10, 20, 300), chance.uniform(-7, 7, 300)], axis=1
    )
    found = at(lit(places, layer(footage(image, (1.0,)))), 10.0)[:, 0]
    for place, color in zip(places, found, strict=True):
        # By similar triangles, on a wall 50 m from the eye that is 20 m wide and 10 m high.
        scale = 50.0 / (place[1] + 50.0)
        column, row = (place[0] * scale + 10.0) / 20.0 * 16 - 0.5, (5.0 - place[2] * scale) / 10.0 * 9 - 0.5
        wanted = np.array(GREY, dtype=float)
        if abs(place[0] * scale) <= 10.0 and abs(place[2] * scale) <= 5.0:
            column, row = float(np.clip(column, 0, 15)), float(np.clip(row, 0, 8))
            pixel = np.zeros(4)
            for i in (int(row), min(int(row) + 1, 8)):
                for j in (int(column), min(int(column) + 1, 15)):
                    if i + j >= 0:
                        pixel += _weight(i, row) * _weight(j, column) * image[0, i, j] / _times(row, column)
            wanted += pixel[3] / 255 * (pixel[:3] - wanted)
        assert np.abs(color - wanted).max() <= 1.0


def _weight(index: int, at: float) -> float:
    return max(0.0, 1.0 - abs(index - at))


def _times(row: float, column: float) -> int:
    return (2 if row == 8 else 1) * (2 if column == 15 else 1)


def test_frames_follow_each_other_and_begin_anew() -> None:
    frames = np.zeros((3, 1, 1, 4), dtype=np.uint8)
    frames[:, 0, 0] = [(10, 0, 0, 255), (20, 0, 0, 255), (30, 0, 0, 0)]
    flight = lit(np.zeros((1, 3)), layer(footage(frames, (0.4, 1.0, 1.2))))
    assert at(flight, 12.2, 12.6, 13.12, 13.4)[0, :, 0].tolist() == [10, 20, GREY[0], 10]


def test_pixels_of_another_number_are_refused() -> None:
    one = np.zeros((1, 2, 2, 4), dtype=np.uint8)
    made = footage(one, (1.0,))
    with pytest.raises(ValueError, match="bytes"):
        pixels(made._replace(rows=3))
    with pytest.raises(ValueError, match="bytes"):
        pixels(made._replace(rows=1))

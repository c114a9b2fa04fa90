"""Flat pictures: every light on a stroke, spare ones dark behind it, and remedies that do what they say."""

from __future__ import annotations

import re

import numpy as np
import pytest
from scipy.spatial.distance import pdist

from shotc.diag.model import Diagnostic
from shotc.geom.apart import spacing, straight_spacing, stretch
from shotc.geom.solids import box
from shotc.ir.fleet import Frame
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import Zone
from shotc.ir.passes import PassContext
from shotc.ir.show import Apart, Drawing, Lettering, Source
from shotc.show.goals import PlaceGoals
from shotc.show.goals.flat import FlatBody
from shotc.show.goals.picture import bodies_of
from tests.support.display_missions import display, fleet, picture, show

pytestmark = pytest.mark.slow

CENTRE = (0.0, 20.0, 40.0)
EYE = (0.0, -90.0, 2.0)
APART = Apart("ellipsoid", 1.2, 2.0, 0.2)
SCALE = np.array([1.0, stretch(APART)])
HEART = b"""<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 90"><path d="M50 85 C 10 55 0 35 5 20 \
C 12 0 40 0 50 22 C 60 0 88 0 95 20 C 100 35 90 55 50 85 Z"/></svg>"""
FILES = {"heart.svg": HEART}


def text(words: str, height: float) -> Lettering:
    return Lettering(words, CENTRE, height, 0.0, None)


def heart(height: float, z: float = 40.0) -> Drawing:
    return Drawing("heart.svg", (0.0, 20.0, z), height, 0.0)


def mission(
    source: Source, fill: str, count: int, zones: tuple[Zone, ...] = (), apart: Apart = APART
) -> KeyframeIR:
    drawn = display(picture(source, fill, color=(255, 0, 0)), viewpoint=EYE, weight=0.5)
    return show(drawn, fleet(count, apart), zones, FILES)


def placed(ir: KeyframeIR) -> tuple[Frame, tuple[Diagnostic, ...]]:
    outcome = PlaceGoals().run(ir, PassContext())
    assert outcome.value is not None, outcome.diagnostics
    return outcome.value.fleets[0].frames[0], outcome.diagnostics


def codes(ir: KeyframeIR) -> list[str]:
    return [d.code for d in PlaceGoals().run(ir, PassContext()).diagnostics]


def lights(frame: Frame) -> np.ndarray:
    return frame.points[frame.colors.any(axis=1)]


def off_strokes(source: Source, fill: str, points: np.ndarray) -> np.ndarray:
    """How far points are from a picture's strokes, (n,), in the metric of the fleet."""
    bodies = bodies_of(picture(source, fill), FILES)
    assert isinstance(bodies, list)
    (body,) = bodies
    assert isinstance(body, FlatBody)
    edges = np.concatenate([shape.edges for shape in body.shapes]) * SCALE
    at = body.flat(points) * SCALE
    start, way = edges[:, 0], edges[:, 1] - edges[:, 0]
    from_start = at[:, None] - start
    share = np.clip((from_start * way).sum(-1) / np.maximum((way * way).sum(-1), 1e-12), 0.0, 1.0)
    beside = np.linalg.norm(from_start - share[..., None] * way, axis=-1).min(axis=1)
    if fill == "outline":
        return np.asarray(beside)
    (x, y), (x0, y0), (x1, y1) = at.T[:, :, None], edges[:, 0].T, edges[:, 1].T
    over = (y0 <= y) != (y1 <= y)
    beyond = x < x0 + (y - y0) / np.where(y1 == y0, 1.0, y1 - y0) * (x1 - x0)
    inside = (over & beyond).sum(axis=1) % 2 == 1
    return np.where(inside, 0.0, beside)


CASES = [
    (text("LOVE", 14.0), "volume", 60),
    (text("LOVE", 18.0), "outline", 60),
    (text("LOVE", 18.0), "outline", 74),
    pytest.param(text("LOVE", 22.2), "volume", 200, marks=pytest.mark.fuzz),
    (text("GO", 22.0), "outline", 60),
    (heart(23.7), "outline", 60),
    (heart(40.0), "volume", 150),
]


@pytest.mark.long
@pytest.mark.parametrize(("source", "fill", "count"), CASES)
def test_no_light_is_beside_a_stroke(source: Source, fill: str, count: int) -> None:
    frame, _ = placed(mission(source, fill, count))
    assert len(frame.points) == count
    least = spacing(APART)
    assert off_strokes(source, fill, lights(frame)).max() < 0.25 * straight_spacing(APART)
    assert pdist(frame.points * (1.0, 1.0, stretch(APART))).min() >= least * (1 - 1e-9)


def test_few_lights_write_along_the_strokes_and_many_along_the_outline() -> None:
    source = text("LOVE", 22.0)
    few, many = (lights(placed(mission(source, "legible", n))[0]) for n in (60, 130))
    assert (off_strokes(source, "outline", many) < 0.25).mean() > 0.95
    assert (off_strokes(source, "outline", few) < 0.25).mean() < 0.5
    assert not codes(mission(source, "legible", 60)) + codes(mission(source, "legible", 130))


@pytest.mark.long
def test_spare_drones_are_dark_behind_the_picture() -> None:
    frame, (warning,) = placed(mission(heart(23.7), "outline", 60))
    dark = ~frame.colors.any(axis=1)
    assert warning.code == "D062"
    assert int(warning.message.split()[0]) == dark.sum() > 0
    assert frame.points[~dark][:, 1] == pytest.approx(20.0, abs=1e-9)
    assert frame.points[dark][:, 1].min() > 20.0 + spacing(APART)  # who looks stands in the south


@pytest.mark.long
def test_spare_drones_stand_in_front_where_there_is_no_room_behind() -> None:
    wall = Zone("wall", "out", box((0.0, 24.0, 40.0), (300.0, 6.0, 80.0), 0.0), ("world", "zones", "wall"))
    frame, _ = placed(mission(heart(23.7), "outline", 60, (wall,)))
    dark = ~frame.colors.any(axis=1)
    assert (frame.points[dark][:, 1] < 20.0).all()


@pytest.mark.long
def test_what_the_help_of_dark_drones_says_lights_all() -> None:
    ir = mission(heart(23.7), "outline", 60)
    (warning,) = PlaceGoals().run(ir, PassContext()).diagnostics
    assert warning.code == "D062"
    number, height, level, upright = numbers(warning)
    assert not codes(mission(heart(23.7), "outline", int(number)))
    assert not codes(mission(heart(height), "outline", 60))
    less = Apart("ellipsoid", level, upright, APART.margin)
    assert not codes(mission(heart(23.7), "outline", 60, apart=less))


def numbers(found: Diagnostic) -> list[float]:
    """The number of drones, the height and both separations that a help names."""
    words = re.fullmatch(
        r"use (\d+) drones \(`count: \1`\), or make it [\d.]+ times as large \(`height: ([\d.]+)[^`]*`\), "
        r"or keep a `separation` of ([\d.]+) m, ([\d.]+) m vertically",
        found.help,
    )
    assert words is not None, found.help
    return [float(word) for word in words.groups()]


@pytest.mark.long
def test_a_fleet_that_is_mostly_dark_is_told_where_to_put_a_larger_picture() -> None:
    (fault,) = PlaceGoals().run(mission(heart(23.7), "outline", 200), PassContext()).diagnostics
    assert fault.code == "D062"
    words = re.search(r"use (\d+) drones .*`height: ([\d.]+), center: \[0, 20, ([\d.]+)\]`", fault.help)
    assert words is not None, fault.help
    number, height, z = int(words[1]), float(words[2]), float(words[3])
    assert fault.message.startswith(f"{200 - number} of 200 drones")
    assert z - height / 2 >= 2.3 - 1e-6  # over the ground by the clearance and a body
    assert not codes(mission(heart(23.7), "outline", number))
    assert not codes(mission(heart(height, z), "outline", 200))


@pytest.mark.parametrize("fill", ["outline", "volume", "legible"])
def test_as_many_drones_as_a_text_is_said_to_need_are_enough(fill: str) -> None:
    source = text("LOVE", 20.0)
    (warning,) = PlaceGoals().run(mission(source, fill, 24), PassContext()).diagnostics
    assert warning.code == "D057"
    enough = int(warning.help.split("use ")[1].split()[0])
    assert not codes(mission(source, fill, enough))


def test_an_outline_with_too_few_lights_is_better_left_out() -> None:
    (warning,) = PlaceGoals().run(mission(text("LOVE", 18.0), "outline", 60), PassContext()).diagnostics
    assert (warning.code, "or leave `fill` out" in warning.help) == ("D057", True)
    assert not codes(mission(text("LOVE", 18.0), "legible", 60))


def test_letters_too_small_for_the_spacing() -> None:
    small = text("go", 9.0)
    (warning,) = PlaceGoals().run(mission(small, "legible", 30), PassContext()).diagnostics
    height = float(warning.help.split("height: ")[1].split("`")[0])
    assert warning.code == "D063"
    assert "D063" not in codes(mission(text("go", height), "legible", 30))
    assert "D063" not in codes(mission(text("GO", 9.0), "legible", 30))


@pytest.mark.long
@pytest.mark.parametrize("apart", [APART, Apart("cylinder", 1.2, 2.0, 0.2)])
def test_layers_show_more_lights_of_which_none_is_beside_a_stroke(apart: Apart) -> None:
    source = text("LOVE", 14.0)
    one = mission(source, "volume", 320, apart=apart)
    drawn = one.mission.displays[0].pictures[0]._replace(layers=3)
    display_ = one.mission.displays[0]._replace(pictures=(drawn,))
    three = KeyframeIR(one.mission._replace(displays=(display_,)), ())
    flat, deep = (placed(ir)[0] for ir in (one, three))
    assert len(lights(deep)) > 1.4 * len(lights(flat))
    scaled = deep.points * (1.0, 1.0, stretch(apart))
    level, up = (pdist(part) for part in (scaled[:, :2], scaled[:, 2:]))
    size = np.hypot(level, up) if apart.shape == "ellipsoid" else np.maximum(level, up)
    assert size.min() >= apart.across * (1 - 1e-9)
    assert len(np.unique(lights(deep)[:, 1].round(6))) == 3
    assert off_strokes(source, "volume", lights(deep)).max() < 0.25 * straight_spacing(APART)

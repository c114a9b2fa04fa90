"""What pictures are drawn from: built-in solids by formula, letters, SVG files friendly and hostile."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np
import pytest

from shotc.ir.show import Box, Drawing, Lettering, Sphere, Torus
from shotc.show.goals.body import SourceFault
from shotc.show.goals.drawing import drawing_body
from shotc.show.goals.flat import FlatBody
from shotc.show.goals.lettering import lettering_body
from shotc.show.goals.solids import solid_body

HERE = (1.0, 2.0, 40.0)


def rng() -> np.random.Generator:
    return np.random.default_rng(0)


def off_centre(source, fill: str, count: int = 40_000) -> np.ndarray:
    points = solid_body(source).draw(fill, count, rng())  # type: ignore[arg-type]
    assert points is not None
    assert points.shape == (count, 3)
    return points - HERE


def test_a_ball_by_radius() -> None:
    reach = np.linalg.norm(off_centre(Sphere(HERE, 5.0), "volume"), axis=1)
    assert np.quantile(reach, [0.125, 0.5]) == pytest.approx([2.5, 5 * 0.5 ** (1 / 3)], rel=0.02)
    assert np.linalg.norm(off_centre(Sphere(HERE, 5.0), "surface"), axis=1) == pytest.approx(5.0)


def test_a_ring_is_even_in_volume_and_area() -> None:
    ring = Torus(HERE, 10.0, 4.0, 0.0, 0.0)
    for fill, moment in (("volume", 10 + 4**2 / (4 * 10)), ("surface", 10 + 4**2 / (2 * 10))):
        reach = np.hypot(*off_centre(ring, fill)[:, :2].T)
        # Pappus: the mean distance from the axis of a body of revolution.
        assert reach.mean() == pytest.approx(moment, rel=0.005)


def test_a_ring_leans_along_its_heading() -> None:
    ring = Torus(HERE, 10.0, 1.0, pi / 2, pi / 2)
    assert np.abs(off_centre(ring, "volume")[:, 0]).max() <= 1.0 + 1e-9  # its axis points east


def test_a_box_by_its_sides() -> None:
    box = Box(HERE, (2.0, 4.0, 6.0), 0.0)
    faces = np.isclose(np.abs(off_centre(box, "surface")), [1, 2, 3])
    assert (faces.sum(axis=1) >= 1).all()
    assert faces.mean(axis=0) == pytest.approx(np.array([24, 12, 8]) / 44, abs=0.01)
    edges = np.isclose(np.abs(off_centre(box, "outline")), [1, 2, 3])
    assert (edges.sum(axis=1) >= 2).all()
    assert 1 - edges.mean(axis=0) == pytest.approx(np.array([2, 4, 6]) / 12, abs=0.01)
    turned = off_centre(Box(HERE, (2.0, 4.0, 6.0), pi / 2), "volume")
    assert np.ptp(turned, axis=0) == pytest.approx([4, 2, 6], rel=0.01)


def text_body(text: str, font: str | None = None, files: dict[str, bytes] | None = None):
    return lettering_body(Lettering(text, HERE, 10.0, 0.0, font), files or {})


def test_capitals_have_the_height_that_is_asked_for() -> None:
    points = text_body("HI").draw("outline", 5000, rng())
    assert np.ptp(points[:, 2]) == pytest.approx(10.0, rel=0.01)
    assert (points.min(axis=0) + points.max(axis=0)) / 2 == pytest.approx(HERE, abs=0.02)
    assert points[:, 1] == pytest.approx(2.0)


def test_holes_of_letters_stay_empty() -> None:
    points = text_body("O").draw("volume", 4000, rng())
    off = np.abs(points - HERE) / np.ptp(points, axis=0).max()
    assert np.hypot(off[:, 0], off[:, 2]).min() > 0.2


def test_a_dollar_is_no_formula() -> None:
    assert text_body("$5$").outlines > text_body("5").outlines * 2


def test_a_font_of_the_mission() -> None:
    import matplotlib

    data = (Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans-Bold.ttf").read_bytes()
    bold = text_body("HI", "my.ttf", {"my.ttf": data})
    assert isinstance(bold, FlatBody)
    assert bold.outlines != text_body("HI").outlines


@pytest.mark.parametrize(
    ("text", "font", "files", "told"),
    [
        ("HI", "No Such Font", {}, "unknown font"),
        ("HI", "my.ttf", {"my.ttf": b"hello"}, "cannot be read as a font"),
        ("HI", "my.ttf", {"my.ttf": b""}, "cannot be read as a font"),
        ("漢字", None, {}, "cannot write"),
        ("  ", None, {}, "no letters"),
    ],
)
def test_texts_that_cannot_be_written(text: str, font: str | None, files, told: str) -> None:
    fault = text_body(text, font, files)
    assert isinstance(fault, SourceFault)
    assert fault.code == "D055"
    assert told in fault.message


def svg(body: str) -> bytes:
    return (
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
        f'viewBox="0 0 100 100">{body}</svg>'
    ).encode()


def drawn(data: bytes):
    return drawing_body(Drawing("a.svg", HERE, 20.0, 0.0), data)


def area(body: FlatBody) -> float:
    """Return the share of its bounding square that a drawing fills, times 400 m^2."""
    points = body.draw("surface", 20_000, rng()) - HERE
    cells = {(int(x * 5), int(z * 5)) for x, _, z in points + 100}
    return len(cells) / 25.0


def test_a_drawing_is_upright_and_scaled() -> None:
    body = drawn(svg('<path d="M10 10 L90 10 L50 90 Z"/>'))  # points down
    points = body.draw("surface", 20_000, rng()) - HERE
    assert np.ptp(points, axis=0) == pytest.approx([20, 0, 20], abs=0.5)
    assert points[:, 2].mean() == pytest.approx(20 / 6, abs=0.1)


@pytest.mark.slow
def test_shapes_that_overlap_are_filled_once_and_holes_not_at_all() -> None:
    square = '<rect x="0" y="0" width="50" height="50"/>'
    assert area(drawn(svg(square + square))) == pytest.approx(area(drawn(svg(square))), rel=0.02)
    hole = '<path fill-rule="evenodd" d="M0 0h40v40h-40z M10 10h20v20h-20z"/>'
    assert area(drawn(svg(hole))) == pytest.approx(300.0, rel=0.1)


def test_lines_groups_and_what_is_used_again() -> None:
    body = drawn(
        svg(
            '<defs><circle id="c" r="10"/></defs><use xlink:href="#c" x="20" y="20"/>'
            '<g transform="translate(60,60)"><use href="#c"/></g>'
            '<line x1="0" y1="90" x2="90" y2="90" style="fill:none;stroke:red;stroke-width:4"/>'
            '<rect width="90" height="5" display="none"/>'
            '<g visibility="hidden"><rect width="9" height="9"/></g>'
        )
    )
    assert [shape.filled for shape in body.shapes] == [True, True, False]
    points = body.draw("surface", 10_000, rng())
    line = np.isclose(points[:, 2], points[:, 2].min()).mean()
    assert line == pytest.approx(360 / (360 + 2 * np.pi * 100), abs=0.01)


LAUGHS = '<g id="a0"><rect width="1" height="1"/></g>' + "".join(
    f'<g id="a{k}">' + f'<use href="#a{k - 1}"/>' * 10 + "</g>" for k in range(1, 9)
)
DEEP = '<g id="a0"><rect width="1" height="1"/></g>' + "".join(
    f'<g id="a{k}"><use href="#a{k - 1}"/></g>' for k in range(1, 400)
)


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (svg("<script>alert(1)</script>"), "script"),
        (svg('<rect onload="x()" width="5" height="5"/>'), "`onload` is a script"),
        (svg('<image href="#a"/>'), "an image"),
        (svg("<foreignObject/>"), "foreign"),
        (svg("<text>hi</text>"), "a text"),
        (svg('<use href="http://example.com/y.svg#a"/>'), "which is not in it"),
        (svg('<use xlink:href="other.svg#a"/>'), "which is not in it"),
        (svg("<style>@import url(http://example.com)</style>"), "another file"),
        (svg('<rect fill="url(http://example.com/#a)" width="5" height="5"/>'), "outside of it"),
        (svg(LAUGHS), "more than 100000 elements"),
        (svg(DEEP), "goes on for ever"),
        (svg('<g id="a"><use href="#a"/></g>'), "goes on for ever"),
        (b'<!DOCTYPE svg [<!ENTITY a "b">]><svg/>', "document type"),
        (b"", "no XML"),
        (b"\xff\xfe\x00", "no XML"),
        (b"<html/>", "its root is `html`"),
        (svg(""), "no path"),
        (svg('<path d="M0 0 L nan 5"/>'), ""),
        (svg('<path d="M0 0 L 1e400 5 L 5 5z"/>'), "no numbers"),
        (svg('<line x2="5" y1="3" y2="3" stroke="red"/>'), "level line"),
    ],
)
def test_drawings_that_are_refused(data: bytes, told: str) -> None:
    fault = drawn(data)
    assert isinstance(fault, SourceFault)
    assert fault.code == "D054"
    assert told in fault.notes[0]
    assert fault.help


def test_gradients_of_the_file_itself_are_fine() -> None:
    body = drawn(svg('<rect fill="url(\'#g\')" width="5" height="5"/>'))
    assert isinstance(body, FlatBody)
    assert body.shapes[0].filled


def painted(body: str, places: list[tuple[float, float]]) -> list[tuple[int, ...]] | None:
    """Return the colours at places of a drawing 100 wide and high, in its own units."""
    corners = '<path d="M0 0 L0 0.01 M100 100 L100 99.99" fill="none" stroke="#010101"/>'
    drawing = drawing_body(Drawing("a.svg", HERE, 100.0, 0.0), svg(corners + body))
    assert isinstance(drawing, FlatBody)
    at = np.array([[x - 50.0, 0.0, 50.0 - y] for x, y in places]) + np.array(HERE)
    found = drawing.colors(at)
    return None if found is None else [tuple(row) for row in found.tolist()]


def test_lights_have_the_colours_of_what_is_painted() -> None:
    inherited = '<style>.sea{fill:#08f}</style><g fill="red"><rect width="60" height="60"/>'
    over = '<rect class="sea" x="20" y="20" width="20" height="20"/></g>'
    over += '<rect x="80" width="10" height="10" fill="lime"/>'
    line = '<path d="M0 90 H100" fill="none" stroke="rgb(255,128,0)"/>'
    places = [(10.0, 10.0), (30.0, 30.0), (85.0, 5.0), (62.0, 30.0), (50.0, 91.0)]
    assert painted(inherited + over + line, places) == [
        (255, 0, 0),
        (0, 136, 255),
        (0, 255, 0),
        (255, 0, 0),  # beside it: the nearest
        (255, 128, 0),
    ]
    ring = '<path fill="red" fill-rule="evenodd" d="M10 10 H90 V90 H10 Z M30 30 H70 V70 H30 Z"/>'
    under = '<rect x="5" y="5" width="90" height="90" fill="blue"/>'
    assert painted(under + ring, [(20.0, 20.0), (50.0, 50.0)]) == [(255, 0, 0), (0, 0, 255)]


NO_LIGHT = (
    "",
    'fill="black"',
    'fill="rubbish"',
    'fill="#12"',
    'fill="url(#none)"',
    'fill="rgba(0,255,0,0)"',
    'fill="currentColor"',
    'style="fill:expression(1)"',
    'fill="rgb(nan,1e999,-4)"',
)


@pytest.mark.parametrize("paint", NO_LIGHT)
def test_what_is_no_colour_of_a_light_is_left_white(paint: str) -> None:
    other = '<rect x="60" width="30" height="30" fill="red"/>'
    assert painted(f'<rect width="30" height="30" {paint}/>', [(15.0, 15.0)]) is None
    assert painted(f'<rect width="30" height="30" {paint}/>{other}', [(15.0, 15.0), (70.0, 9.0)]) == [
        (255, 255, 255),
        (255, 0, 0),
    ]

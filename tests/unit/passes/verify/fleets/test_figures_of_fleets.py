"""The shapes that verification draws: distances, middles and widths known from formulas."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest
from scipy.spatial import cKDTree

from shotc.ir.show import Box, Lettering, Sphere, Torus
from shotc.passes.verify.fleets.pictures.figure import Figure
from shotc.passes.verify.fleets.pictures.solids import solid_figure
from shotc.passes.verify.fleets.pictures.texts import text_figure
from shotc.show.goals.flat import FlatBody
from shotc.show.goals.lettering import lettering_body

pytestmark = pytest.mark.slow

CENTRE = (3.0, -2.0, 40.0)
BALL = Sphere(CENTRE, 10.0)
CUBE = Box(CENTRE, (20.0, 20.0, 20.0), 0.5)
RING = Torus(CENTRE, 12.0, 3.0, 0.4, 0.7)


@pytest.mark.parametrize(
    ("source", "fill", "variances"),
    [
        (BALL, "volume", [20.0] * 3),  # r^2 / 5
        (BALL, "surface", [100.0 / 3.0] * 3),  # r^2 / 3
        (CUBE, "volume", [400.0 / 12.0] * 3),
        (CUBE, "surface", [(100.0 + 2.0 * 400.0 / 12.0) / 3.0] * 3),
        (CUBE, "outline", [(2.0 * 100.0 + 400.0 / 12.0) / 3.0] * 3),
        # By Pappus: R^2 / 2 + 5 r^2 / 8 across, r^2 / 4 along the axis; twice the terms in r of the surface.
        (RING, "volume", [9.0 / 4.0, 72.0 + 45.0 / 8.0, 72.0 + 45.0 / 8.0]),
        (RING, "surface", [9.0 / 2.0, 72.0 + 45.0 / 4.0, 72.0 + 45.0 / 4.0]),
    ],
)
def test_solids_have_the_middle_and_the_width_of_their_formulas(
    source: Sphere | Box | Torus, fill: str, variances: list[float]
) -> None:
    figure = solid_figure(source, fill)  # type: ignore[arg-type]
    assert figure.middle == pytest.approx(CENTRE, abs=0.01)
    assert np.linalg.eigvalsh(figure.spread) == pytest.approx(variances, rel=0.06)
    assert figure.off(figure.points).max() == pytest.approx(0.0, abs=1e-9)


def across(figure: Figure, *offsets: tuple[float, float, float]) -> list[float]:
    return [float(d) for d in figure.off(np.array(CENTRE) + np.array(offsets))]


def test_distances_from_solids() -> None:
    assert across(solid_figure(BALL, "volume"), (0, 0, 0), (0, 13, 0)) == pytest.approx([0.0, 3.0])
    assert across(solid_figure(BALL, "surface"), (0, 0, 0), (0, 13, 0)) == pytest.approx([10.0, 3.0])
    cube = CUBE._replace(heading=0.0)
    places = ((0.0, 0.0, 0.0), (13.0, 14.0, 0.0), (9.0, 8.0, 0.0), (9.0, 8.0, 14.0))
    assert across(solid_figure(cube, "volume"), *places) == pytest.approx([0.0, 5.0, 0.0, 4.0])
    assert across(solid_figure(cube, "surface"), *places) == pytest.approx([10.0, 5.0, 1.0, 4.0])
    edges = [sqrt(200.0), 5.0, sqrt(5.0), sqrt(17.0)]
    assert across(solid_figure(cube, "outline"), *places) == pytest.approx(edges)
    flat = RING._replace(tilt=0.0)
    rings = ((0.0, 0.0, 0.0), (0.0, 12.0, 1.0), (0.0, 12.0, 5.0))
    assert across(solid_figure(flat, "volume"), *rings) == pytest.approx([9.0, 0.0, 2.0])
    assert across(solid_figure(flat, "surface"), *rings) == pytest.approx([9.0, 2.0, 2.0])


def test_a_cube_and_a_ring_are_turned_by_compass() -> None:
    # The axis lies to the North-East, so the ring stands from the South-East to the North-West.
    ring = solid_figure(RING._replace(heading=pi / 4, tilt=pi / 2), "volume")
    assert across(ring, (0, 0, 12), (8, -8, 0)) == pytest.approx([0.0, 0.0])
    assert across(ring, (8, 8, 0))[0] > 10.0
    cube = solid_figure(CUBE._replace(heading=pi / 4), "volume")
    assert across(cube, (0, 14.1, 0), (11, 11, 0)) == pytest.approx([0.0, sqrt(242.0) - 10.0])


@pytest.mark.parametrize("text", ["AB", "gj $5 $"])
def test_a_text_is_the_one_that_planning_draws(text: str) -> None:
    source = Lettering(text, CENTRE, 20.0, 0.6, None)
    body = lettering_body(source, {})
    assert isinstance(body, FlatBody)
    for fill, gap in (("volume", 1.5), ("outline", 1.0)):
        figure, drawn = (
            text_figure(source, outline=fill == "outline"),
            body.draw(fill, 3000, np.random.default_rng(0)),  # type: ignore[arg-type]
        )
        assert figure is not None
        assert drawn is not None
        assert figure.off(drawn).max() < 0.1
        assert cKDTree(drawn).query(figure.points)[0].max() < gap
        assert figure.middle == pytest.approx(drawn.mean(axis=0), abs=0.4)


def test_the_hole_of_a_letter_is_off_it() -> None:
    figure = text_figure(Lettering("O", CENTRE, 20.0, 0.0, None), outline=False)
    assert figure is not None
    hole, before = across(figure, (0.0, 0.0, 0.0), (0.0, 4.0, 0.0))
    assert hole > 4.0
    assert before == pytest.approx(np.hypot(hole, 4.0))


def test_a_text_of_another_font_is_not_known() -> None:
    assert text_figure(Lettering("O", CENTRE, 20.0, 0.0, "DejaVu Serif"), outline=False) is None

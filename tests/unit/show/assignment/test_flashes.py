"""Flashes counted against signals whose number of them is known."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.ir.light_layers import Glints, Gradient
from shotc.show.assignment.flashes import flashing, luminance, most_flashes
from tests.support import show_flights
from tests.support.lit_shows import layer, line, lit
from tests.support.records import replace

T = np.arange(0.0, 4.0, 0.04)


@pytest.mark.parametrize("rate", [1.0, 2.5, 4.0, 5.0])
def test_a_square_wave_has_its_rate(rate: float) -> None:
    found = most_flashes((np.sin(2 * np.pi * rate * T + 0.1) > 0).astype(float))
    assert found.number == pytest.approx(rate, abs=0.51)


@pytest.mark.parametrize(
    "levels",
    [
        0.5 + 0.04 * np.sin(2 * np.pi * 6 * T),  # no change of a tenth
        0.9 + 0.08 * np.sin(2 * np.pi * 6 * T),  # the darker is bright
        T / 4.0,  # it only rises
    ],
)
def test_what_is_no_flash(levels: np.ndarray) -> None:
    assert most_flashes(levels).number == 0


def test_a_fleet_that_flashes_is_told_and_one_that_sparkles_is_not() -> None:
    black, white = (0, 0, 0), (255, 255, 255)
    strobe = Gradient((black, white, black), (0.0, 0.5, 1.0), None, -5.0, 0.0, cyclic=True)
    mission = show_flights.mission()
    flight = replace(lit(line(30), layer(strobe)), shown=show_flights.flight(show_flights.fleet(4)).shown)
    (found,) = flashing(mission, flight)
    assert found.code == "D102"
    assert "5 times" in found.message
    calm = lit(line(300), layer(Glints(white, 0.5, 0.2, 3)))
    assert np.ptp(luminance(calm)[100:400]) < 0.1
    assert flashing(mission, calm) == []

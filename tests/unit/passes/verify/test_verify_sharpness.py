"""The apertures and shutters that are proposed against blur."""

from __future__ import annotations

from math import floor

import numpy as np
import pytest

from shotc.passes.verify.sharpness import STOPS, _time


def test_stops_let_in_half_the_light_each_as_they_are_engraved() -> None:
    exact = [2.0 ** (k / 2) for k in range(1, len(STOPS) + 1)]
    # Two digits, the rest left out; whole from f/10 on.
    assert pytest.approx([floor(10 * f + 1e-9) / 10 if f < 10 else floor(f + 1e-9) for f in exact]) == STOPS


@pytest.mark.parametrize(
    "seconds", [1 / 8, 1 / 10, 1 / 99, 1 / 100, 1 / 101, 1 / 1234, 0.00371, 1 / 7999.5, 0.9]
)
def test_a_shutter_is_no_longer_than_asked_and_has_two_digits(seconds: float) -> None:
    text = _time(seconds)
    rate = int(text.removeprefix("1/").removesuffix(" s"))
    assert 1 / rate <= seconds * (1 + 1e-9)
    step = 10 ** max(int(np.floor(np.log10(rate))) - 1, 0)
    assert rate % step == 0
    assert rate - step < 1 / seconds * (1 + 1e-9)

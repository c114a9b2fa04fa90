"""Light programs of effects, played back by the tests' own reader."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.ir.light_colors import light_colors
from shotc.ir.light_layers import Axis, Band, Glints, Gradient, Layer
from shotc.show.emit.skyc.light_programs import TOLERANCE_LEVELS, programs
from tests.support.lit_shows import layer, line, lit
from tests.support.skyc_reader import color_at

ACROSS = Axis((1.0, 0.0, 0.0), 0.0, 10.0)
RED, BLUE, WHITE = (255, 0, 0), (0, 0, 255), (255, 255, 255)
STACKS: dict[str, tuple[Layer, ...]] = {
    "ramp that goes": (layer(Gradient((RED, BLUE, RED), (0.0, 0.5, 1.0), ACROSS, 0.5, 2.0, cyclic=True)),),
    "chase": (layer(Band(WHITE, ACROSS, 0.7, 0.0, 0.3), "add"),),
    "sparkle over a ramp": (
        layer(Gradient((RED, BLUE), (0.0, 1.0), ACROSS, 0.0, 0.0, cyclic=False)),
        layer(Glints(WHITE, 0.3, 0.3, 5), "screen", 0.8),
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", STACKS)
def test_a_program_plays_back_what_is_planned(name: str) -> None:
    flight = lit(line(8), *STACKS[name])
    times = np.arange(0.0, 20.0, 0.0237)  # between the moments, too
    wanted = light_colors(flight, times)
    for drone, code in enumerate(programs(flight)):
        found = np.array([color_at(code, t) for t in times])
        # Half a level is the rounding of what is wanted at a time between two moments.
        assert np.abs(found - wanted[drone]).max() <= TOLERANCE_LEVELS + 0.51


def test_it_keeps_few_moments_of_what_changes_evenly() -> None:
    still = lit(line(8), *STACKS["sparkle over a ramp"][:1])
    for code in programs(still):
        assert len(code) <= 60
    (noisy, *_) = programs(lit(line(8), *STACKS["sparkle over a ramp"]))
    assert len(noisy) < 20 * 25 * 5 / 2

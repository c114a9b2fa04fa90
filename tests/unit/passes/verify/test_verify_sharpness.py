"""The apertures and shutters that are proposed against blur."""

from __future__ import annotations

from math import floor, inf
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from shotc.ir.drone import Optics
from shotc.passes.verify import sharpness as module
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.sharpness import _stop_down, _time
from shotc.spec.exposure import MOST_F
from tests.support.film_plans import orbit_plan
from tests.support.records import replace


def stop_down(needed: float) -> str:
    """Return the help for discs that an aperture of this f-number would make small enough."""
    soft = SimpleNamespace(worst=needed / 1.4, limit=1.0)
    return _stop_down(soft, Optics(0.036, 1.4, 3e-5, None, 3840), "cam")  # type: ignore[arg-type]


def test_the_next_stop_is_proposed_as_it_is_engraved_on_lenses() -> None:
    # Each lets in half the light: powers of the root of two, with two digits, whole from f/10 on.
    for k in range(1, 13):
        exact = 2.0 ** (k / 2)
        engraved = floor(10 * exact + 1e-9) / 10 if exact < 10 else floor(exact + 1e-9)
        assert f"aperture: f/{engraved:g}}}`" in stop_down(0.97 * engraved)
        assert f"aperture: f/{engraved:g}}}`" in stop_down(0.999 * engraved)
        assert f"aperture: f/{engraved:g}}}`" not in stop_down(1.001 * engraved)


def test_where_no_stop_is_enough_the_camera_goes_away() -> None:
    assert "from farther away" in stop_down(2.0 * MOST_F)


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


def test_discs_are_claimed_in_millimetres_and_blur_in_pixels_where_they_are_largest(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    values = SimpleNamespace(
        disc=np.array([1e-5, 4e-5, 2e-5]),
        motion=np.array([3.0, 1.0, 9.0]),
        background=np.array([1.0, np.nan, 2.0]),
    )
    monkeypatch.setattr(module, "sharpness", lambda *_: values)
    plan = orbit_plan().trajectory
    mission = plan.keyframes.mission
    drone = replace(mission.drones[0], optics=Optics(0.036, 1.4, 3e-5, 0.02, 3840))
    view = SimpleNamespace(shot=SimpleNamespace(id="look"), target="tower", times=np.array([5.0, 6.0, 7.0]))
    filmed: Any = SimpleNamespace(views=(view,))
    found = list(module.sharp(JudgedFlight(mission, drone, plan.drones[0]), filmed))
    assert [(c.constraint, c.unit, c.worst, c.limit, c.time, c.holds) for c in found] == [
        ("tower blur disc", "mm", pytest.approx(0.04, rel=1e-9), pytest.approx(0.03), 6.0, False),
        ("tower motion blur", "px", 9.0, 10.0, 7.0, True),
        ("tower background blur", "px", inf, inf, 6.0, True),
    ]
    assert not any(c.hard for c in found)

"""When the drones of a wave set out, read from control points alone."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from shotc.ir.fleet import FrameTimes
from shotc.ir.trajectory import Claim
from shotc.passes.verify.fleets.displays import LEAST_WAY_M, _waves

BREAKS = np.arange(0.0, 21.0, 0.5)
"""Pieces of half a second; the first picture stands until 4 s, the second one from 16 s."""

STANDS = [FrameTimes("show", 0, 0, 2.0, 4.0), FrameTimes("show", 1, 0, 16.0, 18.0)]


def coefficients(departures: list[float], way: float = 10.0) -> np.ndarray:
    """Control points of drones that set out at these times and fly for 4 s.

    They also move before the first picture, and after the second.
    """
    # The control point k has a part in the pieces k - 3 to k.
    k = np.arange(len(BREAKS) + 2)
    coef = np.zeros((len(departures), len(k), 3))
    for drone, departure in enumerate(departures):
        first = int(np.searchsorted(BREAKS, departure)) + 3
        coef[drone, :, 0] = way * np.clip((k - first + 1) / 8.0, 0.0, 1.0)
    coef[:, :, 2] = np.where((k < 3) | (k > 38), 0.0, 30.0)
    return coef


def claims(departures: list[float], time: float, way: float = 10.0) -> list[Claim]:
    wave = SimpleNamespace(time=time)
    pictures = [SimpleNamespace(wave=None), SimpleNamespace(wave=wave, path=("shots", 0, "frames", 1))]
    track = SimpleNamespace(
        breaks=BREAKS,
        coef=coefficients(departures, way),
        shown=STANDS,
        phases=[SimpleNamespace(name="takeoff", end=1.0)],
    )
    flight: Any = SimpleNamespace(track=track, fleet=SimpleNamespace(name="swarm"))
    display: Any = SimpleNamespace(id="show", pictures=pictures)
    return list(_waves(flight, display, STANDS))


@pytest.mark.parametrize(
    ("departures", "time", "off"),
    [
        ([4.0, 6.0, 8.0], 4.0, 0.0),
        ([8.0, 4.0, 6.0], 4.0, 0.0),
        ([4.0, 6.0, 7.0], 4.0, 1.0),
        ([4.0, 6.0, 9.5], 4.0, 1.5),
        ([5.0, 6.0, 9.0], 4.0, 0.0),
    ],
)
def test_a_wave_takes_from_the_first_departure_to_the_last(
    departures: list[float], time: float, off: float
) -> None:
    (found,) = claims(departures, time)
    assert (found.constraint, found.worst, found.limit) == ("error of wave", off, 1.0)
    assert found.time == max(departures)
    assert found.holds is (off <= 1.0)
    assert found.path == ("shots", 0, "frames", 1, "transition", "wave")


def test_who_hardly_moves_tells_nothing_of_a_wave() -> None:
    assert len(claims([4.0, 6.0], 2.0, 1.01 * LEAST_WAY_M)) == 1
    assert claims([4.0, 6.0], 2.0, 0.99 * LEAST_WAY_M) == []

"""How far a flight is from the tracks of its file: bounds against dense samples, on any clock."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.fleet_spline import places
from shotc.show.recorded.grid import between, bound, points_of, sources, step_of
from shotc.show.recorded.tracks import RecordedTrack

RNG = np.random.default_rng


def polyline(rng: np.random.Generator, count: int = 30) -> Piecewise:
    """A track of straight lines, each at a speed of its own."""
    breaks = np.concatenate([[0.0], np.cumsum(rng.uniform(0.1, 0.6, count))])
    at = np.concatenate([[[0.0] * 3] * 2, np.cumsum(rng.normal(0.0, 0.6, (count - 2, 3)), axis=0)])
    at = np.concatenate([at, at[-1:]])
    share = np.linspace(0.0, 1.0, 4)[:, None]
    return Piecewise(breaks, at[:-1, None] + share * np.diff(at, axis=0)[:, None])


def deviation(track: RecordedTrack, times: Array, breaks: Array, coef: Array) -> float:
    """The largest distance at 20,000 times, the clock being the spline of the times themselves."""
    at = np.linspace(breaks[0], breaks[-1], 20_000)
    clock = places(breaks, np.repeat(times[None, :, None], 3, axis=2), at)[0, :, 0]
    return float(np.linalg.norm(places(breaks, coef, at)[0] - track.curve(clock), axis=1).max())


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10_000), st.booleans(), st.booleans())
def test_the_bound_holds_and_is_near(seed: int, stretched: bool, rests: bool) -> None:
    rng = RNG(seed)
    track = RecordedTrack("a", "a.csv", polyline(rng), None)
    times = sources(0.3 if not rests else 0.0, track.curve.end, 0.25, (rests, rests))
    widths = np.full(len(times) - 3, 0.25)
    if stretched:
        widths = widths * np.exp(np.cumsum(rng.normal(0.0, 0.15, len(widths))).clip(-1, 1.5))
    breaks = np.concatenate([[0.0], np.cumsum(widths)])
    coef = points_of([track], times)
    found = bound([track], times, breaks, coef)
    if rests and not stretched:
        at = np.linspace(0.0, breaks[-1], 20_000)
        real = float(np.linalg.norm(places(breaks, coef, at)[0] - track.curve(at), axis=1).max())
    else:
        real = deviation(track, times, breaks, coef)
    assert real <= found + 1e-9
    assert found <= 4.0 * real + 0.02


def test_even_pieces_leave_a_bend_by_a_sixth_of_its_square() -> None:
    # x = t^2: the spline through its places is t^2 + h^2 / 3, an acceleration of 2 times h^2 / 6.
    breaks = np.arange(0.0, 10.5, 0.5)
    start = breaks[:-1]
    ctrl = np.zeros((20, 4, 3))
    for k, b in enumerate(((0, 0), (0, 1 / 3), (0, 2 / 3), (1, 1))):
        ctrl[:, k, 0] = start**2 + start * b[1] + 0.25 * (b[0] if k == 3 else (0, 0, 1 / 3, 1)[k])
    curve = Piecewise(breaks, ctrl)
    assert curve(np.array([3.3]))[0, 0] == pytest.approx(3.3**2)
    track = RecordedTrack("a", "a", curve, None)
    times = sources(0.0, 10.0, 0.25, (False, False))
    inner = times[3:-3]
    even = 0.25 * np.arange(len(times) - 2)
    at = places(even, points_of([track], times), even[4:-4])[0, :, 0]
    assert at == pytest.approx(inner[2:-2] ** 2 + 0.25**2 / 3, abs=1e-9)


def test_parts_of_a_cubic_are_the_cubic() -> None:
    curve = Piecewise(np.array([0.0, 1.0, 3.0]), RNG(3).normal(size=(2, 4, 3)))
    marks = np.array([0.2, 0.7, 1.0, 1.5, 2.9, 4.0])
    parts = Piecewise(marks, between(curve, marks))
    inside = np.array([0.2, 0.5, 0.99, 1.2, 2.0, 2.8])
    assert parts(inside) == pytest.approx(curve(inside))


@pytest.mark.parametrize(
    ("step", "slower", "found"), [(0.0, 1.0, 0.25), (0.25, 1.0, 0.25), (0.04, 1.0, 0.24), (1.0, 3.0, 1.0)]
)
def test_control_points_stand_on_rows_of_the_file(step: float, slower: float, found: float) -> None:
    assert step_of(step, slower) == pytest.approx(found)

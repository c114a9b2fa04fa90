"""The room that a fleet on arcs takes: the closed bound, what it is led past, what is told if it cannot."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from math import inf

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import knots
from shotc.geom.solids import Cylinder, box
from shotc.ir.mission import Zone
from shotc.ir.passes import PassContext
from shotc.ir.show import Picture, Sphere
from shotc.ir.trajectory import TrajectoryIR
from shotc.passes.verify import judge
from shotc.show.assignment import AssignGoals
from shotc.show.assignment.swell import Heights, led
from shotc.show.geom.arcs import FreeRegion, Gaps
from shotc.show.geom.least_size import least_size
from shotc.show.goals import PlaceGoals
from shotc.show.goals.room import DisplaySurroundings
from shotc.show.separation import KeepApart
from shotc.show.solvers.arc_move import ArcMove, fastest_arc
from tests.support.display_missions import LIMITS, display, fleet, show
from tests.support.few import few

TIGHT = Gaps(1.0, 1.0)
MIDDLE = (30.0, 60.0, 40.0)


def ends_of(seed: int) -> tuple[Array, Array]:
    rng = np.random.default_rng(seed)
    shapes = rng.normal(size=(2, 40, 3)) * rng.uniform(1.0, 12.0, (2, 1, 3))
    return shapes[0] + rng.normal(size=3) * 20.0, shapes[1] + rng.normal(size=3) * 20.0


def about(ends: tuple[Array, Array], free: FreeRegion = TIGHT) -> Callable[[Array], ArcMove]:
    return lambda pivot: fastest_arc(ends, pivot, free, LIMITS, 1.0)


def sampled(ends: tuple[Array, Array], move: ArcMove) -> Array:
    starts, goals = ends
    coef = np.stack([*[starts] * 3, *move.between(starts, goals), *[goals] * 3], axis=0)
    breaks = np.arange(len(coef) - 2.0)
    return np.asarray(BSpline(knots(breaks), coef, 3)(np.linspace(0.0, breaks[-1], 200)))


@pytest.mark.slow
@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**31), st.tuples(*[st.floats(-1, 1)] * 3))
def test_nobody_is_farther_than_the_closed_bound(seed: int, direction: tuple[float, float, float]) -> None:
    """Along any direction: the root of the sum of the squares of how far both formations reach beyond c."""
    way = np.array(direction)
    if np.linalg.norm(way) < 0.1:
        return
    way /= np.linalg.norm(way)
    ends = ends_of(seed)
    pivot = 0.5 * (ends[0].mean(axis=0) + ends[1].mean(axis=0))
    move = about(ends)(pivot)
    before, after = (float(((e - pivot) @ way).max()) for e in ends)
    bound = np.hypot(max(before, 0.0), max(after, 0.0))
    farthest = float(((sampled(ends, move) - pivot) @ way).max())
    assert farthest <= 1.01 * bound + 1e-9


@pytest.mark.slow
@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**31), st.booleans())
def test_it_is_lifted_over_the_ground_or_kept_below_a_height(seed: int, low: bool) -> None:
    ends = ends_of(seed)
    bottom, top = (f(getattr(e[:, 2], g)() for e in ends) for f, g in ((min, "min"), (max, "max")))
    heights = Heights(bottom, inf) if low else Heights(-inf, top)
    move, lack = led(ends, heights, DisplaySurroundings((), -inf), about(ends))
    z = sampled(ends, move)[..., 2]
    assert lack.metres <= 1e-6
    assert z.min() >= heights.low - 1e-6
    assert z.max() <= heights.high + 1e-6


@pytest.mark.long
@pytest.mark.parametrize(
    "move", few(product([6.0, 10.0, 15.0], ["out", "home"]), [(6.0, "home"), (15.0, "out")])
)
def test_between_low_pads_and_a_high_picture_the_swell_is_lifted_until_it_is_clear(
    move: tuple[float, str],
) -> None:
    """Arcs about a lower point are others: the first that is lower may still reach into the ground."""
    radius, way = move
    rng = np.random.default_rng(3)
    pads = np.array([(1.5 * (i % 4), 1.5 * (i // 4), 8.0) for i in range(12)])
    ball = rng.normal(size=(12, 3))
    ball = np.array([60.0, 30.0, 40.0]) + radius * ball / np.linalg.norm(ball, axis=1)[:, None]
    ends = (ball, pads) if way == "home" else (pads, ball)
    free = least_size(*(p * (1.0, 1.0, 0.6) / 1.5 for p in ends))
    for low in (2.25, 5.0, 7.5):
        arcs, lack = led(ends, Heights(low, inf), DisplaySurroundings((), -inf), about(ends, free))
        assert lack.metres <= 1e-6
        assert sampled(ends, arcs)[..., 2].min() >= low - 1e-6


def planned(*zones: Zone) -> tuple[TrajectoryIR | None, list[str], str]:
    """A ball that becomes another one: 60 drones as dense as may be, in a mission with zones."""
    pictures = (
        Picture(Sphere((0.0, 60.0, 40.0), 2.6), "volume", None, None, 2.0, ("shots", 0, "frames", 0)),
        Picture(Sphere(MIDDLE, 2.6), "volume", None, None, 2.0, ("shots", 0, "frames", 1)),
    )
    ir = show(display(*pictures), fleet(60), zones)
    goals = PlaceGoals().run(ir, PassContext()).value
    assert goals is not None
    done = AssignGoals().run(goals, PassContext())
    codes, told = [d.code for d in done.diagnostics], " ".join(d.message + d.help for d in done.diagnostics)
    if done.value is None:
        return None, codes, told
    return KeepApart().run(done.value, PassContext()).value, codes, told


def zone(solid: object) -> Zone:
    return Zone("mast", "out", solid, ("world", "zones", "mast"))  # type: ignore[arg-type]


@pytest.mark.long
@pytest.mark.parametrize(
    "solid",
    [Cylinder((15.0, 60.0), 1.0, 0.0, 38.5), Cylinder((15.0, 62.0), 1.0, 0.0, 90.0)],
    ids=["under its way", "beside its way"],
)
def test_a_swell_is_led_past_what_stands_and_all_of_it_is_proved(solid: Cylinder) -> None:
    trajectory, codes, _ = planned(zone(solid))
    assert not codes
    assert trajectory is not None
    claims = judge(trajectory, PassContext()).certificate
    assert all(claim.holds for claim in claims)
    assert any("mast" in claim.constraint for claim in claims)


@pytest.mark.long
@pytest.mark.slow
def test_a_wall_between_two_pictures_is_told_with_what_is_missing() -> None:
    wall = box((15.0, 0.0, 45.0), (1.0, 4000.0, 90.0), 0.0)
    sky = Zone("sky", "in", box((30.0, 30.0, 40.0), (800.0, 800.0, 90.0), 0.0), ("world", "zones", "sky"))
    trajectory, codes, told = planned(zone(wall), sky)
    assert trajectory is None
    assert codes == ["D089"]
    assert "zone `mast`" in told or "zone `sky`" in told
    assert "so wide that drones stand" in told


@pytest.mark.slow
def test_over_a_wall_between_two_pictures_the_fleet_rises_and_all_of_it_is_proved() -> None:
    trajectory, codes, _ = planned(zone(box((15.0, 0.0, 45.0), (1.0, 400.0, 90.0), 0.0)))
    assert not codes
    assert trajectory is not None
    claims = judge(trajectory, PassContext()).certificate
    assert all(claim.holds for claim in claims)

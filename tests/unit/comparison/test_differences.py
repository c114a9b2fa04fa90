"""Where two conditions differ most: against rotations of scipy, and a plan with a bump at a known place."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from shotc.comparison.differences import differences, turned
from shotc.comparison.score import flown_shots
from shotc.geom.bernstein import Piecewise
from shotc.ir.comparison import Condition
from shotc.ir.path import CAM_YAW, Z
from tests.support.film_plans import orbit_plan


def test_angles_are_those_of_rotations() -> None:
    numbers = np.random.default_rng(3)
    a, b = (np.column_stack([numbers.uniform(-9, 9, 60), numbers.uniform(-1.5, 1.5, 60)]) for _ in range(2))
    one, other = (Rotation.from_euler("ZY", c * [1.0, -1.0]) for c in (a, b))
    assert turned(a, b) == pytest.approx((one.inv() * other).magnitude(), abs=1e-9)


def moved(metres: float, degrees: float, share: float) -> Condition:
    """An orbit whose camera is higher and turned aside about one place of its shot."""
    plan = orbit_plan()
    (track,) = plan.trajectory.drones
    (shot,) = flown_shots(plan)
    middle = shot.start + share * (shot.end - shot.start)
    ctrl = track.curve.ctrl.copy()
    piece = int(np.searchsorted(track.curve.breaks, middle, side="right")) - 1
    bump = np.array([0.0, 0.0, 0.5, 1.0, 0.5, 0.0])  # of a piece, which stays as it is at its ends
    ctrl[piece, :, Z] += metres * bump
    ctrl[piece, :, CAM_YAW] += np.radians(degrees) * bump
    flown = replace(track, curve=Piecewise(track.curve.breaks, ctrl))
    trajectory = replace(plan.trajectory, drones=(flown,))
    return Condition("bent", "", replace(plan, trajectory=trajectory), shots=flown_shots(plan))


def test_the_frame_that_differs_most_is_where_the_bump_is() -> None:
    plan = orbit_plan()
    shots = flown_shots(plan)
    straight = Condition("none", "", plan, shots=shots)
    bent = moved(3.0, 20.0, 0.6)
    (found,) = differences((bent, Condition("gone", "", None), straight))
    assert (found.condition, found.other, found.shot) == ("bent", "none", shots[0].id)
    breaks = plan.trajectory.drones[0].curve.breaks
    middle = shots[0].start + 0.6 * (shots[0].end - shots[0].start)
    piece = int(np.searchsorted(breaks, middle, side="right")) - 1
    assert breaks[piece] < found.time < breaks[piece + 1]
    assert found.time == found.other_time
    assert 0.0 < found.mean < found.metres + found.degrees
    assert found.metres / found.degrees == pytest.approx(3.0 / 20.0, rel=0.02)


def test_one_plan_alone_differs_from_nothing() -> None:
    assert differences((Condition("none", "", orbit_plan()), Condition("gone", "", None))) == ()

"""Where a keyframe's centre ray meets the world."""

from __future__ import annotations

from math import cos, pi, radians, tan

import numpy as np
import pytest
from shotc_casadi.sight import sight_point

from tests.support.path_scenes import free, mission, shot
from tests.support.records import replace as changed
from tests.support.refiner_scenes import arc, subject, walled


def seen(of, at, yaw, pitch, target=None):
    key = changed(free(0, at, yaw=yaw, pitch=pitch), target=target)
    return sight_point(of.mission, of.space, key, (yaw, pitch))


def test_a_ray_that_falls_meets_the_ground():
    of = subject(mission(targets=()), shot([free(0, (0, -50, 40)), free(1, (40, -50, 40))]))
    point = seen(of, (3.0, 4.0, 10.0), 0.0, radians(-30))
    assert point == pytest.approx([3 + 10 / tan(radians(30)), 4.0, 0.0], abs=1e-6)


def test_a_ray_meets_the_wall_of_a_cylinder_and_its_lid():
    of = arc()
    assert seen(of, (-40.0, 0.0, 12.0), 0.0, 0.0) == pytest.approx([-4.0, 0, 12], abs=2e-3)
    # Off its axis: the chord begins at -sqrt(r^2 - y^2).
    assert seen(of, (-40.0, 2.0, 12.0), 0.0, 0.0) == pytest.approx([-(12**0.5), 2, 12], abs=5e-3)
    down = seen(of, (-2.0, 0.0, 40.0), 0.0, radians(-89))
    assert down[2] == pytest.approx(24.0, abs=2e-3)


def test_the_nearest_of_what_a_ray_meets_counts():
    of = walled()
    point = seen(of, (20.0, -44.0, 10.0), 0.0, 0.0)
    assert point == pytest.approx([28.0, -44.0, 10.0], abs=2e-3)


def test_a_ray_that_meets_nothing_ends_as_far_as_the_target():
    of = arc()
    point = seen(of, (-40.0, 0.0, 12.0), pi, radians(20), "tower")
    assert np.linalg.norm(point - [-40, 0, 12]) == pytest.approx(40.0)
    assert seen(of, (-40.0, 0.0, 12.0), pi, radians(20))[0] == pytest.approx(-40 - 50 * cos(radians(20)))

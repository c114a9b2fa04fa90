"""What the camera is to show at every node."""

from __future__ import annotations

from math import cos, sin
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from shotc_casadi.clock.references import filmed_at
from shotc_casadi.conditions import ANG, LOOK_AT, OURS, OURS_4PT
from shotc_casadi.references import own_angles, references_at

from shotc.geom.camera import aim_at
from shotc.geom.shapes import CylinderShape
from shotc.ir.path import CAM_PITCH, CAM_YAW, ClockLeg
from shotc.ir.target import Target
from tests.support.path_scenes import ASPECT, HFOV, TOWER, framed, free, mission, shot
from tests.support.records import replace as changed
from tests.support.refiner_scenes import subject

MAST = Target("mast", (30.0, 30.0, 5.0), CylinderShape(1.0, 10.0), ("targets", "mast"))


def test_the_place_asked_is_that_of_the_leg():
    keys = [
        framed(i, (45 * cos(a), 45 * sin(a), 20.0), TOWER, uv=uv)
        for i, (a, uv) in enumerate([(-1.5, (0, 0)), (-0.9, (-1 / 3, 1 / 3)), (-0.2, (1 / 3, 0))])
    ]
    of = subject(mission(targets=(TOWER,)), shot(keys))
    (span,) = of.leg.framing
    s = np.linspace(of.leg.curve.start, of.leg.curve.end, 57)
    references = references_at(of, OURS, s)
    assert references.place == pytest.approx(span.reference(s), abs=1e-9)
    assert (references.framed == 1).all()
    assert (references.whole == 1).all()
    assert references.centre == pytest.approx(np.tile(TOWER.centre, (57, 1)))
    assert set(references.radius) == {TOWER.radius}
    assert references_at(of, OURS_4PT, s).place == pytest.approx(references.place)


def test_between_two_targets_one_becomes_the_other():
    keys = [framed(0, (-30, -40, 20), TOWER), framed(1, (10, -40, 15), TOWER), framed(2, (50, -10, 10), MAST)]
    of = subject(mission(targets=(TOWER, MAST)), shot(keys))
    first, middle, last = (m.s for m in of.leg.marks)
    s = np.linspace(middle, last, 41)
    references = references_at(of, OURS, s)
    share = (references.centre - TOWER.centre)[:, 0] / (MAST.centre[0] - TOWER.centre[0])
    assert share[[0, -1]] == pytest.approx([0, 1], abs=1e-12)
    assert (np.diff(share) >= 0).all()
    assert share[20] == pytest.approx(0.5)
    assert references.radius == pytest.approx((1 - share) * TOWER.radius + share * MAST.radius)
    assert references.height == pytest.approx((1 - share) * TOWER.height + share * MAST.height)
    before = references_at(of, OURS, np.linspace(first, middle, 11)[:-1])
    assert before.centre == pytest.approx(np.tile(TOWER.centre, (10, 1)))


def test_what_frames_nothing_keeps_the_angles_of_the_convex_path():
    keys = [framed(0, (-30, -40, 20), TOWER), framed(1, (0, -40, 20), TOWER), free(2, (40, -40, 20), yaw=1.0)]
    of = subject(mission(targets=(TOWER,)), shot(keys))
    middle = of.leg.marks[1].s
    s = np.linspace(of.leg.curve.start, of.leg.curve.end, 60)
    references = references_at(of, OURS, s)
    assert ((references.framed == 1) == (s < middle)).all()
    assert (references.whole == references.framed).all()
    assert references.aim == pytest.approx(of.leg.curve(s)[:, [CAM_YAW, CAM_PITCH]])


@pytest.mark.parametrize("condition", [ANG, LOOK_AT], ids=lambda c: c.name)
def test_the_papers_conditions_pass_through_the_authors_own_angles(condition):
    """Composition turned the camera; ANG and LOOK-AT know nothing of it."""
    keys = [
        changed(framed(i, (45 * cos(a), 45 * sin(a), 20.0), TOWER), asked=(0.2, -0.15))
        for i, a in enumerate((-1.5, -0.9, -0.2))
    ]
    of = subject(mission(targets=(TOWER,)), shot(keys))
    s = np.array([m.s for m in of.leg.marks])
    references = references_at(of, condition, s)
    for k, key in enumerate(keys):
        d = tuple(c - p for c, p in zip(TOWER.centre, key.at, strict=True))
        yaw, pitch = aim_at(d, (0.2, -0.15), HFOV, ASPECT)
        assert own_angles(of, key) == pytest.approx((yaw, pitch))
        assert np.exp(1j * references.aim[k, 0]) == pytest.approx(np.exp(1j * yaw), abs=1e-6)
        assert references.aim[k, 1] == pytest.approx(pitch, abs=1e-6)
    dense = references_at(of, condition, np.linspace(s[0], s[-1], 200)).aim
    assert np.abs(np.diff(dense, axis=0)).max() < 0.1  # no whole turns
    assert (references.whole == 0).all()


def test_nodes_at_the_ends_of_the_film_are_filmed_whatever_their_rounding() -> None:
    leg = cast("ClockLeg", SimpleNamespace(start=2.0, end=5.0))
    times = np.array([1.99, 2.0 - 1e-9, 3.0, 5.0 + 1e-9, 5.01])
    assert filmed_at(leg, times).tolist() == [False, True, True, True, False]

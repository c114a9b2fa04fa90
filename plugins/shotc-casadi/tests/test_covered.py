"""Refined cameras show as much of their targets as the paths that they begin from."""

from __future__ import annotations

import numpy as np
import pytest
from shotc_casadi import conditions, refiner, rounds
from shotc_casadi.covered import UncoveredShare, broken, free_of, lost
from shotc_casadi.margins import Check, Margins, tighter
from shotc_casadi.proof import checked
from shotc_casadi.references import ShotContext

from shotc.geom.bernstein import Piecewise
from shotc.geom.shapes import CylinderShape
from shotc.ir.allow import HIDDEN
from shotc.ir.keyframes import PlacedShot
from shotc.ir.passes import PassContext
from shotc.ir.path import PathIR
from shotc.ir.promise import Promise
from shotc.ir.target import Target
from tests.support.mesh_spaces import with_meshes
from tests.support.path_scenes import framed, mission, shot, solve
from tests.support.records import replace
from tests.support.scenes import cone, turned

STATUE = Target("statue", (0.0, 0.0, 2.0), CylinderShape(0.8, 4.0), ("targets", "statue"))
TREE = turned(cone(1.5, 1.0, 5.0), 0.0, (0.0, -12.0))


def film(**promised) -> PlacedShot:
    placed = shot([framed(0, (-14.0, -20.0, 12.0), STATUE), framed(1, (14.0, -20.0, 12.0), STATUE)])
    return placed._replace(shot=replace(placed.shot, promise=Promise(**promised)))


@pytest.fixture(scope="module")
def path() -> PathIR:
    """High enough to look over a tree that stands between."""
    of = mission(targets=(STATUE,))._replace(shots=(film().shot,))
    done = solve(with_meshes(of, TREE), film())
    assert done.value is not None
    return done.value


def lower(subject: ShotContext, metres: float) -> Piecewise:
    """The convex camera, lower in its middle: there the tree is in the way."""
    curve = subject.leg.curve.channels(0, 1, 2, 3, 4)
    ctrl = curve.ctrl.copy()
    s = np.linspace(curve.breaks[:-1], curve.breaks[1:], 6, axis=1)
    share = (s - curve.start) / (curve.end - curve.start)
    ctrl[:, :, 2] -= metres * np.sin(np.pi * share)
    return Piecewise(curve.breaks, ctrl)


def test_shares_of_frames_are_what_is_left_free():
    assert free_of(np.array([0.0, 0.25, 0.75, 0.5])) == UncoveredShare(0.625, 0.25, 1.0, 0.5, 0.75)


@pytest.mark.parametrize(
    ("after", "promise", "less"),
    [
        (UncoveredShare(), {}, False),
        (UncoveredShare(mean=0.9, least=0.6), {}, True),
        (UncoveredShare(mean=0.998, least=0.6), {}, False),
        (UncoveredShare(mean=0.998, least=0.4), {}, True),
        (UncoveredShare(mean=0.998, least=0.6), {"visible": 0.7}, True),
        (UncoveredShare(mean=0.998, least=0.4), {"visible": 0.3}, False),
        (UncoveredShare(mean=0.5, first=0.0, least=0.0), {"reveal": (0.0, 1.0)}, False),
        (UncoveredShare(last=0.9), {"reveal": (0.0, 1.0)}, True),
    ],
)
def test_what_is_promised_and_what_is_told_counts(after, promise, less):
    before = UncoveredShare(first=0.0) if "reveal" in promise else UncoveredShare()
    assert (lost(film(**promise), before, after) > 0.0) is less


def test_what_is_broken_already_is_broken_no_further():
    placed = film(visible=0.9)
    assert broken(placed, UncoveredShare(least=0.3), UncoveredShare(least=0.3)) <= 0.0
    assert broken(placed, UncoveredShare(least=0.3), UncoveredShare(least=0.2)) == pytest.approx(0.08)
    meant = placed._replace(shot=replace(placed.shot, allow=(HIDDEN,), promise=Promise()))
    assert lost(meant, UncoveredShare(), UncoveredShare(0.0, 0.0, 0.0, 0.0, 0.0)) == 0.0


def test_a_camera_behind_a_tree_is_found_to_show_less(path):
    (subject,) = refiner.subjects(path)
    assert checked(subject, conditions.OURS, lower(subject, 0.0)).hidden == 0.0
    check = checked(subject, conditions.OURS, lower(subject, 8.0))
    assert check.hidden > 0.3
    assert not check.holds
    assert checked(subject, conditions.ANG, lower(subject, 8.0)).hidden == 0.0


def test_a_path_that_shows_less_is_held_to_the_convex_one():
    less = Check(0.0, 0.0, 0.1, 0.0)
    once = tighter(Margins(), less, hold=False)
    assert tighter(once, less, hold=False).hold > once.hold > 1.0
    assert tighter(Margins(), Check(0.0, 0.0, 0.0, 0.1), hold=True).hold == 1.0


@pytest.mark.slow
def test_one_that_shows_less_in_every_round_is_not_flown(path, monkeypatch):
    monkeypatch.setattr(rounds, "checked", lambda *_: Check(0.0, 0.0, 0.2, 0.0))
    done = refiner.OURS.refine(path, PassContext())
    assert done.value.drones == path.drones
    (warning,) = done.diagnostics
    assert warning.code == "R014"
    assert "its convex path shows more of its targets" in warning.message


@pytest.mark.slow
def test_a_refined_path_past_a_tree_shows_no_less(path):
    (subject,) = refiner.subjects(path)
    refined = rounds.refine_shot(subject, conditions.OURS)
    assert refined.camera is not None
    assert checked(subject, conditions.OURS, refined.camera).hidden == 0.0

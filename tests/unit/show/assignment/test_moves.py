"""Which way a fleet takes: straight where the spacing proves it, else on arcs, or as the mission says."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.apart import keeps_separation
from shotc.geom.bernstein import Array
from shotc.geom.separation import closest
from shotc.ir.show import Apart, Sphere
from shotc.show.assignment.moves import Mover
from shotc.show.solvers.arc_move import ArcMove
from tests.support.display_missions import display, fleet, picture, show

ROUND = Apart("ellipsoid", 1.5, 2.5, 0.0)
UPRIGHT = Apart("cylinder", 1.5, 2.5, 0.0)


def sheet(step: float, z: float) -> Array:
    return np.array([[step * (k % 6), step * (k // 6), z] for k in range(30)])


@pytest.mark.parametrize(
    ("before", "after", "apart", "path", "arc"),
    [
        (3.0, 1.74, ROUND, "auto", False),  # 1 / 3^2 + 1 / 1.74^2 < 1 / 1.5^2
        (3.0, 1.72, ROUND, "auto", True),
        (1.5, 1.5, ROUND, "auto", True),
        (2.0, 1.6, ROUND, "straight", False),
        (9.0, 9.0, ROUND, "arc", True),
        (3.0, 3.0, UPRIGHT, "auto", False),  # twice the separation, of cylinders
        (1.5, 1.6, UPRIGHT, "auto", False),  # pair by pair: sheets that only grow need no arcs
    ],
)
def test_the_way_is_straight_where_that_is_proved_and_nothing_else_is_asked(
    before: float, after: float, apart: Apart, path: str, arc: bool
) -> None:
    asked = picture(Sphere((0.0, 0.0, 60.0), 5.0))._replace(transition_path=path)  # type: ignore[arg-type]
    swarm = fleet(30, apart)
    mover = Mover(show(display(asked), swarm).mission, swarm)
    move = mover.move(sheet(before, 20.0), sheet(after, 60.0), 1.0, asked)
    assert isinstance(move, ArcMove) == arc
    assert not mover.faults


@pytest.mark.slow
@pytest.mark.parametrize(("step", "arc"), [(1.5, True), (3.05, False)])
def test_cylinders_take_arcs_where_a_pair_asks_for_them(step: float, arc: bool) -> None:
    """A sheet that stands up: neighbours of a row come to be above each other."""
    swarm = fleet(30, UPRIGHT)
    mover = Mover(show(display(picture(Sphere((0.0, 0.0, 60.0), 5.0))), swarm).mission, swarm)
    lying = sheet(step, 0.0)
    standing = lying[:, [2, 1, 0]] * (1.0, 1.0, 2.5 / 1.5) + (0.0, 0.0, 60.0)
    starts = lying + np.array([0.0, 0.0, 20.0])
    move = mover.move(starts, standing, 1.0, None)
    assert isinstance(move, ArcMove) == arc
    coef = np.stack([*[starts] * 3, *move.between(starts, standing), *[standing] * 3], axis=1)
    breaks = np.arange(coef.shape[1] - 2) * (move.duration / move.pieces)
    assert keeps_separation(closest(breaks, coef, UPRIGHT).proven, 1.5)


@pytest.mark.slow
@pytest.mark.parametrize(("easing", "own"), [("ease-in-out", True), ("linear", False)])
def test_heights_of_cylinders_have_scalars_of_their_own_unless_an_easing_is_asked_for(
    easing: str, own: bool
) -> None:
    asked = picture(Sphere((0.0, 0.0, 60.0), 5.0))._replace(easing=easing)  # type: ignore[arg-type]
    swarm = fleet(30, UPRIGHT)
    mover = Mover(show(display(asked), swarm).mission, swarm)
    lying = sheet(1.5, 0.0)
    standing = lying[:, [2, 1, 0]] * (1.0, 1.0, 2.5 / 1.5) + (0.0, 0.0, 60.0)
    move = mover.move(lying + np.array([0.0, 0.0, 20.0]), standing, 1.0, asked)
    assert isinstance(move, ArcMove)
    assert (not np.array_equal(move.ctrl, move.heights)) == own


@pytest.mark.parametrize("path", ["straight", "arc"])
def test_a_picture_is_come_to_by_its_easing(path: str) -> None:
    plain = picture(Sphere((0.0, 0.0, 60.0), 5.0))._replace(transition_path=path)  # type: ignore[arg-type]
    swarm = fleet(30, ROUND)
    times = []
    for easing in ("ease-in-out", "ease-in"):
        asked = plain._replace(easing=easing)  # type: ignore[arg-type]
        mover = Mover(show(display(asked), swarm).mission, swarm)
        times.append(mover.move(sheet(3.0, 20.0), sheet(3.0, 60.0), 1.0, asked).duration)
    assert times[1] > 1.2 * times[0]  # whoever speeds up slowly arrives later

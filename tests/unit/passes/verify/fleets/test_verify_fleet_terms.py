"""One test for one term of what is claimed of fleets: what it protects a show from."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.fleet_pieces import FleetPieces
from shotc.geom.pieces import Pieces
from shotc.geom.proof import ProvedExtreme
from shotc.geom.shapes import CylinderShape
from shotc.geom.solids import Cylinder
from shotc.geom.track import Track
from shotc.ir.fleet import FrameTimes
from shotc.ir.limits import Timing
from shotc.ir.target import Target
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.claims import Limit
from shotc.passes.verify.fleets.displays import displays
from shotc.passes.verify.fleets.flight import FleetFlight, bounded
from shotc.passes.verify.fleets.space import _boxes_apart, _off, nearest
from tests.support.records import replace
from tests.support.show_plans import display, fleet, mission, show
from tests.support.verdicts import verdict_on

SHOW = show()


def claim(ir: TrajectoryIR, constraint: str) -> Claim:
    return next(c for c in verdict_on(ir).certificate if c.constraint == constraint)


def showing(*shown: tuple[int, float, float]) -> TrajectoryIR:
    """The show with pictures at times: (picture, start, end)."""
    track = SHOW.fleets[0]
    pictures = tuple(FrameTimes("globe", picture, 0, start, end) for picture, start, end in shown)
    return replace(SHOW, fleets=(replace(track, shown=pictures),))


@pytest.mark.parametrize(
    ("shown", "astray"),
    [
        (((0, 16.0, 20.0), (1, 26.0, 28.0)), 0),
        (((1, 16.0, 20.0), (0, 26.0, 28.0)), 1),  # the second one first, each in its own time
        (((0, 16.0, 18.0), (0, 18.0, 20.0), (1, 26.0, 28.0)), 1),  # one of them twice
        (((0, 16.0, 26.5), (1, 26.0, 28.0)), 1),  # the second one begins while the first one stands
        (((0, 16.0, 20.0), (1, 26.0, 28.5)), 1),  # the last one stays beyond the display
        (((0, 15.5, 20.0), (1, 26.0, 28.0)), 1),  # the first one begins before it
    ],
)
def test_pictures_are_shown_one_after_another_in_the_order_written(
    shown: tuple[tuple[int, float, float], ...], astray: int
) -> None:
    order = claim(showing(*shown), "pictures out of order")
    assert order.worst == astray
    assert order.holds is (astray == 0)


@pytest.mark.parametrize(("times", "holds"), [(0, False), (1, True), (2, False)])
def test_a_display_is_flown_once(times: int, holds: bool) -> None:
    track = SHOW.fleets[0]
    flown = [p for p in track.phases if p.shot == "globe"] * times
    others = [p for p in track.phases if p.shot is None]
    again = replace(track, phases=(*others, *flown), shown=())
    found = next(displays(FleetFlight.of(SHOW.keyframes.mission, again), SHOW))
    assert (found.constraint, found.worst, found.holds) == ("times flown", times, holds)


@pytest.mark.parametrize("by", [-1.0, 1.0])
def test_a_transition_and_a_hold_are_no_shorter_and_a_transition_no_longer(by: float) -> None:
    moved = showing((0, 16.0, 20.0), (1, 26.0 + by, 28.0))
    assert claim(moved, "error of transition").worst == pytest.approx(1.0)
    assert claim(moved, "lack of hold").worst == pytest.approx(max(by, 0.0))


def test_a_flight_of_years_is_none() -> None:
    track = SHOW.fleets[0]
    slow = replace(SHOW, fleets=(replace(track, breaks=1e6 * track.breaks),))
    (found,) = verdict_on(slow).diagnostics
    assert "longer than 100000 s" in found.message


def test_transitions_that_nothing_judges_are_counted() -> None:
    free = tuple(p._replace(transition=None) for p in display().pictures)
    asked = mission(displays=(display()._replace(pictures=free),))
    found = claim(
        replace(SHOW, keyframes=replace(SHOW.keyframes, mission=asked)), "transitions without a time"
    )
    assert (found.worst, found.holds) == (len(free) - 1, True)
    assert found.constraint not in {c.constraint for c in verdict_on(SHOW).certificate}


@pytest.mark.parametrize(("moment", "off"), [(17.0, 1.0), (15.0, 1.0), (16.0, 0.0)])
def test_a_picture_with_a_moment_is_there_then_and_neither_earlier_nor_later(
    moment: float, off: float
) -> None:
    first, second = display().pictures
    asked = display()._replace(pictures=(first._replace(at=moment), second))
    found = claim(show(mission(displays=(asked,))), "error of moment")
    assert found.worst == pytest.approx(off)
    assert found.holds is (off == 0.0)


@pytest.mark.parametrize("by", [-0.5, 0.5])
def test_a_display_starts_and_lasts_as_asked_from_both_sides(by: float) -> None:
    for timing, name in (
        (Timing(start=16.0 + by), "error of start"),
        (Timing(duration=12.0 + by), "error of duration"),
    ):
        ir = show(mission(displays=(display()._replace(timing=timing),)))
        assert claim(ir, name).worst == pytest.approx(0.5)


@pytest.mark.parametrize(("ends", "early"), [(15.0, -1.0), (17.0, 1.0)])
def test_a_display_waits_for_the_one_it_comes_after(ends: float, early: float) -> None:
    far = tuple((x + 100.0, y, z) for x, y, z in fleet().pads)
    asked = mission(
        fleets=(fleet(), fleet(far, "other")),
        displays=(display()._replace(timing=Timing(after="first")), display("first", "other", 1)),
    )
    ir = show(asked)
    second = ir.fleets[1]
    phases = tuple(
        replace(p, start=ends if p.name == "return" else p.start, end=ends if p.shot else p.end)
        for p in second.phases
    )
    phases = (phases[0], replace(phases[1], end=14.0), replace(phases[2], start=14.0), *phases[3:])
    ir = replace(ir, fleets=(ir.fleets[0], replace(second, phases=phases)))
    start = claim(ir, "start too early")
    assert start.worst == pytest.approx(early)
    assert start.holds is (early <= 0)


def test_an_acceleration_at_the_pads_is_no_rest() -> None:
    # A cubic whose first two control points are the pad's, and whose third is above, begins with a push.
    track = SHOW.fleets[0]
    coef = track.coef.copy()
    coef[0, 0, 2] = coef[0, 2, 2] = 1e-4
    coef[0, 1, 2] = -0.5e-4
    pushed = replace(SHOW, fleets=(replace(track, coef=coef),))
    assert not claim(pushed, "rate at start and end").holds


def test_what_a_box_tells_to_be_far_is_no_nearer_than_its_box() -> None:
    # Hundreds of pieces at a corner of the box round a mast, 4.1 m from it, and one at 3 m from its side.
    mast = Cylinder((0.0, 0.0), 10.0, 0.0, 50.0)
    places = np.array([*[(10.0, 10.0, 20.0)] * 400, (13.0, 0.0, 20.0)])
    many = Pieces(np.arange(401.0), np.arange(1.0, 402.0), np.repeat(places[:, None], 4, axis=1))
    assert nearest(many, mast, lambda _: 1e-6).proven == pytest.approx(3.0, abs=2e-6)


def test_of_drones_beside_a_moving_target_the_nearest_counts_not_the_one_whose_box_is() -> None:
    # Both fly up to y = 20: one towards its middle, 2 m off, the other aside, 3.4 m off. Boxes are alike.
    where = (0.0, 32.0, 20.0)
    giant = Target(
        "giant", where, CylinderShape(10.0, 60.0), ("targets", "giant"), Track((0.0, 100.0), (where, where))
    )
    ir = show(mission(fleets=(fleet(((6.0, 0.0, 0.0), (0.0, 0.0, 0.0))),), targets=(giant,)))
    found = claim(ir, "target giant")
    assert found.worst == pytest.approx(2.0 - 0.3, abs=1e-5)
    assert found.drones == ("swarm-2",)


def test_boxes_of_drones_and_of_a_target_are_as_far_apart_as_boxes_are() -> None:
    # A target of radius 2 and height 4 that goes 10 m to the East; drones that stand, on one piece.
    runner = Target(
        "runner",
        (0.0, 0.0, 2.0),
        CylinderShape(2.0, 4.0),
        ("targets", "runner"),
        Track((0.0, 4.0, 10.0), ((0.0, 0.0, 2.0), (4.0, 0.0, 2.0), (10.0, 0.0, 2.0))),
    )
    stands = [(-5.0, 0.0, 2.0), (15.0, 6.0, 2.0), (5.0, 0.0, 9.0), (5.0, -9.0, -3.0), (11.0, 1.0, 3.0)]
    ctrl = np.repeat(np.array(stands)[:, None, None], 4, axis=2)
    both = FleetPieces(np.array([0.0]), np.array([10.0]), ctrl)
    assert _boxes_apart(both, runner) == pytest.approx([3.0, 5.0, 5.0, np.hypot(7.0, 3.0), 0.0])
    # In the last second it is between 9 and 10 m: only the last piece counts where it is nearest.
    halves = FleetPieces(np.array([0.0, 9.0]), np.array([1.0, 10.0]), np.repeat(ctrl, 2, axis=1))
    assert _boxes_apart(halves, runner)[[0, 1, 2]] == pytest.approx([3.0, 5.0, np.hypot(2.0, 5.0)])
    assert _off(runner, np.array(stands)) == pytest.approx(
        [3.0, np.hypot(15.0, 6.0) - 2.0, *_away(stands[2:])]
    )
    assert _off(runner, np.array([[1.0, 1.0, 2.0]])).tolist() == [0.0]


def _away(places: list[tuple[float, float, float]]) -> list[float]:
    return [
        float(np.hypot(max(np.hypot(x, y) - 2.0, 0.0), max(abs(z - 2.0) - 2.0, 0.0))) for x, y, z in places
    ]


@pytest.mark.parametrize(("upper", "drone"), [(True, "swarm-4"), (False, "swarm-1")])
def test_a_bound_over_all_drones_names_the_one_that_is_worst(upper: bool, drone: str) -> None:
    one = FleetFlight.of(SHOW.keyframes.mission, SHOW.fleets[0])
    limit = Limit("east", 1.0, "m", one.fleet.path, upper=upper)
    (found,) = bounded(one, limit, ProvedExtreme(5.0, 5.0, 0.0), lambda at: at[:, 0]).drones
    assert found == drone

"""Time has no gaps: nothing flies unseen between phases, through joints, or beside a row of a track."""

from dataclasses import replace as changed
from itertools import pairwise

import numpy as np
import pytest

from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.bspline import restrict
from shotc.geom.shapes import CylinderShape
from shotc.geom.solids import Cylinder
from shotc.geom.track import Track
from shotc.geom.track_array import places, rate_seen_from, seen_from
from shotc.ir.phases import Phase
from shotc.ir.sampling import share_of_frames
from shotc.ir.target import Target
from shotc.ir.trajectory import TrajectoryIR
from shotc.passes.verify.shape import JOINTS, MOST_REPORTED, gaps
from shotc.planfile.sanity import inconsistencies
from tests.support.tampered_plans import PLAN, with_mission, with_track, zone
from tests.support.verdicts import claim, codes, verdict_on

TRACK = PLAN.drones[0]
CURVE = TRACK.curve


@pytest.mark.parametrize("joint", [1e-6, 1e-9, 1e-15])
def test_no_time_lies_between_phases(joint: float) -> None:
    transit = TRACK.phases[1]
    apart = changed(transit, end=transit.end - max(joint, np.spacing(transit.end)))
    assert "V014" in codes(with_track(phases=(TRACK.phases[0], apart, *TRACK.phases[2:])))


def test_a_wall_cannot_be_flown_through_between_phases_of_no_length() -> None:
    # The shot passes (40, 0) at t = 37 s: 400 gaps of a microsecond, side by side, where a wall stands.
    shot = TRACK.phases[2]
    before, after = changed(shot, end=36.9998), changed(shot, start=37.0002)
    points = np.arange(36.9998, 37.0002, 1e-6)
    inside = [changed(shot, start=float(t), end=float(t)) for t in points]
    phases = (*TRACK.phases[:2], before, *inside, after, *TRACK.phases[3:])
    wall = zone("out", Cylinder((40.0, 0.0), 1e-3, 0.0, 30.0))
    walled = with_mission(with_track(phases=phases), zones=wall)
    faults = [d for d in verdict_on(walled).diagnostics if d.code == "V014"]
    assert "open" in faults[0].message
    assert len(faults) == MOST_REPORTED + 1  # and not one for each of them


@pytest.mark.parametrize(
    ("phases", "said"),
    [
        ([(0.0, 4.0), (4.0, 10.0)], []),
        ([(0.0, 4.0), (4.0 + 1e-9, 10.0)], ["open"]),
        ([(0.0, 4.0), (4.0 - 1e-9, 10.0)], ["two of its phases"]),
        ([(0.0, 6.0), (3.0, 10.0)], ["two of its phases"]),
        ([(1e-9, 4.0), (4.0, 10.0)], ["open"]),
        ([(-1e-9, 4.0), (4.0, 10.0)], ["two of its phases"]),
        ([(0.0, 4.0), (4.0, 10.0 - 1e-9)], ["open"]),
        ([(0.0, 4.0), (4.0, 10.0 + 1e-9)], ["two of its phases"]),
        ([(0.0, 4.0), (4.0, 4.0), (4.0, 10.0)], ["ends at 4 s"]),
        ([(0.0, 6.0), (6.0, 4.0), (4.0, 10.0)], ["ends at 4 s"]),
    ],
)
def test_phases_hold_every_instant_once(phases: list[tuple[float, float]], said: list[str]) -> None:
    found = list(gaps(tuple(Phase("transit", None, *ends) for ends in phases), 0.0, 10.0))
    assert len(found) == len(said)
    assert all(word in text for word, text in zip(said, found, strict=True))


def stepping(order: int, by: float, joints: int) -> TrajectoryIR:
    """The sample plan whose x, or its rate or acceleration, steps by ``by`` at some joints of the shot."""
    ctrl = CURVE.ctrl.copy()
    first = int(np.searchsorted(CURVE.breaks, 22.0)) + 1
    for k in range(first, first + joints):
        width = CURVE.breaks[k + 1] - CURVE.breaks[k]
        unit = {0: [1.0] * 3, 1: [0.0, width / 5, 2 * width / 5], 2: [0.0, 0.0, width**2 / 20]}[order]
        ctrl[k, :3, 0] += by * np.array(unit)
    return with_track(curve=Piecewise(CURVE.breaks, ctrl))


@pytest.mark.slow
@pytest.mark.parametrize("order", range(3))
def test_what_joints_step_by_is_added_up(order: int) -> None:
    joints = JOINTS[order]
    name = f"jump of {joints.name}"
    # Alone each is far below what one may be, and what the values are relative to.
    few, many = (stepping(order, joints.most / 20, count) for count in (10, 100))
    kept, broken = claim(few, name), claim(many, name)
    assert kept.worst == pytest.approx(joints.most / 2, rel=0.1)
    assert kept.holds
    assert broken.worst == pytest.approx(5 * joints.most, rel=0.1)
    assert not broken.holds
    assert "V011" in codes(many)
    assert broken.unit == "m" + joints.unit


@pytest.mark.slow
@pytest.mark.parametrize(("order", "most"), [(0, 1e-6), (1, 1e-6), (2, 1e-4)])
def test_what_may_be_rounded_away_is_an_absolute_amount(order: int, most: float) -> None:
    # Whatever the size of the flight: a kilometre away it is the same.
    assert JOINTS[order].most == most
    far = CURVE.ctrl + np.array([1000.0, 0, 0, 0, 0, 0, 0])
    moved = with_track(curve=Piecewise(CURVE.breaks, far))
    found = claim(moved, f"jump of {JOINTS[order].name}")
    assert found.limit == most
    assert found.worst < 0.1 * most
    one = stepping(order, 3 * most, 1)
    assert not claim(one, f"jump of {JOINTS[order].name}").holds


def test_short_pieces_with_small_steps_are_no_motion() -> None:
    # 40 um a piece of 20 us: 2 m/s, of which no derivative tells.
    breaks = 60.0 + 2e-5 * np.arange(1001)
    x = np.repeat(4e-5 * np.arange(1000.0)[:, None], 6, axis=1)
    ctrl = np.repeat(CURVE(60.0)[None, None], 1000, axis=0).repeat(6, axis=1)
    ctrl[..., 0] += x
    whole = restrict(CURVE, np.union1d(CURVE.breaks, [60.0]))
    k = int(np.searchsorted(whole.breaks, 60.0))
    joined = Piecewise(
        np.concatenate([whole.breaks[:k], breaks, whole.breaks[k + 1 :] + 0.02]),
        np.concatenate([whole.ctrl[:k], ctrl, whole.ctrl[k:]]),
    )
    phases = [
        changed(p, start=p.start + 0.02 * (p.start > 60), end=p.end + 0.02 * (p.end > 60))
        for p in TRACK.phases
    ]
    crept = with_track(curve=joined, phases=tuple(phases))
    assert claim(crept, "jump of value").worst == pytest.approx(2 * 999 * 4e-5, rel=1e-2)
    assert "V011" in codes(crept)


def test_a_flight_begins_at_time_0_exactly() -> None:
    breaks = CURVE.breaks.copy()
    breaks[0] = 1e-9
    phases = (changed(TRACK.phases[0], start=1e-9), *TRACK.phases[1:])
    assert "V014" in codes(with_track(curve=Piecewise(breaks, CURVE.ctrl), phases=phases))


def test_what_is_wanted_on_screen_does_not_jump() -> None:
    # The bound on its rate is what closes the time between frames.
    framing = TRACK.framing[0]
    whole = restrict(framing.reference, np.array([framing.start, 37.0, framing.end]))
    for by, found in ((0.0, []), (5e-6, ["V014"])):
        wanted = Piecewise(whole.breaks, whole.ctrl + np.array([0.0, by])[:, None, None])
        assert codes(with_track(framing=(changed(framing, reference=wanted),))) == found


def passing(by: float, row: float) -> Track:
    """A target that goes from 5 m beside the orbit onto it and back within 2 ``by`` seconds after a row."""
    # At t = 37 s the orbit is at (40, 0, 20).
    far, near = (40.0, 60.0, 20.0), (40.0, 0.0, 20.0)
    times = (0.0, row, row + by, row + 2 * by, 200.0)
    return Track(times, (far, far, near, far, far))


def meets(track: Track) -> TrajectoryIR:
    moving = Target("ghost", track.at(0.0), CylinderShape(0.5, 1.0), ("targets", "ghost"), track)
    return with_mission(targets=(*PLAN.keyframes.mission.targets, moving))


@pytest.mark.slow
@pytest.mark.parametrize("by", [1e-9, 1e-11, 1e-13])
def test_rows_next_to_a_break_count(by: float) -> None:
    k = int(np.searchsorted(CURVE.breaks, 37.0))
    row = float(CURVE.breaks[k])
    assert abs(row - 37.0) < 0.1
    track = passing(by, row)
    assert claim(meets(track), "target ghost").worst < 0.0
    assert "V010" in codes(meets(track))


def test_no_target_of_a_plan_is_faster_than_a_mission_can_write() -> None:
    texts = [text for path, text in inconsistencies(meets(passing(0.05, 37.0))) if path.endswith("track")]
    assert len(texts) == 1
    assert "1200 m/s" in texts[0]
    assert not list(inconsistencies(meets(passing(0.07, 37.0))))
    carried = Track((0.0,), ((0.0, 90.0, 1.0),), after=(0.0, 1001.0, 0.0))
    assert [path for path, _ in inconsistencies(meets(carried))] == ["mission.targets[1].track"]


def relative(track: Track, t: Array) -> Array:
    return np.asarray(CURVE.channels(0, 1, 2)(t) - places(track, t))


def test_the_rate_as_a_target_sees_it_is_that_of_the_place() -> None:
    track = Track((10.0, 30.0, 30.0 + 1e-12, 50.0), ((0, 0, 1), (9, 3, 1), (9, 3, 1), (4, 4, 2)))
    track = track._replace(after=(0.0, 2.0, 0.0))
    t = np.array([5.0, 20.03, 40.01, 70.02])
    step = 1e-5
    slope = (relative(track, t + step) - relative(track, t - step)) / (2 * step)
    place = CURVE.channels(0, 1, 2)
    assert np.allclose(rate_seen_from(place, track)(t), slope, atol=1e-6)
    assert np.allclose(seen_from(place, track)(t), relative(track, t), atol=1e-9)
    # The piece of a picosecond is no noise.
    assert np.abs(rate_seen_from(place, track).ctrl).max() < 20.0


@pytest.mark.slow
def test_a_framing_in_many_parts_does_not_show_more_frames() -> None:
    # The camera looks over the tower from the middle of the shot on; each end of a part is a sample more.
    framing = TRACK.framing[0]
    ctrl = CURVE.ctrl.copy()
    ctrl[int(np.searchsorted(CURVE.breaks, 37.0)) :, :, 4] += 0.9
    looking_away = with_track(curve=Piecewise(CURVE.breaks, ctrl))
    cuts = np.linspace(22.01, 36.0, 2000)
    parts = [changed(framing, start=float(a), end=float(b)) for a, b in pairwise(cuts)]
    whole, split = looking_away, with_track(looking_away, framing=(framing, *parts))
    assert claim(whole, "tower in frame").worst == pytest.approx(0.5, abs=0.01)
    assert claim(split, "tower in frame").worst == claim(whole, "tower in frame").worst
    assert claim(split, "tower in sight").worst == claim(whole, "tower in sight").worst


@pytest.mark.parametrize(
    ("good", "counted", "share"),
    [
        ([1, 1, 0, 0], [1, 1, 1, 1], 0.5),
        ([1, 1, 0, 0], [1, 0, 1, 1], 1 / 3),
        ([1, 1, 0, 0], [1, 1, 1, 0], 0.5),
        ([1, 1], [0, 1], 1.0),
        ([1, 0], [1, 0], 0.5),
    ],
)
def test_a_sample_that_is_no_frame_can_only_lower_a_share(
    good: list[int], counted: list[int], share: float
) -> None:
    assert share_of_frames(np.array(good, dtype=bool), np.array(counted, dtype=bool)) == pytest.approx(share)

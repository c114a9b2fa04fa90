"""That a flight is one: each rule of its form on both sides of its boundary."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, nan

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.path import CAM_YAW
from shotc.ir.phases import KeyframeTime, Phase, Reference
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.shape import first_few, shape, structure
from tests.support.plain_flights import PHASES, plain_mission
from tests.support.records import replace

MISSION = replace(plain_mission(), shots=(replace(plain_mission().shots[0], id="out"),))
BREAKS = np.array([0.0, 4.0, 14.0, 24.0, 28.0])


def resting(edit: Callable[[np.ndarray], None] = lambda _: None, breaks: np.ndarray = BREAKS) -> Piecewise:
    """Return a flight that stays on its pad, with other control points in some places."""
    ctrl = np.zeros((len(breaks) - 1, 6, 7))
    edit(ctrl)
    return Piecewise(breaks, ctrl)


def claims(curve: Piecewise) -> dict[str, Claim]:
    track = DroneTrajectory("cam1", curve, PHASES, (), ())
    return {c.constraint: c for c in shape(JudgedFlight(MISSION, MISSION.drones[0], track))}


def step(piece: int, channel: int, order: int, by: float) -> Callable[[np.ndarray], None]:
    """Make one derivative jump by so much where a piece begins: the lower ones stay, and it returns to rest.

    The control points are those of by * t^order / order! near the break, and zero at its other end.
    """
    width = BREAKS[piece + 1] - BREAKS[piece]
    factor = by * width**order / [1.0, 5.0, 20.0][order]

    def edit(ctrl: np.ndarray) -> None:
        ctrl[piece, order, channel] += factor

    return edit


JUMPS = {
    0: ("jump of value", 1e-6, ""),
    1: ("jump of rate", 1e-6, "/s"),
    2: ("jump of acceleration", 1e-4, "/s^2"),
}


@pytest.mark.parametrize("order", JUMPS)
@pytest.mark.parametrize("channel", range(7))
@pytest.mark.parametrize(("share", "holds"), [(0.9, True), (-0.9, True), (2.2, False), (-2.2, False)])
def test_what_joints_step_by_is_bounded(order: int, channel: int, share: float, holds: bool) -> None:
    """A tolerance of a millionth of its unit is added to each bound."""
    name, most, per = JUMPS[order]
    by = share * most
    claim = claims(resting(step(2, channel, order, by)))[name]
    assert claim.worst == pytest.approx(abs(by), rel=1e-6)
    assert (claim.limit, claim.upper, claim.holds) == (most, True, holds)
    assert claim.unit == ("m" if channel < CAM_YAW else "rad") + per
    assert claim.time == 14.0


@pytest.mark.parametrize("order", JUMPS)
def test_steps_of_one_channel_add_up_and_the_largest_sum_counts(order: int) -> None:
    name, most, _ = JUMPS[order]

    def both(ctrl: np.ndarray) -> None:
        for piece, share in ((1, 0.7), (2, 1.5), (3, -0.7)):
            step(piece, 1, order, share * most)(ctrl)
        step(1, 5, order, 2.0 * most)(ctrl)

    claim = claims(resting(both))[name]
    assert claim.worst == pytest.approx(2.9 * most, rel=1e-6)
    assert (claim.unit[:1], claim.time) == ("m", 14.0)


def test_a_flight_without_a_step_has_none() -> None:
    for name, _, _ in JUMPS.values():
        claim = claims(resting())[name]
        assert (claim.worst, claim.time, claim.holds) == (0.0, None, True)


@pytest.mark.parametrize("end", [0, -1])
@pytest.mark.parametrize(("off", "holds"), [(0.99e-3, True), (1.01e-3, False), (2.0, False)])
def test_a_flight_begins_and_ends_at_home(end: int, off: float, holds: bool) -> None:
    """The control points next to the end are as far off, so that the drone is at rest there."""

    def edit(ctrl: np.ndarray) -> None:
        ctrl[end, : 3 if end == 0 else None][-3 if end else None :, :3] += (
            off * np.array([2.0, -1.0, 2.0]) / 3.0
        )

    claim = claims(resting(edit))["distance from home"]
    assert claim.worst == pytest.approx(off)
    assert (claim.limit, claim.holds, claim.time) == (1e-3, holds, BREAKS[end])


@pytest.mark.parametrize("end", [0, -1])
@pytest.mark.parametrize("channel", range(7))
@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize(("share", "holds"), [(1.9, True), (-2.1, False), (2.1, False)])
def test_a_flight_begins_and_ends_at_rest(
    end: int, channel: int, order: int, share: float, holds: bool
) -> None:
    width = 4.0
    point = order if end == 0 else 5 - order
    factor = width**order / (5.0 if order == 1 else 20.0)

    def edit(ctrl: np.ndarray) -> None:
        ctrl[end, point, channel] = share * 1e-6 * factor

    if order == 1:  # its acceleration there would be larger

        def edit(ctrl: np.ndarray) -> None:
            ctrl[end, point, channel] = share * 1e-6 * factor
            ctrl[end, 2 if end == 0 else 3, channel] = 2.0 * share * 1e-6 * factor

    claim = claims(resting(edit))["rate at start and end"]
    assert claim.worst == pytest.approx(abs(share) * 1e-6)
    assert (claim.holds, claim.time) == (holds, BREAKS[end])


@pytest.mark.parametrize("spare", [1e-4, -1e-4])
def test_endurance_counts_from_the_lift_off(spare: float) -> None:
    def edit(ctrl: np.ndarray) -> None:
        ctrl[1, 3, 2] = 1.0

    drone = replace(MISSION.drones[0], endurance=24.0 + spare)
    track = DroneTrajectory("cam1", resting(edit), PHASES, (), ())
    claim = next(c for c in shape(JudgedFlight(MISSION, drone, track)) if c.constraint == "endurance")
    assert (claim.worst, claim.holds) == (24.0, spare > 0)


SOUND = DroneTrajectory("cam1", resting(), PHASES, (KeyframeTime("out", 0, 5.0),), ())


def faults(**changes: object) -> list[str]:
    track = replace(SOUND, **changes)
    found = list(structure(TrajectoryIR(KeyframeIR(MISSION, ()), (track,), (), ())))
    assert {d.code for d in found} <= {"V014"}
    whole = "the flight of `cam1` is not whole: "
    assert all(d.message.startswith(whole) for d in found)
    return [d.message.removeprefix(whole) for d in found]


def phases(*times: float) -> tuple[Phase, ...]:
    """Return the phases with other times: start and end of each."""
    pairs = zip(times[::2], times[1::2], strict=True)
    return tuple(replace(p, start=a, end=b) for p, (a, b) in zip(PHASES, pairs, strict=True))


def on_screen(step_by: float) -> Reference:
    curve = Piecewise(np.array([4.0, 9.0, 14.0]), np.zeros((2, 2, 2)))
    ctrl = curve.ctrl.copy()
    ctrl[1, 0, 1] = step_by
    return Reference("out", "tower", 4.0, 14.0, Piecewise(curve.breaks, ctrl))


def test_a_sound_flight_has_no_fault() -> None:
    assert faults() == []
    assert faults(framing=(on_screen(0.9e-6), replace(on_screen(0.0), reference=None))) == []


def test_a_flight_is_of_a_drone_of_the_mission() -> None:
    names = ("zebra", "cam1", "ant", "moth")
    tracks = tuple(replace(SOUND, drone=name) for name in names)
    found = list(structure(TrajectoryIR(KeyframeIR(MISSION, ()), tracks, (), ())))
    strange = ("ant", "moth", "zebra")
    assert [d.message for d in found] == [
        f"the flight of `{s}` belongs to no drone of the mission" for s in strange
    ]


@pytest.mark.parametrize(("value", "count"), [(1e6, 0), (-1e6, 0), (1e6 + 0.1, 1), (-1e6 - 0.1, 1)])
def test_a_flight_stays_in_the_world(value: float, count: int) -> None:
    assert len(faults(curve=resting(lambda c: c.__setitem__((1, 2, 3), value)))) == count


@pytest.mark.parametrize(("seconds", "count"), [(1.001e-5, 0), (0.999e-5, 1)])
def test_a_piece_lasts_long_enough_to_have_derivatives(seconds: float, count: int) -> None:
    breaks = np.array([0.0, 4.0, 4.0 + seconds, 24.0, 28.0])
    assert len(faults(curve=resting(breaks=breaks))) == count


@pytest.mark.parametrize("bad", [nan, inf, -inf])
def test_every_time_is_a_number(bad: float) -> None:
    said = ["a time is not a finite number"]
    assert faults(phases=phases(0.0, 4.0, 4.0, bad, 14.0, 24.0, 24.0, 28.0)) == said
    assert faults(keyframes=(KeyframeTime("out", 0, bad),)) == said
    assert faults(framing=(replace(on_screen(0.0), end=bad),)) == said
    assert faults(framing=(replace(on_screen(0.0), start=bad),)) == said


@pytest.mark.parametrize(("time", "told"), [(1e11, "1e+11"), (-1e11, "-1e+11"), (29.1, "29.1"), (28.9, "")])
def test_no_time_is_far_outside_of_the_flight(time: float, told: str) -> None:
    """Samples up to 1e11 s would take more memory than there is. The flight ends at 28 s."""
    said = [f"a keyframe or a picture of it is at {told} s, outside of the flight"] if told else []
    assert faults(keyframes=(KeyframeTime("out", 0, time),)) == said
    if time > 0.0:
        assert faults(framing=(replace(on_screen(0.0), end=time),)) == said


@pytest.mark.parametrize(
    ("times", "said"),
    [
        ((0.0, 4.0, 4.0, 14.0, 14.0, 24.0, 24.0, 28.0), []),
        ((0.5, 4.0, 4.0, 14.0, 14.0, 24.0, 24.0, 28.0), ["its phases leave 0 s to 0.5 s open"]),
        ((0.0, 4.0, 4.0, 14.0, 14.0, 24.0, 24.0, 27.5), ["its phases leave 27.5 s to 28 s open"]),
        ((0.0, 4.0, 4.5, 14.0, 14.0, 24.0, 24.0, 28.0), ["its phases leave 4 s to 4.5 s open"]),
        (
            (0.0, 4.5, 4.0, 14.0, 14.0, 24.0, 24.0, 28.0),
            ["two of its phases hold the time from 4 s to 4.5 s"],
        ),
        (
            (-1.0, 4.0, 4.0, 14.0, 14.0, 24.0, 24.0, 28.0),
            ["two of its phases hold the time from -1 s to 0 s"],
        ),
        (
            (0.0, 4.0, 4.0, 14.0, 14.0, 24.0, 24.0, 29.0),
            ["two of its phases hold the time from 28 s to 29 s"],
        ),
        ((0.0, 4.0, 4.0, 4.0, 4.0, 24.0, 24.0, 28.0), ["its shot phase ends at 4 s, and begins at 4 s"]),
    ],
)
def test_phases_hold_every_instant_once(times: tuple[float, ...], said: list[str]) -> None:
    assert faults(phases=phases(*times)) == said


def test_a_flight_has_phases_and_begins_at_time_0() -> None:
    assert faults(phases=()) == ["it has no phases"]
    late = phases(1.0, 5.0, 5.0, 15.0, 15.0, 25.0, 25.0, 29.0)
    assert faults(curve=resting(breaks=BREAKS + 1.0), phases=late) == ["it begins at 1 s, not at 0 s"]


def test_shots_are_those_of_the_mission_and_phases_know_theirs() -> None:
    strange = "it names shots that the mission does not have: back"
    named = "a phase is a shot without a name, or has one without being a shot"
    back = replace(PHASES[1], shot="back")
    assert faults(phases=(PHASES[0], back, *PHASES[2:])) == [strange]
    assert faults(framing=(replace(on_screen(0.0), shot="back"),)) == [strange]
    assert faults(phases=(PHASES[0], replace(PHASES[1], shot=None), *PHASES[2:])) == [named]
    assert faults(phases=(PHASES[0], PHASES[1], replace(PHASES[2], shot="out"), PHASES[3])) == [named]


def test_what_is_wanted_on_screen_does_not_jump() -> None:
    assert faults(framing=(on_screen(0.0), on_screen(1.1e-6))) == [
        "what is wanted of a target on screen jumps"
    ]


def test_a_curve_has_seven_channels() -> None:
    assert faults(curve=resting().channels(0, 1, 2, 3, 4, 5)) == ["its curve has 6 channels, not 7"]


@pytest.mark.parametrize(("count", "told"), [(0, 0), (1, 1), (5, 5), (6, 6), (9, 6)])
def test_the_first_five_faults_are_told(count: int, told: int) -> None:
    found = list(first_few(iter([f"fault {k}" for k in range(count)])))
    assert len(found) == told
    assert found[:5] == [f"fault {k}" for k in range(min(count, 5))]
    more = "more than 5 faults of its form: the others are not listed"
    assert found[5:] == [more] * (count > 5)

"""That a plan frames what its mission asks for, where it asks for it: each rule on both sides."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest

from shotc.geom.bernstein import Piecewise
from shotc.ir.keyframes import PlacedKeyframe, PlacedShot, PlacedSubject
from shotc.ir.mission import Ideal
from shotc.ir.phases import KeyframeTime, Reference
from shotc.ir.promise import Promise
from shotc.ir.trajectory import Claim, DroneTrajectory
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.pictured import asked
from shotc.passes.verify.reference import reference_framing
from tests.support.plain_flights import (
    EAST,
    HOP,
    PHASES,
    WEST,
    lines,
    plain_keyframe,
    plain_mission,
    plain_shot,
)
from tests.support.records import replace

MIDDLE = (20.0, 0.0, 10.0)
UNTIMED, UNFRAMED, BESIDE, OFF, OFF_COURSE = (
    "keyframes without a time",
    "frames without their target",
    "frames of another target",
    "reference off its keyframes",
    "reference off its composition",
)
FIRST, LAST = (0.1, -0.2), (0.5, 0.1)
RATE = plain_mission().rate


def keyframe(
    at: tuple[float, float, float],
    place: tuple[float, float] | None,
    target: str | None = "mast",
    hold: float = 0.0,
) -> PlacedKeyframe:
    return plain_keyframe(at, hold=hold, target=target, reference=place)


BOTH = (keyframe(WEST, FIRST), keyframe(EAST, LAST))


def wanted(*places: tuple[float, float], times: tuple[float, ...] = (4.0, 14.0)) -> Piecewise:
    """Return a reference that goes straight through places on screen at given times."""
    at = np.array(places)
    return Piecewise(np.array(times), np.stack([at[:-1], at[1:]], axis=1))


def span(curve: Piecewise | None, start: float = 4.0, end: float = 14.0, target: str = "mast") -> Reference:
    return Reference("out", target, start, end, curve)


STRAIGHT = span(wanted(FIRST, LAST))


def flight(*spans: Reference, met: tuple[float, ...] = (4.0, 14.0)) -> JudgedFlight:
    mission = plain_mission()
    reached = tuple(KeyframeTime("out", i, t) for i, t in enumerate(met))
    return JudgedFlight(
        mission, mission.drones[0], DroneTrajectory("cam1", lines(HOP), PHASES, reached, spans)
    )


def judged(placed: PlacedShot, *spans: Reference, met: tuple[float, ...] = (4.0, 14.0)) -> dict[str, Claim]:
    return {c.constraint: c for c in reference_framing(flight(*spans, met=met), placed, PHASES[1])}


@pytest.mark.parametrize("promise", [Promise(), Promise(in_frame=0.5), Promise(screen_error=0.1)])
def test_a_straight_reference_between_two_keyframes_is_what_was_asked(promise: Promise) -> None:
    found = judged(plain_shot(*BOTH, promise=promise), STRAIGHT)
    assert set(found) == {UNFRAMED, BESIDE, OFF}
    assert (found[UNFRAMED].worst, found[BESIDE].worst) == (0.0, 0.0)
    assert found[OFF].worst == pytest.approx(0.0, abs=1e-12)
    assert (found[OFF].limit, found[OFF].hard) == (0.01, True)
    assert (found[UNFRAMED].limit, found[UNFRAMED].hard, found[UNFRAMED].upper) == (0.0, True, True)


@pytest.mark.parametrize("end", [0, 1])
@pytest.mark.parametrize(("off", "holds"), [(0.0099, True), (0.0101, False)])
def test_at_both_keyframes_the_reference_is_theirs(end: int, off: float, holds: bool) -> None:
    """It moves along the line, which counts at its ends alone."""
    along = np.subtract(LAST, FIRST) / np.linalg.norm(np.subtract(LAST, FIRST))
    places = [np.array(FIRST), np.array(LAST)]
    places[end] = places[end] + (1 - 2 * end) * off * along
    claim = judged(plain_shot(*BOTH), span(wanted(*map(tuple, places))))[OFF]
    assert (claim.worst, claim.holds, claim.time) == (pytest.approx(off), holds, (4.0, 14.0)[end])


@pytest.mark.parametrize(("off", "holds"), [(0.0099, True), (0.0101, False), (-0.0101, False)])
def test_between_keyframes_the_reference_is_on_the_line_between_theirs(off: float, holds: bool) -> None:
    along = np.subtract(LAST, FIRST) / np.linalg.norm(np.subtract(LAST, FIRST))
    middle = 0.3 * np.array(FIRST) + 0.7 * np.array(LAST) + off * np.array([-along[1], along[0]])
    claim = judged(plain_shot(*BOTH), span(wanted(FIRST, tuple(middle), LAST, times=(4.0, 9.0, 14.0))))[OFF]
    assert (claim.worst, claim.holds) == (pytest.approx(abs(off)), holds)
    assert claim.time == pytest.approx(9.0, abs=1e-9)


@pytest.mark.parametrize(("beyond", "holds"), [(0.009, True), (0.02, False)])
@pytest.mark.parametrize("end", [0, 1])
def test_the_line_ends_at_both_references(end: int, beyond: float, holds: bool) -> None:
    along = np.subtract(LAST, FIRST) / np.linalg.norm(np.subtract(LAST, FIRST))
    middle = np.array((FIRST, LAST)[end]) + (2 * end - 1) * beyond * along
    claim = judged(plain_shot(*BOTH), span(wanted(FIRST, tuple(middle), LAST, times=(4.0, 9.0, 14.0))))[OFF]
    assert (claim.worst, claim.holds) == (pytest.approx(beyond), holds)


def test_a_reference_that_stands_stays_in_its_place() -> None:
    still = plain_shot(keyframe(WEST, FIRST), keyframe(EAST, FIRST))
    assert judged(still, span(wanted(FIRST, FIRST)))[OFF].worst == pytest.approx(0.0, abs=1e-12)
    aside = (FIRST[0] + 0.3, FIRST[1] - 0.4)
    found = judged(still, span(wanted(FIRST, aside, FIRST, times=(4.0, 9.0, 14.0))))[OFF]
    assert found.worst == pytest.approx(0.5)


@pytest.mark.parametrize("missing", [0, 1, 2])
def test_every_keyframe_has_a_time(missing: int) -> None:
    met = (4.0, 14.0)[: 2 - missing]
    for promise in (Promise(), Promise(in_frame=1.0)):
        found = judged(plain_shot(*BOTH, promise=promise), STRAIGHT, met=met)
        if not missing:
            assert UNTIMED not in found
            continue
        claim = found[UNTIMED]
        assert (set(found), claim.worst, claim.limit) == ({UNTIMED, BESIDE}, missing, 0.0)
        assert (claim.holds, claim.hard) == (False, True)


@pytest.mark.parametrize(
    ("spans", "frames"),
    [
        (((4.0, 14.0),), 0),
        ((), 10.0 * RATE + 1),
        (((4.0, 9.0),), 5.0 * RATE),
        (((4.0, 8.0), (9.0, 14.0)), 1.0 * RATE - 1),
        (((4.0, 8.0), (8.0, 14.0)), 0),
    ],
)
def test_every_frame_between_two_keyframes_of_a_target_frames_it(
    spans: tuple[tuple[float, float], ...], frames: float
) -> None:
    whole = wanted(FIRST, LAST)
    claim = judged(plain_shot(*BOTH), *(span(whole, *ends) for ends in spans))[UNFRAMED]
    assert (claim.worst, claim.holds) == (pytest.approx(frames), frames == 0)
    other = judged(plain_shot(*BOTH), *(span(whole, *ends, target="tower") for ends in spans))[UNFRAMED]
    assert other.worst == 10.0 * RATE + 1


def test_without_a_reference_in_a_frame_it_is_off_without_a_number() -> None:
    claim = judged(plain_shot(*BOTH), span(None))[OFF]
    assert (claim.worst, claim.holds) == (inf, False)


def test_keyframes_without_a_place_on_screen_have_no_line() -> None:
    for first, last in ((None, LAST), (FIRST, None), (None, None)):
        found = judged(plain_shot(keyframe(WEST, first), keyframe(EAST, last)), STRAIGHT)
        assert set(found) == {UNFRAMED, BESIDE}


HALF = 3.0 * RATE - 1
"""Frames of the first 30 % of the way from one keyframe to the other, which takes 10 s."""


@pytest.mark.parametrize(
    ("targets", "spans", "lacking", "beside"),
    [
        (("mast", "tower"), (("mast", 4.0, 9.0), ("tower", 9.0, 14.0)), 0, 0),
        (("mast", "tower"), (("mast", 4.0, 7.1), ("tower", 10.9, 14.0)), 0, 0),
        (("mast", "tower"), (("mast", 4.0, 10.9), ("tower", 7.1, 14.0)), 0, 0),
        (("mast", "tower"), (("mast", 4.0, 14.0),), HALF, 3.0 * RATE),
        (("mast", "tower"), (("mast", 4.0, 6.0), ("tower", 9.0, 14.0)), 1.0 * RATE, 0),
        (("mast", "tower"), (("mast", 4.0, 9.0), ("tower", 6.0, 14.0)), 0, 1.0 * RATE),
        (("mast", "tower"), (), HALF, None),
        ((None, "mast"), (("mast", 9.0, 14.0),), 0, 0),
        ((None, "mast"), (("mast", 14.0, 14.0),), HALF, 0),
        ((None, "mast"), (("mast", 4.0, 14.0),), 0, 3.0 * RATE),
        (("mast", None), (("mast", 4.0, 9.0),), 0, 0),
        (("mast", None), (("mast", 4.0, 4.0),), HALF, 0),
        (("mast", None), (("mast", 4.0, 14.0),), 0, 3.0 * RATE),
        (("mast", None), (), HALF, None),
        ((None, None), (("mast", 6.0, 8.0),), None, 2.0 * RATE + 1),
        (("mast", "mast"), (("mast", 4.0, 14.0), ("tower", 6.0, 8.0)), 0, 2.0 * RATE + 1),
    ],
)
def test_the_picture_of_a_target_ends_in_the_middle_of_the_way_to_another_or_to_none(
    targets: tuple[str | None, str | None],
    spans: tuple[tuple[str, float, float], ...],
    lacking: float | None,
    beside: float | None,
) -> None:
    """On what is not within a fifth of the way from the middle, no plan chooses what it frames."""
    turned = plain_shot(keyframe(WEST, None, targets[0]), keyframe(EAST, None, targets[1]))
    found = judged(turned, *(span(None, start, end, target) for target, start, end in spans))
    for name, frames in ((UNFRAMED, lacking), (BESIDE, beside)):
        assert (name in found) is (frames is not None)
        if frames is not None:
            assert found[name].worst == pytest.approx(frames, abs=1.0)
            assert (found[name].holds, found[name].hard) == (frames == 0, True)


def test_a_hold_frames_its_target_to_its_end() -> None:
    held = plain_shot(keyframe(WEST, FIRST, "mast", hold=2.0), keyframe(EAST, LAST, "tower"))
    after = span(None, 9.5, 14.0, "tower")
    assert judged(held, span(None, 4.0, 9.5), after)[UNFRAMED].worst == 0
    gap = (span(None, 4.0, 5.0), span(None, 5.5, 9.5), after)
    assert judged(held, *gap)[UNFRAMED].worst == pytest.approx(0.5 * RATE, abs=1.0)


def test_a_camera_that_turns_on_the_spot_frames_its_targets_before_and_after() -> None:
    turned = plain_shot(keyframe(WEST, FIRST, "mast"), keyframe(WEST, LAST, "tower"))
    assert judged(turned, span(None, 4.0, 4.0), span(None, 14.0, 14.0, "tower"))[UNFRAMED].worst == 0


def test_keyframes_of_no_target_have_nothing_between_them() -> None:
    nothing = plain_shot(keyframe(WEST, FIRST, None), keyframe(EAST, LAST, None))
    assert judged(nothing) == {}
    assert judged(nothing, STRAIGHT)[BESIDE].worst == 10.0 * RATE + 1


def test_a_hold_before_the_way_is_not_judged_by_the_line() -> None:
    """From 4 s to 6 s the reference stands, then it goes; without the hold it would lag, on the line."""
    held_first = plain_shot(keyframe(WEST, FIRST, hold=2.0), keyframe(EAST, LAST))
    late = span(wanted(FIRST, FIRST, LAST, times=(4.0, 6.0, 14.0)))
    assert judged(held_first, late)[OFF].worst == pytest.approx(0.0, abs=1e-12)
    far = np.add(FIRST, (0.0, 0.3))
    jumping = span(wanted(tuple(far), FIRST, LAST, times=(4.0, 6.0, 14.0)))
    assert judged(held_first, jumping)[OFF].worst == pytest.approx(0.0, abs=1e-12)
    assert judged(plain_shot(*BOTH), jumping)[OFF].worst == pytest.approx(0.3)


@pytest.mark.parametrize("target", ["mast", None])
def test_a_single_keyframe_is_framed_for_the_whole_shot(target: str | None) -> None:
    one = plain_shot(keyframe(WEST, FIRST, target))
    found = judged(one, span(wanted(FIRST, FIRST), 4.0, 9.0), met=(4.0,))
    frames = {UNFRAMED: 5.0 * RATE, OFF: inf} if target else {BESIDE: 5.0 * RATE + 1}
    assert {name: claim.worst for name, claim in found.items() if not claim.holds} == frames


def test_the_worst_of_several_ways_is_told() -> None:
    three = plain_shot(keyframe(WEST, FIRST), keyframe(MIDDLE, LAST), keyframe(EAST, FIRST))
    bent = wanted(FIRST, (0.3, 0.3), LAST, (0.3, -0.35), FIRST, times=(4.0, 6.0, 9.0, 11.0, 14.0))
    found = judged(three, span(bent), met=(4.0, 9.0, 14.0))
    normal = np.array([-0.6, 0.8])  # of the line from FIRST to LAST, 0.5 long
    expected = [abs(normal @ np.subtract(p, FIRST)) for p in ((0.3, 0.3), (0.3, -0.35))]
    assert found[OFF].worst == pytest.approx(max(expected))
    gaps = judged(three, span(bent, 4.0, 8.9), span(bent, 12.0, 14.0), met=(4.0, 9.0, 14.0))[UNFRAMED]
    assert gaps.worst == pytest.approx(3.0 * RATE)
    assert gaps.time == 9.0


COURSE = Ideal("world", None, ((0.0, WEST), (1.0, EAST)))


def on_clock(*subjects: PlacedSubject, promise: Promise | None = None) -> PlacedShot:
    shot = plain_shot(ideal=COURSE, promise=promise or Promise())
    return replace(shot, subjects=subjects)


def subject(place: tuple[float, float] | None, target: str = "mast") -> PlacedSubject:
    return PlacedSubject(target, place, None, None, ("shots", 0))


@pytest.mark.parametrize(("off", "holds"), [(0.0, True), (0.0099, True), (0.0101, False)])
def test_subjects_of_a_shot_on_its_own_clock_keep_their_places(off: float, holds: bool) -> None:
    aside = (FIRST[0] + 0.6 * off, FIRST[1] - 0.8 * off)
    for promise in (Promise(), Promise(in_frame=1.0)):
        spans = (
            span(wanted(FIRST, aside, FIRST, times=(4.0, 9.0, 14.0))),
            span(wanted(LAST, LAST), target="tower"),
        )
        found = judged(on_clock(subject(FIRST), subject(LAST, "tower"), promise=promise), *spans)
        assert found[OFF_COURSE].worst == pytest.approx(off)
        assert (found[OFF_COURSE].holds, found[OFF_COURSE].hard) == (holds, True)
        assert not off or found[OFF_COURSE].time == pytest.approx(9.0)
        assert (found[UNFRAMED].worst, found[UNFRAMED].hard) == (0.0, True)


def test_what_is_not_framed_on_its_own_clock_is_counted_for_each_subject() -> None:
    """The first subject lacks after 9 s; of the second, without a place on screen, nothing is framed."""
    spans = (span(wanted(FIRST, FIRST), 4.0, 9.0),)
    found = judged(on_clock(subject(FIRST), subject(None, "tower")), *spans)
    assert found[UNFRAMED].worst == 5.0 * RATE + 10.0 * RATE + 1
    assert (found[OFF_COURSE].worst, found[OFF_COURSE].holds) == (inf, False)
    free = judged(on_clock(subject(None)), span(None))
    assert (free[UNFRAMED].worst, free[OFF_COURSE].worst) == (0.0, 0.0)


def test_a_target_is_held_between_its_own_keyframes_and_in_their_holds() -> None:
    keyframes = (
        keyframe(WEST, FIRST, "mast", 1.0), keyframe(MIDDLE, FIRST, "mast", 0.5),
        keyframe(MIDDLE, FIRST, "tower", 0.5), keyframe(EAST, FIRST, "tower"),
    )  # fmt: skip
    met, times = (4.0, 7.0, 10.0, 14.0), np.linspace(4.0, 14.0, 101)
    one = flight(met=met)

    def kept(target: str, placed: PlacedShot) -> list[float]:
        inside = times[asked(one, placed, PHASES[1], target, times)]
        return [float(inside[0]), float(inside[-1]), len(inside)] if len(inside) else []

    assert kept("mast", plain_shot(*keyframes)) == pytest.approx([4.0, 7.5, 36])
    assert kept("tower", plain_shot(*keyframes)) == pytest.approx([10.0, 14.0, 41])
    assert kept("post", plain_shot(*keyframes)) == []


def test_a_subject_without_a_place_on_screen_hides_no_other_one() -> None:
    spans = span(None, target="tower"), span(wanted(FIRST, LAST))
    found = judged(on_clock(subject(None, "tower"), subject(FIRST)), *spans)
    assert (found[OFF_COURSE].worst, found[OFF_COURSE].holds) == (pytest.approx(0.5), False)

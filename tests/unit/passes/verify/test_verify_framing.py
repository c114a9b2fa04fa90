"""What the proof says of a target on screen: in frame, hidden, off its place, and promises to paste."""

import re
from math import pi, radians

import numpy as np
import pytest

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import quintic_hermite
from shotc.geom.solids import box
from shotc.ir.mission import Promise, Zone
from shotc.ir.path import CAM_YAW, HFOV, PathDeviation
from shotc.ir.trajectory import TrajectoryIR
from shotc.passes.verify import Verify, judge
from shotc.passes.verify.hidden import longest
from tests.support.records import replace
from tests.support.tampered_plans import (
    CONTEXT,
    MISSION,
    PLAN,
    claim,
    codes,
    shifted,
    with_ctrl,
    with_mission,
    with_track,
)


def test_framing_promises() -> None:
    aside = shifted(CAM_YAW, radians(32))
    assert {"V019", "V020"} <= set(codes(aside))
    away = shifted(CAM_YAW, pi * 0.9)
    found = {d.code: d for d in judge(away, CONTEXT).diagnostics}
    assert "behind the camera" in found["V020"].message


def swaying(size: float) -> TrajectoryIR:
    """The camera sways once a second while it films: by nothing at whole seconds."""
    track = PLAN.drones[0]
    t = np.concatenate([[0.0, 8.0], np.linspace(22, 52, 241), [82.0, 112.0, 122.0]])
    value, rate, bend = (track.curve.derivative(n)(t) if n else track.curve(t) for n in range(3))
    rest = ~((t >= 22) & (t <= 52))
    rate[rest], bend[rest] = 0.0, 0.0
    filmed = (t > 22) & (t < 52)
    phase = 2 * pi * t[filmed]
    value[filmed, CAM_YAW] += size * np.sin(phase) ** 2
    rate[filmed, CAM_YAW] += size * 2 * pi * np.sin(2 * phase)
    bend[filmed, CAM_YAW] += size * 8 * pi**2 * np.cos(2 * phase)
    return with_track(curve=quintic_hermite(t, value, rate, bend))


@pytest.mark.parametrize(("size", "method"), [(0.01, "bounded"), (0.1, "sampled")])
def test_between_samples_a_promise_is_proved_or_only_sampled(size: float, method: str) -> None:
    shot = replace(MISSION.shots[0], promise=Promise(screen_error=0.05))
    ir = with_mission(swaying(size), rate=1.0, shots=(shot,))
    error = claim(ir, "tower screen error")
    assert error.worst < 0.003  # samples see nothing of it
    assert error.method == method
    seen = claim(with_mission(ir, rate=7.0), "tower screen error").worst
    assert (seen > 0.05) is (method == "sampled")


def test_whole_in_frame_between_samples() -> None:
    for size, method in ((0.1, "bounded"), (0.6, "sampled")):
        found = claim(with_mission(swaying(size), rate=1.0), "tower in frame")
        assert found.worst == 1.0
        assert found.method == method


def test_without_promises_losses_are_warnings() -> None:
    ir = with_mission(shifted(CAM_YAW, radians(32)), shots=(replace(MISSION.shots[0], promise=Promise()),))
    outcome = Verify().run(ir, CONTEXT)
    assert [d.code for d in outcome.diagnostics] == ["V030", "V032"]
    assert outcome.value is not None
    soft = [c for c in outcome.value.certificate if not c.hard]
    assert {c.constraint for c in soft if not c.holds} == {"tower in frame"}
    assert "worst at t = " in outcome.diagnostics[0].notes[0]
    assert outcome.diagnostics[0].message.startswith("tower is not whole in frame in ")


def test_a_hidden_target_is_a_warning() -> None:
    screen = Zone("screen", "out", box((30.0, 0.0, 10), (1, 4, 20), 0), ("world", "zones", "screen"))
    ir = with_mission(zones=(*MISSION.zones, screen))
    assert codes(ir) == ["V031"]
    share = claim(ir, "tower visible")
    assert 0.9 < share.worst < 1.0
    assert share.time is not None
    assert PLAN.drones[0].curve(share.time)[0] > 39  # it hides it from the east only
    (told,) = Verify().run(ir, CONTEXT).diagnostics
    assert told.message.startswith("tower is hidden in ")
    assert told.notes[-1].startswith("zone `screen` hides it in ")
    assert float(told.notes[-1].split()[-2]) == pytest.approx(100 * (1 - share.worst), abs=0.2)


def test_a_target_within_a_zone_is_hidden_in_every_frame_and_that_is_an_error_unless_it_is_meant() -> None:
    hall = Zone("hall", "out", box((0.0, 0.0, 15), (12, 12, 30), 0), ("world", "zones", "hall"))
    ir = with_mission(zones=(*MISSION.zones, hall))
    assert claim(ir, "tower visible").worst == 0.0
    outcome = Verify().run(ir, CONTEXT)
    assert outcome.value is None
    (told,) = outcome.diagnostics
    assert told.code == "V050"
    assert told.notes[-1] == "zone `hall` hides it in 100 %"
    meant = replace(MISSION.shots[0], allow=("hidden-subject",))
    assert codes(with_mission(zones=(*MISSION.zones, hall), shots=(meant,))) == []


@pytest.mark.slow
def test_a_target_hidden_in_just_most_of_the_frames_is_an_error() -> None:
    """Between hidden for a while, which is told, and hidden in most frames, there is half of them."""
    found = {}
    for wide in (10.0, 60.0):
        screen = Zone("screen", "out", box((10.0, 0.0, 10), (1, wide, 20), 0), ("world", "zones", "screen"))
        ir = with_mission(zones=(*MISSION.zones, screen))
        # The screen stands beside the way there, too, which is another warning.
        found[claim(ir, "tower visible").worst < 0.5] = [code for code in codes(ir) if code != "V034"]
    assert found == {False: ["V031"], True: ["V050"]}


@pytest.mark.parametrize(("beside", "found"), [(8.0, ["V031"]), (6.9, [])])
def test_a_target_that_overlaps_the_filmed_one_does_not_hide_it(beside: float, found: list[str]) -> None:
    (tower,) = MISSION.targets
    annex = replace(
        tower,
        name="annex",
        centre=(tower.centre[0] + beside, *tower.centre[1:]),
        shape=tower.shape._replace(radius=1.0),
    )
    wide = replace(tower, shape=tower.shape._replace(radius=6.0))
    ir = with_mission(targets=(wide, annex))
    assert [code for code in codes(ir) if code == "V031"] == found
    assert (claim(ir, "tower visible").worst < 1.0) is bool(found)


def test_the_worst_of_what_is_hidden_is_the_middle_of_the_longest_stretch() -> None:
    assert longest(np.array([0, 1, 1, 0, 0, 1, 1, 1, 0], dtype=bool)) == 6
    assert longest(np.array([1, 1, 1, 1, 0, 1], dtype=bool)) == 1
    assert longest(np.zeros(4, dtype=bool)) == 0


def promising(promise: Promise, ir: TrajectoryIR = PLAN) -> list[Diagnostic]:
    shot = replace(MISSION.shots[0], promise=promise)
    return list(judge(with_mission(ir, shots=(shot,)), CONTEXT).diagnostics)


def test_a_broken_size_is_told_by_what_is_seen_and_a_range_to_paste() -> None:
    (found,) = promising(Promise(size=(0.01, 0.7)))
    assert found.message == "tower fills 0.8101 of the frame's height in shot `half`, 0.7 is promised at most"
    assert found.help.startswith("promise `size: [0.01, 0.811]`, or change the distance")
    assert promising(Promise(size=(0.01, 0.811))) == []
    (found,) = promising(Promise(size=(0.9, 0.95)))
    assert "0.9 is promised at least" in found.message
    assert found.help.startswith("promise `size: [0.81, 0.95]`")


def test_a_range_to_paste_holds_for_both_ends() -> None:
    nearer = with_ctrl(lambda c: c.__setitem__((..., HFOV), c[..., HFOV] * np.linspace(1, 1.1, 6)))
    both = [d for d in promising(Promise(size=(0.78, 0.79)), nearer) if d.code == "V021"]
    assert len(both) == 2
    assert both[0].help == both[1].help
    low, high = re.findall(r"0\.\d+", both[0].help)
    kept = promising(Promise(size=(float(low), float(high))), nearer)
    assert not [d for d in kept if d.code == "V021"]


@pytest.mark.slow
def test_a_broken_screen_error_is_told_with_a_promise_to_paste() -> None:
    aside = shifted(CAM_YAW, radians(3))
    (found,) = promising(Promise(screen_error=0.05), aside)
    assert found.message == (
        "tower is 0.07339 of half a frame off its place on screen in shot `half`, 0.05 is promised at most"
    )
    assert found.help == "promise `screen_error: 0.0734`, or turn the camera slower there"
    assert promising(Promise(screen_error=0.0734), aside) == []


def test_a_cropped_target_is_told_with_a_promise_to_paste() -> None:
    aside = shifted(CAM_YAW, radians(32))
    found, off_its_place = promising(Promise(in_frame=1.0), aside)
    assert off_its_place.code == "V032"
    assert found.message == "tower is whole in 0 % of the frames of shot `half`, 100 % is promised"
    assert found.help.startswith("promise `in_frame: 0 %`, or move or widen the shot")


def test_a_broken_promise_names_what_bent_the_path() -> None:
    bent = (PathDeviation("half", 1.5, 3.0, "zone tree"), PathDeviation("other", 9.0, 0.0, "the ground"))
    (found,) = promising(Promise(size=(0.1, 0.7)), replace(PLAN, deviations=bent))
    assert "the shot leaves its ideal path by up to 1.50 m, round zone `tree`" in found.notes
    assert not any("ground" in note for note in found.notes)

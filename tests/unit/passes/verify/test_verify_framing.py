"""What the proof says of a target on screen: in frame, hidden, off its place, and promises to paste."""

import re
from math import ceil, pi, radians
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import quintic_hermite
from shotc.geom.solids import box
from shotc.ir.mission import Zone
from shotc.ir.obstacle_mesh import obstacle_mesh
from shotc.ir.path import BODY_YAW, CAM_YAW, HFOV, PathDeviation
from shotc.ir.promise import Promise
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify import Verify
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.hidden import hidden_by
from shotc.passes.verify.pictured import asked
from shotc.passes.verify.visible import longest
from tests.support.records import replace
from tests.support.scenes import house, turned
from tests.support.tampered_plans import MISSION, PLAN, shifted, with_ctrl, with_mission, with_track
from tests.support.verdicts import CONTEXT, claim, codes, verdict_on


def test_framing_promises() -> None:
    assert {"V019", "V020"} <= set(codes(aside(32)))
    away = shifted(CAM_YAW, pi * 0.9)
    found = {d.code: d for d in verdict_on(away).diagnostics}
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


def aside(degrees: float) -> TrajectoryIR:
    """The sample plan, turned aside all the time, body and camera."""
    by = radians(degrees)
    return with_ctrl(lambda c: c.__setitem__((..., [CAM_YAW, BODY_YAW]), c[..., [CAM_YAW, BODY_YAW]] + by))


def test_without_promises_losses_are_warnings() -> None:
    ir = with_mission(aside(32), shots=(replace(MISSION.shots[0], promise=Promise()),))
    outcome = Verify().run(ir, CONTEXT)
    assert [d.code for d in outcome.diagnostics] == ["V030", "V032"]
    assert outcome.value is not None
    soft = [c for c in outcome.value.certificate if not c.hard]
    assert {c.constraint for c in soft if not c.holds} == {"tower in frame"}
    assert "worst at t = " in outcome.diagnostics[0].notes[0]
    assert outcome.diagnostics[0].message.startswith("tower is not whole in frame in ")


@pytest.mark.slow
def test_a_hidden_target_is_a_warning() -> None:
    screen = Zone("screen", "out", box((30.0, 0.0, 10), (1, 4, 20), 0), ("world", "zones", "screen"))
    ir = with_mission(zones=(*MISSION.zones, screen))
    assert codes(ir) == ["V031"]
    share, shown = claim(ir, "tower visible"), claim(ir, "tower in sight")
    assert 0.9 < shown.worst < 1.0
    assert 0.0 < share.worst < 0.5
    assert share.time is not None
    assert PLAN.drones[0].curve(share.time)[0] > 39  # it hides it from the east only
    (told,) = Verify().run(ir, CONTEXT).diagnostics
    most = f"{ceil(1000 * (1 - share.worst)) / 10:g} %"
    assert told.message == f"tower is hidden by up to {most} of its outline in shot `half`"
    assert told.notes[-1].startswith(f"zone `screen` hides up to {most} of it, and more than half in ")
    assert float(told.notes[-1].split()[-5]) == pytest.approx(100 * (1 - shown.worst), abs=0.2)


@pytest.mark.long
def test_a_target_within_a_zone_is_hidden_in_every_frame_and_that_is_an_error_unless_it_is_meant() -> None:
    hall = Zone("hall", "out", box((0.0, 0.0, 15), (12, 12, 30), 0), ("world", "zones", "hall"))
    ir = with_mission(zones=(*MISSION.zones, hall))
    assert claim(ir, "tower visible").worst == 0.0
    outcome = Verify().run(ir, CONTEXT)
    assert outcome.value is None
    (told,) = outcome.diagnostics
    assert told.code == "V050"
    assert told.notes[-1] == "zone `hall` hides up to 100 % of it, and more than half in 100 % of the frames"
    meant = replace(MISSION.shots[0], allow=("hidden-subject",))
    assert codes(with_mission(zones=(*MISSION.zones, hall), shots=(meant,))) == []


@pytest.mark.slow
def test_what_hides_a_target_is_named_by_its_part() -> None:
    walls = [turned(house(1, 4, 19, 20), 0.0, (x, y)) for x, y in ((30.0, 0.0), (30.0, 400.0))]
    numbers = np.repeat([0, 1], [len(wall) for wall in walls])
    mesh = obstacle_mesh("buildings", "houses.geojson", np.concatenate(walls), (numbers, ("Barn", "Mill")))
    ir = with_mission(meshes=(mesh,))
    found = [d for d in Verify().run(ir, CONTEXT).diagnostics if d.code == "V031"]
    notes = found[0].notes
    assert [note.partition(" hides")[0] for note in notes if " hides up to" in note] == ["building `Barn`"]
    again = replace(mesh, names=("Barn", "Barn"))
    alone = replace(mesh, part=np.zeros(len(numbers), dtype=np.intp), names=("houses",))
    for other, name in ((again, "building `Barn`"), (alone, "buildings `houses.geojson`")):
        (told,) = (
            d for d in Verify().run(with_mission(meshes=(other,)), CONTEXT).diagnostics if d.code == "V031"
        )
        assert told.notes[-1] == notes[-1].replace("building `Barn`", name)


@pytest.mark.slow
def test_a_target_hidden_in_just_most_of_the_frames_is_an_error() -> None:
    """Between hidden for a while, which is told, and hidden in most frames, there is half of them."""
    found = {}
    for wide in (10.0, 60.0):
        screen = Zone("screen", "out", box((10.0, 0.0, 10), (1, wide, 20), 0), ("world", "zones", "screen"))
        ir = with_mission(zones=(*MISSION.zones, screen))
        # The screen stands beside the way there, too, which is another warning.
        found[claim(ir, "tower in sight").worst < 0.5] = [code for code in codes(ir) if code != "V034"]
    assert found == {False: ["V031"], True: ["V050"]}


@pytest.mark.slow
@pytest.mark.parametrize(("beside", "found"), [(13.0, ["V031"]), (11.9, [])])
def test_a_target_that_overlaps_the_filmed_one_does_not_hide_it(beside: float, found: list[str]) -> None:
    (tower,) = MISSION.targets
    annex = replace(
        tower,
        name="annex",
        centre=(tower.centre[0] + beside, *tower.centre[1:]),
        shape=tower.shape._replace(radius=6.0),
    )
    wide = replace(tower, shape=tower.shape._replace(radius=6.0))
    ir = with_mission(targets=(wide, annex))
    assert [code for code in codes(ir) if code == "V031"] == found
    assert (claim(ir, "tower visible").worst < 1.0) is bool(found)


def test_the_worst_of_what_is_hidden_is_the_middle_of_the_longest_stretch() -> None:
    assert longest(np.array([0, 1, 1, 0, 0, 1, 1, 1, 0], dtype=bool)) == 6
    assert longest(np.array([1, 1, 1, 1, 0, 1], dtype=bool)) == 1
    assert longest(np.zeros(4, dtype=bool)) == 0


def screened(north: float, promise: Promise) -> TrajectoryIR:
    """The plan with a screen east of the tower, whose southern edge is so far north, and a promise."""
    screen = Zone("screen", "out", box((30.0, north + 9, 10), (1, 18, 20), 0), ("world", "zones", "screen"))
    shot = replace(MISSION.shots[0], promise=promise)
    return with_mission(zones=(*MISSION.zones, screen), shots=(shot,))


@pytest.mark.slow
def test_a_promise_of_what_is_visible_holds_for_every_frame_and_is_told_with_who_covers_how_much() -> None:
    ir = screened(-1.0, Promise(visible=0.9))
    found = claim(ir, "tower visible")
    assert (found.hard, found.holds, found.method, found.limit) == (True, False, "sampled", 0.9)
    (told,) = [d for d in verdict_on(ir).diagnostics if d.code == "V028"]
    least = 100 * found.worst
    assert told.message == (
        f"{least:.4g} % of the outline of tower is free in a frame of shot `half`, 90 % is promised at least"
    )
    assert told.notes[0].startswith(f"worst at t = {found.time:.3f} s")
    assert "zone `screen` hides up to" in told.notes[-1]
    kept = float(told.help.split("`visible: ")[1].split(" %")[0]) / 100
    assert kept == pytest.approx(found.worst, abs=1e-3)
    corrected = screened(-1.0, Promise(visible=kept))
    assert "V028" not in codes(corrected)
    assert claim(corrected, "tower visible").holds


def before_the_first_frame(promise: Promise) -> TrajectoryIR:
    """The plan with a wall between the tower and where the camera is first, and a promise."""
    (phase,) = (p for p in PLAN.drones[0].phases if p.shot == "half")
    eye = PLAN.drones[0].curve(phase.start)[:3]
    x, y = (0.7 * (eye[:2] - np.array(MISSION.targets[0].centre[:2]))).tolist()
    wall = Zone("wall", "out", box((x, y, 20), (14, 14, 40), 0), ("world", "zones", "wall"))
    shot = replace(MISSION.shots[0], promise=promise)
    return with_mission(zones=(*MISSION.zones, wall), shots=(shot,))


@pytest.mark.slow
def test_a_reveal_is_held_at_its_ends_and_being_hidden_meanwhile_is_meant() -> None:
    ir = before_the_first_frame(Promise(reveal=(0.0, 1.0)))
    made = {c.constraint: c for c in verdict_on(ir).certificate if c.shot == "half"}
    first, last = made["tower visible at first"], made["tower visible at last"]
    assert (first.worst, last.worst, first.upper, last.upper) == (0.0, 1.0, True, False)
    assert [first.hard, last.hard] == [True, True]
    assert last.path[-2:] == ("reveal", "to")
    assert not {"V029", "V031", "V050"} & set(codes(ir))


@pytest.mark.slow
def test_a_broken_reveal_is_told_at_the_end_that_breaks_it_with_one_that_is_kept() -> None:
    told = [d for d in promising(Promise(reveal=(0.0, 1.0))) if d.code == "V029"]
    assert [d.message for d in told] == [
        "100 % of the outline of tower is free in the first frame of shot `half`, 0 % is promised at most"
    ]
    assert "promise" not in told[0].help  # nothing is revealed that is free at first
    lost = verdict_on(before_the_first_frame(Promise(reveal=(1.0, 0.2)))).diagnostics
    assert [d.message.split(" is free in ")[1].split(" frame")[0] for d in lost if d.code == "V029"] == [
        "the first",
        "the last",
    ]
    half = verdict_on(screened(-1.0, Promise(reveal=(0.5, 0.9)))).diagnostics
    assert all("reveal: {" in d.help or "begin or end" in d.help for d in half if d.code == "V029")


def promising(promise: Promise, ir: TrajectoryIR = PLAN) -> list[Diagnostic]:
    shot = replace(MISSION.shots[0], promise=promise)
    return list(verdict_on(with_mission(ir, shots=(shot,))).diagnostics)


@pytest.mark.slow
def test_a_broken_size_is_told_by_what_is_seen_and_a_range_to_paste() -> None:
    (found,) = promising(Promise(size=(0.01, 0.7)))
    assert found.message == "tower fills 0.8101 of the frame's height in shot `half`, 0.7 is promised at most"
    assert found.help.startswith("promise `size: [0.01, 0.811]`, or change the distance")
    assert promising(Promise(size=(0.01, 0.811))) == []
    (found,) = promising(Promise(size=(0.9, 0.95)))
    assert "0.9 is promised at least" in found.message
    assert found.help.startswith("promise `size: [0.81, 0.95]`")


@pytest.mark.slow
def test_a_range_to_paste_holds_for_both_ends() -> None:
    nearer = with_ctrl(lambda c: c.__setitem__((..., HFOV), c[..., HFOV] * np.linspace(1, 1.1, 6)))
    both = [d for d in promising(Promise(size=(0.78, 0.79)), nearer) if d.code == "V021"]
    assert len(both) == 2
    assert both[0].help == both[1].help
    low, high = re.findall(r"0\.\d+", both[0].help)
    kept = promising(Promise(size=(float(low), float(high))), nearer)
    assert not [d for d in kept if d.code == "V021"]


@pytest.mark.long
def test_a_broken_screen_error_is_told_with_a_promise_to_paste() -> None:
    off = aside(3)
    (found,) = promising(Promise(screen_error=0.05), off)
    assert found.message == (
        "tower is 0.07339 of half a frame off its place on screen in shot `half`, 0.05 is promised at most"
    )
    assert found.help == "promise `screen_error: 0.0734`, or turn the camera less there"
    assert promising(Promise(screen_error=0.0734), off) == []


def test_a_target_that_no_frame_shows_whole_has_no_promise_to_paste() -> None:
    found, off_its_place = promising(Promise(in_frame=1.0), aside(32))
    assert off_its_place.code == "V032"
    assert found.message == "tower is whole in 0 % of the frames of shot `half`, 100 % is promised"
    assert found.help == "film from farther away or through a wider lens where the target is cropped"


def test_a_broken_promise_names_what_bent_the_path() -> None:
    bent = (PathDeviation("half", 1.5, 3.0, "zone tree"), PathDeviation("other", 9.0, 0.0, "the ground"))
    (found,) = promising(Promise(size=(0.1, 0.7)), replace(PLAN, deviations=bent))
    assert "the shot leaves its ideal path by up to 1.50 m, round zone `tree`" in found.notes
    assert not any("ground" in note for note in found.notes)


def test_a_place_on_screen_is_held_in_the_frames_that_have_one() -> None:
    (span,) = PLAN.drones[0].framing
    middle = 0.5 * (span.start + span.end)
    free = replace(span, start=middle, reference=None)
    found = claim(with_track(aside(3), framing=(replace(span, end=middle), free)), "tower screen error")
    assert found.worst == pytest.approx(np.tan(radians(3)) / np.tan(radians(35)), rel=0.03)
    assert found.time is not None
    assert span.start <= found.time <= middle


def test_a_size_that_is_not_known_is_the_worst_of_either_kind() -> None:
    away = shifted(CAM_YAW, pi * 0.9)
    assert claim(away, "tower size smallest").worst == -np.inf
    assert claim(away, "tower size largest").worst == np.inf


@pytest.mark.slow
def test_nothing_is_asked_of_a_target_out_of_its_shot() -> None:
    (span,) = PLAN.drones[0].framing
    longer = replace(span, start=span.start - 10.0, end=span.end + 10.0)
    for constraint in ("tower in frame", "tower size smallest", "tower screen error"):
        assert claim(with_track(framing=(longer,)), constraint) == claim(PLAN, constraint)


def test_a_target_counts_from_its_first_keyframe_to_its_last_with_their_holds() -> None:
    """Of five keyframes the second to the fourth are of the tower; the second holds before its leg."""
    placed, track = PLAN.keyframes.shots[0], PLAN.drones[0]
    (phase,) = (p for p in track.phases if p.shot == placed.shot.id)
    keyframes = [replace(k, target="tower" if 0 < i < 4 else None) for i, k in enumerate(placed.keyframes)]
    keyframes[1], keyframes[3] = replace(keyframes[1], hold=1.0), replace(keyframes[3], hold=2.0)
    t = [k.time for k in track.keyframes]
    times = np.array([t[0], t[1] - 0.1, t[1], t[2], t[3], t[3] + 1.9, t[3] + 2.1, t[4]])
    flight = JudgedFlight(MISSION, MISSION.drones[0], track)
    found = asked(flight, replace(placed, keyframes=tuple(keyframes)), phase, "tower", times)
    assert found.tolist() == [False, False, True, True, True, True, False, False]


def test_what_hides_most_of_a_target_is_named_first() -> None:
    zones = [
        Zone(name, "out", box((x, 0.0, 10), (1, wide, 20), 0), ("world", "zones", name))
        for name, x, wide in (("narrow", 32.0, 2.0), ("wide", 30.0, 4.0))
    ]
    ir = with_mission(zones=(*MISSION.zones, *zones))
    told = hidden_by(ir, cast("Claim", SimpleNamespace(subject="cam1", shot="half")), "tower")
    assert [text.split(" ")[1] for text in told] == ["`wide`", "`narrow`"]

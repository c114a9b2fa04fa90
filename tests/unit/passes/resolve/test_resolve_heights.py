"""What heights count from: a target's foot, the ground, the plane z = 0; and what is told of them."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest

from shotc.diag.registry import has_errors
from shotc.ir.ideal import ideal_place
from shotc.ir.mission import MissionIR
from shotc.planning.clock.ideals import ideal_places
from tests.support.front_passes import resolved
from tests.support.resolve_missions import faults

ROOF = """\
shotc: 1
mission: heights
targets:
  roof: {at: [5, 0, 14], radius: 4, height: 4}
  climber: {track: {start: [-40, 40, 0.9], velocity: [4, 0, 0.5]}, radius: 0.4, height: 1.8}
drones:
  cam: {model: x500, home: [0, -60, 0]}
shots:
  - {id: a, drone: cam, SHOT}
"""


def mission(shot: str, **changes: str) -> str:
    text = ROOF.replace("SHOT", shot)
    for old, new in changes.items():
        text = text.replace(old, new)
    return text


def resolve(text: str) -> MissionIR:
    found, diagnostics = resolved(text)
    assert found is not None, diagnostics
    return found


def heights(shot: str) -> list[float]:
    (found,) = resolve(mission(shot)).shots
    return [k.at[2] for k in found.keyframes]


GENERATED = [
    ("kind: orbit, target: roof, radius: 30", "", 20.0, 20.0),
    ("kind: spiral, target: roof, radius: [30, 40]", "from", 10.0, 25.0),
    ("kind: elevator, target: roof, azimuth: 90 deg, distance: 30", "from", 10.0, 25.0),
    ("kind: dolly, target: roof, azimuth: 90 deg, distance: [50, 30]", "", 20.0, 20.0),
    ("kind: crane, target: roof, azimuth: 90 deg, distance: [50, 30]", "from", 10.0, 25.0),
    ("kind: top-down, target: roof, drift: [0, 0.2, 0], timing: {duration: 10}", "", 20.0, 20.0),
]


@pytest.mark.parametrize(("shot", "span", "first", "last"), GENERATED)
@pytest.mark.parametrize(
    ("above", "base"), [("target", 12.0), ("ground", 0.0), ("origin", 0.0), (None, 12.0)]
)
def test_an_altitude_counts_from_what_it_says(shot, span, first, last, above, base):
    written = f"[{first:g}, {last:g}]" if span else f"{first:g}"
    altitude = written if above is None else f"{{above: {above}, height: {written}}}"
    found = heights(f"{shot}, altitude: {altitude}")
    assert (found[0], found[-1]) == pytest.approx((base + first, base + last))


def test_the_same_path_is_drawn_however_its_height_is_counted():
    shot = "kind: crane, target: roof, azimuth: 20 deg, distance: [50, 30], altitude: "
    told = [
        f"{{above: {above}, height: [{a}, {b}]}}" for above, a, b in (("target", 3, 8), ("origin", 15, 20))
    ]
    one, other = (resolve(mission(shot + text)).shots[0].keyframes for text in told)
    assert len(one) == len(other)
    assert np.array([k.at for k in one]) == pytest.approx(np.array([k.at for k in other]))


@pytest.mark.parametrize(
    "shot",
    [
        "kind: chase, target: climber, distance: 12",
        "kind: lead, target: climber, distance: 12",
        "kind: lateral, target: climber, distance: 12, side: left",
        "kind: flyby, target: climber, behind: 12, ahead: 15, offset: 8",
        "kind: orbit, target: climber, radius: 15, sweep: 90 deg",
        "kind: top-down, target: climber",
    ],
)
@pytest.mark.parametrize("above", ["target", "ground", "origin"])
def test_a_camera_climbs_with_its_target_where_it_counts_from_its_foot(shot, above):
    found = resolve(
        mission(f"{shot}, altitude: {{above: {above}, height: 9}}, timing: {{start: 2, duration: 8}}")
    )
    (one,) = found.shots
    for t in (2.0, 5.5, 10.0):
        foot = 0.5 * t if above == "target" else 0.0
        assert ideal_place(found, one, 2.0, t)[2] == pytest.approx(foot + 9.0)
    times = np.linspace(0.0, 12.0, 25)
    plain = np.array([ideal_place(found, one, 2.0, float(t)) for t in times])
    assert ideal_places(found, one, 2.0, times) == pytest.approx(plain)


def test_places_may_count_from_the_ground():
    shot = "kind: static, look_at: roof, at: [30, 0, {above: ground, height: 12}]"
    assert heights(shot) == [12.0]
    assert heights(shot.replace("ground", "origin")) == [12.0]
    (wrong,) = faults(mission(shot.replace("ground", "target")))
    assert wrong.code == "S007"
    assert "cannot count from the target" in wrong.message


def test_a_height_that_is_read_anew_is_told_once_with_both_numbers():
    shot = "kind: orbit, target: roof, radius: 30, altitude: 20"
    (told,) = faults(mission(shot))
    assert told.code == "G020"
    assert told.notes == ("its foot is at z = 12.00 m; the camera is at z = 32.00 m, it was at 20.00 m",)
    for above, z in (("target", 32.0), ("origin", 20.0)):
        written = f"{{above: {above}, height: 20}}"
        assert f"`altitude: {written}`" in told.help
        text = mission(shot.replace("altitude: 20", f"altitude: {written}"))
        assert faults(text) == []
        assert resolve(text).shots[0].keyframes[0].at[2] == z


def test_a_target_on_the_ground_is_read_as_before():
    assert faults(mission("kind: orbit, target: roof, radius: 30, altitude: 20", **{"0, 14]": "0, 2]"})) == []


def test_a_climb_is_told_with_its_span():
    shot = "kind: chase, target: climber, distance: 12, altitude: 5, timing: {start: 2, duration: 8}"
    (told,) = faults(mission(shot))
    assert told.notes == (
        "its foot is at z = 1.00 to 5.00 m; the camera is at z = 6.00 to 10.00 m, it was at 5.00 m",
    )


def test_a_camera_below_the_foot_of_its_target_is_told():
    shot = "kind: orbit, target: roof, radius: 30, altitude: {above: ground, height: 8}"
    (told,) = faults(mission(shot))
    assert (told.code, told.notes) == ("G021", ("it is at z = 8.00 m, the target's foot at z = 12.00 m",))
    assert faults(mission(shot.replace("ground", "origin"))) == []


def test_the_greatest_height_is_a_rule_and_a_warning_where_it_is_silent():
    shot = "kind: orbit, target: roof, radius: 150, altitude: {above: ground, height: 130}"
    (silent,) = faults(mission(shot))
    assert silent.code == "G024"
    assert not has_errors([silent])
    for rule, codes in (("150", []), ("off", []), ("125 m", ["G022"])):
        text = mission(shot, **{"shots:": f"rules: {{max_height: {rule}}}\nshots:"})
        assert [d.code for d in faults(text)] == codes


def test_the_advice_for_a_blocked_path_counts_as_the_shot_does():
    mast = "{keep: out, cylinder: {center: [35, 0], radius: 3, height: [0, 40]}}"
    zone = f"world:\n  zones:\n    mast: {mast}\ntargets:"
    shot = "kind: orbit, target: roof, radius: 30, altitude: {above: target, height: 20}"
    told = next(d for d in faults(mission(shot, **{"targets:": zone})) if d.code == "G016")
    assert "`altitude: {above: target, height: 29.0}`" in told.help
    freed = mission(shot.replace("height: 20", "height: 29"), **{"targets:": zone})
    assert faults(freed) == []


def test_a_ring_keeps_its_bearing_from_the_axis():
    (found,) = resolve(
        mission("kind: orbit, target: roof, radius: 30, altitude: {above: target, height: 3}")
    ).shots
    for i, k in enumerate(found.keyframes):
        turn = -2 * pi * i / (len(found.keyframes) - 1)
        assert k.at == pytest.approx((5 + 30 * sin(turn), 30 * cos(turn), 15.0))


def test_what_stands_needs_no_height():
    text = mission("kind: orbit, target: roof, radius: 30, altitude: 20", **{"at: [5, 0, 14]": "at: [5, 0]"})
    text = text.replace("home: [0, -60, 0]", "home: [0, -60]")
    found = resolve(text)
    assert faults(text) == []
    assert found.target("roof").centre == (5.0, 0.0, 2.0)
    assert found.drone("cam").home == (0.0, -60.0, 0.0)
    camera = mission("kind: static, look_at: roof, at: [30, 0]")
    assert [d.code for d in faults(camera)] == ["S008"]

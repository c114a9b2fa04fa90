"""place-keyframes: the camera turns so that the target comes to its place, whole; it never moves."""

from __future__ import annotations

import re
from itertools import pairwise
from math import atan2, cos, hypot, pi, radians, sin
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.diag.model import Diagnostic
from shotc.geom.camera import view
from shotc.geom.shapes import CylinderShape
from shotc.ir.flown_order import flown_order
from shotc.ir.keyframes import KeyframeIR, PlacedKeyframe
from shotc.ir.limits import Timing, Vec3
from shotc.ir.mission import Composition, Keyframe, MissionIR, Shot
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.target import Target
from shotc.passes.place_keyframes import PlaceKeyframes
from shotc.spec.compositions import COMPOSITIONS, FRAMES
from tests.support.film_plans import orbit_mission
from tests.support.front_passes import clean, placed
from tests.support.records import replace

TOWER = Target("tower", (0.0, 0.0, 12.0), CylinderShape(4.0, 24.0), ("targets", "tower"))


def mission_of(keyframes: tuple[Keyframe, ...]) -> MissionIR:
    base = orbit_mission()
    return replace(base, targets=(TOWER,), zones=(), shots=(replace(base.shots[0], keyframes=keyframes),))


def keyframe(**changes: object) -> Keyframe:
    values: dict[str, object] = {
        "at": (0.0, -50.0, 12.0),
        "aim": None,
        "target": "tower",
        "composition": COMPOSITIONS["thirds"],
        "hfov": radians(70),
        "hold": 0.0,
        "time": None,
        "placed": True,
        "path": ("shots", 0, "keyframes", 0),
    }
    return Keyframe(**{**values, **changes})  # type: ignore[arg-type]


def run(*keyframes: Keyframe) -> Outcome[KeyframeIR]:
    return PlaceKeyframes().run(mission_of(keyframes), PassContext())


def place(**changes: object) -> PlacedKeyframe:
    outcome = run(keyframe(**changes))
    assert outcome.diagnostics == ()
    assert outcome.value is not None
    return outcome.value.shots[0].keyframes[0]


def seen(k: PlacedKeyframe, target: Target = TOWER) -> tuple[float, float, float]:
    offset = tuple(a - b for a, b in zip(target.centre, k.at, strict=True))
    return view(k.yaw, k.pitch, k.hfov, 16 / 9).project(offset)  # type: ignore[arg-type]


def bounds(k: PlacedKeyframe) -> tuple[float, float, float, float]:
    offset = tuple(a - b for a, b in zip(TOWER.centre, k.at, strict=True))
    camera = view(k.yaw, k.pitch, k.hfov, 16 / 9)
    return TOWER.shape.bounds(camera, offset)  # type: ignore[arg-type]


def test_looking_at_a_target_puts_it_in_the_middle() -> None:
    k = place()
    assert (k.yaw, k.pitch) == pytest.approx((pi / 2, 0))
    assert k.reference == k.asked == (0, 0)


def test_a_framing_moves_to_the_nearest_third() -> None:
    # The user holds the tower right of the middle: u = 20 deg off of 35 deg.
    k = place(at=(0.0, -70.0, 12.0), aim=(pi / 2 + radians(20), radians(-9)))
    assert k.asked is not None
    assert k.asked[0] > 0.3
    assert k.reference == (1 / 3, 1 / 3)
    u, v, depth = seen(k)
    assert depth > 0
    assert (u, v) == pytest.approx((1 / 3, 1 / 3))
    assert k.at == (0.0, -70.0, 12.0)


def test_keep_keeps_the_users_angles() -> None:
    aim = (pi / 2 + radians(7), radians(-3))
    k = place(aim=aim, composition=COMPOSITIONS["keep"])
    assert (k.yaw, k.pitch) == aim
    assert k.reference == k.asked
    assert k.asked == pytest.approx(seen(k)[:2])


def test_a_frame_of_its_own_overrides_the_shots_composition() -> None:
    k = place(aim=(pi / 2 - radians(10), 0.0), composition=FRAMES["right-third"])
    assert k.reference == (1 / 3, 0.0)
    assert seen(k)[:2] == pytest.approx((1 / 3, 0))


def test_lines_take_the_nearest_point_of_the_nearest_line() -> None:
    aim = (pi / 2 + radians(12), radians(-2))
    k = place(at=(0.0, -70.0, 12.0), aim=aim, composition=COMPOSITIONS["thirds-lines"])
    assert k.asked is not None
    assert k.reference is not None
    assert k.reference[0] == pytest.approx(1 / 3)
    assert k.reference[1] == pytest.approx(k.asked[1], abs=0.01)


def test_a_keyframe_without_a_target_keeps_its_angles() -> None:
    k = place(target=None, aim=(1.25, -0.5))
    assert (k.yaw, k.pitch, k.reference, k.asked) == (1.25, -0.5, None, None)


def test_a_point_is_looked_at_straight() -> None:
    k = place(target=None, aim=(0.0, 0.0, 12.0), at=(30.0, 0.0, 42.0))
    assert (k.yaw, k.pitch) == pytest.approx((pi, -pi / 4))


def test_yaw_is_wrapped() -> None:
    assert place(target=None, aim=(3 * pi / 2, 0.0)).yaw == pytest.approx(-pi / 2)
    assert place(target=None, aim=(-pi, 0.0)).yaw == pi


def test_straight_down_the_picture_points_along_the_motion() -> None:
    down = {"target": None, "aim": (0.0, 0.0, 0.0)}
    outcome = run(
        keyframe(at=(-30.0, -30.0, 40.0), **down),
        keyframe(at=(0.0, 0.0, 40.0), **down),
        keyframe(at=(0.0, 0.0, 60.0), **down),
    )
    assert outcome.value is not None
    _, b, c = outcome.value.shots[0].keyframes
    assert b.pitch == pytest.approx(-pi / 2)
    assert b.yaw == pytest.approx(pi / 4)  # the way it came, for it only rises from there
    assert c.yaw == pytest.approx(pi / 4)


def test_a_target_that_is_cropped_on_the_set_moves_along_its_vertical_with_a_warning() -> None:
    aim = (pi / 2 - radians(10), radians(-8))
    outcome = run(keyframe(at=(0.0, -40.0, 12.0), aim=aim, composition=FRAMES["upper-left"]))
    (warning,) = outcome.diagnostics
    assert warning.code == "G011"
    assert outcome.value is not None
    k = outcome.value.shots[0].keyframes[0]
    assert k.reference is not None
    assert k.reference[0] == -1 / 3
    assert 0 <= k.reference[1] < 1 / 3
    assert max(map(abs, bounds(k))) == pytest.approx(1.0, abs=1e-4)  # as near to the point as it stays whole
    place = proposed(warning)
    assert run(keyframe(at=place, aim=aim, composition=FRAMES["upper-left"])).diagnostics == ()
    wide = radians(float(warning.help.split("`hfov` to ")[1].split(" deg")[0]))
    assert (
        run(keyframe(at=(0.0, -40.0, 12.0), aim=aim, composition=FRAMES["upper-left"], hfov=wide)).diagnostics
        == ()
    )


def proposed(d: Diagnostic) -> Vec3:
    x, y, z = map(float, d.help.split("move to [")[1].split("]")[0].split(","))
    return (x, y, z)


@pytest.mark.parametrize("at", [(15.0, -15.0, 5.0), (-10.0, 10.0, 25.0), (0.0, 22.0, 2.6)])
def test_the_place_where_a_target_fits_has_the_bearing_and_is_over_the_ground(at: Vec3) -> None:
    (error,) = run(keyframe(at=at)).diagnostics
    x, y, z = proposed(error)
    assert run(keyframe(at=(x, y, z))).diagnostics == ()
    assert atan2(y, x) == pytest.approx(atan2(at[1], at[0]), abs=1e-3)
    straight = 12 + (at[2] - 12) * hypot(x, y) / hypot(*at[:2])
    assert z == pytest.approx(straight if straight >= 2.6 else at[2], abs=0.02)


def test_a_target_that_fits_nowhere_is_an_error_whose_help_works() -> None:
    outcome = run(keyframe(at=(0.0, -20.0, 12.0)))
    assert outcome.value is None
    (error,) = outcome.diagnostics
    assert error.code == "G010"
    x, y, z = proposed(error)
    assert (x, z) == (0.0, 12.0)
    assert run(keyframe(at=(x, y, z))).diagnostics == ()
    assert run(keyframe(at=(x, y + 0.3, z))).value is None
    wide = float(error.help.split("`hfov` to ")[1].split(" deg")[0])
    assert run(keyframe(at=(0.0, -20.0, 12.0), hfov=radians(wide))).diagnostics == ()
    assert run(keyframe(at=(0.0, -20.0, 12.0), hfov=radians(wide - 0.5))).value is None


def test_a_target_above_the_gimbals_reach_is_an_error_that_names_the_pitch() -> None:
    high = replace(TOWER, centre=(0.0, 0.0, 100.0), shape=CylinderShape(4.0, 4.0))
    mission = replace(
        mission_of((keyframe(at=(0.0, -50.0, 10.0), composition=COMPOSITIONS["center"]),)), targets=(high,)
    )
    (error,) = PlaceKeyframes().run(mission, PassContext()).diagnostics
    assert error.code == "G013"
    assert "60.9 deg" in error.notes[0]


def test_a_gimbal_that_stops_short_of_the_set_is_told_as_the_cause_and_its_help_works() -> None:
    kite = replace(TOWER, centre=(0.0, 0.0, 30.0), shape=CylinderShape(1.0, 2.0))
    view = keyframe(at=(0.0, -30.0, 10.0), composition=COMPOSITIONS["center"])

    def place_with(highest_deg: float) -> tuple[Diagnostic, ...]:
        mission = replace(mission_of((view,)), targets=(kite,))
        drone = mission.drones[0]
        gimbal = replace(drone.gimbal, pitch=(-pi / 2, radians(highest_deg)))
        mission = replace(mission, drones=(replace(drone, gimbal=gimbal),))
        return PlaceKeyframes().run(mission, PassContext()).diagnostics

    (warning,) = place_with(20.0)
    assert warning.code == "G011"
    assert "gimbal" in warning.message
    assert "needs a pitch of 33.7 deg; the gimbal reaches -90.0 to 20.0 deg" in warning.notes[0]
    enough = float(warning.help.split("pitch to ")[1].split(" deg")[0])
    assert place_with(enough) == ()
    assert place_with(enough - 0.1)


@pytest.mark.slow
def test_a_generated_path_is_told_the_distance_to_keep_at_its_altitude() -> None:
    head = "shotc: 1\nmission: far\ntargets: {tower: {at: [0, 0, 12], radius: 4, height: 24}}\n"
    head += "drones: {cam1: {home: [0, -90, 0]}}\nshots:\n"
    shot = "  - {id: a, kind: orbit, drone: cam1, target: tower, radius: RR, altitude: 20}\n"
    (error,) = placed(head + shot.replace("RR", "20"))[1]
    assert error.code == "G010"
    enough = float(error.help.split("`radius: ")[1].split("`")[0])
    line = shot.replace("RR", "20")
    assert error.labels[0].span.column == line.index("20,") + 1
    assert placed(head + shot.replace("RR", f"{enough}"))[1] == []
    assert placed(head + shot.replace("RR", f"{enough - 0.2}"))[1] != []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "key"),
    [
        ("kind: spiral, radius: [20, 70], altitude: [10, 30]", "radius"),
        ("kind: spiral, radius: [20, 22], altitude: [30, 10]", "radius"),
        ("kind: elevator, azimuth: 20 deg, distance: 20, altitude: [5, 45]", "distance"),
        ("kind: dolly, azimuth: 20 deg, distance: [25, 20], altitude: 20", "distance"),
        ("kind: dolly, azimuth: 20 deg, distance: [20, 50], altitude: 8", "distance"),
        ("kind: crane, azimuth: 70 deg, distance: [70, 25], altitude: [10, 30]", "distance"),
    ],
)
def test_a_generated_path_is_told_the_parameter_and_the_value_that_works(kind: str, key: str) -> None:
    head = "shotc: 1\nmission: far\ntargets: {tower: {at: [0, 0, 12], radius: 4, height: 24}}\n"
    head += "drones: {cam1: {home: [0, -90, 0]}}\nshots:\n"
    text = f"{head}  - {{id: a, drone: cam1, target: tower, {kind}}}\n"
    error = placed(text)[1][0]
    remedy = re.search(rf"write `({key}: .+?)`", error.help)
    assert remedy is not None
    old = re.search(rf"{key}: (\[.*?\]|\d+)", text.splitlines()[-1])
    assert old is not None
    assert error.labels[0].span.column == text.splitlines()[-1].index(old[0]) + len(key) + 3
    assert placed(text.replace(old[0], remedy[1]))[1] == []


def test_a_line_with_an_error_has_no_warnings_beside_it() -> None:
    line: dict[str, Any] = {"composition": FRAMES["upper-left"], "path": ("shots", 0, "kind")}
    near, far = keyframe(at=(0.0, -20.0, 12.0), **line), keyframe(at=(0.0, -40.0, 12.0), **line)
    assert [[d.code for d in run(k).diagnostics] for k in (near, far)] == [["G010"], ["G011"]]
    assert [d.code for d in run(far, near).diagnostics] == ["G010"]


def test_generated_keyframes_are_reported_once_a_shot() -> None:
    ring = tuple(
        keyframe(at=(18 * cos(a), 18 * sin(a), 12.0), placed=False, path=("shots", 0, "kind"))
        for a in (0.0, 0.5, 1.0, 1.5)
    )
    outcome = run(*ring)
    (error,) = outcome.diagnostics
    assert error.code == "G010"
    assert "4 of the 4" in error.notes[-1]


points = st.tuples(st.floats(-120, 120), st.floats(-120, 120), st.floats(3, 60)).filter(
    lambda p: hypot(p[0], p[1]) > 12
)


@pytest.mark.slow
@settings(max_examples=60)
@given(
    points,
    st.floats(-25, 25),
    st.floats(-12, 12),
    st.sampled_from(["center", "thirds", "thirds-lines", "phi"]),
)
def test_every_placed_target_is_whole_and_on_its_reference(
    at: tuple[float, float, float], turn: float, tilt: float, name: str
) -> None:
    straight = atan2(-at[1], -at[0]), atan2(12 - at[2], hypot(at[0], at[1]))
    aim = (straight[0] + radians(turn), max(-pi / 2, min(pi / 6, straight[1] + radians(tilt))))
    outcome = run(keyframe(at=at, aim=aim, composition=COMPOSITIONS[name]))
    if outcome.value is None:
        assert {d.code for d in outcome.diagnostics} <= {"G010", "G013"}
        return
    k = outcome.value.shots[0].keyframes[0]
    assert k.at == at
    assert k.reference is not None
    assert seen(k)[:2] == pytest.approx(k.reference, abs=1e-9)
    assert max(map(abs, bounds(k))) <= 1 + 1e-5
    assert -pi < k.yaw <= pi
    assert -pi / 2 - 1e-6 <= k.pitch <= radians(30) + 1e-6


def shots(*timings: tuple[str, str, Timing]) -> list[Shot]:
    base = orbit_mission().shots[0]
    return [replace(base, id=i, drone=d, timing=t) for i, d, t in timings]


def ids(order: tuple[Shot, ...]) -> str:
    return "".join(s.id for s in order)


def test_shots_fly_as_written_unless_their_timing_says_otherwise() -> None:
    auto = Timing()
    assert ids(flown_order(shots(("a", "x", auto), ("b", "x", auto), ("c", "x", auto)))) == "abc"
    late, early = Timing(start=50), Timing(start=5)
    assert ids(flown_order(shots(("a", "x", late), ("b", "x", auto), ("c", "x", early)))) == "cba"
    assert ids(flown_order(shots(("a", "x", late), ("b", "y", early)))) == "ab"
    assert ids(flown_order(shots(("a", "x", Timing(after="c")), ("b", "x", auto), ("c", "x", auto)))) == "bca"
    assert ids(flown_order(shots(("a", "x", Timing(after="b")), ("b", "x", Timing(after="a"))))) == "ab"


@pytest.mark.slow
@given(st.permutations("abcdef"), st.lists(st.sampled_from("abcdef"), min_size=6, max_size=6))
def test_a_shot_comes_after_the_one_it_waits_for(order: list[str], waits: list[str]) -> None:
    # Waits only for shots of a smaller letter run in no circle.
    timings = [(c, "x", Timing(after=w) if w < c else Timing()) for c, w in zip(order, waits, strict=True)]
    flown = ids(flown_order(shots(*timings)))
    assert sorted(flown) == list("abcdef")
    assert all(flown.index(t.after) < flown.index(c) for c, _, t in timings if t.after is not None)


def test_an_orbit_turns_the_camera_evenly() -> None:
    text = """\
shotc: 1
mission: round
targets: {tower: {at: [0, 0, 12], radius: 4, height: 24}}
drones: {cam1: {home: [0, -60, 0]}}
shots:
  - {id: round, kind: orbit, drone: cam1, target: tower, radius: 45, altitude: 20}
"""
    keyframes = clean(text).shots[0].keyframes
    turns = [(b.yaw - a.yaw) % (2 * pi) for a, b in pairwise(keyframes)]
    assert turns == pytest.approx([pi / 12] * 24)
    assert len({round(k.pitch, 9) for k in keyframes}) == 1


def test_an_error_stops_the_pass_but_tells_all() -> None:
    text = """\
shotc: 1
mission: near
targets: {tower: {at: [0, 0, 12], radius: 4, height: 24}}
drones: {cam1: {home: [0, -60, 0]}}
shots:
  - id: walk
    kind: keyframes
    drone: cam1
    keyframes:
      - {at: [0, -20, 12], look_at: tower}
      - {at: [0, -60, 12], look_at: tower}
      - {at: [15, 0, 12], look_at: tower}
"""
    value, found = placed(text)
    assert value is None
    assert [(d.code, d.labels[0].span.line) for d in found] == [("G010", 10), ("G010", 12)]


def test_own_points_are_a_set() -> None:
    own = Composition("own", points=((-0.2, 0.1), (0.2, 0.1)))
    k = place(at=(0.0, -70.0, 12.0), aim=(pi / 2 + 0.1, 0.0), composition=own)
    assert k.reference == (0.2, 0.1)

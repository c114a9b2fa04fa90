"""place-goals: goals of every frame apart, in the shape, clear of what stands; and what is said where not."""

from __future__ import annotations

import re
from itertools import pairwise
from math import inf, pi

import numpy as np
import pytest
from scipy.spatial.distance import pdist

from shotc.diag.code_info import CodeInfo
from shotc.diag.codes.pictures import CODES
from shotc.diag.model import Diagnostic
from shotc.geom.apart import spacing, stretch
from shotc.geom.solids import Cylinder, box
from shotc.ir.fleet import GoalIR
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import Zone
from shotc.ir.passes import PassContext
from shotc.ir.show import Apart, Box, Lettering, Model, Sphere, Torus
from shotc.show.goals import PlaceGoals
from tests.support.display_missions import APART, display, fleet, picture, show
from tests.support.few import few
from tests.support.front_passes import placed
from tests.support.meshes import box_mesh, ply, sphere_mesh

pytestmark = pytest.mark.slow

MIDDLE = (0.0, 0.0, 60.0)
BALL = Sphere(MIDDLE, 15.0)
EYE = (0.0, -80.0, 2.0)


def goals_of(ir: KeyframeIR, seed: int = 0) -> GoalIR:
    outcome = PlaceGoals().run(ir, PassContext(seed=seed))
    assert outcome.value is not None, outcome.diagnostics
    return outcome.value


def fault_of(ir: KeyframeIR) -> Diagnostic:
    outcome = PlaceGoals().run(ir, PassContext())
    assert outcome.value is None
    assert len(outcome.diagnostics) == 1, outcome.diagnostics
    return outcome.diagnostics[0]


def nearest(points: np.ndarray, apart: Apart) -> float:
    return float(pdist(points * (1, 1, stretch(apart))).min())


@pytest.mark.long
@pytest.mark.parametrize("info", [c for c in CODES if c.phase == "plan"], ids=lambda c: c.slug)
def test_the_examples_that_planning_finds(info: CodeInfo) -> None:
    for text, codes in ((info.failing, {info.code}), (info.passing, set())):
        ir, _ = placed(text)
        assert ir is not None
        found = PlaceGoals().run(ir, PassContext()).diagnostics
        assert {d.code for d in found} == codes
        assert all(d.labels[0].span.line > 10 for d in found)


@pytest.mark.long
@pytest.mark.parametrize("apart", [APART, Apart("cylinder", 1.0, 2.0, 0.1)])
@pytest.mark.parametrize("weight", [inf, 0.5, 0.0])
@pytest.mark.parametrize(
    ("source", "fill"),
    [
        (BALL, "volume"),
        (BALL, "surface"),
        (Torus(MIDDLE, 16.0, 5.0, 0.4, pi / 2), "volume"),
        (Box(MIDDLE, (24.0, 24.0, 24.0), 0.5), "surface"),
        (Box(MIDDLE, (24.0, 24.0, 24.0), 0.5), "outline"),
        (Lettering("SHOTC", MIDDLE, 24.0, 0.3, None), "volume"),
        (Lettering("SHOTC", MIDDLE, 24.0, 0.3, None), "outline"),
    ],
)
def test_goals_are_as_far_apart_as_moves_need(source, fill: str, weight: float, apart: Apart) -> None:
    goals = goals_of(show(display(picture(source, fill), viewpoint=EYE, weight=weight), fleet(60, apart)))
    (frame,) = goals.fleets[0].frames
    assert frame.points.shape == (60, 3)
    assert nearest(frame.points, apart) >= spacing(apart) * (1 - 1e-9)


def test_spacing_that_the_viewpoint_took_is_given_back() -> None:
    drawn = display(picture(Sphere(MIDDLE, 9.0)), viewpoint=EYE, weight=0.5)
    goals = goals_of(show(drawn, fleet(200)))
    stats = dict(goals.stats)
    assert stats["goals show/1 moved by spacing, largest m"] > 0
    assert stats["goals show/1 moved by spacing, mean m"] < 1.0


def test_the_ball_is_filled_and_its_middle_kept() -> None:
    (frame,) = goals_of(show(display(picture(BALL)), fleet(200))).fleets[0].frames
    reach = np.linalg.norm(frame.points - MIDDLE, axis=1)
    assert np.linalg.norm(frame.points.mean(axis=0) - MIDDLE) < 0.3
    # An eighth of a ball's volume is within half of its radius.
    assert (reach < 7.5).mean() == pytest.approx(0.125, abs=0.05)


def test_goals_on_a_surface_are_on_it() -> None:
    (frame,) = goals_of(show(display(picture(BALL, "surface")), fleet(100))).fleets[0].frames
    assert np.linalg.norm(frame.points - MIDDLE, axis=1) == pytest.approx(15.0, abs=0.3)


def test_a_text_stands_in_one_plane() -> None:
    source = Lettering("GO", MIDDLE, 30.0, 0.7, None)
    (frame,) = goals_of(show(display(picture(source)), fleet(60))).fleets[0].frames
    ahead = np.array([np.sin(0.7), np.cos(0.7), 0.0])
    assert (frame.points - MIDDLE) @ ahead == pytest.approx(0.0, abs=1e-9)
    assert np.ptp(frame.points[:, 2]) == pytest.approx(30.0, abs=4.0)


def test_the_same_mission_gives_the_same_bytes() -> None:
    ir = show(display(picture(BALL), viewpoint=EYE, weight=0.5), fleet(80))
    first, again, other = (goals_of(ir, seed).fleets[0].frames[0].points for seed in (3, 3, 4))
    assert first.tobytes() == again.tobytes()
    assert first.tobytes() != other.tobytes()


def test_frames_come_in_the_order_of_the_pictures() -> None:
    drawn = display(picture(BALL), picture(Torus(MIDDLE, 16.0, 5.0, 0.0, 0.0), index=1))
    frames = goals_of(show(drawn, fleet(50))).fleets[0].frames
    assert [(f.display, f.picture, f.index) for f in frames] == [("show", 0, 0), ("show", 1, 0)]


@pytest.mark.slow
def test_frames_of_an_animation_follow_each_other() -> None:
    files = {f"{k}.ply": ply(sphere_mesh(6.0, 12) + np.array([2.0 * k, 0, 0])) for k in range(6)}
    walk = Model(tuple(files), 1.0, (0.0, 0.0, 40.0), None, 0.0)
    drawn = display(picture(walk), viewpoint=EYE, weight=0.5)
    frames = goals_of(show(drawn, fleet(40), files=files)).fleets[0].frames
    assert [f.index for f in frames] == list(range(6))
    for one, then in pairwise(frames):
        # Each goal goes with the body, nearly: no goal changes its place in it.
        assert np.linalg.norm(then.points - one.points - (2, 0, 0), axis=1).max() < 1.0
    assert frames[0].points.mean(axis=0) == pytest.approx((0, 0, 40), abs=0.4)


def test_a_model_is_scaled_turned_and_placed() -> None:
    files = {"a.ply": ply(box_mesh((100, 50, 7), (2, 6, 4)))}
    model = Model(("a.ply",), None, MIDDLE, 20.0, pi / 2)
    (frame,) = goals_of(show(display(picture(model)), fleet(150), files=files)).fleets[0].frames
    size = np.ptp(frame.points, axis=0)
    assert size == pytest.approx([30, 10, 20], abs=5)
    assert frame.points.mean(axis=0) == pytest.approx(MIDDLE, abs=0.5)


def test_colours_of_the_mission_of_the_file_or_white() -> None:
    corners = sphere_mesh(8.0, 12) + np.array([0, 0, 40])
    red = np.where(corners.reshape(-1, 3)[:, :1] < 0, [[255, 0, 0]], [[0, 0, 255]])
    files = {"a.ply": ply(corners, red)}
    model = Model(("a.ply",), None, None, None, 0.0)
    (own,) = goals_of(show(display(picture(model)), fleet(40), files=files)).fleets[0].frames
    sure = np.abs(own.points[:, 0]) > 2
    assert (own.colors[sure, 0] == np.where(own.points[sure, 0] < 0, 255, 0)).all()
    said = display(picture(model, color=(1, 2, 3)))
    (frame,) = goals_of(show(said, fleet(40), files=files)).fleets[0].frames
    assert (frame.colors == (1, 2, 3)).all()
    (white,) = goals_of(show(display(picture(BALL)), fleet(40))).fleets[0].frames
    assert (white.colors == 255).all()
    assert white.colors.dtype == np.uint8


def test_a_point_cloud_is_its_points() -> None:
    cloud = np.random.default_rng(0).random((500, 3)) * (20, 4, 20) + (0, 0, 30)
    model = Model(("a.ply",), None, None, None, 0.0)
    ir = show(display(picture(model)), fleet(30), files={"a.ply": ply(cloud)})
    (frame,) = goals_of(ir).fleets[0].frames
    assert (frame.points > (-0.5, -0.5, 29.5)).all()
    assert (frame.points < (20.5, 4.5, 50.5)).all()
    thin = show(display(picture(model)), fleet(30), files={"a.ply": ply(cloud[:20])})
    fault = fault_of(thin)
    assert (fault.code, "20 points" in fault.message) == ("D061", True)


@pytest.mark.long
def test_too_many_drones_and_what_would_do() -> None:
    tight = Sphere(MIDDLE, 2.5)
    done = PlaceGoals().run(show(display(picture(tight)), fleet(100)), PassContext())
    (fault,) = done.diagnostics
    assert fault.code == "D062"
    number = int(fault.help.split("use ")[1].split()[0])
    radius = float(fault.help.split("radius: ")[1].split("`")[0])
    level, upright = (float(fault.help.split(word)[1].split(" m")[0]) for word in ("`separation` of ", "m, "))
    assert 50 < number < 100
    less = Apart("ellipsoid", level, upright, 0.15)
    for source, crowd in (
        (tight, fleet(number)),
        (Sphere(MIDDLE, radius), fleet(100)),
        (tight, fleet(100, less)),
    ):
        assert not PlaceGoals().run(show(display(picture(source)), crowd), PassContext()).diagnostics
    # Told: they are in a lattice, and how many of them.
    assert dict(done.value.stats)["goals show/1 lattice"] == number


def apart_enough(points, of) -> bool:
    """Tell whether goals are as far apart as moves need."""
    scaled = points * np.array([1.0, 1.0, stretch(of)])
    return bool(pdist(scaled).min() >= spacing(of) * (1 - 1e-9))


@pytest.mark.long
@pytest.mark.parametrize("viewpoint", few([None, (0.0, -200.0, 2.0)], [None]))
def test_drones_without_room_stay_dark_behind_the_outline_of_a_cube(viewpoint) -> None:
    cube = Box(MIDDLE, (12.0, 12.0, 12.0), 0.0)
    shown = display(picture(cube, fill="outline"))._replace(viewpoint=viewpoint)
    crowd = fleet(200)
    done = PlaceGoals().run(show(shown, crowd), PassContext())
    assert [d.code for d in done.diagnostics] == ["D062"]
    (frame,) = done.value.fleets[0].frames
    dark = (frame.colors == 0).all(axis=1)
    assert f"{dark.sum()} of 200 drones" in done.diagnostics[0].message
    assert 0 < dark.sum() < 180
    assert apart_enough(frame.points, crowd.apart)
    # Behind is beyond the picture, as the audience looks at it; North without one.
    assert frame.points[dark][:, 1].min() > frame.points[~dark][:, 1].max() + 1.0


@pytest.mark.long
@pytest.mark.parametrize(("number", "side"), [(60, 5.0), (100, 3.0)])
def test_the_larger_cube_of_the_help_shows_all_drones_and_is_not_too_low(number: int, side: float) -> None:
    """Goals that are pushed apart lie below the edges of the cube, as near to the ground as it may come."""
    cube, crowd = Box((0.0, 20.0, 6.0), (side,) * 3, 0.0), fleet(number)
    done = PlaceGoals().run(show(display(picture(cube, fill="outline")), crowd), PassContext())
    (warning,) = done.diagnostics
    found = re.search(r"`size: ([0-9.]+), center: \[0, 20, ([0-9.]+)\]`", str(warning.help))
    assert found
    size, z = map(float, found.groups())
    written = Box((0.0, 20.0, z), (size,) * 3, 0.0)
    again = PlaceGoals().run(show(display(picture(written, fill="outline")), crowd), PassContext())
    assert not again.diagnostics


@pytest.mark.long
def test_dark_drones_of_a_solid_stand_in_front_where_there_is_no_room_behind() -> None:
    """As those of a flat picture do: one rule places both."""
    cube = Box(MIDDLE, (17.0, 17.0, 17.0), 0.0)
    wall = Zone("wall", "out", box((0.0, 17.5, 60.0), (300.0, 16.0, 90.0), 0.0), ("world", "zones", "wall"))
    crowd = fleet(190)
    shown = display(picture(cube, fill="outline"))
    (frame,) = goals_of(show(shown, crowd, (wall,))).fleets[0].frames
    dark = (frame.colors == 0).all(axis=1)
    assert 0 < dark.sum() < 170
    assert (frame.points[dark][:, 1] < frame.points[~dark][:, 1].min() - 1.0).any()
    assert apart_enough(frame.points, crowd.apart)


@pytest.mark.long
def test_of_an_animation_the_same_drones_stay_dark_in_every_frame() -> None:
    files = {f"w{k}.ply": ply(sphere_mesh(5.0 + 0.5 * k, 12)) for k in range(3)}
    model = Model(tuple(files), 2.0, MIDDLE, None, 0.0)
    done = PlaceGoals().run(show(display(picture(model)), fleet(200), files=files), PassContext())
    assert "D062" in [d.code for d in done.diagnostics]
    dark = [(frame.colors == 0).all(axis=1) for frame in done.value.fleets[0].frames]
    assert all((one == dark[0]).all() for one in dark)
    assert dark[0].any()


def test_too_few_drones_are_warned_of() -> None:
    few = PlaceGoals().run(show(display(picture(BALL)), fleet(5)), PassContext())
    assert few.value is not None
    assert [d.code for d in few.diagnostics] == ["D057"]
    text = Lettering("SHOTC", MIDDLE, 20.0, 0.0, None)
    (warning,) = PlaceGoals().run(show(display(picture(text)), fleet(20)), PassContext()).diagnostics
    enough = int(warning.help.split("use ")[1].split()[0])
    assert not PlaceGoals().run(show(display(picture(text)), fleet(enough)), PassContext()).diagnostics


def zone(keep: str, x: float, y: float, radius: float, top: float = 100.0) -> Zone:
    return Zone("mast", keep, Cylinder((x, y), radius, 0.0, top), ("world", "zones", "mast"))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("around", "centre", "told"),
    [
        (zone("out", 12, 3, 3), MIDDLE, "is inside zone `mast`"),
        (zone("in", 12, 3, 20), MIDDLE, "is outside keep-in zone `mast`"),
        (zone("out", 0, 0, 30, 10), (0.0, 0.0, 20.0), "zone `mast`"),
        (None, (0.0, 0.0, 10.0), "is too low"),
    ],
)
def test_the_shift_that_is_proposed_is_enough(around: Zone | None, centre, told: str) -> None:
    zones = () if around is None else (around,)
    fault = fault_of(show(display(picture(Sphere(centre, 15.0))), fleet(100), zones))
    assert fault.code == "D058"
    assert told in fault.message
    place = [float(c) for c in fault.help.split("center: [")[1].split("]")[0].split(",")]
    shift = [float(c) for c in fault.help.split("shift it by [")[1].split("]")[0].split(",")]
    assert np.add(centre, shift) == pytest.approx(place)
    goals_of(show(display(picture(Sphere(tuple(place), 15.0))), fleet(100), zones))


def test_spacing_pushes_nobody_into_a_zone() -> None:
    wall = zone("out", 0, 14, 6.5)
    ir = show(display(picture(Sphere(MIDDLE, 7.0))), fleet(100), (wall,))
    (frame,) = goals_of(ir).fleets[0].frames
    assert np.hypot(frame.points[:, 0], frame.points[:, 1] - 14).min() >= 6.8 - 1e-9
    assert dict(goals_of(ir).stats)["goals show/1 moved by spacing, largest m"] > 0.3


def test_a_zone_that_holds_no_such_picture() -> None:
    fault = fault_of(show(display(picture(BALL)), fleet(100), (zone("in", 0, 0, 9),)))
    assert fault.help == "make the picture smaller, or place it elsewhere"


@pytest.mark.parametrize(
    "source",
    [
        BALL,
        Box(MIDDLE, (20.0, 20.0, 20.0), 0.0),
        Torus((0.0, -16.0, 60.0), 16.0, 5.0, 0.0, 0.0),
        Torus((0.0, -2.0, 61.0), 16.0, 5.0, 0.0, 0.0),  # in its middle, where it is hollow
    ],
)
def test_a_viewpoint_in_the_picture(source) -> None:
    drawn = display(picture(source), viewpoint=(0.0, -2.0, 61.0), weight=0.5)
    assert fault_of(show(drawn, fleet(30))).code == "D059"


def test_a_viewpoint_in_a_mesh() -> None:
    model = Model(("a.ply",), None, MIDDLE, None, 0.0)
    drawn = display(picture(model), viewpoint=(1.0, 2.0, 61.0), weight=0.5)
    assert fault_of(show(drawn, fleet(30), files={"a.ply": ply(sphere_mesh(10.0, 12))})).code == "D059"


def test_a_ball_has_no_edges() -> None:
    assert fault_of(show(display(picture(BALL, "outline")), fleet(30))).code == "D060"


def test_all_pictures_with_faults_are_told() -> None:
    drawn = display(picture(BALL, "outline"), picture(Sphere((0.0, 0.0, 5.0), 15.0), index=1))
    found = PlaceGoals().run(show(drawn, fleet(30)), PassContext())
    assert [d.code for d in found.diagnostics] == ["D060", "D058"]


@pytest.mark.parametrize(
    "source", [BALL, Torus(MIDDLE, 16.0, 5.0, 0.4, pi / 2), Lettering("GO", MIDDLE, 24.0, 0.3, None)]
)
def test_a_repeated_picture_has_the_same_goals_and_a_moved_one_has_them_moved(source) -> None:
    other, moved = Box(MIDDLE, (24.0, 24.0, 24.0), 0.5), source._replace(centre=(5.0, 10.0, 60.0))
    pictures = (picture(source), picture(other), picture(source)._replace(color=(255, 0, 0)), picture(moved))
    frames = goals_of(show(display(*pictures), fleet(24, APART))).fleets[0].frames
    assert np.array_equal(frames[0].points, frames[2].points)
    assert frames[3].points == pytest.approx(frames[0].points + np.array([5.0, 10.0, 0.0]), abs=1e-6)

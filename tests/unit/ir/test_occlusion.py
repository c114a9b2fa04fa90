"""What stands before a target: a drone as a ball, and what is told of it."""

from __future__ import annotations

import numpy as np
import pytest

from shotc.geom.line_of_sight import crosses
from shotc.geom.shapes import BoxShape, CylinderShape, GroupShape, Part
from shotc.geom.track import Track
from shotc.ir.hidden import hides
from shotc.ir.mission import MissionIR
from shotc.ir.occlusion import hiders, others_of
from shotc.ir.sampling import seen
from shotc.ir.target import Target
from shotc.ir.trajectory import DroneTrajectory
from tests.support.film_plans import orbit_mission
from tests.support.records import replace
from tests.support.sight_plans import EYE, at, film, mission, still, through

MAST: Target = replace(
    orbit_mission().targets[0],
    name="mast",
    centre=(40.0, 0.0, 10.0),
    shape=CylinderShape(0.5, 4.0),
    track=None,
)
OF = replace(mission(), targets=(MAST,))
TIMES = np.linspace(0.0, 10.0, 2001)


def hidden(bird: DroneTrajectory) -> np.ndarray:
    eye = film("eye", still(EYE))
    return seen(OF, eye, "mast", TIMES, others_of((eye, bird), "eye")).hidden


def test_a_drone_that_crosses_the_line_of_sight_hides_the_target_while_its_ball_is_on_it() -> None:
    crossing = through([0.0, 10.0], [at(20.0, -5.0, 10.0), at(20.0, 5.0, 10.0)])
    on_it = np.abs(crossing(TIMES)[:, 1]) < OF.drone("bird").radius
    assert 0.02 < on_it.mean() < 0.3
    assert np.array_equal(hidden(film("bird", crossing)), on_it)


def test_a_drone_above_the_line_or_beyond_the_target_or_behind_the_camera_hides_nothing() -> None:
    for x, y, z in ((20.0, 0.0, 10.6), (41.0, 0.0, 10.0), (-3.0, 0.0, 10.0)):
        assert not hidden(film("bird", still(at(x, y, z)))).any()
    assert hidden(film("bird", still(at(20.0, 0.0, 10.4)))).all()


def test_a_drone_on_its_pad_before_its_flight_hides_as_well() -> None:
    short = film("bird", still(at(20.0, 0.0, 10.0), length=2.0))
    assert hidden(short).all()


def test_each_that_hides_is_named() -> None:
    eye, bird = film("eye", still(EYE)), film("bird", still(at(20.0, 0.0, 10.0)))
    other: Target = replace(MAST, name="pole", centre=(30.0, 0.0, 10.0))
    of = replace(OF, targets=(MAST, other))
    found = hiders(of, others_of((eye, bird), "eye"), "mast", eye.curve(TIMES)[:, :3], TIMES)
    assert {name: bool(hides.all()) for name, hides in found} == {"target pole": True, "drone bird": True}


def lit(x: float = 0.0, height: float = 24.0) -> MissionIR:
    """A tower with a lantern, x metres beside its axis; height : of the lantern's middle."""
    light: Target = replace(MAST, name="light", centre=(40.0, 0.0, 12.0), shape=CylinderShape(4.0, 24.0))
    lantern: Target = replace(
        MAST, name="lantern", centre=(40.0 + x, 0.0, height), shape=CylinderShape(1.5, 4.0)
    )
    return replace(mission(), targets=(light, lantern))


def hides_the_other(of: MissionIR, name: str, eye: tuple[float, float, float]) -> bool:
    """Whether the other target hides one: as sampled, and as the course of a framing is judged by."""
    camera = film("eye", still(at(*eye)))
    sampled = seen(of, camera, name, TIMES).hidden
    named = [bool(hidden.any()) for _, hidden in hiders(of, (), name, camera.curve(TIMES)[:, :3], TIMES)]
    assert named == [bool(sampled.all())] == [hides(of, name, eye, 0.0) is not None]
    return named[0]


@pytest.mark.parametrize(
    ("of", "one"),
    [
        (lit(height=22.0), True),  # inside
        (lit(), True),  # out at the top by half of it
        (lit(x=5.4, height=22.0), True),  # out at the side
        (lit(height=26.0), True),  # upon it
        (lit(height=26.1), False),
        (lit(x=5.6, height=22.0), False),
    ],
)
def test_targets_that_overlap_or_touch_do_not_hide_each_other(of: MissionIR, one: bool) -> None:
    lantern = of.target("lantern").centre
    above = hides_the_other(of, "light", (40.0, 0.0, 60.0))
    beside = hides_the_other(of, "lantern", (-10.0, 0.0, 2.0 if lantern[0] == 40.0 else lantern[2]))
    assert not (one and (above or beside))
    assert one or above or beside


def test_a_target_that_walks_into_another_is_hidden_by_it_before_and_after() -> None:
    tower: Target = replace(MAST, name="tower", centre=(40.0, 0.0, 10.0), shape=CylinderShape(4.0, 20.0))
    walk = Track((0.0, 10.0), ((60.0, 0.0, 10.0), (40.0, 0.0, 10.0)))
    walker: Target = replace(
        MAST, name="walker", centre=walk.points[0], shape=CylinderShape(0.5, 2.0), track=walk
    )
    of = replace(mission(), targets=(tower, walker))
    eye = film("eye", still(EYE))
    apart = walk_x(walk) > 40.0 + 4.0 + 0.5 + 1e-6
    assert np.array_equal(seen(of, eye, "walker", TIMES).hidden, apart)
    assert 0.7 < apart.mean() < 0.8


def walk_x(walk: Track) -> np.ndarray:
    return np.array([walk.at(float(t))[0] for t in TIMES])


def test_a_lorry_hides_while_it_stands_across_as_it_turns() -> None:
    bend = Track((0.0, 5.0, 10.0), ((20.0, -9.0, 10.0), (20.0, 0.0, 10.0), (29.0, 0.0, 10.0)))
    shape = BoxShape(8.0, 1.0, 2.0, (0.0, 1.0))
    lorry: Target = replace(MAST, name="lorry", centre=bend.points[0], shape=shape, track=bend)
    of = replace(mission(), targets=(MAST, lorry))
    point = (40.0, 0.0, 10.0)
    eyes = still(EYE)(TIMES)[:, :3]
    found = next(hides for name, hides in hiders(of, (), "mast", eyes, TIMES) if name == "target lorry")
    exact = np.array([crosses(lorry.solid_at(float(t)), EYE[:3], point) for t in TIMES])
    assert 0.2 < exact.mean() < 0.9
    assert (found != exact).mean() < 2e-3  # where it comes and goes


def test_parts_of_a_group_hide_nothing_of_it_or_of_each_other() -> None:
    front: Target = replace(MAST, name="front", centre=(20.0, 0.0, 10.0))
    shape = GroupShape((Part((-10.0, 0.0, 0.0), front.shape), Part((10.0, 0.0, 0.0), MAST.shape)))
    both: Target = replace(MAST, name="both", centre=(30.0, 0.0, 10.0), shape=shape, parts=("front", "mast"))
    eyes = still(EYE)(TIMES)[:, :3]
    for groups, names in (((), ["target front"]), ((both,), [])):
        of = replace(mission(), targets=(MAST, front), groups=groups)
        assert [name for name, hides in hiders(of, (), "mast", eyes, TIMES) if hides.any()] == names
        assert (hides(of, "mast", tuple(map(float, EYE[:3])), 0.0) is None) is bool(groups)
    assert [name for name, hides in hiders(of, (), "both", eyes, TIMES) if hides.any()] == []

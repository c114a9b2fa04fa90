"""What stands before a target: a drone as a ball, and what is told of it."""

from __future__ import annotations

import numpy as np

from shotc.ir.mission import Target
from shotc.ir.occlusion import hiders, others_of
from shotc.ir.sampling import seen
from shotc.ir.trajectory import DroneTrajectory
from tests.records import replace
from tests.samples import orbit_mission
from tests.sights import EYE, at, film, mission, still, through

MAST: Target = replace(
    orbit_mission().targets[0], name="mast", centre=(40.0, 0.0, 10.0), radius=0.5, height=4.0, track=None
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

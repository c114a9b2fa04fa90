"""Products that burn over terrain and beside buildings: values known by hand, and dense samples."""

from __future__ import annotations

import re
from dataclasses import replace
from importlib import import_module
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shotc.diag.model import Diagnostic
from shotc.geom.fleet_spline import places
from shotc.geom.surface.near import nearest
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import MissionIR
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.show import PyroCue
from shotc.ir.trajectory import Claim, TrajectoryIR
from shotc.passes.verify.fleets import pyro_advice
from shotc.passes.verify.fleets.flight import FleetFlight
from tests.support.few import examples
from tests.support.show_plans import display, fleet, flight, mission
from tests.support.standing_worlds import SIDE, STEP, from_box, height_over, house, ridge, terrain
from tests.support.surfaces import Grid, grid
from tests.support.terrain_missions import relief
from tests.support.verdicts import verdict_on

pyro = import_module("shotc.passes.verify.fleets.pyro")
GROUND = "pyro 1 fountain from the ground"
BUILDINGS = "pyro 1 fountain from the buildings"
BURNS = (17.0, 27.0)
"""Drones 2 and 3 stand at y = 20 m and x = 4 and 8 m then, at first at z = 30 m, at last at 32 m."""


def plateau(height: float) -> Grid:
    return grid(np.full((SIDE, SIDE), height), STEP)


def burning(clear: float, shape: Grid | None = None, *meshes: ObstacleMesh) -> MissionIR:
    time, duration = BURNS[0] + 1.0, BURNS[1] - BURNS[0] - 1.0
    cue = PyroCue(time, (2, 3), "fountain", duration, clear, 1.0, 0.0, 0.0, ("shots", 0))
    shown = display()._replace(pyro=(cue,))
    return mission(displays=(shown,), terrain=None if shape is None else terrain(shape), meshes=meshes)


def judged(asked: MissionIR) -> tuple[dict[str, Claim], list[Diagnostic]]:
    ir = TrajectoryIR(KeyframeIR(asked, ()), (), (), (), (flight(asked.fleets[0]),))
    verdict = verdict_on(ir)
    told = [d for d in verdict.diagnostics if d.code == "V059" and "from drones" not in d.message]
    return {c.constraint: c for c in verdict.certificate}, told


@pytest.mark.parametrize(("clear", "holds"), [(15.0, False), (8.0, True)])
def test_ten_metres_over_a_plateau_it_is_ten_metres_from_the_ground(clear: float, *, holds: bool) -> None:
    claims, told = judged(burning(clear, plateau(20.0)))
    found = claims[GROUND]
    assert found.worst == pytest.approx(10.0, abs=1e-5)
    assert found.holds == holds
    assert len(told) == (0 if holds else 1)
    for fault in told:
        assert fault.message == (
            "swarm-2 of swarm: pyro 1 fountain from the ground of shot `globe` is 10.000 m, "
            "at least 15.000 m is needed"
        )


def test_without_terrain_the_distance_is_the_height() -> None:
    claims, told = judged(burning(31.0))
    assert claims[GROUND].worst == pytest.approx(30.0, abs=1e-9)
    assert len(told) == 1


def test_beside_a_slope_it_is_the_distance_and_not_the_height() -> None:
    """The slope rises by 45 degrees, z = x: it is 1 / sqrt 2 of the height above it away."""
    shape = ridge(80.0, at=80.0, half=80.0)
    claims, _ = judged(burning(5.0, shape))
    assert claims[GROUND].worst == pytest.approx((30.0 - 8.0) / np.sqrt(2.0), abs=0.01)
    assert claims[GROUND].drones == ("swarm-3",)


@pytest.mark.parametrize(("height", "depth"), [(33.0, -3.0), (30.5, -0.5)])
def test_in_a_hill_the_distance_is_the_depth(height: float, depth: float) -> None:
    claims, told = judged(burning(1.0, plateau(height)))
    assert claims[GROUND].worst == pytest.approx(depth, abs=1e-3)
    assert len(told) == 1


def test_beyond_the_terrain_nothing_is_proved() -> None:
    shape = plateau(20.0)
    asked = burning(1.0, shape)
    beyond = terrain(Grid(shape.heights, shape.step, shape.corners - [310.0, 0.0, 0.0], shape.faces))
    claims, told = judged(asked._replace(terrain=beyond))
    assert claims[GROUND].worst == -np.inf
    assert len(told) == 1


TOWER = (15.0, 20.0, 25.0), (8.0, 8.0, 50.0)
"""Its wall is at x = 11 m, 3 m from drone 3."""


@pytest.mark.parametrize(("clear", "holds"), [(4.0, False), (2.5, True)])
def test_a_building_beside_what_burns_counts_as_the_ground_does(clear: float, *, holds: bool) -> None:
    claims, told = judged(burning(clear, None, house(*TOWER)))
    found = claims[BUILDINGS]
    assert found.worst == pytest.approx(3.0, abs=1e-5)
    assert found.holds == holds
    assert found.drones == ("swarm-3",)
    assert len(told) == (0 if holds else 1)
    for fault in told:
        assert fault.message.startswith(
            "swarm-3 of swarm: pyro 1 fountain from the buildings of shot `globe` is 3.000 m"
        )
        assert any("nearest is building `house`" in note for note in fault.notes)


def test_what_burns_inside_of_a_building_is_told() -> None:
    claims, told = judged(burning(1.0, None, house((8.0, 20.0, 25.0), (4.0, 4.0, 50.0))))
    assert claims[BUILDINGS].worst == pytest.approx(-2.0, abs=1e-3)
    assert claims[BUILDINGS].drones == ("swarm-3",)
    assert len(told) == 1


def test_half_the_spacing_of_a_cloud_is_taken_off() -> None:
    claims, _ = judged(burning(1.0, None, replace(house(*TOWER), kind="scene", spacing=0.4)))
    assert claims["pyro 1 fountain from the scene"].worst == pytest.approx(2.6, abs=1e-5)


@pytest.mark.long
@settings(max_examples=examples(4, 300), deadline=None)
@given(st.integers(0, 2**31), st.floats(2.0, 30.0))
def test_no_sample_is_nearer_than_what_is_proved(seed: int, height: float) -> None:
    shape = relief(seed % 1000, height)
    rng = np.random.default_rng(seed)
    centre = tuple((rng.uniform(-10.0, 10.0, 3) + np.array([6.0, 20.0, 30.0])).tolist())
    size = tuple(rng.uniform(1.0, 8.0, 3).tolist())
    asked = burning(2.0, shape, house(centre, size))  # type: ignore[arg-type]
    claims, _ = judged(asked)
    flown = flight(asked.fleets[0])
    at = places(flown.breaks, flown.coef[1:3], np.linspace(*BURNS, 3000)).reshape(-1, 3)
    assert asked.terrain is not None
    over = height_over(shape, at)
    ground = float(over.min() if over.min() < 0 else nearest(asked.terrain.ground.surface, at).distance.min())
    assert claims[GROUND].worst <= ground + 1e-9
    assert claims[GROUND].worst == pytest.approx(ground, abs=0.02)
    near = float(from_box(at, centre, size).min())  # type: ignore[arg-type]
    assert claims[BUILDINGS].worst <= near + 1e-9
    if near > 0.05:
        assert claims[BUILDINGS].worst == pytest.approx(near, abs=0.02)


def one_cue(cue: PyroCue, pads: tuple[tuple[float, float, float], ...], **world: object) -> MissionIR:
    shown = display()._replace(pyro=(cue,))
    return mission(fleets=(fleet(pads),), displays=(shown,), **world)


def test_a_moment_that_would_do_is_given_and_does() -> None:
    """The drone is 10 m over the plateau in the first picture, and 12 m in the second, until 28 s."""
    cue = PyroCue(18.0, (1,), "fountain", 1.5, 11.5, 0.0, 0.0, 0.0, ("shots", 0))
    asked = one_cue(cue, ((8.0, 0.0, 0.0),), terrain=terrain(plateau(20.0)))
    _, (fault,) = judged(asked)
    found = re.match(r"write `at: ([\d.]+) s`, or write `clear: 10 m` if", fault.help)
    assert found is not None, fault.help
    moment = float(found[1])
    assert 18.0 < moment <= 26.5
    again = cue._replace(time=moment)
    assert judged(one_cue(again, ((8.0, 0.0, 0.0),), terrain=terrain(plateau(20.0))))[1] == []


def test_drones_that_would_do_are_given_and_do() -> None:
    """A house is 5 m from the first of two drones, and 25 m from the other."""
    built = (house((-7.5, 20.0, 20.0), (5.0, 20.0, 40.0)),)
    cue = PyroCue(18.0, (1,), "fountain", 9.0, 12.0, 0.0, 0.0, 0.0, ("shots", 0))
    pads = ((0.0, 0.0, 0.0), (20.0, 0.0, 0.0))
    told = judged(one_cue(cue, pads, meshes=built))[1]
    assert [fault.help.split("`")[1] for fault in told] == ["drones: [2]"]
    assert judged(one_cue(cue._replace(drones=(2,)), pads, meshes=built))[1] == []


def test_what_burns_on_the_ground_is_told_when_it_may_burn() -> None:
    cue = PyroCue(2.0, (1,), "fountain", 5.0, 50.0, 1.0, 0.0, 0.0, ("shots", 0))
    _, (fault,) = judged(one_cue(cue, ((8.0, 0.0, 0.0),)))
    assert fault.help == "have it burn in the air: `at` between 9.00 s and 33.00 s"


@pytest.mark.parametrize(("until", "outside"), [(32.5, 0.0), (38.0, 0.0), (39.5, 1.5)])
def test_what_burns_until_the_drones_land_is_within_the_flight(until: float, outside: float) -> None:
    cue = PyroCue(until - 1.5, (1,), "fountain", 1.5, 0.5, 0.0, 0.0, 0.0, ("shots", 0))
    claims, _ = judged(one_cue(cue, ((8.0, 0.0, 0.0),)))
    assert claims["pyro 1 fountain outside the flight"].worst == pytest.approx(outside)


def test_a_fleet_without_a_display_stands_on_its_pads_for_the_whole_flight() -> None:
    asked = mission(fleets=(fleet(), fleet(((90.0, 0.0, 0.0), (95.0, 0.0, 0.0)), "spare")))
    track = flight(asked.fleets[0])
    one = FleetFlight.of(asked, track)
    ir = TrajectoryIR(KeyframeIR(asked, ()), (), (), (), (track,))
    spare = next(others for others in pyro._others(ir, [one], one, 0) if "spare" in others.what)
    assert spare.breaks.tolist() == [track.breaks[0], track.breaks[-1]]
    assert spare.ctrl[:, 0, 0].tolist() == [[90.0, 0.0, 0.0], [95.0, 0.0, 0.0]]


@pytest.mark.parametrize(
    ("of", "drones", "ignition", "busy"),
    [
        ("swarm", (1, 3), 20.0, True),
        ("swarm", (3,), 20.0, False),
        ("swarm", (1,), 15.0, False),
        ("swarm", (1,), 24.0, False),
        ("other", (1,), 20.0, False),
    ],
)
def test_drones_on_which_something_else_burns_meanwhile_are_no_remedy(
    of: str, drones: tuple[int, ...], ignition: float, busy: bool
) -> None:
    cue = PyroCue(20.0, (2,), "fountain", 4.0, 1.0, 0.0, 0.0, 0.0, ("shots", 0, "pyro", 0))
    own = display()._replace(pyro=(cue,))
    asked = cue._replace(time=ignition, drones=drones, path=("shots", 1, "pyro", 0))
    other = display("second", of, 1)._replace(pyro=(asked,))
    ir = SimpleNamespace(keyframes=SimpleNamespace(mission=SimpleNamespace(displays=(own, other))))
    firing: Any = SimpleNamespace(ir=ir, display=own)
    assert pyro_advice._Firing._burn_others(firing, cue, (1, 2)) is busy


def test_a_product_is_as_far_as_the_viewpoint_the_ground_and_other_drones_the_nearest_of_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    breaks = np.linspace(0.0, 4.0, 5)
    coef = np.tile(np.array([[3.0, 4.0, 20.0]]), (7, 1))[None] + np.zeros((2, 1, 1))
    monkeypatch.setattr(pyro_advice, "sampled_distances", lambda _, p: np.full(len(p), 18.0))
    firing: Any = SimpleNamespace(
        flight=SimpleNamespace(track=SimpleNamespace(breaks=breaks, coef=coef)),
        times=np.array([0.0, 1.0, 2.0]),
        apart=np.array([[50.0, 50.0, 50.0], [50.0, 2.0, 50.0]]),
        display=SimpleNamespace(viewpoint=(3.0, -8.0, 15.0)),
    )
    during = np.array([True, True, False])
    found = pyro_advice._Firing._least(firing, [0, 1], during)
    assert found == pytest.approx(np.array([[13.0, 13.0], [13.0, 2.0]]))
    firing.display.viewpoint = None
    assert pyro_advice._Firing._least(firing, [1], during) == pytest.approx(np.array([[18.0, 2.0]]))


@pytest.mark.parametrize(
    ("of", "time", "burns"), [("swarm", 19.0, True), ("swarm", 16.9, False), ("other", 19.0, False)]
)
def test_a_product_burns_from_its_ignition_on_drones_of_its_own_fleet(
    of: str, time: float, burns: bool
) -> None:
    asked = burning(5.0)
    assert pyro.burning_at(asked, of, time) is burns


def test_a_place_is_above_terrain_in_it_or_beyond_it() -> None:
    module = import_module("shotc.passes.verify.fleets.burning")
    places = np.array([[4.0, 20.0, 31.0], [4.0, 20.0, 18.0], [1e6, 20.0, 31.0]])
    assert module._from_terrain(terrain(plateau(20.0)), places).tolist() == [11.0, -2.0, -np.inf]

"""What planners keep clear of is what the judge holds them to: two rules, held against each other."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shotc.geom.bernstein import Piecewise
from shotc.geom.solid_arrays.points import distances
from shotc.ir.limits import Vec3
from shotc.ir.mission import MissionIR
from shotc.ir.path import CHANNELS, HFOV
from shotc.ir.phases import Phase
from shotc.ir.trajectory import DroneTrajectory
from shotc.passes.verify.claims import JudgedFlight
from shotc.passes.verify.space import space
from shotc.planning.clearances import clearances_of
from shotc.planning.free_space import bounds_slack
from shotc.planning.obstacles import flight_space, pad_space
from tests.support.front_passes import resolved

MISSION = """\
shotc: 1
mission: around
world:
  zones:
    tower: {{keep: out, cylinder: {{center: [30, 5], radius: {radius}, height: [0, 25]}}}}
    house: {{keep: out, polygon: {{height: [0, {height}], points: [
      [-30, -20], [-10, -20], [-10, -12], [-22, -12], [-22, 4], [-30, 4]]}}}}
    dome: {{keep: in, cylinder: {{center: [0, 0], radius: 80, height: [0, 60]}}}}
    field: {{keep: in, polygon: {{points: [[-60, -60], [60, -60], [60, 50], [-60, 50]], height: [2, 70]}}}}
targets:
  statue: {{at: [0, 20, 2], radius: 1.5, height: 4}}
drones:
  cam: {{model: x500, home: [0, -40, 2.5]}}
rules: {{ground_clearance: {ground}, target_clearance: {clearance}}}
shots:
  - {{id: look, kind: static, drone: cam, at: [0, 5, 12], look_at: statue, timing: {{duration: 5}}}}
"""
ONCE = 2e-4  # share of a distance, and metres, to which the judge measures what is far from a limit


def mission_of(radius: float, height: float, ground: float, clearance: float) -> MissionIR:
    text = MISSION.format(radius=radius, height=height, ground=ground, clearance=clearance)
    mission, found = resolved(text)
    assert mission is not None, found
    return mission


def hovering(mission: MissionIR, place: Vec3, phase: str) -> JudgedFlight:
    """A drone that stays at a place for a second."""
    pose = np.zeros(len(CHANNELS))
    pose[:3], pose[HFOV] = place, 1.2
    curve = Piecewise(np.array([0.0, 1.0]), np.tile(pose, (1, 6, 1)))
    drone = mission.drones[0]
    phases = (Phase(phase, None, 0.0, 1.0),)  # type: ignore[arg-type]
    return JudgedFlight(mission, drone, DroneTrajectory(drone.name, curve, phases, (), ()))


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high).map(lambda x: round(x, 3))


PLACES = st.tuples(numbers(-90, 90), numbers(-90, 90), numbers(-2, 80))
RULES = st.tuples(numbers(0.5, 6), numbers(3, 30), numbers(0.5, 4), numbers(0.5, 4))


@pytest.mark.slow
@given(RULES, PLACES)
def test_the_planners_rule_is_the_judges(rules: tuple[float, float, float, float], place: Vec3) -> None:
    mission = mission_of(*rules)
    drone = mission.drones[0]
    judged = {c.constraint: c.worst - c.limit for c in space(hovering(mission, place, "transit"))}
    planned = {str(c.owner): -c.lack(place) for c in clearances_of(mission, drone)}
    planned["ground clearance"] = place[2] - mission.rules.over_ground(drone.radius)
    assert judged.keys() == planned.keys()
    for name, slack in planned.items():
        # The judge stops where it is sure: inside a solid it says how deep by its surface alone.
        if slack > -drone.radius:
            assert judged[name] == pytest.approx(slack, abs=ONCE * max(1.0, abs(slack)))
        else:
            assert judged[name] < 0.0


@pytest.mark.slow
@given(RULES, PLACES)
def test_a_room_is_what_its_clearances_leave(rules: tuple[float, float, float, float], place: Vec3) -> None:
    mission = mission_of(*rules)
    drone, p = mission.drones[0], np.array([place])
    space = flight_space(mission, drone)
    slack = min(
        float(bounds_slack(space, p)[0]),
        *(float(distances(o.part, p[0])) - o.clearance for o in space.obstacles),
    )
    kept = min(
        place[2] - mission.rules.over_ground(drone.radius),
        *(-c.lack(place) for c in clearances_of(mission, drone)),
    )
    # A room measures to the planes of a hull, clearances to its edges: both agree on who is inside.
    if abs(kept) > 1e-6 and abs(slack) > 1e-6:
        assert (slack >= 0.0) == (kept >= 0.0)


def test_at_its_pad_a_drone_keeps_clear_of_bodies_alone() -> None:
    mission = mission_of(2.0, 10.0, 3.0, 2.5)
    drone = mission.drones[0]
    flight, pad = (flight_space(mission, drone), pad_space(mission, drone))
    assert {o.owner.name: o.clearance for o in flight.obstacles}["statue"] == drone.radius + 2.5
    assert {o.owner.name: o.clearance for o in pad.obstacles}["statue"] == drone.radius
    assert {str(w.owner) for w in flight.walls} - {str(w.owner) for w in pad.walls} == {"ground"}

"""A corridor that no smooth curve fits: what is in conflict, and a remedy that helps when it is applied."""

from __future__ import annotations

import re

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.geom.solids import Cylinder, Solid
from shotc.ir.owners import GROUND, zone_owner
from shotc.passes.solve_path_qp.explain.path import failure
from shotc.planning.obstacles import flight_space
from shotc.planning.path.position import PolylineTask, Solved, solve_stretch
from shotc.planning.path.shots import Stuck
from shotc.solvers.conic import Status
from shotc.solvers.spline_relax import Relaxation
from tests.support.path_scenes import FIELD, block, free, inside, legs, mission, out, planned, shot, solve
from tests.support.records import replace

POLE = Cylinder((0.0, 0.0), 2.0, 0.0, 70.0)
PAST = np.array([[-20.0, -6.0, 8.0], [0.0, -2.3, 8.0], [20.0, -6.0, 8.0]])


def told(made, corners):
    """Return the fault of a stretch that is held to its corners, near what is in the way or not."""
    steps = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    s = np.concatenate([[0.0], np.cumsum(steps)])
    ends = tuple(range(len(corners)))
    stretch = PolylineTask(corners, s, ends, np.zeros((0, 3)), np.zeros(0), 0.75)
    drone = made.drones[0]
    space = flight_space(made, drone)
    found = solve_stretch(space, stretch, drone.limits)
    assert found.curve is None
    return failure(made, drone, space, through(corners), Stuck(found, corners, ends))


def through(corners):
    return shot([free(i, at) for i, at in enumerate(corners)])


def metres(text: str) -> float:
    return float(re.search(r"([0-9.]+) m\b", text)[1])


def scene(solid: Solid):
    return mission(out("pole", solid), inside("field", FIELD), targets=())


@pytest.mark.slow
def test_a_remedy_that_is_told_plans_when_it_is_applied():
    assert solve(scene(POLE), through(PAST)).value is None
    fault = told(scene(POLE), PAST)
    assert fault.code == "Q003"
    (note,) = fault.notes
    assert note.startswith("zone `pole` would have to be 0.3")
    assert re.fullmatch(r"shrink zone `pole` by [0-9.]+ m on every side", fault.help)
    less = metres(fault.help)
    assert 0.3 <= less < 0.36
    shrunk = replace(POLE, radius=POLE.radius - less, bottom=POLE.bottom + less, top=POLE.top - less)
    assert len(legs(planned(scene(shrunk), through(PAST)), "shot")) == 1


@pytest.mark.slow
def test_a_border_is_widened():
    rim = np.array([[-20.0, -78.0, 4.0], [0.0, -79.7, 8.0], [20.0, -78.0, 4.0]])
    made = mission(inside("field", FIELD), targets=(), home=(-40.0, -60.0, 0.0))
    fault = told(made, rim)
    assert fault.code == "Q003"
    assert fault.notes == ("zone `field` would have to be 0.30 m wider on every side",)
    assert fault.help.startswith("widen zone `field` by ")
    wider = metres(fault.help)
    grown = tuple((x + wider * np.sign(x), y + wider * np.sign(y)) for x, y in FIELD.points)
    larger = replace(FIELD, points=grown, bottom=FIELD.bottom - wider, top=FIELD.top + wider)
    assert len(legs(planned(replace(made, zones=(inside("field", larger),)), through(rim)), "shot")) == 1


@pytest.mark.slow
def test_the_ground_cannot_shrink_but_its_clearance_can():
    low = np.array([[-20.0, 0.0, 4.0], [0.0, 1.0, 2.3], [20.0, 0.0, 4.0]])
    made = mission(targets=())
    fault = told(made, low)
    assert fault.code == "Q003"
    assert fault.notes == ("rules.ground_clearance would have to be 0.30 m lower",)
    assert fault.help.startswith("lower rules.ground_clearance by ")
    eased = replace(made.rules, ground_clearance=made.rules.ground_clearance - metres(fault.help))
    assert len(legs(planned(replace(made, rules=eased), through(low)), "shot")) == 1


def test_where_nothing_tried_helps_no_number_is_promised():
    made = mission(out("slab", block((-50, 50), (-1, 1), (0, 70))), targets=())
    corners = np.array([[-5.0, -20.0, 8.0], [0.1, 0.0, 8.0], [5.0, 20.0, 8.0]])
    fault = told(made, corners)
    assert fault.code == "Q003"
    assert "zone `slab` would have to be 1.60 m smaller on every side" in fault.notes
    assert not re.search(r"[0-9]", fault.help)


def test_what_need_not_give_way_is_not_listed():
    made = scene(POLE)
    drone, placed = made.drones[0], through(PAST)
    space = flight_space(made, drone)

    def fault(owners, points):
        nothing = Relaxation(Status.SOLVED, None, np.array(owners), np.array(points))
        solved = Solved(
            None, Status.INFEASIBLE, float("nan"), 1, nothing, (zone_owner(made.zones[0]), GROUND)
        )
        return failure(made, drone, space, placed, Stuck(solved, PAST, (0, 1, 2)))

    some = fault([0.4, 0.004], [0.0, 0.003, 0.0])
    assert some.code == "Q003"
    assert some.notes == ("zone `pole` would have to be 0.40 m smaller on every side",)
    assert not any("0.00" in label.text for label in some.labels)
    assert fault([0.004, 0.0], [0.0, 0.003, 0.0]).code == "Q008"


@pytest.mark.slow
@pytest.mark.parametrize(("radius", "height"), [(1000, 4), (3000, 4), (1000, 2)])
def test_a_way_of_kilometres_round_a_rim_of_metres_is_planned(radius, height):
    text = f"""\
shotc: 1
mission: huge
targets: {{disc: {{at: [0, 0, 14], radius: {radius}, height: {height}}}}}
drones: {{cam1: {{model: x500, home: [0, -60, 0], endurance: 10 h}}}}
shots:
  - id: look
    kind: keyframes
    drone: cam1
    keyframes:
      - {{at: [-20, 0, 6], heading: 0 deg, pitch: 0 deg}}
      - {{at: [20, 0, 20], heading: 0 deg, pitch: 0 deg}}
"""
    found = compile_source(text.encode(), "m.yaml", None, PlanOptions(stop_after="solve-path-qp"))
    assert [d.code for d in found.diagnostics] == []
    assert [report.name for report in found.reports][-1] == "solve-path-qp"

from __future__ import annotations

from itertools import pairwise
from math import acos, ceil, inf, pi, radians

import numpy as np
import pytest

from shotc.emit.mavlink.style import Style, follow, region_of, style_of
from shotc.emit.mavlink.thin import StraightLeg, Thinner, Tolerance, thinner_of
from shotc.emit.waypoints.clearance import keep_outs, shortfall
from shotc.emit.waypoints.track import track_of
from shotc.geom.bernstein import Piecewise
from shotc.geom.solids import Cylinder
from shotc.ir.mission import Zone
from shotc.ir.obstacle_mesh import obstacle_mesh
from shotc.ir.trajectory import VerifiedIR
from tests.support.film_plans import orbit_mission, orbit_plan
from tests.support.mavlink_flights import flight, plan, retold, straight
from tests.support.records import replace

SAMPLE = orbit_plan()


def thinner(source: VerifiedIR, style: Style | None = None) -> Thinner:
    mission = source.trajectory.keyframes.mission
    track = track_of(mission, source.trajectory.drones[0])
    style = style or style_of(mission, source.trajectory.drones[0], track)
    return thinner_of(track, mission.drones[0], style, keep_outs(mission, mission.drones[0]))


def filmed(legs: list[StraightLeg]) -> list[StraightLeg]:
    return [leg for leg in legs if leg.shot]


def test_a_straight_flight_is_one_leg_each_way() -> None:
    legs = thinner(plan(straight())).legs(Tolerance())
    assert [(leg.shot, leg.rest) for leg in legs] == [("half", False), (None, False)]


@pytest.mark.parametrize("allowed", [0.1, 0.25, 1.0])
def test_a_circle_takes_as_many_legs_as_its_sagitta_asks(allowed: float) -> None:
    legs = filmed(thinner(SAMPLE).legs(Tolerance(allowed, inf, inf)))
    # A chord over the angle a of a circle of radius 40 m is 40 (1 - cos(a / 2)) off at most.
    least = ceil(pi / (2 * acos(1 - allowed / 40)))
    assert least <= len(legs) <= least + 2
    track = thinner(SAMPLE).track
    for leg in legs:
        points = track.poses.position[leg.first : leg.last + 1]
        a, b = points[0], points[-1]
        along = (b - a) / np.linalg.norm(b - a)
        off = (points - a) - np.outer((points - a) @ along, along)
        assert np.linalg.norm(off, axis=1).max() <= allowed


@pytest.mark.slow
def test_legs_follow_one_another_and_cover_the_track() -> None:
    work = thinner(SAMPLE)
    legs = work.legs(Tolerance())
    assert legs[0].first == 0
    assert legs[-1].last == len(work.track.time) - 1
    assert all(a.last == b.first for a, b in pairwise(legs))


def test_legs_of_a_stretch_are_even() -> None:
    work = thinner(SAMPLE)
    legs = filmed(work.legs(Tolerance(0.25, inf, inf)))
    lengths = [
        np.linalg.norm(work.track.poses.position[g.last] - work.track.poses.position[g.first]) for g in legs
    ]
    assert min(lengths[1:-1]) > 0.75 * max(lengths)
    assert lengths[-1] > 0.3 * max(lengths)


@pytest.mark.slow
def test_heading_bounds_legs_where_px4_holds_it() -> None:
    work = thinner(SAMPLE)
    yaw = work.track.poses.body_yaw
    tight = filmed(work.legs(Tolerance(10.0, radians(3.0), inf)))
    assert len(tight) >= 180 / 6
    assert max(abs(yaw[leg.last] - yaw[leg.first]) for leg in tight) <= radians(6.0) + 1e-9
    ardupilot = retold(SAMPLE, autopilot="ardupilot")
    assert len(filmed(thinner(ardupilot).legs(Tolerance(10.0, radians(3.0), inf)))) < 10


@pytest.mark.slow
def test_legs_do_not_cut_a_clearance_that_the_curve_keeps() -> None:
    # A tank inside the orbit, which the body sphere clears by 0.1 m.
    mission = orbit_mission()
    tank = Zone("tank", "out", Cylinder((0.0, 0.0), 39.3, 0.0, 40.0), ("world", "zones", "tank"))
    mission = replace(mission, zones=(*mission.zones, tank))
    source = plan(SAMPLE.trajectory.drones[0], mission=mission)
    work = thinner(source)
    loose = Tolerance(1.0, inf, inf)

    def deepest(legs: list[StraightLeg]) -> float:
        points = work.track.poses.position
        line = [
            points[leg.first] + s * (points[leg.last] - points[leg.first])
            for leg in filmed(legs)
            for s in np.linspace(0, 1, 50)
        ]
        return max(
            float(shortfall(o, np.array(line)).max())
            for o in work.obstacles
            if o.owner.words == "zone `tank`"
        )

    free = replace(work, obstacles=(), planned_shortfall=())
    assert deepest(free.legs(loose)) > 0.5
    assert deepest(work.legs(loose)) < 0.05


@pytest.mark.slow
def test_legs_do_not_cut_the_clearance_of_a_building_either() -> None:
    turn = np.linspace(0, 2 * np.pi, 121)
    ring = 38.0 * np.column_stack([np.cos(turn), np.sin(turn)])
    low, high = np.zeros((120, 1)), np.full((120, 1), 40.0)
    a0, b0, b1 = (np.hstack(part) for part in ((ring[:-1], low), (ring[1:], low), (ring[1:], high)))
    walls = np.concatenate(
        [np.stack([a0, b0, b1], axis=1), np.stack([a0, b1, np.hstack([ring[:-1], high])], axis=1)]
    )
    tank = obstacle_mesh("buildings", "tank.geojson", walls, (np.zeros(len(walls), dtype=int), ("tank",)))
    mission = orbit_mission()
    radius = mission.drones[0].radius
    rules = mission.rules._replace(obstacle_clearance=1.9 - radius)
    source = plan(SAMPLE.trajectory.drones[0], mission=replace(mission, meshes=(tank,), rules=rules))
    work, loose = thinner(source), Tolerance(1.0, inf, inf)
    (beside,) = [o for o in work.obstacles if o.owner.kind == "buildings"]

    def deepest(legs: list[StraightLeg]) -> float:
        points = work.track.poses.position
        ends = [(points[leg.first], points[leg.last]) for leg in filmed(legs)]
        line = [a + s * (b - a) for a, b in ends for s in np.linspace(0, 1, 50)]
        return float(shortfall(beside, np.array(line)).max())

    assert deepest(replace(work, obstacles=(), planned_shortfall=()).legs(loose)) > 0.5
    assert deepest(work.legs(loose)) < 0.05


def test_a_hold_is_a_stretch_of_its_own() -> None:
    low, high, east = (0.0, -60.0, 0.0, 0.0, 0.0), (0.0, -60.0, 20.0, 0.0, 0.0), (40.0, -60.0, 20.0, 0.0, 0.0)
    trajectory = flight(
        [
            ("takeoff", None, 8.0, high),
            ("shot", "half", 10.0, east),
            ("shot", "half", 3.0, east),
            ("return", None, 10.0, high),
            ("land", None, 8.0, low),
        ],
        pad=low,
    )
    track = track_of(orbit_mission(), trajectory)
    assert [s.rest for s in track.stretches] == [False, True, False]
    rest = track.stretches[1]
    assert track.time[rest.last] - track.time[rest.first] == pytest.approx(3.0)


def test_a_centred_target_is_followed_and_an_off_centre_one_gets_places_by_leg() -> None:
    work = thinner(SAMPLE)
    assert work.style.followed == {"half": (0.0, 0.0, 12.0)}
    source = SAMPLE.trajectory.drones[0]
    ctrl = source.curve.ctrl.copy()
    ctrl[:, :, 3] += 0.2
    turned = replace(source, curve=Piecewise(source.curve.breaks, ctrl))
    style = thinner(plan(turned)).style
    assert style.followed == {}
    assert style.aimed == {"half"}
    fixed = replace(orbit_mission().drones[0].gimbal, yaw=(0.0, 0.0))
    assert thinner(plan(turned, gimbal=fixed)).style.aimed == frozenset()


@pytest.mark.slow
def test_the_region_of_a_leg_lies_where_the_camera_axes_meet() -> None:
    source = plan(SAMPLE.trajectory.drones[0])
    work = thinner(source, replace(thinner(source).style, followed={}, aimed=frozenset({"half"})))
    leg = filmed(work.legs(Tolerance()))[5]
    region = region_of(work.style, work.track, slice(leg.first, leg.last + 1), "half")
    assert region == pytest.approx((0.0, 0.0, 12.0), abs=0.05)


def test_following_stops_at_the_ends_of_the_gimbal() -> None:
    drone = orbit_mission().drones[0]
    behind = np.array([[-10.0, 1.0, 0.0]])
    yaw, pitch = follow(drone, np.zeros((1, 3)), np.zeros(1), behind[0])
    assert yaw[0] == pytest.approx(radians(135))
    assert pitch[0] == 0.0
    _, up = follow(drone, np.zeros((1, 3)), np.zeros(1), (1.0, 0.0, 10.0))
    assert up[0] == pytest.approx(radians(30))

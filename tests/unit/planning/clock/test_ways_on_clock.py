"""Ways to shots of what moves: clear of it whichever way they lead, and in time, or told when."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source
from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.geom.solid_arrays.points import distances
from shotc.geom.solids import Cylinder, Prism, Solid, box, point
from shotc.ir.ideal import ideal_place
from shotc.ir.keyframes import PlacedShot
from shotc.ir.mission import MissionIR
from shotc.ir.path import MovingLeg
from shotc.ir.phases import Phase
from shotc.ir.trajectory import Claim, VerifiedIR
from shotc.passes.verify.advice import Rule, advice
from shotc.planning.clock.aims import CameraTask
from shotc.planning.clock.departure import When, choose
from shotc.planning.clock.detours import with_sweeps
from shotc.planning.clock.moving import Moving
from shotc.planning.clock.shot import OtherVehicles, TimedShot, timed_shot
from shotc.planning.clock.starts import CLOSE_S, SPARE_S, ClockFailure, Reached, put_off
from shotc.planning.clock.visibility import Visibility
from shotc.planning.free_space import FreeSpace
from shotc.planning.obstacles import FreeSpaces, free_spaces_of
from shotc.planning.path.legs import LegContext, Pose, way_to
from shotc.planning.timing.straight import LineLimits
from shotc.planning.timing.timed_leg import leg_time
from tests.support.few import few
from tests.support.front_passes import placed
from tests.support.owners import owner

pytestmark = pytest.mark.slow

EMPTY = FreeSpace((), (), ())
PAIR = """\
shotc: 1
mission: pair
targets:
  cyclist: {track: {points: [[-100, 0, 0.9], [-100, 0, 0.9], [60, 0, 0.9]], times: [0, 15, 42]}, radius: 0.9,
    height: 1.8}
  second: {track: {points: [[-100, 4, 0.9], [-100, 4, 0.9], [60, 4, 0.9]], times: [0, 15, 42]}, radius: 0.9,
    height: 1.8}
drones:
  cam: {model: x500, home: HOME}
shots:
  - {id: duo, kind: framing, drone: cam, timing: {start: 15, duration: 12}, subjects: [
      {target: cyclist, frame: left-third, size: SIZE}, {target: second, frame: right-third}]}
"""
RIDE = """\
shotc: 1
mission: ride
targets:
  rider: {track: {file: rider.csv BEGINS}, radius: 0.9, height: 1.8}
drones:
  cam: {model: x500, home: [-100, -15, 0]}
shots:
  - {id: tail, kind: chase, drone: cam, target: rider, distance: 10, altitude: 4,
     timing: {TIMING}}
"""
ROWS = "t,x,y,z\n0,-100,0,0.9\n20,20,0,0.9\n40,60,113,0.9\n"


def compiled(mission: str, folder: Path | None = None) -> tuple[VerifiedIR | None, tuple[Diagnostic, ...]]:
    done = compile_source(mission.encode(), "m.yaml", folder, PlanOptions(refiner="none"))
    return done.plan, done.diagnostics


@cache
def ride(timing: str, begins: str = "") -> tuple[VerifiedIR | None, tuple[Diagnostic, ...]]:
    with TemporaryDirectory() as folder:
        (Path(folder) / "rider.csv").write_text(ROWS)
        return compiled(RIDE.replace("TIMING", timing).replace(" BEGINS", begins), Path(folder))


def pair() -> MissionIR:
    ir, _ = placed(PAIR.replace("SIZE", "0.7").replace("HOME", "[-85, -15, 0]"))
    assert ir is not None
    return ir.mission


def only(found: tuple[Diagnostic, ...], code: str) -> Diagnostic:
    (told,) = (d for d in found if d.code == code)
    return told


@pytest.mark.long
@pytest.mark.parametrize("size", ["0.9", "0.7"])
@pytest.mark.parametrize("home", few(["[-100, 15, 0]", "[-97, 12, 0]", "[-85, -15, 0]"], ["[-97, 12, 0]"]))
def test_the_way_to_a_shot_leads_round_who_stands_in_it(size: str, home: str) -> None:
    plan, found = compiled(PAIR.replace("SIZE", size).replace("HOME", home))
    assert plan is not None, found
    curve = plan.trajectory.drones[0].curve
    fly = next(p.end for p in plan.trajectory.drones[0].phases if p.name == "takeoff")
    t = np.arange(fly, 15.0, 0.01)
    for y in (0.0, 4.0):
        away = distances(Cylinder((-100.0, y), 0.9, 0.0, 1.8), curve(t)[:, :3])
        assert away.min() >= plan.trajectory.keyframes.mission.rules.target_clearance


@pytest.mark.long
def test_a_start_put_off_is_one_at_which_the_drone_is_there() -> None:
    told = only(ride("start: 0, duration: 6")[1], "T003")
    start = re.search(r"`start: ([\d.]+) s` or later", told.help)
    assert start is not None, told
    assert ride(f"start: {start[1]}, duration: 6")[0] is not None


@pytest.mark.long
def test_a_track_that_ends_before_the_later_shot_does_leaves_so_much_of_it() -> None:
    told = only(ride("start: 0, duration: 40")[1], "T003")
    numbers = re.search(r"`start: ([\d.]+) s` and `duration: ([\d.]+) s` or less", told.help)
    assert numbers is not None, told
    assert 0.0 <= 40.0 - float(numbers[1]) - float(numbers[2]) < 0.1
    assert ride(f"start: {numbers[1]}, duration: {numbers[2]}")[0] is not None


def test_a_recording_that_begins_later_leaves_the_drone_time_for_the_whole_of_it() -> None:
    told = only(ride("start: 0, duration: 40")[1], "T003")
    numbers = re.search(r"`begins: ([\d.]+) s` of `rider`\).* `start: ([\d.]+) s`", told.help)
    assert numbers is not None, told
    plan, found = ride(f"start: {numbers[2]}, duration: 40", f", begins: {numbers[1]}")
    assert plan is not None, found


def test_what_comes_before_a_shot_adds_up_to_its_earliest_start() -> None:
    told = only(ride("start: 0, duration: 6")[1], "T003")
    parts, total = told.notes[0].removeprefix("before it come ").split(": ")
    told_sum = float(total.split(" s")[0])
    assert sum(float(x) for x in re.findall(r"([\d.]+) s", parts)) == pytest.approx(told_sum, abs=0.11)
    assert f"but {told_sum:.2f} s is the earliest" in told.message


@pytest.mark.long
def test_a_shot_without_a_start_is_told_how_long_it_can_be() -> None:
    told = only(ride("duration: 40")[1], "M010")
    left = re.search(r"`duration: ([\d.]+) s` or less", told.help)
    assert left is not None, told
    assert ride(f"duration: {left[1]}")[0] is not None


CAR = """\
shotc: 1
mission: car
targets:
  car: {track: {start: [-100, 0, 0.9], velocity: [14, 0, 0]}, radius: 1, height: 1.8}
drones:
  cam: {model: x500, home: [0, -15, 0], limits: {speed: 16 m/s}}
shots:
  - {id: side, kind: lateral, drone: cam, target: car, side: right, distance: 15, altitude: 4,
     timing: {start: START, duration: 8}}
"""


def test_a_shot_begins_as_its_target_comes_by_and_the_run_up_is_no_longer_than_its_motion_needs() -> None:
    """The car passes the pad at 7.1 s. At 3 m/s^2 and 8 m/s^3 the drone needs 5.04 s and 35 m to 14 m/s."""
    start = 9.97  # 0.01 s later than a drone can begin it that stops before its run-up
    told = only(compiled(CAR.replace("START", "8"))[1], "T003")
    earliest = re.search(r"`start: ([\d.]+) s`", told.help)
    assert earliest is not None, told
    assert 8.5 < float(earliest[1]) < start
    plan, found = compiled(CAR.replace("START", str(start)))
    assert plan is not None, found
    curve = plan.trajectory.drones[0].curve
    times = np.arange(0.0, start, 0.01)
    speed = np.linalg.norm(curve.derivative()(times)[:, :2], axis=1)
    rest = times[speed < 1e-3][-1]
    least = LineLimits(20.0, 3.0, 8.0).least_time(14.0)
    assert start - rest < 1.15 * least
    assert float(np.trapezoid(speed[times >= rest], times[times >= rest])) < 1.15 * 35.3
    assert least == pytest.approx(5.04, abs=0.01)


class Chaser:
    """Reaches a shot by an arrival that is known for each start; keeps what was asked of it."""

    def __init__(self, slope: float, offset: float, idle: float = 0.0) -> None:
        self.slope, self.offset, self.idle = slope, offset, idle
        self.starts: list[float] = []

    def __call__(self, placed: PlacedShot, start: float) -> Reached | ClockFailure:
        self.starts.append(start)
        made = type("Shot", (), {"leg": type("Leg", (), {"start": start})()})()
        gained = (1.0 - self.slope) * max(0.0, start - self.idle)
        return Reached(placed, made, None, self.offset - gained, (False, False))  # type: ignore[arg-type]


@pytest.mark.parametrize("slope", [0.0, 0.3, 0.6, 0.8])
def test_a_start_is_put_off_to_where_the_drone_has_caught_up(slope: float) -> None:
    mission = pair()
    found = put_off(mission, Chaser(slope, 5.0), PlacedShot(mission.shots[0], ()), 1.0, lambda start: -start)
    assert isinstance(found, Reached)
    exact = 5.0 / (1.0 - slope)
    assert exact <= found.shot.leg.start <= exact + CLOSE_S + 2 * SPARE_S / (1.0 - slope)


def test_a_drone_that_falls_behind_is_given_up_soon() -> None:
    mission, chaser = pair(), Chaser(1.0, 5.0)
    found = put_off(mission, chaser, PlacedShot(mission.shots[0], ()), 1.0, lambda start: -start)
    assert isinstance(found, Reached)
    assert found.late > 0.0
    assert len(chaser.starts) <= 5


def test_a_drone_that_gains_nothing_at_first_is_waited_for() -> None:
    mission = pair()
    found = put_off(
        mission, Chaser(0.8, 5.0, idle=12.0), PlacedShot(mission.shots[0], ()), 1.0, lambda start: -start
    )
    assert isinstance(found, Reached)
    assert found.late <= 0.0
    assert found.shot.leg.start == pytest.approx(12.0 + 25.0, abs=CLOSE_S + 2 * SPARE_S / 0.2)


def test_a_way_that_costs_more_once_is_no_reason_to_give_a_drone_up() -> None:
    """From 6 s on the short way is barred, and the one over it takes 7 s more."""

    class Barred(Chaser):
        def __call__(self, placed: PlacedShot, start: float) -> Reached | ClockFailure:
            reached = super().__call__(placed, start)
            assert isinstance(reached, Reached)
            return replace(reached, late=reached.late + (7.0 if start > 6.0 else 0.0))

    mission, chaser = pair(), Barred(0.2, 5.0)
    found = put_off(mission, chaser, PlacedShot(mission.shots[0], ()), 1.0, lambda start: 5.0 - 0.8 * start)
    assert isinstance(found, Reached)
    assert found.late <= 0.0
    assert found.shot.leg.start == pytest.approx(15.0, abs=CLOSE_S + 2 * SPARE_S / 0.8)


def test_a_drone_that_has_to_wait_at_the_fourth_try_is_not_given_up() -> None:
    """It gains at three tries; then somebody passes its way, and it loses 3.5 s."""
    lateness = iter([10.1, 3.7, 2.1, 5.6, 0.5, -0.1])

    class Waiting(Chaser):
        def __call__(self, placed: PlacedShot, start: float) -> Reached | ClockFailure:
            reached = super().__call__(placed, start)
            assert isinstance(reached, Reached)
            return replace(reached, late=next(lateness))

    mission, chaser = pair(), Waiting(0.5, 8.5)
    found = put_off(mission, chaser, PlacedShot(mission.shots[0], ()), 6.0, lambda start: 6.0 - 0.8 * start)
    assert isinstance(found, Reached)
    assert found.late <= 0.0
    assert found.shot.leg.start == chaser.starts[5]


FOLLOWED = """\
shotc: 1
mission: two
targets:
  runner:
    track: {points: [[-4.14, -28.79, 0.9], [52.32, 3.65, 0.9], [232.74, 153.34, 0.9]], speed: 2.6}
    radius: 0.4
    height: 1.8
drones:
  cam1: {model: x500, home: [6.43, -22.96, 0], limits: {speed: 12 m/s}, body: forward}
  cam2: {model: x500, home: [12.28, -24.6, 0], limits: {speed: 12 m/s}, body: forward}
rules: {mutual_visibility: {strength: off}}
shots:
  - {id: s1, kind: chase, drone: cam1, target: runner, distance: 6.2, altitude: 4.7, timing: {duration: 11.6}}
  - {id: s2, kind: chase, drone: cam2, target: runner, distance: 5.6, altitude: 3.2, timing: {duration: 11.5}}
"""


def test_a_motion_is_near_what_it_films_or_there_is_none() -> None:
    """Planes beside the first drone all but contradict each other: they leave room kilometres away."""
    ir, _ = placed(FOLLOWED)
    assert ir is not None
    mission, (first, second) = ir.mission, ir.shots
    begins, ends = 5.7, 20.7

    def flown(times: Array) -> Array:
        held = np.clip(times, begins, ends)
        return np.array([ideal_place(mission, first.shot, 7.41, float(t)) for t in held])

    drone = mission.drones[1]
    beside = Moving(owner("drone cam1"), point((0.0, 0.0, 0.0)), 3.0, flown, always=True)
    camera_task = CameraTask(mission, drone, second.subjects)
    made = timed_shot(
        camera_task, (free_spaces_of(mission, drone), OtherVehicles((beside,), Visibility())), second, 8.14
    )
    assert isinstance(made, TimedShot)
    begin = np.array(ideal_place(mission, second.shot, 8.14, 8.14))
    assert np.linalg.norm(made.leg.curve(8.14)[:3] - begin) < 10.0


def test_a_way_that_meets_a_drone_is_worse_than_one_that_is_late() -> None:
    """A drone hovers half way: the straight way is in time, the one over it is not."""
    mission = pair()
    drone = mission.drones[0]
    flight = LegContext(drone, FreeSpaces(EMPTY, EMPTY), np.array([0.0, 0.0, 5.0]), None)
    here, high, above, there = (
        (x, 0.0, z, 0.0, 0.0, 0.0, 1.2) for x, z in ((0.0, 5.0), (0.0, 12.0), (40.0, 12.0), (40.0, 5.0))
    )

    def legs(*poses: Pose) -> list[MovingLeg]:
        ways = [way_to(flight, a, b, ("shots", 0)) for a, b in pairwise(poses)]
        return [leg for way in ways if isinstance(way, list) for leg in way]

    hovers = Moving(
        owner("drone b"), point((20.0, 0.0, 5.0)), 3.0, lambda t: np.zeros((len(t), 3)), always=True
    )
    straight, over = legs(here, there), legs(here, high, above, there)
    lasts = sum(leg_time(drone, leg) for leg in straight)
    way = choose(
        mission, drone, OtherVehicles((hovers,), Visibility()), [straight, over], When(0.0, lasts + 0.1)
    )
    assert way is not None
    assert len(way.legs) == 3
    assert way.end > lasts + 1.0


VAN = box((0.0, 0.0, 0.0), (4.6, 1.9, 1.8), 0.4)  # one that goes one way keeps its sides


@pytest.mark.parametrize("part", [Cylinder((0.0, 0.0), 0.9, -0.9, 0.9), VAN])
def test_a_sweep_holds_all_places_of_its_target(part: Solid) -> None:
    def at(times: np.ndarray) -> np.ndarray:
        return np.column_stack([np.sin(times), 0.3 * times, 1.0 + 0.1 * times])

    moving = [Moving(owner("target x"), part, 1.6, at, apart=5.6)]
    flight, transit, _ = with_sweeps(FreeSpaces(EMPTY, EMPTY), moving, (2.0, 5.0))
    (swept,), (wide,) = flight.obstacles, transit.obstacles
    angle = np.linspace(0.0, 2 * np.pi, 24)
    rim = np.column_stack([0.89 * np.cos(angle), 0.89 * np.sin(angle), np.zeros(24)])
    if isinstance(part, Prism):
        rim = 0.99 * np.column_stack([np.array(part.points), np.zeros(len(part.points))])
    for t in np.arange(2.0, 5.01, 0.5):
        assert distances(swept.part, at(np.array([t])) + rim).max() == pytest.approx(0.0, abs=1e-9)
    assert (str(swept.owner), swept.clearance) == ("target x", 1.6)
    assert (wide.part, wide.clearance) == (swept.part, 5.6)


def test_a_van_that_stands_is_swept_as_it_is() -> None:
    moving = [Moving(owner("target x"), VAN, 1.6, lambda t: np.tile([3.0, 4.0, 1.0], (len(t), 1)))]
    (swept,) = with_sweeps(FreeSpaces(EMPTY, EMPTY), moving, (2.0, 5.0)).flight.obstacles
    assert isinstance(swept.part, Prism)
    moved = {(round(x + 3.0, 9), round(y + 4.0, 9)) for x, y in VAN.points}
    assert {(round(x, 9), round(y, 9)) for x, y in swept.part.points} == moved
    assert (swept.part.bottom, swept.part.top) == (VAN.bottom + 1.0, VAN.top + 1.0)


@pytest.mark.parametrize("phase", ["transit", "return"])
def test_on_a_way_of_the_planners_own_no_rule_is_to_be_lowered(phase: str) -> None:
    rule = ("rules", "target_clearance")
    claim = Claim("target second", "cam", None, 1.0, 0.8, "m", False, 5.0, None, "bounded", True, False, rule)
    help_ = advice(pair(), claim, Rule("V010"), Phase(phase, None, 0.0, 9.0))  # type: ignore[arg-type]
    assert "lower" not in help_
    assert "`home`" in help_
    assert "lower" in advice(pair(), claim, Rule("V010"), Phase("shot", "duo", 0.0, 9.0))

"""Cameras that film a show: what is claimed of both together, held against dense samples and other eyes."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from shotc.api import PlanOptions, compile_source, verify_plan
from shotc.collective import collective_returns
from shotc.collective.homing import Homing
from shotc.emit.csv_table import EMITTER
from shotc.emit.plan_json import EMITTER as PLAN_JSON
from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.fleet_spline import places
from shotc.geom.solids import signed_distance
from shotc.ir.passes import PassContext
from shotc.ir.path import CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.trajectory import Claim, TrajectoryIR, VerifiedIR
from shotc.passes.verify import judge
from shotc.show.beside_cameras import beside, timed, too_early
from shotc.show.beside_cameras.airspace import airspace
from shotc.show.emit.skyc import EMITTER as SKYC
from shotc.show.emit.vviz import EMITTER as VVIZ
from tests.support import skyc_reader
from tests.support.compiled import compiled
from tests.support.records import replace

pytestmark = pytest.mark.slow
SPECS = Path(__file__).parents[2] / "specs"

MISSION = """\
shotc: 1
mission: filmed
drones:
  cam: {model: x500, home: [0, -70, 0], camera: {hfov: 60 deg, aspect: "16:9"}}
fleets:
  swarm: {count: 10, layout: {grid: {spacing: 4, origin: [30, 30, 0]}}, separation: 1}
shots:
  - id: dance
    kind: display
    fleet: swarm
    viewpoint: [0, -60, 2]
    pyro:
      - {at: 47 s, drones: [2, 5], product: fountain, duration: 20, prefire: 0.5, clear: 0.9, pan: 90 deg}
    frames:
      - {sphere: {center: [0, 0, 30], radius: 6}, name: globe, at: 45 s, hold: 14}
      - {cube: {center: [0, 0, 30], size: 14, heading: 20 deg}, name: block, hold: 4}
  - id: turn
    kind: orbit
    drone: cam
    target: globe
    radius: 29
    altitude: {above: origin, height: 30}
    start_azimuth: 180 deg
    sweep: 50 deg
    timing: {duration: 12}
    require: {in_frame: 100 %}
"""


@pytest.fixture(scope="module")
def plan() -> VerifiedIR:
    done = compile_source(MISSION.encode(), "filmed.yaml", None, PlanOptions(refiner="none"))
    assert done.plan is not None, done.diagnostics
    return done.plan


def apart(ir: TrajectoryIR, times: Array) -> Array:
    """Return how far the camera is from the nearest drone of the fleet at times, sampled, metres."""
    camera, fleet = ir.drones[0].curve, ir.fleets[0]
    eye = camera(np.clip(times, camera.start, camera.end))[:, :3]
    swarm = places(fleet.breaks, fleet.coef, np.minimum(times, fleet.breaks[-1]))
    return np.asarray(np.linalg.norm(swarm - eye, axis=2).min(axis=0))


def separation(certificate: tuple[Claim, ...]) -> Claim:
    return next(c for c in certificate if c.constraint == "separation from cam")


def test_the_separation_of_camera_and_fleet_is_that_of_dense_samples(plan: VerifiedIR) -> None:
    ir, claim = plan.trajectory, separation(plan.certificate)
    sampled = apart(ir, np.arange(0.0, ir.end, 0.01)).min()
    assert claim.limit == 3.0
    assert claim.holds
    assert sampled - 0.05 <= claim.worst <= sampled
    assert claim.drones[1] == "cam"
    assert claim.time is not None
    assert apart(ir, np.array([claim.time]))[0] == pytest.approx(claim.worst, abs=0.05)


def test_a_camera_that_flies_through_the_picture_breaks_it(plan: VerifiedIR) -> None:
    ir = plan.trajectory
    camera = ir.drones[0]
    ctrl = camera.curve.ctrl.copy()
    ctrl[:, :, 1] += 27.0
    through = replace(camera, curve=Piecewise(camera.curve.breaks, ctrl))
    claim = separation(judge(replace(ir, drones=(through,)), PassContext()).certificate)
    moved = apart(replace(ir, drones=(through,)), np.arange(0.0, ir.end, 0.01)).min()
    assert not claim.holds
    assert moved - 0.05 <= claim.worst <= moved


@pytest.mark.parametrize("in_the_way", [False, True])
def test_a_show_that_is_filmed_is_called_off_clear_of_its_cameras(plan: VerifiedIR, in_the_way: bool) -> None:
    """A camera that hovers where the fleet would go home has it go another way, or no return holds."""
    ir = plan.trajectory
    if in_the_way:
        curve = ir.drones[0].curve
        ctrl = curve.ctrl.copy()
        ctrl[:, :, :3] = (16.0, 16.0, 21.0)
        camera = replace(ir.drones[0], curve=Piecewise(curve.breaks, ctrl))
        ir = replace(ir, drones=(camera,))
    ways = []
    for found in collective_returns(replace(plan, trajectory=ir), 26.0, lambda _: None):
        (way,) = found.fleets
        if way.track is None:
            continue
        ways.append(way)
        flown = replace(ir.fleets[0], breaks=way.track.breaks, coef=way.track.coef)
        times = np.arange(found.time, max(way.down, ir.drones[0].curve.end), 0.02)
        sampled = apart(replace(ir, fleets=(flown,)), times).min()
        claim = separation(way.claims)
        assert sampled - 0.05 <= claim.worst <= sampled + 1e-9
        assert claim.holds == (sampled >= 3.0)
    assert len(ways) >= 2
    if not in_the_way:
        assert all(way.holds for way in ways)


@pytest.mark.parametrize("duration", [20.0, 40.0])
def test_a_fleet_that_is_called_off_waits_in_the_air_until_its_products_have_burnt(
    plan: VerifiedIR, duration: float
) -> None:
    ir = plan.trajectory
    mission = ir.keyframes.mission
    display = mission.displays[0]
    cue = replace(display.pyro[0], duration=duration)
    mission = replace(mission, displays=(replace(display, pyro=(cue,)),))
    ir = replace(ir, keyframes=replace(ir.keyframes, mission=mission))
    way = Homing(ir, ir.fleets[0]).at(50.0)
    assert way.track is not None
    assert way.holds
    assert way.over >= cue.end
    assert (way.waits > 0.0) == (duration == 40.0)
    claim = next(c for c in way.claims if c.constraint == "pyro 1 fountain from drones of swarm")
    times = np.arange(50.0, cue.end, 0.01)
    swarm = places(way.track.breaks, way.track.coef, times)
    away = [np.linalg.norm(np.delete(swarm, row, axis=0) - swarm[row], axis=2).min() for row in (1, 4)]
    assert min(away) - 0.05 <= claim.worst <= min(away)
    before = Homing(ir, ir.fleets[0]).at(46.0)
    assert not [c for c in before.claims if c.constraint.startswith("pyro")]


def test_cameras_stay_out_of_an_airspace_that_holds_every_drone(plan: VerifiedIR) -> None:
    ir = plan.trajectory
    zones = list(airspace(ir.keyframes.mission, ir.fleets[0]))
    camera, fleet = ir.drones[0].curve, ir.fleets[0]
    times = np.arange(0.0, ir.end, 0.5)
    for drone in places(fleet.breaks, fleet.coef, np.minimum(times, fleet.breaks[-1])):
        assert all(min(signed_distance(z.solid, tuple(p)) for z in zones) <= -2.9 for p in drone)
    eye = camera(np.clip(times, camera.start, camera.end))[:, :3]
    assert all(min(signed_distance(z.solid, tuple(p)) for z in zones) > 0.29 for p in eye)


def test_the_shot_begins_when_its_picture_stands_and_every_light_is_in_the_frame(plan: VerifiedIR) -> None:
    ir = plan.trajectory
    flight, fleet = ir.drones[0], ir.fleets[0]
    filmed = next(p for p in flight.phases if p.shot == "turn")
    assert filmed.start == pytest.approx(fleet.shown[0].start, abs=1e-6)
    times = np.linspace(filmed.start, filmed.end, 25)
    for pose, swarm in zip(
        flight.curve(times), places(fleet.breaks, fleet.coef, times).swapaxes(0, 1), strict=True
    ):
        yaw, pitch = pose[CAM_YAW], pose[CAM_PITCH]
        ahead = np.array([np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)])
        right = np.array([np.sin(yaw), -np.cos(yaw), 0.0])
        off = swarm - pose[:3]
        depth, half = off @ ahead, np.tan(pose[HFOV] / 2)
        assert (depth > 0).all()
        assert (np.abs(off @ right) <= half * depth).all()
        assert (np.abs(off @ np.cross(right, ahead)) <= half * 9 / 16 * depth).all()


def test_the_plan_is_proved_again_from_its_bytes(plan: VerifiedIR) -> None:
    data = PLAN_JSON.emit(plan).artifacts[0].data
    again = verify_plan(data, "plan.json")
    assert again.diagnostics == ()
    assert separation(again.certificate).worst == pytest.approx(separation(plan.certificate).worst)


def test_lights_outside_of_what_cameras_frame_are_an_error(plan: VerifiedIR) -> None:
    ir = plan.trajectory
    mission = ir.keyframes.mission
    globe = next(group for group in mission.groups if group.name == "globe")
    small = globe._replace(shape=globe.shape._replace(radius=4.0))  # type: ignore[union-attr]
    less = mission._replace(groups=(small, *(g for g in mission.groups if g is not globe)))
    verdict = judge(replace(ir, keyframes=ir.keyframes._replace(mission=less)), PassContext())
    claim = next(c for c in verdict.certificate if c.constraint == "lights outside globe")
    assert not claim.holds
    (told,) = (d for d in verdict.diagnostics if d.code == "V057")
    assert told.help is not None
    assert f"{2 * claim.worst:.3f} m more for each length of its `size`" in told.help


def test_the_airspace_keeps_cameras_out_and_hides_nothing(plan: VerifiedIR) -> None:
    mission = beside(plan.trajectory).mission
    assert {zone.name for zone in mission.zones} == {"airspace of swarm"}
    assert mission.opaque_zones == ()


def test_a_shot_that_cannot_wait_for_its_display_is_told_when_that_ends(plan: VerifiedIR) -> None:
    ir = plan.trajectory
    (shot,) = ir.keyframes.mission.shots
    end = next(p.end for p in ir.fleets[0].phases if p.shot == "dance")

    def starting(start: float) -> TrajectoryIR:
        asked = shot._replace(timing=shot.timing._replace(start=start, after="dance"))
        mission = ir.keyframes.mission._replace(shots=(asked,))
        return replace(ir, keyframes=ir.keyframes._replace(mission=mission))

    assert [(late.id, at) for late, at in too_early(starting(end - 0.1))] == [("turn", end)]
    assert list(too_early(starting(end))) == []


def test_who_is_near_a_product_that_burns_is_who_dense_samples_find(plan: VerifiedIR) -> None:
    ir, times = plan.trajectory, np.arange(46.5, 67.0, 0.01)
    fleet = ir.fleets[0]
    swarm = places(fleet.breaks, fleet.coef, times)
    carry = swarm[[1, 4]]
    camera = ir.drones[0].curve(times)[:, :3]
    others = [np.delete(swarm, k, axis=0) - swarm[k] for k in (1, 4)]
    sampled = {
        "drones of swarm": min(np.linalg.norm(away, axis=2).min() for away in others),
        "camera cam": np.linalg.norm(camera - carry, axis=2).min(),
        "the audience": np.linalg.norm(carry - (0.0, -60.0, 2.0), axis=2).min(),
        "the ground": carry[..., 2].min(),
    }
    claims = {c.constraint: c for c in plan.certificate}
    for other, least in sampled.items():
        claim = claims[f"pyro 1 fountain from {other}"]
        assert claim.holds
        assert claim.drones[0] in ("swarm-02", "swarm-05")
        assert least - 0.06 <= claim.worst <= least + 1e-9
        assert claim.method == "bounded"


def test_what_burns_on_the_ground_is_led_into_the_air(plan: VerifiedIR) -> None:
    ir = plan.trajectory
    (display,) = ir.keyframes.mission.displays
    late = display._replace(pyro=tuple(cue._replace(time=cue.time + 1000.0) for cue in display.pyro))
    mission = ir.keyframes.mission._replace(displays=(late,))
    verdict = judge(replace(ir, keyframes=ir.keyframes._replace(mission=mission)), PassContext())
    (told,) = (d for d in verdict.diagnostics if d.code == "V059")
    assert told.help is not None
    written = re.fullmatch(r"write `at: ([\d.]+) s`", told.help)
    assert written is not None
    breaks = ir.fleets[0].breaks
    assert breaks[0] <= float(written[1]) <= breaks[-1]


def test_the_show_file_fires_what_the_mission_says(plan: VerifiedIR) -> None:
    drones = skyc_reader.read(SKYC.emit(plan).artifacts[0].data)["swarm"]["drones"]
    programs = [drone["settings"].get("pyro") for drone in drones]
    assert [k for k, program in enumerate(programs, 1) if program] == [2, 5]
    payload = {"name": "fountain", "duration": 20.0, "prefireTime": 0.5, "yaw": 90.0, "pitch": -90.0}
    assert programs[1] == {"version": 1, "events": [[46.5, 0, "1"]], "payloads": {"1": payload}}


def test_the_file_of_viewers_fires_it_too(plan: VerifiedIR) -> None:
    drones = json.loads(VVIZ.emit(plan).artifacts[0].data)["performances"]
    fired = {drone["id"]: drone["payloadDescription"][1:] for drone in drones}
    assert [number for number, payloads in fired.items() if payloads] == [2, 5]
    event = {"id": 1, "type": "Pyro", "eventTime": 46.5, "vdl": "fountain", "pan": 90.0, "tilt": 180.0}
    assert fired[5] == [event]


@pytest.mark.fuzz
def test_the_show_in_layers_is_filmed_without_a_warning() -> None:
    done = compiled(SPECS / "harbour-letters.yaml")
    assert done.plan is not None
    assert done.diagnostics == ()
    rows = EMITTER.emit(done.plan).artifacts[0].data.splitlines()
    times = [float(row.split(b",")[0]) for row in rows if row.split(b",")[1] == b"swarm-001"]
    assert np.diff(times).min() == pytest.approx(0.2)  # beside cameras, which have 50 rows a second


def test_a_shot_waits_for_the_display_that_it_comes_after(plan: VerifiedIR) -> None:
    ir = plan.trajectory
    (shot,) = ir.keyframes.mission.shots
    end = next(p.end for p in ir.fleets[0].phases if p.shot == "dance")
    later = timed(ir, shot._replace(timing=shot.timing._replace(after="dance")))
    assert (later.timing.start, later.timing.after) == (end, None)
    assert timed(ir, shot).timing.start == ir.fleets[0].shown[0].start
    second = timed(ir, shot, begun=ir.fleets[0].shown[0].start)  # its drone films the picture already
    assert second.timing.start is None
    asked = timed(ir, shot._replace(timing=shot.timing._replace(start=7.0)))
    assert asked.timing.start == 7.0

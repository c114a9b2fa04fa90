"""Checks of a plan file beyond its types: names exist, numbers are meaningful, sizes are bounded."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain, pairwise
from math import dist, hypot, pi

from shotc.geom.shapes import CylinderShape, GroupShape, TargetShape
from shotc.geom.solids import Cylinder, Solid, is_simple, signed_area
from shotc.geom.track import Track
from shotc.geom.vec import plus
from shotc.ir.drone import Drone
from shotc.ir.keyed import in_order, is_keyed
from shotc.ir.mission import Ideal, MissionIR, Shot
from shotc.ir.path import CHANNELS
from shotc.ir.power import Power
from shotc.ir.trajectory import DroneTrajectory, TrajectoryIR
from shotc.planfile.fleet_sanity import fleet_faults
from shotc.rounding import plain, up
from shotc.units import LARGEST

MOST_TICKS = 20_000_000
"""Most ticks of the output clock in a flight."""

MOST_CORNERS = 1000
"""Most corners of a zone."""

FLIGHT_POINTS = 6
"""Control points of a piece of a flight, which is a quintic."""

UNIT_TOLERANCE = 1e-6
"""Tolerance of a unit vector's length, and of the position of a group's part against its body, metres."""

FASTEST_M_S = (1 + 1e-6) * LARGEST["speed"]
"""Largest speed of a target, m/s: the largest that a mission can write, plus the rounding of its rows."""

Fault = tuple[str, str]


def inconsistencies(ir: TrajectoryIR) -> Iterator[Fault]:
    """Yield (path, fault) for everything that makes a proof of the plan meaningless."""
    mission = ir.keyframes.mission
    yield from mission_faults(mission)
    for i, drone in enumerate(mission.drones):
        yield from _drone(drone, f"mission.drones[{i}]")
    yield from _names(mission, ir)
    for i, track in enumerate(ir.drones):
        yield from _track(track, mission, f"drones[{i}]")
    yield from fleet_faults(ir)


def mission_faults(mission: MissionIR) -> Iterator[Fault]:
    """Yield (path, fault) for the world and the rules of a mission."""
    if not 0 < mission.rate <= 1000:
        yield "mission.rate", f"{mission.rate:g} is not between 0 and 1000 samples a second"
    half_angle = mission.rules.half_angle
    if half_angle is not None and not 0 < half_angle <= pi / 2:
        yield "mission.rules.half_angle", f"{half_angle:g} rad is not between 0 and a right angle"
    if min(mission.rules.transits[:2]) < 0:
        yield "mission.rules.transits", "a clearance is negative"
    for i, zone in enumerate(mission.zones):
        text = _solid(zone.solid)
        if text:
            yield f"mission.zones[{i}].solid", text
    for i, target in enumerate(mission.targets):
        text = _shape(target.shape)
        if text:
            yield f"mission.targets[{i}].shape", text
        text = "" if target.track is None else _motion(target.track)
        if text:
            yield f"mission.targets[{i}].track", text
    yield from _groups(mission)
    if mission.origin is not None and abs(mission.origin.lat_deg) > 90:
        yield "mission.origin.lat_deg", f"{mission.origin.lat_deg:g} is no latitude"


def _motion(track: Track) -> str:
    if not track.times or len(track.times) != len(track.points):
        return "it does not have a point for every time"
    if track.headings and len(track.headings) != len(track.times):
        return "it does not have a heading for every time"
    if any(after <= before for before, after in pairwise(track.times)):
        return "its times do not rise"
    rows = zip(pairwise(track.times), pairwise(track.points), strict=True)
    fastest = max([hypot(*track.after), *(dist(p, q) / (t - s) for (s, t), (p, q) in rows)])
    if fastest > FASTEST_M_S:
        return f"it moves at up to {plain(up(fastest, 2))} m/s, faster than {FASTEST_M_S:g} m/s"
    return ""


def _ideal(ideal: Ideal, targets: set[str]) -> str:
    alone = ideal.frame in ("world", "keyframes")
    known = ideal.target is None if alone else ideal.target in targets
    if not known:
        return "it is about no target of the mission"
    shares = [share for share, _ in ideal.points]
    if len(shares) < 2 or any(b < a for a, b in pairwise(shares)):
        return "it has no points in order of time"
    return ""


def _solid(solid: Solid) -> str:
    if solid.bottom > solid.top:
        return "its bottom is above its top"
    if isinstance(solid, Cylinder):
        return "its radius is negative" if solid.radius < 0 else ""
    if not 3 <= len(solid.points) <= MOST_CORNERS:
        return f"it has {len(solid.points)} corners, 3 to {MOST_CORNERS} are possible"
    if not is_simple(solid.points) or signed_area(solid.points) <= 0:
        return "its outline crosses itself or does not run counter-clockwise"
    return ""


def _drone(drone: Drone, path: str) -> Iterator[Fault]:
    limits = drone.limits
    positive = {
        **{f"limits.{name}": value for name, value in limits.bounds.items()},
        "gimbal.rate": drone.gimbal.rate,
        "gimbal.acceleration": drone.gimbal.acceleration,
        "aspect": drone.aspect,
        "endurance": drone.endurance,
    }
    for name, value in positive.items():
        if value <= 0:
            yield f"{path}.{name}", f"{value:g} is not positive"
    if drone.power is not None:
        yield from _power(drone.power, f"{path}.power")
    if drone.radius < 0:
        yield f"{path}.radius", f"{drone.radius:g} is negative"
    if not 0 < drone.hfov < pi:
        yield f"{path}.hfov", f"{drone.hfov:g} rad is no field of view"


def _power(power: Power, path: str) -> Iterator[Fault]:
    for name, value in power._asdict().items():
        if name != "reserve" and value <= 0:
            yield f"{path}.{name}", f"{value:g} is not positive"
    if not 0 <= power.reserve < 1:
        yield f"{path}.reserve", f"{power.reserve:g} is no share that leaves something to fly on"


def _names(mission: MissionIR, ir: TrajectoryIR) -> Iterator[Fault]:
    for kind in ("zones", "targets", "drones", "fleets"):
        yield from _twice(f"mission.{kind}", (item.name for item in getattr(mission, kind)))
    yield from _twice("mission.groups", (target.name for target in mission.every_target))
    shots = (*(shot.id for shot in mission.shots), *(display.id for display in mission.displays))
    yield from _twice("mission.shots", shots)
    yield from _twice("keyframes", (placed.shot.id for placed in ir.keyframes.shots))
    yield from _twice("drones", (track.drone for track in ir.drones))
    yield from _twice("fleets", (track.fleet for track in ir.fleets))
    drones, targets = {d.name for d in mission.drones}, {t.name for t in mission.every_target}
    for i, shot in enumerate(mission.shots):
        if shot.drone not in drones:
            yield f"mission.shots[{i}].drone", f"there is no drone `{shot.drone}`"
        named = {shot.subject, *(k.target for k in shot.keyframes), *(s.target for s in shot.subjects)}
        for target in named - {None, *targets}:
            yield f"mission.shots[{i}]", f"there is no target `{target}`"
        if shot.ideal is not None:
            yield from _on_clock(shot, targets, f"mission.shots[{i}]")
    for i, placed in enumerate(ir.keyframes.shots):
        named = {*(k.target for k in placed.keyframes), *(s.target for s in placed.subjects)}
        for target in sorted(named - {None, *targets}, key=str):
            yield f"keyframes[{i}]", f"there is no target `{target}`"
    missing = {shot.id for shot in mission.shots} - {placed.shot.id for placed in ir.keyframes.shots}
    for name in sorted(missing):
        yield "keyframes", f"those of shot `{name}` are missing"


def _on_clock(shot: Shot, targets: set[str], path: str) -> Iterator[Fault]:
    """Yield the faults of a shot on its own clock."""
    assert shot.ideal is not None
    if shot.timing.duration is None:
        yield f"{path}.timing", "a shot on its own clock needs a duration"
    elif text := _ideal(shot.ideal, targets):
        yield f"{path}.ideal", text
    elif is_keyed(shot) != bool(shot.keyframes) or len(shot.keyframes) not in (0, len(shot.ideal.points)):
        yield f"{path}.keyframes", "they are not those of its ideal"
    elif is_keyed(shot) and not in_order(shot):
        yield f"{path}.ideal", "its keyframes are not in order of time"
    for name in {k.beside.target for k in shot.keyframes if k.beside is not None} - targets:
        yield f"{path}.keyframes", f"there is no target `{name}`"


def _shape(shape: TargetShape) -> str:
    """Return the fault of a body's shape, or an empty string."""
    if isinstance(shape, GroupShape):
        return "a group is no body"
    if isinstance(shape, CylinderShape):
        return "a radius or height is negative" if min(shape) < 0 else ""
    if min(shape[:3]) < 0:
        return "a side is negative"
    return "" if abs(hypot(*shape.ahead) - 1.0) <= UNIT_TOLERANCE else "`ahead` is no unit vector"


def _groups(mission: MissionIR) -> Iterator[Fault]:
    """Yield the faults of the groups: a group consists of the bodies that it names, at their positions."""
    bodies = {target.name: target for target in mission.targets}
    for i, group in enumerate(mission.groups):
        if not group.parts and not isinstance(group.shape, GroupShape):
            continue  # a picture of a fleet has no bodies
        parts = [bodies[name] for name in group.parts if name in bodies]
        if len(parts) < len(group.parts) or not parts or not isinstance(group.shape, GroupShape):
            yield f"mission.groups[{i}]", "its parts are not those that it names"
            continue
        expected = [(plus(group.centre, part.offset), part.shape) for part in group.shape.parts]
        same = [
            dist(centre, body.centre) <= UNIT_TOLERANCE and shape == body.shape
            for (centre, shape), body in zip(expected, parts, strict=False)
        ]
        if group.track is not None or len(expected) != len(parts) or not all(same):
            yield f"mission.groups[{i}].shape", "its parts are not where they stand"


def _twice(path: str, names: Iterable[str]) -> Iterator[Fault]:
    seen: set[str] = set()
    for name in names:
        if name in seen:
            yield path, f"`{name}` stands there twice"
        seen.add(name)


def _track(track: DroneTrajectory, mission: MissionIR, path: str) -> Iterator[Fault]:
    targets = {t.name for t in mission.every_target}
    for i, span in enumerate(track.framing):
        if span.target not in targets:
            yield f"{path}.framing[{i}].target", f"there is no target `{span.target}`"
        if span.reference is not None and span.reference.ctrl.shape[2] != 2:
            yield f"{path}.framing[{i}].reference", "does not have the two channels u and v"
    if track.curve.ctrl.shape[2] != len(CHANNELS):
        yield f"{path}.curve", f"has {track.curve.ctrl.shape[2]} channels, not {len(CHANNELS)}"
    if track.curve.ctrl.shape[1] != FLIGHT_POINTS:
        points = track.curve.ctrl.shape[1]
        yield f"{path}.curve", f"has {points} control points a piece, not {FLIGHT_POINTS}"
    times = chain((p.end for p in track.phases), (track.curve.end,))
    if max(times) * mission.rate > MOST_TICKS:
        yield f"{path}.curve", f"lasts {track.curve.end:g} s: too many samples at {mission.rate:g} Hz"

"""World and drones: presets filled in, places put into W, zones made solids."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import cos, degrees, isclose, sin, tan
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel

from shotc.diag.model import Diagnostic
from shotc.geom.focal import FULL_FRAME_M
from shotc.geom.solids import Cylinder, Prism, Solid, box, is_simple, signed_area
from shotc.ir.drone import Drone, Gimbal, LensRange, Optics, Safety
from shotc.ir.limits import Limits, Vec2, Vec3
from shotc.ir.mission import Zone
from shotc.ir.origin import KeyPath, OriginMap
from shotc.ir.power import SEA_LEVEL_KG_M3, Power, density_at
from shotc.kinds.base import counts_from_ground, stands
from shotc.passes.resolve.lower.rehearsal import toward
from shotc.spec.drones import CameraSpec, DroneSpec, LimitsSpec
from shotc.spec.fields import Geodetic, OnMap
from shotc.spec.heights import HeightRange
from shotc.spec.mission import MissionSpec
from shotc.spec.places import Spot
from shotc.spec.presets import CIRCLE_SHARE, PIXELS, PRESETS, Preset
from shotc.spec.rehearse import WindSpec
from shotc.spec.world import ZoneSpec

if TYPE_CHECKING:  # a mission of cameras loads none of it
    from shotc.ir.show import Fleet
    from shotc.ir.terrain import Terrain
    from shotc.spec.fleets import FleetSpec

Put = Callable[[Spot | Geodetic], Vec3]
LEAST_AREA = 1e-4  # m^2
BURIED = 0.25  # share of a target's height under the ground that is no rounding of its place
BEYOND = 2.0  # times a preset's figure; presets stay at half of what makers publish, or more
WIDER = 1.02  # times as wide as the picture of a model, from which a lens counts as another
_PUBLISHED = {"speed": "m/s", "climb": "m/s", "descent": "m/s", "acceleration": "m/s^2"}
LEAST_SPEED = 0.1  # m/s that the wind has to leave


def zones(
    spec: MissionSpec, put: Put, terrain: Terrain | None, origins: OriginMap
) -> tuple[tuple[Zone, ...], list[Diagnostic]]:
    """Return the zones as solids; a polygon that encloses nothing is a fault and no zone."""
    found: list[Zone] = []
    faults: list[Diagnostic] = []
    for name, zone in spec.world.zones.items():
        path = ("world", "zones", name)
        solid = _solid(zone, put, terrain)
        if isinstance(solid, str):
            label = origins.value((*path, "polygon", "points"))
            help_ = "list the corners in the order in which one walks round the zone"
            faults.append(Diagnostic("G007", f"the polygon of zone `{name}` {solid}", (label,), help=help_))
        else:
            found.append(Zone(name, zone.keep, solid, path))
    return tuple(found), faults


def zone_counts_from_ground(zone: ZoneSpec) -> bool:
    """Tell whether the heights of a zone count from the ground."""
    if zone.box is not None:
        return counts_from_ground(zone.box.center)
    shape = zone.cylinder or zone.polygon
    return shape is not None and shape.height.ground


def _solid(zone: ZoneSpec, put: Put, terrain: Terrain | None) -> Solid | str:
    """Return the solid of a zone, or what its polygon does wrong."""
    if zone.cylinder is not None:
        c, (x, y), r = zone.cylinder, on_map(zone.cylinder.center, put), zone.cylinder.radius
        about = ((x - r, y - r), (x + r, y + r))
        return Cylinder((x, y), r, *_heights(zone, c.height, terrain, about))
    if zone.box is not None:
        solid = box(put(zone.box.center), zone.box.size, zone.box.heading)
        if not stands(zone.box.center):
            return solid
        over = HeightRange(0.0, zone.box.size[2], ground=True)
        return Prism(solid.points, *_heights(zone, over, terrain, solid.points))
    assert zone.polygon is not None
    ring = _ring(tuple(on_map(p, put) for p in zone.polygon.points))
    if len(ring) < 3:
        return f"has {len(ring)} different corners, not three or more"
    if not is_simple(ring):
        return "crosses or touches itself"
    area = signed_area(ring)
    if abs(area) < LEAST_AREA:
        return "encloses no area"
    heights = _heights(zone, zone.polygon.height, terrain, ring)
    return Prism(ring if area > 0 else ring[::-1], *heights)


def on_map(place: Vec2 | OnMap, put: Put) -> Vec2:
    """Return x and y of a place on the map, metres of W."""
    if not isinstance(place, OnMap):
        return place
    x, y, _ = put(Geodetic(lat=place.lat, lon=place.lon, height=0.0))
    return (x, y)


def _heights(zone: ZoneSpec, height: HeightRange, terrain: Terrain | None, ring: Sequence[Vec2]) -> Vec2:
    """Return the lowest and the highest z of a zone whose heights may count from the ground.

    ring : corners of a polygon round it
    Of ground that rises, a zone to keep out of has the lowest and the highest about it, so that it is no
    smaller than what is meant, and one to stay in is no larger.
    """
    if not height.ground or terrain is None:
        return height.low, height.high
    x, y = zip(*ring, strict=True)
    low, high = terrain.span((min(x), min(y)), (max(x), max(y)))
    if zone.keep == "in":
        low, high = high, low
    return low + height.low, high + height.high


def _ring(points: tuple[Vec2, ...]) -> tuple[Vec2, ...]:
    """Drop corners that repeat the one before them, as a closing point does."""
    return tuple(p for i, p in enumerate(points) if not _same(p, points[i - 1]))


def _same(p: Vec2, q: Vec2) -> bool:
    return all(isclose(a, b, abs_tol=1e-6) for a, b in zip(p, q, strict=True))


def drones(spec: MissionSpec, put: Put, origins: OriginMap) -> tuple[dict[str, Drone], list[Diagnostic]]:
    """Return the drones by name, with presets filled in and what the wind does to their speed."""
    found: dict[str, Drone] = {}
    faults: list[Diagnostic] = []
    wind = spec.world.wind
    density = density_at(0.0 if spec.world.origin is None else spec.world.origin.alt)
    for name, drone in spec.drones.items():
        resolved = resolve_drone(name, drone, put, wind, density)
        faults += becalmed("drone", resolved, wind.speed, origins)
        faults += beyond_model("drone", drone, resolved.path, origins)
        faults += another_lens(drone, resolved, origins)
        found[name] = resolved
    return found, faults


def resolve_drone(
    name: str, spec: DroneSpec, put: Put, wind: WindSpec, density: float = SEA_LEVEL_KG_M3
) -> Drone:
    """Return a drone as its preset and what the mission puts in its place; density : of the air, kg/m^3."""
    preset, to = PRESETS[spec.model], toward(wind)
    power = _power(spec, preset, density)
    limits = limits_of(preset, spec.limits, wind.speed if to is None else 0.0)
    if to is not None:
        limits = limits._replace(wind=(wind.speed * cos(to), wind.speed * sin(to)))
    camera = spec.camera
    return Drone(
        name=name,
        model=spec.model,
        home=put(spec.home),
        limits=limits,
        gimbal=preset.gimbal if spec.gimbal is None else Gimbal(**_over(preset.gimbal, spec.gimbal)),
        hfov=camera.field_of_view or preset.hfov,
        lens=_lens(camera, preset),
        optics=_optics(camera, preset),
        safety=_safety(spec, put),
        aspect=camera.aspect_ratio or preset.aspect,
        radius=spec.radius or preset.radius,
        endurance=spec.endurance or (preset.endurance if power is None else power.endurance),
        priority=spec.priority,
        body=spec.body or preset.body,
        autopilot=preset.autopilot,
        path=("drones", name),
        power=power,
    )


def _power(spec: DroneSpec, preset: Preset, density: float) -> Power | None:
    """Return the power of a drone in air of a density, None where nobody knows it.

    Whose endurance is written may have another battery than its model: its energy is not known then.
    """
    written = spec.power
    if written is None:
        known = preset.power if spec.endurance is None else None
        return None if known is None else known._replace(density=density)
    rotors, share = written.rotors, written.efficiency or 1.0
    power = Power(written.mass, written.battery, rotors.count, rotors.radius, share, written.reserve)
    if written.hover is not None:
        power = power.hovering_for(written.hover)
    return power._replace(density=density)


def _lens(camera: CameraSpec, preset: Preset) -> LensRange | None:
    """Return the lens of a camera; None where neither mission nor model says what it is."""
    hfov = camera.field_of_view or preset.hfov
    return camera.lens or (LensRange(hfov, hfov, 0.0) if preset.fixed_lens else None)


def _safety(spec: DroneSpec, put: Put) -> Safety | None:
    """Return what a drone does when something goes wrong; None where the mission is silent."""
    written = spec.safety
    if written is None:
        return None
    return Safety(written.link_lost, written.return_height, tuple(put(place) for place in written.rally))


def _optics(camera: CameraSpec, preset: Preset) -> Optics | None:
    """Return what a camera exposes with; None where the mission says neither aperture nor shutter."""
    if camera.aperture is None and camera.shutter is None:
        return None
    sensor = preset.sensor if camera.sensor is None else camera.sensor[0]
    circle = camera.circle_of_confusion or CIRCLE_SHARE * (sensor or FULL_FRAME_M)
    return Optics(sensor, camera.aperture, circle, camera.shutter, camera.pixels or PIXELS)


def limits_of(preset: Preset, spec: LimitsSpec, wind: float) -> Limits:
    """Return the preset's limits with what the mission gives in their place, less so much wind, m/s."""
    limits = _over(preset.limits, spec)
    limits["speed"] -= wind
    return Limits(**limits)


def _over(preset: Limits | Gimbal, spec: BaseModel) -> dict[str, Any]:
    """Return the preset's fields, with what the mission gives in their place."""
    given = {key: getattr(spec, key) for key in type(spec).model_fields}
    return {key: getattr(preset, key) if given[key] is None else given[key] for key in given}


def beyond_model(
    what: str, spec: DroneSpec | FleetSpec, path: KeyPath, origins: OriginMap
) -> list[Diagnostic]:
    """Warn of limits that no drone of the model that the mission names is likely to have.

    Limits are taken at their word, and a preset is no bound: it is for planning, and below what its drone
    can do. Where no model is named, they are of a drone of the user's own, which nothing is known of.
    """
    model = (*path, "model")
    if model not in origins.values:
        return []
    preset = PRESETS[spec.model].limits
    given = {key: (getattr(spec.limits, key), getattr(preset, key)) for key in _PUBLISHED}
    return [
        Diagnostic(
            "K015",
            f"the `{key}` of {what} `{path[-1]}` is far above its model's",
            (origins.value((*path, "limits", key)), origins.value(model, "the model")),
            (f"{limit:g} {_PUBLISHED[key]} are {limit / usual:.1f} times the {usual:g} of `{spec.model}`",),
            f"mend it if it was not meant (a bare number is in {_PUBLISHED[key]}); it is taken at its word",
        )
        for key, (limit, usual) in given.items()
        if limit is not None and limit > BEYOND * usual * (1 + 1e-9)
    ]


def another_lens(spec: DroneSpec, drone: Drone, origins: OriginMap) -> list[Diagnostic]:
    """Warn of a lens that the camera built into the drone's model has not: one that zooms, or a wider one."""
    preset, lens = PRESETS[spec.model], drone.lens
    if not preset.fixed_lens or lens is None:
        return []
    wider = tan(lens.widest / 2) > WIDER * tan(preset.hfov / 2)
    if not (lens.zooms or wider):
        return []
    shown = f"shows {degrees(lens.widest):.4g} deg"
    if lens.zooms:
        shown = f"zooms from {degrees(lens.widest):.4g} to {degrees(lens.longest):.4g} deg"
    return [
        Diagnostic(
            "K022",
            f"the lens that is written for `{drone.name}` is not the one of its model",
            (origins.key((*drone.path, "camera")), origins.value((*drone.path, "model"), "the model")),
            (f"it {shown}; `{spec.model}` has a camera built in that shows {degrees(preset.hfov):.4g} deg",),
            "take the lens out of `camera`, unless the machine carries it: what is framed with it is not in"
            " the film of another one",
        )
    ]


def becalmed(what: str, drone: Drone | Fleet, wind: float, origins: OriginMap) -> list[Diagnostic]:
    """Return the fault of a drone, or of a fleet's drones, to which the wind leaves no speed."""
    if drone.limits.slowest >= LEAST_SPEED:
        return []
    speed = drone.limits.slowest + wind
    labels = (
        origins.value(("world", "wind")),
        origins.value((*drone.path, "limits", "speed"), f"{what} `{drone.name}`"),
    )
    none, half = max(0.0, speed - LEAST_SPEED), speed / 2
    diagnostic = Diagnostic(
        "K011",
        f"the wind leaves {what} `{drone.name}` no speed",
        labels,
        (f"it flies {speed:.1f} m/s at most, and the wind takes {wind:.1f} m/s of that",),
        f"wait for wind below {min(none, half):.1f} m/s, which leaves it half its speed "
        f"({none:.1f} m/s leave it next to none), or take a faster drone",
    )
    return [diagnostic]

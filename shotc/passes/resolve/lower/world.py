"""World and drones: presets filled in, places converted into W, zones as solids."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from math import cos, degrees, isclose, pi, sin, tan
from typing import TYPE_CHECKING, Any, NamedTuple

from pydantic import BaseModel

from shotc.diag.model import Diagnostic
from shotc.geom.camera import yaw_of
from shotc.geom.focal import FULL_FRAME_M
from shotc.geom.solids import Cylinder, Prism, Solid, box, is_simple, signed_area
from shotc.ir.drone import Drone, Gimbal, LensRange, Optics, Safety
from shotc.ir.ground import GroundHeight
from shotc.ir.limits import Limits, Vec2, Vec3
from shotc.ir.mission import Zone
from shotc.ir.origin import KeyPath, OriginMap
from shotc.ir.power import SEA_LEVEL_KG_M3, Power, density_at
from shotc.ir.rehearsal import Rehearsal, RehearsalPromise, Wind
from shotc.kinds.base import Place, counts_from_ground, stands
from shotc.rounding import at_least
from shotc.spec.drones import CameraSpec, DroneSpec, LimitsSpec
from shotc.spec.fields import Geodetic, OnMap
from shotc.spec.heights import HeightRange
from shotc.spec.mission import MissionSpec
from shotc.spec.places import Spot
from shotc.spec.presets import CIRCLE_SHARE, PRESETS, WIDTH_PX, Preset
from shotc.spec.rehearse import RehearseSpec, WindSpec
from shotc.spec.world import ZoneSpec

if TYPE_CHECKING:  # missions without these features do not load them
    from shotc.ir.show import Fleet
    from shotc.ir.terrain import Terrain
    from shotc.spec.fleets import FleetSpec


Put = Callable[[Spot | Geodetic], Vec3]
LEAST_AREA_M2 = 1e-4  # m^2
BURIED_SHARE = 0.25  # share of a target's height below the ground that rounding does not explain
BEYOND_PRESET_RATIO = 2.0  # factor of a preset's value; presets have at least half of the published values
WIDER_LENS_RATIO = 1.02  # ratio of widths from which a lens differs from the model's
_PUBLISHED = {"speed": "m/s", "climb": "m/s", "descent": "m/s", "acceleration": "m/s^2"}
LEAST_SPEED_M_S = 0.1  # m/s, least speed that the wind has to leave


class PadSite(NamedTuple):
    """Where pads are put. put : a place into W; ground : z of the ground at x and y, metres."""

    put: Put
    ground: GroundHeight

    def over(self, anchor: Place, plan: Iterable[Vec2]) -> tuple[Vec3, ...]:
        """Return pads of a layout at places (x, y) of W; anchor : the place that the layout is given by.

        All are as high as the anchor, over the ground or over the origin as that counts.
        """
        x, y, z = self.put(anchor)
        if not counts_from_ground(anchor):
            return tuple((px, py, z) for px, py in plan)
        height = z - self.ground(x, y)
        return tuple((px, py, self.ground(px, py) + height) for px, py in plan)


def zones(
    spec: MissionSpec, put: Put, terrain: Terrain | None, origins: OriginMap
) -> tuple[tuple[Zone, ...], list[Diagnostic]]:
    """Return the zones as solids, and the faults of polygons that enclose no area."""
    zones: list[Zone] = []
    faults: list[Diagnostic] = []
    for name, zone in spec.world.zones.items():
        path = ("world", "zones", name)
        solid = _solid(zone, put, terrain)
        if isinstance(solid, str):
            label = origins.value((*path, "polygon", "points"))
            help_ = "list the corners in the order in which one walks round the zone"
            faults.append(Diagnostic("G007", f"the polygon of zone `{name}` {solid}", (label,), help=help_))
        else:
            zones.append(Zone(name, zone.keep, solid, path))
    return tuple(zones), faults


def zone_counts_from_ground(zone: ZoneSpec) -> bool:
    """Return whether the heights of a zone are above ground."""
    if zone.box is not None:
        return counts_from_ground(zone.box.center)
    shape = zone.cylinder or zone.polygon
    return shape is not None and shape.height.ground


def _solid(zone: ZoneSpec, put: Put, terrain: Terrain | None) -> Solid | str:
    """Return the solid of a zone, or the fault of its polygon."""
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
    if abs(area) < LEAST_AREA_M2:
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
    """Return the lowest and the highest z of a zone whose heights may be above ground.

    On rising ground, a keep-out zone has the lowest and the highest ground below it, so that it is not
    smaller than intended, and a keep-in zone is not larger.

    ring : corners of a polygon around it
    """
    if not height.ground or terrain is None:
        return height.low, height.high
    x, y = zip(*ring, strict=True)
    low, high = terrain.span((min(x), min(y)), (max(x), max(y)))
    if zone.keep == "in":
        low, high = high, low
    return low + height.low, high + height.high


def _ring(points: tuple[Vec2, ...]) -> tuple[Vec2, ...]:
    """Return the corners without those that repeat the one before, as a closing point does."""
    return tuple(p for i, p in enumerate(points) if not _same(p, points[i - 1]))


def _same(p: Vec2, q: Vec2) -> bool:
    return all(isclose(a, b, abs_tol=1e-6) for a, b in zip(p, q, strict=True))


def drones(spec: MissionSpec, put: Put, origins: OriginMap) -> tuple[dict[str, Drone], list[Diagnostic]]:
    """Return the drones by name, with presets and the effect of wind on their speed, and their faults."""
    drones: dict[str, Drone] = {}
    faults: list[Diagnostic] = []
    wind = spec.world.wind
    density = density_at(0.0 if spec.world.origin is None else spec.world.origin.alt)
    for name, drone in spec.drones.items():
        resolved = resolve_drone(name, drone, put, wind, density)
        faults += becalmed("drone", resolved, wind.speed, origins)
        faults += beyond_model("drone", drone, resolved.path, origins)
        faults += another_lens(drone, resolved, origins)
        drones[name] = resolved
    return drones, faults


def resolve_drone(
    name: str, spec: DroneSpec, put: Put, wind: WindSpec, density: float = SEA_LEVEL_KG_M3
) -> Drone:
    """Return a drone from its preset and the mission's values; density : of the air, kg/m^3."""
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
    """Return the power of a drone in air of a given density; None where it is not known.

    If the endurance is written, the battery may differ from the model's, so its energy is not known.
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
    """Return the lens of a camera; None where neither mission nor model gives it."""
    hfov = camera.field_of_view or preset.hfov
    return camera.lens or (LensRange(hfov, hfov, 0.0) if preset.fixed_lens else None)


def _safety(spec: DroneSpec, put: Put) -> Safety | None:
    """Return the drone's reactions to failures; None where the mission gives none."""
    written = spec.safety
    if written is None:
        return None
    return Safety(written.link_lost, written.return_height, tuple(put(place) for place in written.rally))


def _optics(camera: CameraSpec, preset: Preset) -> Optics | None:
    """Return the exposure of a camera; None where the mission gives neither aperture nor shutter."""
    if camera.aperture is None and camera.shutter is None:
        return None
    sensor = preset.sensor if camera.sensor is None else camera.sensor[0]
    circle = camera.circle_of_confusion or CIRCLE_SHARE * (sensor or FULL_FRAME_M)
    return Optics(sensor, camera.aperture, circle, camera.shutter, camera.pixels or WIDTH_PX)


def limits_of(preset: Preset, spec: LimitsSpec, wind: float) -> Limits:
    """Return the preset's limits with the mission's values, minus the wind's speed, m/s."""
    limits = _over(preset.limits, spec)
    limits["speed"] -= wind
    return Limits(**limits)


def _over(preset: Limits | Gimbal, spec: BaseModel) -> dict[str, Any]:
    """Return the preset's fields with the mission's values."""
    given = {key: getattr(spec, key) for key in type(spec).model_fields}
    return {key: getattr(preset, key) if given[key] is None else given[key] for key in given}


def beyond_model(
    what: str, spec: DroneSpec | FleetSpec, path: KeyPath, origins: OriginMap
) -> list[Diagnostic]:
    """Return warnings for limits that no drone of the named model is likely to have.

    Limits are used as written. A preset is no bound: it is for planning, and lower than what its drone can
    do. Without a named model the drone is the user's own, of which nothing is known.
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
            f"correct it if it is a slip (a bare number is in {_PUBLISHED[key]}); "
            "the plan uses it as it is written",
        )
        for key, (limit, usual) in given.items()
        if limit is not None and limit > BEYOND_PRESET_RATIO * usual * (1 + 1e-9)
    ]


def another_lens(spec: DroneSpec, drone: Drone, origins: OriginMap) -> list[Diagnostic]:
    """Return a warning for a lens that the model's built-in camera lacks: one that zooms, or a wider one."""
    preset, lens = PRESETS[spec.model], drone.lens
    if not preset.fixed_lens or lens is None:
        return []
    wider = tan(lens.widest / 2) > WIDER_LENS_RATIO * tan(preset.hfov / 2)
    if not (lens.zooms or wider):
        return []
    angle = f"shows {degrees(lens.widest):.4g} deg"
    if lens.zooms:
        angle = f"zooms from {degrees(lens.widest):.4g} to {degrees(lens.longest):.4g} deg"
    return [
        Diagnostic(
            "K022",
            f"the lens of `{drone.name}` is not the one built into its model",
            (origins.key((*drone.path, "camera")), origins.value((*drone.path, "model"), "the model")),
            (f"it {angle}; `{spec.model}` has a camera built in that shows {degrees(preset.hfov):.4g} deg",),
            "take the lens out of `camera`, unless the machine carries it: what is framed with it is not in"
            " the film of another one",
        )
    ]


def becalmed(what: str, drone: Drone | Fleet, wind: float, origins: OriginMap) -> list[Diagnostic]:
    """Return the fault of a drone, or of a fleet's drones, to which the wind leaves no speed."""
    if drone.limits.slowest >= LEAST_SPEED_M_S:
        return []
    speed = drone.limits.slowest + wind
    labels = (
        origins.value(("world", "wind")),
        origins.value((*drone.path, "limits", "speed"), f"{what} `{drone.name}`"),
    )
    none, half = max(0.0, speed - LEAST_SPEED_M_S), speed / 2
    diagnostic = Diagnostic(
        "K011",
        f"the wind leaves {what} `{drone.name}` no speed",
        labels,
        (f"it flies {at_least(speed, 1)} m/s at most, and the wind takes {wind:.1f} m/s of that",),
        f"wait for wind below {min(none, half):.1f} m/s, which leaves it half its speed "
        f"({none:.1f} m/s leave it next to none), or, if it flies that, raise `limits.speed` to "
        f"{at_least(2.0 * wind, 1)} m/s",
    )
    return [diagnostic]


def toward(wind: WindSpec) -> float | None:
    """Return the yaw towards which the wind blows, rad, opposite to where it comes from."""
    return None if wind.from_ is None else yaw_of(wind.from_ + pi)


def rehearsal(written: RehearseSpec | None) -> Rehearsal | None:
    """Return the rehearsal that a mission asks for, or None."""
    if written is None:
        return None
    requirements = written.require
    return Rehearsal(
        promise=RehearsalPromise(
            requirements.in_frame,
            requirements.in_sight,
            requirements.mean_error,
            requirements.clearance,
            requirements.stray,
            requirements.of,
        ),
        path=("rehearse",),
        runs=written.runs,
        loop=written.loop,
        wind=None if written.wind is None else Wind(written.wind.speed, toward(written.wind)),
        gusts=written.gusts,
        gps=written.gps,
        wander=written.wander,
    )

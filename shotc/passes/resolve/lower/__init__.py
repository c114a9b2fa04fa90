"""Lowering: from a loaded mission to a MissionIR with all names, units, places, files and kinds resolved."""

from collections.abc import Callable, Collection, Mapping
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.ir.drone import Drone
from shotc.ir.framed_course import StartedFraming
from shotc.ir.ground import GroundHeight, flat
from shotc.ir.mission import Deferred, GeoOrigin, MissionIR, Zone
from shotc.ir.rules import Rules, TransitClearance
from shotc.ir.source import MissionSource
from shotc.kinds.base import Kind, placed
from shotc.passes.resolve.lower.earth import check_earth, geo_origin
from shotc.passes.resolve.lower.files import FileReader, Files, match_files
from shotc.passes.resolve.lower.ideals import with_framings, with_times
from shotc.passes.resolve.lower.music import MusicReading, music_of
from shotc.passes.resolve.lower.names import check_names, emitters_of, once
from shotc.passes.resolve.lower.obstacles import Obstacles, read_obstacles
from shotc.passes.resolve.lower.shots import Shots, ShotSurroundings, ShowMaterial, expand_shots
from shotc.passes.resolve.lower.slips import check_slips
from shotc.passes.resolve.lower.targets import Targets, targets
from shotc.passes.resolve.lower.terrain import read_terrain
from shotc.passes.resolve.lower.tracks import read_tracks
from shotc.passes.resolve.lower.world import PadSite, Put, drones, rehearsal, resolve_drone, toward, zones
from shotc.spec.drones import DroneSpec
from shotc.spec.load import LoadedMission
from shotc.spec.presets import RATE_HZ, SHOW_RATE_HZ, TRANSIT_FILMED_M, TRANSIT_OTHER_M
from shotc.spec.rehearse import WindSpec
from shotc.spec.rules import RulesSpec

if TYPE_CHECKING:
    from shotc.ir.terrain import Terrain

ANYWHERE = GeoOrigin(0.0, 0.0, 0.0)


class PartialMission(NamedTuple):
    """A mission as far as it can be resolved, and the faults of its text.

    courses : of its framings, in the order of the shots
    unplaced : whether its places on earth are too far from each other, or its ground is not known
    drones_valid : whether every drone can fly as written
    level : targets whose tracks are from files without heights
    """

    mission: MissionIR
    courses: tuple[StartedFraming, ...]
    faults: tuple[Diagnostic, ...]
    unplaced: bool
    drones_valid: bool
    level: frozenset[str]


def lowered(
    ir: LoadedMission,
    kinds: Mapping[str, Kind],
    emitters: Collection[str] | None,
    progress: Callable[[str], None],
) -> PartialMission:
    """Resolve a mission; kinds, emitters : as in ``Resolve``."""
    world = _world(ir)
    progress("expanding the shots")
    music = music_of(ir, world.files)
    shots = _shots(ir, world, kinds, music)
    show = _show(ir, world, shots, music)
    names = check_names(ir.spec, ir.origins, emitters)
    slips = check_slips(ir.spec, world.files.origin, ir.origins)
    faults = once([*world.faults, *music.faults, *slips, *names, *shots.diagnostics, *show.diagnostics])
    mission, courses = with_framings(with_times(_mission(ir, world, shots, show, music)))
    return PartialMission(mission, courses, tuple(faults), world.unplaced, world.drones_valid, world.level)


class _World(NamedTuple):
    """All data of a mission except its shots.

    put : converts a place into W
    read : reader of the files, with those that were read
    unplaced : whether its places on earth are too far from each other, or its ground is not known
    drones_valid : whether every drone can fly as written
    level : targets whose tracks are from files without heights
    heights : z of the ground at x and y
    terrain : of that ground, None where it is flat
    standing : the scene and the buildings
    """

    put: Put
    files: Files
    read: FileReader
    zones: tuple[Zone, ...]
    drones: Mapping[str, Drone]
    targets: Targets
    rules: Rules
    faults: tuple[Diagnostic, ...]
    unplaced: bool
    drones_valid: bool
    level: frozenset[str]
    heights: GroundHeight
    terrain: "Terrain | None"
    standing: Obstacles


def _shots(ir: LoadedMission, world: _World, kinds: Mapping[str, Kind], music: MusicReading) -> Shots:
    surroundings = ShotSurroundings(
        kinds,
        world.drones,
        world.targets.by_name,
        world.rules,
        world.files.origin or (ANYWHERE if world.unplaced else None),
        ir.origins,
        world.files.read,
        partial(match_files, ir.folder, ir.origins),
        world.heights,
        music.music,
    )
    return expand_shots(
        ir.spec, surroundings, lambda: resolve_drone("spare", DroneSpec(), world.put, WindSpec())
    )


def _show(ir: LoadedMission, world: _World, shots: Shots, music: MusicReading) -> ShowMaterial:
    """Return what fleets fly and draw; a mission without them loads none of it."""
    if not ir.spec.fleets:
        return ShowMaterial()
    from shotc.passes.resolve.lower.material import show_material

    return show_material(ir, PadSite(world.put, world.heights), world.files, shots.displays, music.song)


def _world(ir: LoadedMission) -> _World:
    spec, origins = ir.spec, ir.origins
    earth_faults = check_earth(spec, origins)
    origin = geo_origin(spec)
    read = FileReader(ir.folder, origins)
    files = Files(origin, origins, read)
    terrain = None if earth_faults else read_terrain(spec, partial(placed, origin or ANYWHERE, flat), files)
    if isinstance(terrain, Diagnostic):
        earth_faults = [*earth_faults, terrain]
    relief = None if isinstance(terrain, Diagnostic) else terrain
    heights = flat if relief is None else relief.z
    put = partial(placed, origin or ANYWHERE, heights)
    standing = Obstacles(unread=True) if earth_faults else read_obstacles(spec, put, relief, files)
    found_zones, zone_faults = zones(spec, put, relief, origins)
    found_drones, drone_faults = drones(spec, put, origins)
    tracks = read_tracks(spec, put, files)
    found_targets = targets(spec, put, tracks.tracks, standing, origins)
    return _World(
        put,
        files,
        read,
        found_zones,
        found_drones,
        found_targets,
        _rules(spec.rules),
        (
            *earth_faults,
            *standing.faults,
            *zone_faults,
            *drone_faults,
            *tracks.diagnostics,
            *found_targets.faults,
        ),
        unplaced=bool(earth_faults),
        heights=heights,
        terrain=relief,
        standing=standing,
        drones_valid=not has_errors(drone_faults),
        level=tracks.level,
    )


def _mission(
    ir: LoadedMission, world: _World, shots: Shots, show: ShowMaterial, music: MusicReading
) -> MissionIR:
    spec = ir.spec
    return MissionIR(
        name=spec.mission,
        origin=world.files.origin,
        wind=spec.world.wind.speed,
        zones=world.zones,
        targets=world.targets.bodies,
        drones=tuple(world.drones.values()),
        rules=world.rules,
        shots=shots.shots,
        rate=spec.output.rate or (SHOW_RATE_HZ if shots.displays and not shots.shots else RATE_HZ),
        emit=emitters_of(spec),
        source_sha256=ir.sha256,
        deferred=_each_once(shots.deferred),
        origins=ir.origins,
        fleets=show.fleets,
        displays=shots.displays,
        files=show.files,
        terrain=world.terrain,
        meshes=world.standing.meshes,
        groups=(*world.targets.groups, *shots.pictures),
        source=_source(ir, world.read, show),
        wind_toward=toward(spec.world.wind),
        rehearsal=rehearsal(spec.rehearse),
        music=music.music,
    )


def _source(ir: LoadedMission, read: FileReader, show: ShowMaterial) -> MissionSource:
    tables, linked = tuple(read.tables.items()), tuple(read.linked.items())
    return MissionSource(ir.text, tables, show.drawn, ir.chosen, linked)


def _rules(spec: RulesSpec) -> Rules:
    rules = Rules(spec.separation, spec.ground_clearance, spec.target_clearance)
    rules = rules._replace(
        transits=_transits(spec),
        max_height=spec.max_height,
        obstacle_clearance=spec.obstacle_clearance,
        look_ahead=spec.look_ahead,
    )
    visibility = spec.mutual_visibility
    if visibility is None:
        return rules
    return rules._replace(visibility=visibility.strength, half_angle=visibility.half_angle)


def _transits(spec: RulesSpec) -> TransitClearance:
    clearances = spec.transit_clearance
    filmed, other = (None, None) if clearances is None else (clearances.filmed, clearances.other)
    return TransitClearance(
        TRANSIT_FILMED_M if filmed is None else filmed,
        TRANSIT_OTHER_M if other is None else other,
        filmed is not None,
        other is not None,
    )


def _each_once(shots: tuple[Deferred, ...]) -> tuple[Deferred, ...]:
    """Return each feature once, at its first place; shots : what the kinds of shots found."""
    first: dict[str, Deferred] = {}
    for deferred in shots:
        first.setdefault(deferred.feature, deferred)
    return tuple(first.values())

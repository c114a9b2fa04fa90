"""resolve: LoadedMission to MissionIR.

Takes a mission whose shape is right. Gives every name, preset, unit, place and kind resolved, and
reports all that can be told without a solver. A fault silences only what depends on it: geometry and
timing are judged once all names and places stand.
"""

from collections.abc import Collection, Iterator, Mapping
from functools import partial
from typing import ClassVar, Final, NamedTuple

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors, stops
from shotc.ir.keyed import is_keyed
from shotc.ir.mission import Drone, GeoOrigin, MissionIR, Rules, Shot, Target, TransitClearance, Zone
from shotc.ir.origin import KeyPath
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.source import MissionSource
from shotc.kinds.base import Kind, placed
from shotc.passes.resolve.covered import covered
from shotc.passes.resolve.deferred import deferred_features
from shotc.passes.resolve.earth import check_earth, geo_origin
from shotc.passes.resolve.files import Ground, Reader, match_files
from shotc.passes.resolve.framing import check_framing
from shotc.passes.resolve.framings import with_framings
from shotc.passes.resolve.geometry import check_places
from shotc.passes.resolve.grammar import allowed, check_grammar
from shotc.passes.resolve.home import check_homes
from shotc.passes.resolve.ideals import check_ideal
from shotc.passes.resolve.keyed import check_carried, with_times
from shotc.passes.resolve.names import check_names, emitters_of, once
from shotc.passes.resolve.pads import check_pads
from shotc.passes.resolve.passers import passers_of
from shotc.passes.resolve.shots import Cast, Shots, expand_shots
from shotc.passes.resolve.show import Show, check_show, shown
from shotc.passes.resolve.timing import check_timing
from shotc.passes.resolve.tracks import read_tracks
from shotc.passes.resolve.world import Put, check_targets, drones, resolve_drone, targets, zones
from shotc.spec.drones import DroneSpec
from shotc.spec.load import LoadedMission
from shotc.spec.presets import RATE, SHOW_RATE, TRANSIT_FILMED, TRANSIT_OTHER
from shotc.spec.rules import RulesSpec

ANYWHERE = GeoOrigin(0.0, 0.0, 0.0)


class _World(NamedTuple):
    """All but the shots.

    put : puts a place into W; read : who reads the files, and has those that were read
    astray : whether its places on earth lie too far from each other
    sound : whether every drone can fly as it is written
    """

    put: Put
    ground: Ground
    read: Reader
    zones: tuple[Zone, ...]
    drones: Mapping[str, Drone]
    targets: Mapping[str, Target | None]
    rules: Rules
    faults: tuple[Diagnostic, ...]
    astray: bool
    sound: bool


class Resolve:
    """The pass.

    kinds : every shot kind that is installed, by name
    emitters : names of the emitters that are installed, or None where that is not known
    """

    name: ClassVar[str] = "resolve"

    def __init__(self, kinds: Mapping[str, Kind], emitters: Collection[str] | None = None) -> None:
        self.kinds: Final = kinds
        self.emitters: Final = emitters

    def run(self, ir: LoadedMission, ctx: PassContext) -> Outcome[MissionIR]:
        """Resolve one mission."""
        world = _world(ir)
        ctx.progress("expanding the shots")
        shots = self._shots(ir, world)
        show = shown(ir, world.put, world.ground, shots.displays)
        names = check_names(ir.spec, ir.origins, self.emitters)
        faults = once([*world.faults, *names, *shots.diagnostics, *show.diagnostics])
        mission, framings = with_framings(with_times(_mission(ir, world, shots, show)))
        faults += framings
        faults += _judged(ir, mission, world, order=not has_errors(faults))
        if not has_errors(faults):
            faults += [*check_grammar(mission, allowed(ir.spec)), *covered(mission)]
        return Outcome(None if stops(faults) else mission, tuple(faults))

    def _shots(self, ir: LoadedMission, world: _World) -> Shots:
        cast = Cast(
            self.kinds,
            world.drones,
            world.targets,
            world.rules,
            world.ground.origin or (ANYWHERE if world.astray else None),
            ir.origins,
            world.ground.read,
            partial(match_files, ir.folder, ir.origins),
        )
        return expand_shots(ir.spec, cast, lambda: resolve_drone("spare", DroneSpec(), world.put, 0.0))


def _world(ir: LoadedMission) -> _World:
    spec, origins = ir.spec, ir.origins
    astray = check_earth(spec, origins)
    origin = geo_origin(spec)
    put = partial(placed, origin or ANYWHERE)
    read = Reader(ir.folder, origins)
    ground = Ground(origin, origins, read)
    found_zones, zone_faults = zones(spec, put, origins)
    found_drones, drone_faults = drones(spec, put, origins)
    tracks, track_faults = read_tracks(spec, put, ground)
    found_targets = targets(spec, put, tracks)
    buried = [] if astray else check_targets(found_targets, origins)
    return _World(
        put,
        ground,
        read,
        found_zones,
        found_drones,
        found_targets,
        _rules(spec.rules),
        (*astray, *zone_faults, *drone_faults, *buried, *track_faults),
        astray=bool(astray),
        sound=not has_errors(drone_faults),
    )


def _mission(ir: LoadedMission, world: _World, shots: Shots, show: Show) -> MissionIR:
    spec = ir.spec
    return MissionIR(
        name=spec.mission,
        origin=world.ground.origin,
        wind=spec.world.wind,
        zones=world.zones,
        targets=tuple(t for t in world.targets.values() if t is not None),
        drones=tuple(world.drones.values()),
        rules=world.rules,
        shots=shots.shots,
        rate=spec.output.rate or (SHOW_RATE if shots.displays and not shots.shots else RATE),
        emit=emitters_of(spec),
        source_sha256=ir.sha256,
        deferred=deferred_features(spec, shots.deferred),
        origins=ir.origins,
        fleets=show.fleets,
        displays=shots.displays,
        files=show.files,
        source=MissionSource(ir.text, tuple(world.read.tables.items()), show.drawn, ir.chosen),
    )


def _judged(ir: LoadedMission, mission: MissionIR, world: _World, *, order: bool) -> list[Diagnostic]:
    """Return what can be told from numbers alone; ``order`` is whether names and waits all stand."""
    if world.astray:
        return []
    faults = [
        *_static_faults(mission, timing=world.sound, order=order),
        *check_pads(ir.spec, mission),
    ]
    if ir.spec.fleets:
        faults += check_show(mission, ir.spec, order=order and not has_errors(faults))
    return faults


def _rules(spec: RulesSpec) -> Rules:
    rules = Rules(spec.separation, spec.ground_clearance, spec.target_clearance)
    rules = rules._replace(transits=_transits(spec))
    visibility = spec.mutual_visibility
    if visibility is None:
        return rules
    return rules._replace(visibility=visibility.strength, half_angle=visibility.half_angle)


def _transits(spec: RulesSpec) -> TransitClearance:
    asked = spec.transit_clearance
    filmed, other = (None, None) if asked is None else (asked.filmed, asked.other)
    return TransitClearance(
        TRANSIT_FILMED if filmed is None else filmed,
        TRANSIT_OTHER if other is None else other,
        filmed is not None,
        other is not None,
    )


def _static_faults(mission: MissionIR, *, timing: bool, order: bool) -> list[Diagnostic]:
    """Return what is wrong with places and times.

    What a keyframe sees is judged where its place stands, a shot's time where all its places do, and
    the order of the shots where all shots and homes do.
    """
    ideals = (fault for shot in mission.shots for fault in check_ideal(mission, shot))
    homes = [*check_homes(mission), *ideals, *passers_of(mission)]
    places = [(shot, path, d) for shot in mission.shots for path, d in _places(mission, shot)]
    wrong = [(shot, path) for shot, path, d in places if has_errors([d])]
    faults = [*homes, *(d for _, _, d in places), *check_framing(mission, {path for _, path in wrong})]
    if timing:
        misplaced = {shot.path for shot, _ in wrong}
        sound = [shot for shot in mission.shots if shot.path not in misplaced]
        faults += check_timing(mission, sound, schedule=order and not homes and not wrong)
    return faults


def _places(mission: MissionIR, shot: Shot) -> Iterator[tuple[KeyPath, Diagnostic]]:
    """Yield what is wrong with the places of a shot's keyframes, with their lines."""
    yield from check_carried(mission, shot) if is_keyed(shot) else check_places(mission, shot)

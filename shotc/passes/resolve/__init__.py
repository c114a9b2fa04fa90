"""resolve: LoadedMission to MissionIR.

Takes a mission whose shape is right. Gives every name, preset, unit, place and kind resolved, and
reports all that can be told without a solver. A fault silences only what depends on it: geometry and
timing are judged once all names and places stand.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from functools import partial
from typing import ClassVar, Final

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors, stops
from shotc.ir.mission import GeoOrigin, MissionIR, Rules
from shotc.kinds.base import Kind, placed
from shotc.passes.base import Outcome, PassContext
from shotc.passes.resolve.deferred import deferred_features
from shotc.passes.resolve.earth import check_earth, geo_origin
from shotc.passes.resolve.files import Ground, match_files, read_file
from shotc.passes.resolve.framing import check_framing
from shotc.passes.resolve.geometry import check_places
from shotc.passes.resolve.grammar import allowed, check_grammar
from shotc.passes.resolve.home import check_homes
from shotc.passes.resolve.names import check_names, emitters_of, once
from shotc.passes.resolve.seldom import check_fleets, check_ideals, framed, shown, tracks_of
from shotc.passes.resolve.shots import Cast, expand_shots
from shotc.passes.resolve.timing import check_timing
from shotc.passes.resolve.world import check_targets, drones, resolve_drone, targets, zones
from shotc.spec.drones import DroneSpec
from shotc.spec.load import LoadedMission
from shotc.spec.presets import RATE, SHOW_RATE
from shotc.spec.rules import RulesSpec

ANYWHERE = GeoOrigin(0.0, 0.0, 0.0)


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
        spec, origins = ir.spec, ir.origins
        astray = check_earth(spec, origins)
        origin = geo_origin(spec)
        put = partial(placed, origin or ANYWHERE)
        found_zones, zone_faults = zones(spec, put, origins)
        found_drones, drone_faults = drones(spec, put, origins)
        rules = _rules(spec.rules)
        read = partial(read_file, ir.folder, origins)
        ground = Ground(origin, origins, read)
        tracks, track_faults = tracks_of(ir, put, ground)
        found_targets = targets(spec, put, tracks)
        ctx.progress("expanding the shots")
        cast = Cast(
            self.kinds,
            found_drones,
            found_targets,
            rules,
            origin or (ANYWHERE if astray else None),
            origins,
            read,
            partial(match_files, ir.folder, origins),
        )
        shots = expand_shots(spec, cast, lambda: resolve_drone("spare", DroneSpec(), put, 0.0))
        show = shown(ir, put, ground, shots.displays)
        faults = once(
            [
                *astray,
                *zone_faults,
                *drone_faults,
                *([] if astray else check_targets(found_targets, origins)),
                *track_faults,
                *check_names(spec, origins, self.emitters),
                *shots.diagnostics,
                *show.diagnostics,
            ]
        )
        mission = MissionIR(
            name=spec.mission,
            origin=origin,
            wind=spec.world.wind,
            zones=found_zones,
            targets=tuple(t for t in found_targets.values() if t is not None),
            drones=tuple(found_drones.values()),
            rules=rules,
            shots=shots.shots,
            rate=spec.output.rate or (SHOW_RATE if shots.displays and not shots.shots else RATE),
            emit=emitters_of(spec),
            source_sha256=ir.sha256,
            deferred=deferred_features(spec, shots.deferred),
            origins=origins,
            fleets=show.fleets,
            displays=shots.displays,
            files=show.files,
        )
        mission, framings = framed(mission)
        faults += framings
        faults += _static_faults(
            mission, geometry=not astray, timing=not drone_faults, order=not has_errors(faults)
        )
        if not astray:
            faults += check_fleets(mission, ir, order=not has_errors(faults))
        if not has_errors(faults):
            faults += check_grammar(mission, allowed(spec))
        return Outcome(None if stops(faults) else mission, tuple(faults))


def _rules(spec: RulesSpec) -> Rules:
    visibility = spec.mutual_visibility
    return Rules(
        spec.separation,
        spec.ground_clearance,
        spec.target_clearance,
        "prefer" if visibility is None else visibility.strength,
        None if visibility is None else visibility.half_angle,
    )


def _static_faults(mission: MissionIR, *, geometry: bool, timing: bool, order: bool) -> list[Diagnostic]:
    """Return what can be told from numbers alone; ``order`` is whether names and waits all stand.

    What a keyframe sees is judged where its place stands, a shot's time where all its places do, and
    the order of the shots where all shots and homes do.
    """
    if not geometry:
        return []
    homes = check_homes(mission)
    homes = [*homes, *check_ideals(mission)]
    places = [(shot, path, d) for shot in mission.shots for path, d in check_places(mission, shot)]
    wrong = [(shot, path) for shot, path, d in places if has_errors([d])]
    faults = [*homes, *(d for _, _, d in places), *check_framing(mission, {path for _, path in wrong})]
    if timing:
        misplaced = {shot.path for shot, _ in wrong}
        sound = [shot for shot in mission.shots if shot.path not in misplaced]
        faults += check_timing(mission, sound, schedule=order and not homes and not wrong)
    return faults

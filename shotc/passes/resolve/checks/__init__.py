"""Checks of a resolved mission without a solver. A fault suppresses only the checks that depend on it."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.ir.keyed import is_keyed
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.origin import KeyPath
from shotc.passes.resolve.checks.counted import check_counted
from shotc.passes.resolve.checks.covered import covered
from shotc.passes.resolve.checks.framing import check_framing
from shotc.passes.resolve.checks.framings import check_course
from shotc.passes.resolve.checks.grammar import allowed, check_grammar
from shotc.passes.resolve.checks.heights import Way, check_heights, check_reference, way_of
from shotc.passes.resolve.checks.home import check_homes
from shotc.passes.resolve.checks.ideals import check_ideal
from shotc.passes.resolve.checks.keyed import check_carried
from shotc.passes.resolve.checks.parked import check_parked
from shotc.passes.resolve.checks.passers import passers_of
from shotc.passes.resolve.checks.places import check_places
from shotc.passes.resolve.checks.safety import check_safety
from shotc.passes.resolve.checks.shake import check_shake
from shotc.passes.resolve.checks.terrain import check_covered, check_level
from shotc.passes.resolve.checks.timing import check_timing
from shotc.passes.resolve.checks.underground import check_underground
from shotc.passes.resolve.lower import PartialMission
from shotc.spec.load import LoadedMission


def check(ir: LoadedMission, partial: PartialMission) -> list[Diagnostic]:
    """Return the faults of a mission as written and as resolved, those of its names first."""
    mission = partial.mission
    if partial.unplaced and not has_errors(partial.faults):
        return list(partial.faults)  # the ground is not known, so nothing on it can be checked
    faults = [*partial.faults, *(d for course in partial.courses for d in check_course(mission, course))]
    if not partial.unplaced:
        faults += _judged(ir, partial, order=not has_errors(faults))
    if not has_errors(faults):
        faults += [*check_grammar(mission, allowed(ir.spec)), *covered(mission)]
    return faults


def _judged(ir: LoadedMission, partial: PartialMission, *, order: bool) -> list[Diagnostic]:
    """Return the faults of numbers; ``order`` is whether all names and dependencies are valid."""
    mission = partial.mission
    if unknown := list(check_counted(mission, ir.spec, partial.level)):
        return unknown
    faults = [
        *check_level(mission, ir.spec.world),
        *check_underground(mission, ir.spec, partial.level),
        *_static_faults(mission, timing=partial.drones_valid, order=order),
        *check_parked(ir.spec, mission),
    ]
    if ir.spec.fleets:
        from shotc.passes.resolve.checks.show import check_show

        faults += _shows_beside_meshes(mission)
        faults += check_show(mission, ir.spec, order=order and not has_errors(faults))
    return faults


def _static_faults(mission: MissionIR, *, timing: bool, order: bool) -> list[Diagnostic]:
    """Return the faults of places and times.

    The framing of a keyframe is checked where its place is valid, a shot's time where all its places are, and
    the order of the shots where all shots and homes are.
    """
    filmed = [(shot, way_of(mission, shot)) for shot in mission.shots]
    if beyond := [*check_covered(mission, filmed), *_shows_beyond(mission)]:
        return beyond
    beside = _beside_meshes(mission, filmed)
    ideals = (fault for shot, film in filmed for fault in check_ideal(mission, shot, film))
    homes = [*check_homes(mission), *check_safety(mission), *beside.homes, *ideals, *passers_of(mission)]
    places = [_PlaceFault(shot, *fault) for shot in mission.shots for fault in _places(mission, shot)]
    places += beside.places
    wrong = [fault for fault in places if has_errors([fault.diagnostic])]
    misplaced = {fault.shot.path for fault in wrong}
    faults = [*homes, *(d for shot, film in filmed for d in check_reference(mission, shot, film))]
    faults += [fault.diagnostic for fault in places]
    well_placed = [(shot, film) for shot, film in filmed if shot.path not in misplaced]
    faults += [d for shot, film in well_placed for d in check_heights(mission, shot, film)]
    faults += [d for shot, film in well_placed for d in check_shake(mission, shot, film)]
    faults += check_framing(mission, {fault.path for fault in wrong})
    if timing:
        faults += check_timing(
            mission, [shot for shot, _ in well_placed], schedule=order and not homes and not wrong
        )
    return faults


def _shows_beyond(mission: MissionIR) -> Iterator[Diagnostic]:
    """Yield the pads and the pictures of shows that are not above the terrain."""
    if mission.terrain is not None and (mission.fleets or mission.displays):
        from shotc.passes.resolve.checks.show.covered_by_terrain import check_show_covered

        yield from check_show_covered(mission)


class _PlaceFault(NamedTuple):
    """A fault of a place of a shot; path : that of its keyframe."""

    shot: Shot
    path: KeyPath
    diagnostic: Diagnostic


class _MeshFaults(NamedTuple):
    """Faults beside scenes and buildings: of homes, and of places of shots."""

    homes: tuple[Diagnostic, ...] = ()
    places: tuple[_PlaceFault, ...] = ()


def _beside_meshes(mission: MissionIR, filmed: Sequence[tuple[Shot, Way]]) -> _MeshFaults:
    if not mission.meshes:
        return _MeshFaults()
    from shotc.passes.resolve.checks.beside_meshes import check_homes_beside, check_shot_beside

    faults = ((shot, check_shot_beside(mission, shot, film)) for shot, film in filmed)
    places = tuple(_PlaceFault(shot, path, d) for shot, diagnosed in faults for path, d in diagnosed)
    return _MeshFaults(tuple(check_homes_beside(mission)), places)


def _shows_beside_meshes(mission: MissionIR) -> Iterator[Diagnostic]:
    """Yield the pads and the pictures of shows that are too near to scenes and buildings."""
    if not mission.meshes:
        return
    from shotc.passes.resolve.checks.show.beside_meshes import check_pads_beside, check_pictures_beside

    yield from check_pads_beside(mission)
    fleets = {fleet.name: fleet for fleet in mission.fleets}
    for display in mission.displays:
        if display.fleet in fleets:
            yield from check_pictures_beside(mission, display, fleets[display.fleet])


def _places(mission: MissionIR, shot: Shot) -> Iterator[tuple[KeyPath, Diagnostic]]:
    """Yield the faults of the places of a shot's keyframes, with their key paths."""
    yield from check_carried(mission, shot) if is_keyed(shot) else check_places(mission, shot)

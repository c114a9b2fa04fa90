"""What few missions have: tracks, shots on their own clock, fleets. Its modules load where a mission has it.

``check`` runs at every keystroke and commit, and most of its time is loading.
"""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, NamedTuple

from shotc.diag.model import Diagnostic
from shotc.ir.mission import MissionIR, Shot
from shotc.ir.source import KeptFiles
from shotc.kinds.base import Expansion, Scene
from shotc.passes.resolve.files import Ground
from shotc.passes.resolve.world import Put
from shotc.spec.load import LoadedMission
from shotc.spec.shot import ShotBase

if TYPE_CHECKING:
    from shotc.geom.track import Track
    from shotc.ir.show import Display, Fleet


def tracks_of(
    ir: LoadedMission, put: Put, ground: Ground
) -> "tuple[Mapping[str, Track], Iterable[Diagnostic]]":
    """Return the motion of every target that moves, and what is wrong with the others."""
    if all(target.track is None for target in ir.spec.targets.values()):
        return {}, ()
    from shotc.passes.resolve.tracks import read_tracks

    return read_tracks(ir.spec, put, ground)


def on_clock(shot: ShotBase, scene: Scene, given: Expansion) -> Expansion:
    """Return keyframes of what moves as a shot on its own clock."""
    from shotc.kinds import moving

    return moving.on_clock(shot, scene, given)


def framed(mission: MissionIR) -> tuple[MissionIR, list[Diagnostic]]:
    """Return the mission with the ideals of shots on their own clock, and what stands against them."""
    if any(shot.ideal is not None and shot.keyframes for shot in mission.shots):
        from shotc.passes.resolve.keyed import with_times

        mission = with_times(mission)
    if not any(shot.ideal is not None and shot.ideal.framed for shot in mission.shots):
        return mission, []
    from shotc.passes.resolve.framings import with_framings

    return with_framings(mission)


def keyed_times(mission: MissionIR, shot: Shot) -> list[Diagnostic]:
    """Return what is wrong with the times of a shot on its own clock that keyframes tell."""
    from shotc.passes.resolve.keyed import check_times

    return list(check_times(mission, shot))


def check_ideals(mission: MissionIR) -> list[Diagnostic]:
    """Return what is wrong with the shots on their own clock."""
    clocked = [shot for shot in mission.shots if shot.ideal is not None]
    if not clocked:
        return []
    from shotc.passes.resolve.ideals import check_ideal

    return [fault for shot in clocked for fault in check_ideal(mission, shot)]


def check_covered(mission: MissionIR) -> list[Diagnostic]:
    """Return where targets are within keep-out zones."""
    if not mission.targets or all(zone.keep == "in" for zone in mission.zones):
        return []
    from shotc.passes.resolve.covered import covered

    return list(covered(mission))


def check_passers(mission: MissionIR) -> list[Diagnostic]:
    """Return what comes over a pad while its drone stands there."""
    if all(target.track is None for target in mission.targets):
        return []
    from shotc.passes.resolve.passers import passers_of

    return list(passers_of(mission))


class Show(NamedTuple):
    """Fleets whose layouts can be read, the files that displays draw, and what is wrong with the others.

    files : (name, bytes); drawn : (name, SHA-256) of the same
    """

    fleets: "tuple[Fleet, ...]" = ()
    files: tuple[tuple[str, bytes], ...] = ()
    drawn: tuple[tuple[str, str], ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()


def shown(ir: LoadedMission, put: Put, ground: Ground, displays: "tuple[Display, ...]") -> Show:
    """Resolve the fleets, and read what their displays draw."""
    if not ir.spec.fleets:
        return Show()
    from shotc.passes.resolve.show import digests, fleets_of, not_kept, read_material

    fleets, wrong = fleets_of(ir.spec, put, ground)
    if isinstance(ir.folder, KeptFiles):
        return Show(fleets, (), ir.folder.drawn, (*wrong, *not_kept(displays, ir.folder, ir.origins)))
    files, missing = read_material(displays, ir.folder, ir.origins)
    return Show(fleets, files, digests(files), (*wrong, *missing))


def check_fleets(mission: MissionIR, ir: LoadedMission, *, order: bool) -> list[Diagnostic]:
    """Return what is wrong with what fleets display."""
    if not ir.spec.fleets:
        return []
    from shotc.passes.resolve.show import check_show

    return check_show(mission, ir.spec, order=order)

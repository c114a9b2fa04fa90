"""The lowering of the mission in a plan, with planning's choices.

A plan holds the mission's text and the tables that it names. So verification takes the requirements from the
mission itself, and does not rely on what the plan states about it.
"""

from collections.abc import Callable, Mapping
from itertools import cycle
from pathlib import Path
from typing import Any

from shotc import plugins
from shotc.checking import models_of
from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.ir.keyframes import KeyframeIR, Lowered
from shotc.ir.passes import PassContext
from shotc.ir.source import Autopilot, Chosen, KeptFiles, MissionSource, flown_by, kept_files
from shotc.passes.resolve.lower.names import AUTO
from shotc.pipeline import FRONT, PassSettings, passes_of, run
from shotc.source.file import SourceFile
from shotc.spec.load import LoadedMission, load


def lower_kept(source: MissionSource, name: str, folders: tuple[Path, ...] = ()) -> Lowered:
    """Lower the mission in a plan.

    name : in messages; folders : searched in order for the files that the plan links to
    """
    return lower(source.text, name, kept_files(source, folders), source.chosen)


def lower(data: bytes, name: str, folder: Path | KeptFiles | None, chosen: Chosen) -> Lowered:
    """Lower a mission by the front passes, which need no solver.

    data, name, folder : as in ``spec.load.load``
    chosen : planning's choices, such as the drones of shots with `drone: auto`
    """
    kinds = plugins.shot_kinds()
    loaded = load(data, name, folder, models_of(kinds.plugins), kinds.unusable)
    diagnostics = list(loaded.diagnostics)
    mission = None if loaded.mission is None else _with_chosen(loaded.mission, chosen, diagnostics)
    if mission is None or has_errors(diagnostics):
        return _stopped(diagnostics, loaded.file)
    return _placed(mission, kinds.plugins, loaded.file, chosen.autopilot)


def lower_for_flights(
    data: bytes, name: str, folder: Path | None, filmed: Callable[[], Mapping[str, str]]
) -> Lowered:
    """Lower a mission for the verification of flights by other tools.

    filmed : returns the drones of the shots that the flight files name; called if the mission leaves a drone
        open
    Shots that no file names are assigned to drones in turn, idle ones first; no flight is compared with them.
    """
    kinds = plugins.shot_kinds()
    mission = load(data, name, folder, models_of(kinds.plugins), kinds.unusable).mission
    chosen = Chosen()
    shots = [] if mission is None else [shot.id for shot in mission.spec.shots if shot.drone == AUTO]
    if mission is not None and shots and mission.spec.drones:
        busy = {shot.drone for shot in mission.spec.shots}
        known, turn = filmed(), cycle(sorted(mission.spec.drones, key=busy.__contains__))
        chosen = Chosen(tuple((shot, known.get(shot) or next(turn)) for shot in shots))
    return lower(data, name, folder, chosen)


def _placed(
    mission: LoadedMission, kinds: Mapping[str, Any], file: SourceFile, autopilot: Autopilot | None
) -> Lowered:
    front = run(passes_of(FRONT, PassSettings(kinds)), mission, PassContext())
    if not isinstance(front.value, KeyframeIR) or has_errors(front.diagnostics):
        return _stopped(front.diagnostics, file)
    return Lowered(with_autopilot(front.value, autopilot), (), file)


def _stopped(diagnostics: Any, file: SourceFile) -> Lowered:
    return Lowered(None, tuple(d for d in diagnostics if has_errors([d])), file)


def _with_chosen(mission: LoadedMission, chosen: Chosen, diagnostics: list[Diagnostic]) -> LoadedMission:
    """Return the mission with the chosen drones; append a diagnostic for each shot without one."""
    drones = dict(chosen.drones)
    shots = mission.spec.shots
    left = {i: shot.id for i, shot in enumerate(shots) if shot.drone == AUTO}
    for i in (i for i, name in left.items() if name not in drones):
        label = mission.origins.value(("shots", i, "drone"))
        text = f"the plan does not say which drone films shot `{left[i]}`"
        diagnostics.append(Diagnostic("V042", text, (label,), help="plan the mission again"))
    filled = tuple(
        shot.model_copy(update={"drone": drones.get(shot.id, AUTO)}) if i in left else shot
        for i, shot in enumerate(shots)
    )
    used = Chosen(tuple((name, drones[name]) for name in left.values() if name in drones))
    return mission._replace(spec=mission.spec.model_copy(update={"shots": filled}), chosen=used)


def with_smoothing(keyframes: KeyframeIR, seconds: float | None) -> KeyframeIR:
    """Return the mission with another smoothing time of all its shots, if one is given."""
    if seconds is None:
        return keyframes
    mission = keyframes.mission
    tried = mission._replace(shots=tuple(shot._replace(smoothing=seconds) for shot in mission.shots))
    placed = tuple(p._replace(shot=p.shot._replace(smoothing=seconds)) for p in keyframes.shots)
    return keyframes._replace(mission=tried, shots=placed)


def with_autopilot(keyframes: KeyframeIR, autopilot: Autopilot | None) -> KeyframeIR:
    """Return the mission with one autopilot for every drone, if one is given.

    Emitters for other autopilots are replaced by those for this one.
    """
    if autopilot is None:
        return keyframes
    mission = keyframes.mission
    drones = tuple(drone._replace(autopilot=autopilot) for drone in mission.drones)
    source = mission.source._replace(chosen=mission.source.chosen._replace(autopilot=autopilot))
    emit = flown_by(autopilot, mission.emit)
    return keyframes._replace(mission=mission._replace(drones=drones, source=source, emit=emit))

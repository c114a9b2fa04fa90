"""Names that shots use: their existence, uniqueness, and cycles of dependencies."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any

from shotc.diag.model import Diagnostic
from shotc.ir.origin import KeyPath, OriginMap
from shotc.ir.source import TAKES
from shotc.spec.mission import MissionSpec
from shotc.spec.presets import EMIT, LARGE_OUTPUTS, MANY_DRONES, PRESETS, SHOW_EMIT
from shotc.spec.shot import NO_DRONE
from shotc.spec.words import nearest

AUTO = "auto"
_UNKNOWN = ("N001", "N002", "N003")
_SHOWN_PLACES = 4  # labels of one unknown name


def emitters_of(spec: MissionSpec) -> tuple[str, ...]:
    """Return the emitters that a mission asks for, or by default those that suit its drones."""
    if spec.output.emit is not None:
        return spec.output.emit
    displays = [shot for shot in spec.shots if shot.kind == "display"]
    emitters = _show_emitters(spec) if displays else ()
    filmed = _film_emitters(spec) if len(displays) < len(spec.shots) or not displays else ()
    return tuple(dict.fromkeys((*filmed, *emitters)))


def _show_emitters(spec: MissionSpec) -> tuple[str, ...]:
    drones = sum(fleet.count for fleet in spec.fleets.values())
    return SHOW_EMIT if drones <= MANY_DRONES else tuple(n for n in SHOW_EMIT if n not in LARGE_OUTPUTS)


def _film_emitters(spec: MissionSpec) -> tuple[str, ...]:
    machines = dict.fromkeys(TAKES[PRESETS[drone.model].autopilot][0] for drone in spec.drones.values())
    # Without a place on earth there are no mission files to write.
    flown = () if spec.world.origin is None else tuple(machines) or ("mavlink",)
    return tuple(name for each in EMIT for name in (flown if each == "mavlink" else (each,)))


def check_names(spec: MissionSpec, origins: OriginMap, emitters: Collection[str] | None) -> list[Diagnostic]:
    """Return all faults of the names of drones, shots and emitters; kinds check their targets.

    emitters : names of usable emitters, or None where these are not known
    """
    faults = [*nobody(spec, origins), *_drones(spec, origins), *_ids(spec, origins), *_waits(spec, origins)]
    for i, name in enumerate(emitters_of(spec)):
        if emitters is not None and name not in emitters:
            path = ("output", "emit", i)
            faults.append(_unknown("N005", "emitter", name, dict.fromkeys(emitters), origins, path))
    return faults


def once(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return diagnostics with an unknown name that occurs in several places reported once."""
    groups: dict[tuple[str, str], list[Diagnostic]] = {}
    for i, diagnostic in enumerate(dict.fromkeys(diagnostics)):
        key = diagnostic.message if diagnostic.code in _UNKNOWN else str(i)
        groups.setdefault((diagnostic.code, key), []).append(diagnostic)
    return [_merged(group) if len(group) > 1 else group[0] for group in groups.values()]


def _merged(group: list[Diagnostic]) -> Diagnostic:
    """Return one diagnostic for the same unknown name in different places."""
    ordered = sorted(group, key=lambda diagnostic: diagnostic.sort_key)
    first, *others = dict.fromkeys(diagnostic.labels[0] for diagnostic in ordered)
    labels = (first, *(label._replace(text="here, too") for label in others[: _SHOWN_PLACES - 1]))
    notes = (f"it stands in {1 + len(others)} places",) if len(others) >= _SHOWN_PLACES else ()
    return group[0]._replace(labels=labels, notes=(*group[0].notes, *notes))


def nobody(spec: MissionSpec, origins: OriginMap) -> list[Diagnostic]:
    """Return the fault of a mission without drones in which a shot leaves its drone open."""
    if spec.drones:
        return []
    first = [("shots", i, "drone") for i, shot in enumerate(spec.shots) if shot.drone == AUTO][:1]
    help_ = "define drones under `drones`"
    message = "there is no drone to choose from"
    return [Diagnostic("K014", message, (origins.value(path),), help=help_) for path in first]


def _drones(spec: MissionSpec, origins: OriginMap) -> list[Diagnostic]:
    return [
        _unknown("N002", "drone", shot.drone, spec.drones, origins, ("shots", i, "drone"))
        for i, shot in enumerate(spec.shots)
        if shot.drone not in (AUTO, NO_DRONE) and shot.drone not in spec.drones
    ]


def _ids(spec: MissionSpec, origins: OriginMap) -> list[Diagnostic]:
    faults: list[Diagnostic] = []
    first: dict[str, int] = {}
    for i, shot in enumerate(spec.shots):
        if shot.id not in first:
            first[shot.id] = i
            continue
        labels = (
            origins.value(("shots", i, "id")),
            origins.value(("shots", first[shot.id], "id"), "the first shot of this name"),
        )
        message = f"two shots are called `{shot.id}`"
        help_ = f"call this one something else, such as `{shot.id}-{i + 1}`"
        faults.append(Diagnostic("N006", message, labels, help=help_))
    return faults


def _waits(spec: MissionSpec, origins: OriginMap) -> list[Diagnostic]:
    """Return dependencies on shots that do not exist, and each cycle of dependencies once."""
    index = {shot.id: i for i, shot in reversed(list(enumerate(spec.shots)))}
    waits = {shot.id: shot.timing.after for shot in spec.shots}
    faults: list[Diagnostic] = []
    reported: set[str] = set()
    for i, shot in enumerate(spec.shots):
        after = shot.timing.after
        if after is None:
            continue
        path = ("shots", i, "timing", "after")
        if after not in index:
            others = {name: None for name in index if name != shot.id}
            faults.append(_unknown("N004", "shot", after, others, origins, path))
            continue
        # Two shots of one name can make a false cycle; then the name is the fault.
        circle = _circle(shot.id, waits) if len(waits) == len(spec.shots) else []
        if circle and reported.isdisjoint(circle):
            reported.update(circle)
            chain = " after ".join(f"`{name}`" for name in (*circle, circle[0]))
            labels = tuple(origins.value(("shots", index[name], "timing", "after")) for name in circle)
            message = (
                "shots wait for each other in a circle" if len(circle) > 1 else "a shot waits for itself"
            )
            faults.append(Diagnostic("N007", message, labels, (chain,), "drop one `after`"))
    return faults


def _circle(start: str, waits: dict[str, str | None]) -> list[str]:
    """Return the cycle of dependencies that ``start`` is part of, or nothing."""
    chain = [start]
    while (following := waits.get(chain[-1])) is not None and following not in chain:
        chain.append(following)
    return chain if following == start else []


def _unknown(
    code: str, what: str, name: str, known: dict[str, Any], origins: OriginMap, path: KeyPath
) -> Diagnostic:
    help_ = nearest(name, known) if known else f"the mission has no other {what}"
    return Diagnostic(code, f"unknown {what} `{name}`", (origins.value(path),), help=help_)

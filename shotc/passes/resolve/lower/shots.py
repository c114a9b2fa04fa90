"""Shots: their kinds expanded to keyframes, with timing, pace and promises."""

from collections.abc import Callable, Iterator, Mapping
from math import isfinite
from typing import TYPE_CHECKING, Any, NamedTuple

from shotc.diag.model import Diagnostic, Label
from shotc.diag.plugin_faults import plugin_failed
from shotc.ir.drone import Drone
from shotc.ir.ground import Above, GroundHeight, flat
from shotc.ir.limits import Timing
from shotc.ir.mission import Deferred, GeoOrigin, Ideal, Keyframe, Shot, Subject
from shotc.ir.music import Music
from shotc.ir.origin import KeyPath, OriginMap
from shotc.ir.promise import Promise
from shotc.ir.rules import Rules
from shotc.ir.target import Target
from shotc.kinds import moving
from shotc.kinds.base import Expansion, Kind, Scene, unknown_target
from shotc.spec.heights import Altitude
from shotc.spec.mission import MissionSpec
from shotc.spec.shot import NO_DRONE, ShotBase

if TYPE_CHECKING:  # missions without these features do not load them
    from shotc.ir.show import Display, Fleet
    from shotc.spec.shot import RequireSpec


class ShotSurroundings(NamedTuple):
    """The data that all shots of a mission share: a scene without the shot.

    drones : by name
    targets : by name, None where a track cannot be used
    """

    kinds: Mapping[str, Kind]
    drones: Mapping[str, Drone]
    targets: Mapping[str, Target | None]
    rules: Rules
    origin: GeoOrigin | None
    origins: OriginMap
    read: Callable[[str, KeyPath], bytes | Diagnostic]
    match: Callable[[str, KeyPath], tuple[str, ...] | Diagnostic]
    ground: GroundHeight = flat
    music: Music | None = None


class Shots(NamedTuple):
    """Shots with keyframes, displays of fleets, and the diagnostics of the others.

    pictures : of fleets, those that have names, as targets
    """

    shots: tuple[Shot, ...]
    displays: "tuple[Display, ...]"
    diagnostics: tuple[Diagnostic, ...]
    deferred: tuple[Deferred, ...]
    pictures: tuple[Target, ...] = ()


class ShowMaterial(NamedTuple):
    """Fleets with readable layouts, the files that displays draw, and the faults of the others.

    files : (name, bytes), the song among them
    drawn : (name, SHA-256) of the drawn files
    """

    fleets: "tuple[Fleet, ...]" = ()
    files: tuple[tuple[str, bytes], ...] = ()
    drawn: tuple[tuple[str, str], ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()


def expand_shots(spec: MissionSpec, surroundings: ShotSurroundings, spare: Callable[[], Drone]) -> Shots:
    """Expand every shot; one without a valid drone is checked with the drone of ``spare`` and left out."""
    written = [(("shots", i), shot) for i, shot in enumerate(spec.shots)]
    shown = [
        _expand(spec, shot, surroundings, spare(), path) for path, shot in written if shot.drone == NO_DRONE
    ]
    diagnostics = [d for expansion in shown for d in expansion.diagnostics]
    deferred = [d for expansion in shown for d in expansion.deferred]
    displays = [expansion.display for expansion in shown if expansion.display is not None]
    # Cameras may film the pictures of any display by their names.
    pictures: Mapping[str, Target | None] = {}
    if shown:
        from shotc.passes.resolve.lower.named_pictures import named_pictures, unread_names

        pictures, wrong = named_pictures(spec, displays, surroundings)
        targets = {**unread_names(spec, displays), **surroundings.targets, **pictures}
        surroundings = surroundings._replace(targets=targets)
        diagnostics += wrong
    shots: list[Shot] = []
    for path, shot in written:
        if shot.drone == NO_DRONE:
            continue
        drone = surroundings.drones.get(shot.drone)
        expansion = _expand(spec, shot, surroundings, drone or spare(), path)
        diagnostics += [*_wrong_names(spec, shot, surroundings, path), *expansion.diagnostics]
        deferred += expansion.deferred
        if (expansion.keyframes or expansion.ideal) and drone is not None:
            shots.append(_shot(spec, shot, expansion, path))
    targets_of_pictures = tuple(target for target in pictures.values() if target is not None)
    return Shots(tuple(shots), tuple(displays), tuple(diagnostics), tuple(deferred), targets_of_pictures)


def _expand(
    spec: MissionSpec, shot: ShotBase, surroundings: ShotSurroundings, drone: Drone, path: KeyPath
) -> Expansion:
    scene = Scene(
        drone=drone,
        rules=surroundings.rules,
        composition=shot.composition or spec.rules.composition,
        targets=surroundings.targets,
        path=path,
        origins=surroundings.origins,
        origin=surroundings.origin,
        read=surroundings.read,
        match=surroundings.match,
        pace=spec.rules.pace,
        fleets={name: fleet.groups for name, fleet in spec.fleets.items()},
        ground=surroundings.ground,
        music=surroundings.music,
    )
    kind = surroundings.kinds[shot.kind]
    expansion = expanded(kind, shot, scene) if kind.foreign else kind.expand(shot, scene)
    if not _moves(expansion.keyframes, surroundings.targets):
        return expansion
    return moving.on_clock(shot, scene, expansion)


def _moves(keyframes: tuple[Keyframe, ...], targets: Mapping[str, Target | None]) -> bool:
    """Return whether a keyframe films a moving target, or has its place beside one."""
    names = {k.target for k in keyframes} | {k.beside.target for k in keyframes if k.beside is not None}
    subjects = (targets.get(name) for name in names if name is not None)
    return any(target is not None and target.track is not None for target in subjects)


def _shot(spec: MissionSpec, shot: ShotBase, expansion: Expansion, path: KeyPath) -> Shot:
    timing = shot.timing
    return Shot(
        id=shot.id,
        kind=shot.kind,
        drone=shot.drone,
        subject=shot.target,
        keyframes=expansion.keyframes,
        timing=Timing(timing.start, timing.after, timing.duration or expansion.duration),
        pace=shot.pace or spec.rules.pace,
        promise=_promise(shot.require),
        refine_optional=shot.refine is not None and shot.refine.optional,
        path=path,
        ideal=expansion.ideal,
        subjects=expansion.subjects,
        size=shot.size,
        allow=tuple(dict.fromkeys((*spec.rules.allow, *shot.allow))),
        above=_above(shot),
        smoothing=shot.smoothing or spec.rules.smoothing,
        focus=shot.focus,
        photos=None if shot.photos is None else shot.photos.every,
    )


def _wrong_names(
    spec: MissionSpec, shot: ShotBase, surroundings: ShotSurroundings, path: KeyPath
) -> Iterator[Diagnostic]:
    """Yield the faults of a shot's target and focus: an unknown target, or a focus without an aperture."""
    origins, targets = surroundings.origins, surroundings.targets
    if shot.target is not None and shot.target not in targets:
        yield unknown_target(origins, (*path, "target"), shot.target, targets)
    where = (*path, "focus")
    if isinstance(shot.focus, str) and shot.focus not in targets:
        yield unknown_target(origins, where, shot.focus, targets)
    elif shot.focus is not None:
        yield from _without_aperture(spec, shot, origins.value(where))


def _without_aperture(spec: MissionSpec, shot: ShotBase, label: Label) -> Iterator[Diagnostic]:
    """Yield the fault of a focus if the camera of the shot's drone has no aperture."""
    drone = spec.drones.get(shot.drone)
    if drone is not None and drone.camera.aperture is None:
        yield Diagnostic(
            "K021",
            f"shot `{shot.id}` has a `focus`, but the camera of `{shot.drone}` has no aperture",
            (label,),
            ("the depth of field follows from the aperture",),
            f"write `camera: {{aperture: f/2.8}}` of `{shot.drone}`, or take `focus` out",
        )


def _above(shot: ShotBase) -> Above | None:
    """Return the reference of a camera's altitude, where the shot's kind has one."""
    altitude = getattr(shot, "altitude", None)
    return (altitude.above or "target") if isinstance(altitude, Altitude) else None


def _promise(written: "RequireSpec | None") -> Promise:
    if written is None:
        return Promise()
    reveal = None if written.reveal is None else (written.reveal.from_, written.reveal.to)
    return Promise(written.in_frame, written.screen_error, written.size, written.visible, reveal)


def expanded(kind: Kind, shot: ShotBase, scene: Scene) -> Expansion:
    """Return the expansion of a shot by a kind of another package, or P008 on the line of the kind."""
    try:
        expansion: Any = kind.expand(shot, scene)
        wrong = _wrong(expansion)
    except Exception as fault:  # noqa: BLE001  a plugin may raise anything
        return _refused(kind, scene, fault)
    return _refused(kind, scene, wrong) if wrong else expansion


def _refused(kind: Kind, scene: Scene, fault: Exception | str) -> Expansion:
    label = scene.origins.value((*scene.path, "kind"))
    return Expansion(diagnostics=(plugin_failed(f"kind `{kind.name}`", kind.package, fault, label),))


def _wrong(result: Any) -> str:
    """Return what is wrong with the form of an expansion; an empty text if nothing is."""
    if not isinstance(result, Expansion):
        return f"returned a {type(result).__name__}, not an Expansion"
    parts: Any = ((result.keyframes, Keyframe), (result.subjects, Subject), (result.diagnostics, Diagnostic))
    for items, record in parts:
        if not isinstance(items, tuple) or not all(isinstance(item, record) for item in items):
            return f"returned something else than {record.__name__}s in a tuple"
    ideal: Any = result.ideal
    if not isinstance(ideal, Ideal | None):
        return f"returned a {type(ideal).__name__} as its ideal"
    if not all(isfinite(number) for number in _numbers((result.keyframes, result.ideal, result.duration))):
        return "returned a number that is not finite"
    if not (result.keyframes or result.ideal or result.display or result.diagnostics or result.deferred):
        return "returned no keyframe, and does not say why"
    return ""


def _numbers(value: Any) -> Iterator[float]:
    if isinstance(value, float):
        yield value
    elif isinstance(value, tuple):
        for item in value:
            yield from _numbers(item)

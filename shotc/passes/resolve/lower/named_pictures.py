"""Pictures of fleets that cameras film by their names: targets that are no obstacles."""

from collections.abc import Iterable, Mapping
from math import cos, sin
from typing import TYPE_CHECKING

from shotc.diag.model import Diagnostic
from shotc.geom.shapes import BoxShape, CylinderShape
from shotc.ir.limits import Vec3
from shotc.ir.origin import OriginMap
from shotc.ir.show import Box, Model, Picture, Sphere, Torus, fleet_name
from shotc.ir.target import Target
from shotc.passes.resolve.lower.fleets import apart_of
from shotc.spec.mission import MissionSpec
from shotc.spec.shot import NO_DRONE

if TYPE_CHECKING:
    from shotc.geom.shapes import BodyShape
    from shotc.ir.show import Display
    from shotc.passes.resolve.lower.shots import ShotSurroundings


def named_pictures(
    spec: MissionSpec, displays: "Iterable[Display]", surroundings: "ShotSurroundings"
) -> tuple[Mapping[str, Target | None], list[Diagnostic]]:
    """Return the named pictures as targets, None for one of unknown size, and their faults."""
    targets: dict[str, Target | None] = {}
    faults: list[Diagnostic] = []
    for display in displays:
        for picture in (p for p in display.pictures if p.name is not None):
            name, where = str(picture.name), (*picture.path, "name")
            if name in surroundings.targets or name in targets:
                label = surroundings.origins.value(where)
                help_ = f"write `name: {name}-2`"
                faults.append(Diagnostic("D129", f"there are two targets `{name}`", (label,), help=help_))
                continue
            body = _body(picture, _allowance(spec, display))
            targets[name] = None if body is None else Target(name, body[0], body[1], where)
            if body is None:
                faults.append(_without_size(surroundings.origins, picture))
    return targets, faults


def unread_names(spec: MissionSpec, displays: "Iterable[Display]") -> Mapping[str, None]:
    """Return the picture names of invalid displays, so that a shot that films one is no fault."""
    read = {display.id for display in displays}
    wrong = (shot for shot in spec.shots if shot.drone == NO_DRONE and shot.id not in read)
    # Frames are of the kind's own model; frames of an animation alone have no names.
    frames = (frame for shot in wrong for frame in getattr(shot, "frames", ()))
    names = (getattr(frame, "name", None) for frame in frames)
    return {name: None for name in names if name is not None}


def _allowance(spec: MissionSpec, display: "Display") -> float:
    """Return how far lights may lie outside of the picture, metres: half of their least distance."""
    fleet, least = spec.fleets.get(fleet_name(display.fleet)), spec.rules.separation
    return 0.5 * (least if fleet is None else apart_of(fleet, least).across)


def _body(picture: Picture, allowance: float) -> "tuple[Vec3, BodyShape] | None":
    """Return the centre and the shape of the body that contains a picture, or None where its size is unknown.

    allowance : metres beyond the picture, on each side
    """
    source, more = picture.source, 2.0 * allowance
    if picture.size is not None and source.centre is not None:
        width, depth, height = picture.size
        ahead = NORTH if isinstance(source, Sphere) else _ahead(source.heading)
        return source.centre, BoxShape(depth + more, width + more, height + more, ahead)
    if isinstance(source, Sphere):
        return source.centre, CylinderShape(source.radius + allowance, 2.0 * source.radius + more)
    if isinstance(source, Box):
        width, depth, height = source.size
        return source.centre, BoxShape(depth + more, width + more, height + more, _ahead(source.heading))
    if isinstance(source, Torus):
        rim = source.radius + source.tube
        depth = source.radius * abs(cos(source.tilt)) + source.tube
        up = source.radius * abs(sin(source.tilt)) + source.tube
        return source.centre, BoxShape(
            2.0 * depth + more, 2.0 * rim + more, 2.0 * up + more, _ahead(source.heading)
        )
    return None


NORTH = (0.0, 1.0)


def _ahead(heading: float) -> tuple[float, float]:
    return (sin(heading), cos(heading))


def _without_size(origins: OriginMap, picture: Picture) -> Diagnostic:
    label = origins.value((*picture.path, "name"))
    note = "its size is known only when the show is planned, too late for the cameras that frame it"
    message, help_ = (
        f"nothing says how large `{picture.name}` is",
        "say its `size`, as [width, depth, height]",
    )
    if isinstance(picture.source, Model) and picture.source.centre is None:
        message, help_ = f"nothing says where `{picture.name}` is", "say the `center` of the model"
    return Diagnostic("D130", message, (label,), (note,), help_)

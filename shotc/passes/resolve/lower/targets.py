"""Targets: bodies with their shapes put into W, and groups of those that make one picture."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import cos, sin
from typing import TYPE_CHECKING, NamedTuple

from shotc.diag.model import Diagnostic
from shotc.geom.shapes import BodyShape, BoxShape, CylinderShape, GroupShape, Part
from shotc.geom.vec import Vec3, minus
from shotc.ir.origin import OriginMap
from shotc.ir.target import Target
from shotc.kinds.base import stands, unknown_target
from shotc.passes.resolve.lower.world import Put
from shotc.spec.mission import MissionSpec
from shotc.spec.world import TargetSpec

if TYPE_CHECKING:  # a mission of cameras loads none of it
    from shotc.geom.track import Track


class Targets(NamedTuple):
    """The targets by name, None for one whose track or whose parts cannot be used, and what is wrong."""

    found: Mapping[str, Target | None]
    faults: tuple[Diagnostic, ...]


def targets(spec: MissionSpec, put: Put, tracks: Mapping[str, Track], origins: OriginMap) -> Targets:
    """Return the bodies, then the groups."""
    found: dict[str, Target | None] = {}
    faults: list[Diagnostic] = []
    for name, target in spec.targets.items():
        if target.parts is None:
            found[name] = _body(name, target, put, tracks.get(name))
            faults += _sideways(name, target, origins)
    for name, target in spec.targets.items():
        if target.parts is not None:
            wrong = list(_wrong_parts(spec, name, target.parts, origins))
            parts = [found.get(part) for part in target.parts]
            bodies = [part for part in parts if part is not None]
            found[name] = _group(name, bodies) if len(bodies) == len(parts) and not wrong else None
            faults += wrong
    return Targets(found, tuple(faults))


def _body(name: str, target: TargetSpec, put: Put, track: Track | None) -> Target | None:
    """Return a body; one without a height stands on the ground."""
    shape: BodyShape
    if target.size is None:
        assert target.radius is not None
        shape = CylinderShape(target.radius, target.tall)
    else:
        # A box that stands lies by its heading, a compass bearing; one that moves by its course.
        shape = BoxShape(*target.size, (sin(target.heading or 0.0), cos(target.heading or 0.0)))
    path = ("targets", name)
    if track is not None:
        yaw = track.heading(0.0)
        return Target(name, track.at(0.0), shape.facing((cos(yaw), sin(yaw))), path, track)
    if target.at is None:
        return None
    x, y, z = put(target.at)
    return Target(name, (x, y, z + shape.height / 2) if stands(target.at) else (x, y, z), shape, path)


def _group(name: str, bodies: list[Target]) -> Target:
    """Return bodies that stand as one target, about the middle of what they take of the world."""
    sides = [(b.shape.half_width((1.0, 0.0)), b.shape.half_width((0.0, 1.0)), b.height / 2) for b in bodies]
    reaches = list(zip([b.centre for b in bodies], sides, strict=True))
    middle = [
        (min(c[k] - r[k] for c, r in reaches) + max(c[k] + r[k] for c, r in reaches)) / 2 for k in range(3)
    ]
    centre: Vec3 = (middle[0], middle[1], middle[2])
    parts = tuple(
        Part(minus(b.centre, centre), b.shape) for b in bodies if not isinstance(b.shape, GroupShape)
    )
    names = tuple(b.name for b in bodies)
    return Target(name, centre, GroupShape(parts), ("targets", name), parts=names)


def _wrong_parts(
    spec: MissionSpec, name: str, parts: tuple[str, ...], origins: OriginMap
) -> Iterator[Diagnostic]:
    """Yield what cannot be a part of a group: it is not defined, moves, is a group, or stands there twice."""
    bodies = {other: None for other, target in spec.targets.items() if target.parts is None}
    rest = [part for part in dict.fromkeys(parts) if part in bodies and spec.targets[part].track is None]
    for i, part in enumerate(parts):
        path = ("targets", name, "parts", i)
        if part not in spec.targets:
            yield unknown_target(origins, path, part, bodies)
        elif part not in rest or part in parts[:i]:
            why = "it is one already" if part in rest else "it moves, and parts stand"
            why = why if part in bodies else "it is itself a group"
            labels = (origins.value(path), origins.key(("targets", part), "defined here"))
            help_ = f"write `parts: [{', '.join(rest)}]`"
            few = "name two or more targets that stand, each once; a framing films several that move as one"
            message = f"`{part}` cannot be a part of target `{name}`"
            yield Diagnostic("G041", message, labels, (why,), few if len(rest) < 2 else help_)


def _sideways(name: str, target: TargetSpec, origins: OriginMap) -> Iterator[Diagnostic]:
    """Tell of a box that moves and is wider than long: sizes of zones begin with the width."""
    if target.track is None or target.size is None or target.size[1] <= target.size[0]:
        return
    length, width, height = target.size
    path = ("targets", name, "size")
    note = f"it is {length:g} m long, the way it goes, {width:g} m wide and {height:g} m high"
    help_ = (
        f"write `size: [{width:g}, {length:g}, {height:g}]` if it goes lengthways: [length, width, height]"
    )
    yield Diagnostic("G040", f"target `{name}` goes sideways", (origins.value(path),), (note,), help_)

"""Targets: bodies with their shapes in W, and groups of bodies."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import count
from math import cos, sin
from typing import TYPE_CHECKING, NamedTuple

from shotc.diag.model import Diagnostic
from shotc.geom.enclosing import EnclosingShape
from shotc.geom.shapes import BodyShape, BoxShape, CylinderShape, GroupShape, Part
from shotc.geom.vec import Vec3, minus
from shotc.ir.origin import OriginMap
from shotc.ir.target import Target
from shotc.kinds.base import stands, unknown_target
from shotc.passes.resolve.lower.built_targets import bodies_of_building
from shotc.passes.resolve.lower.obstacles import Obstacles
from shotc.passes.resolve.lower.world import Put
from shotc.spec.mission import MissionSpec
from shotc.spec.world import TargetSpec

if TYPE_CHECKING:  # missions without these features do not load them
    from shotc.geom.track import Track


class Targets(NamedTuple):
    """The targets, and their faults.

    by_name : by name, None for one whose track, parts or building cannot be used
    boxes : bodies of buildings with several bodies; they have no names of their own in the mission
    """

    by_name: Mapping[str, Target | None]
    boxes: tuple[Target, ...]
    faults: tuple[Diagnostic, ...]

    @property
    def bodies(self) -> tuple[Target, ...]:
        """Those that stand or move."""
        return (*(t for t in self.by_name.values() if t is not None and not t.parts), *self.boxes)

    @property
    def groups(self) -> tuple[Target, ...]:
        """Those with several bodies."""
        return tuple(t for t in self.by_name.values() if t is not None and t.parts)


def targets(
    spec: MissionSpec, put: Put, tracks: Mapping[str, Track], standing: Obstacles, origins: OriginMap
) -> Targets:
    """Return the bodies and groups; standing : the buildings and the scene."""
    known = Targets(dict.fromkeys(spec.targets), (), ())
    for name, target in spec.targets.items():
        if target.building is not None:
            known = _with_building(known, name, bodies_of_building(spec, name, standing, origins), spec)
        elif target.parts is None:
            body = {name: _body(name, target, put, tracks.get(name))}
            known = known._replace(
                by_name={**known.by_name, **body}, faults=(*known.faults, *_sideways(name, target, origins))
            )
    for name, target in spec.targets.items():
        if target.parts is not None:
            wrong = tuple(_wrong_parts(spec, name, target.parts, origins))
            parts = [known.by_name.get(part) for part in target.parts]
            whole = [part for part in parts if part is not None]
            group = None
            if len(whole) == len(parts) and not wrong:
                group = _group(name, [body for part in whole for body in _its(part, known.boxes)])
            known = known._replace(by_name={**known.by_name, name: group}, faults=(*known.faults, *wrong))
    return known


def _with_building(
    targets: Targets, name: str, shapes: tuple[EnclosingShape, ...] | Diagnostic | None, spec: MissionSpec
) -> Targets:
    """Return targets with a building; one with several bodies is a group."""
    if shapes is None or isinstance(shapes, Diagnostic):
        return targets._replace(faults=targets.faults if shapes is None else (*targets.faults, shapes))
    path = ("targets", name)
    if len(shapes) == 1:
        own = Target(name, shapes[0].centre, shapes[0].shape, path)
        return targets._replace(by_name={**targets.by_name, name: own})
    boxes = [
        Target(own, body.centre, body.shape, path)
        for own, body in zip(_box_names(name, shapes, spec), shapes, strict=True)
    ]
    return targets._replace(
        by_name={**targets.by_name, name: _group(name, boxes)}, boxes=(*targets.boxes, *boxes)
    )


def _box_names(name: str, shapes: tuple[EnclosingShape, ...], spec: MissionSpec) -> Iterator[str]:
    """Yield names for the bodies of a building: those of its parts where they are usable, else numbers."""
    parts = Counter(body.name for body in shapes)
    numbers = (own for own in (f"{name}.{i}" for i in count(1)) if own not in spec.targets)
    for body in shapes:
        own = f"{name}.{body.name}"
        usable = _PART.fullmatch(body.name) and parts[body.name] == 1 and own not in spec.targets
        yield own if usable else next(numbers)


_PART = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,30}")


def _its(target: Target, boxes: tuple[Target, ...]) -> list[Target]:
    """Return the bodies of a target."""
    return [box for box in boxes if box.name in target.parts] if target.parts else [target]


def _body(name: str, target: TargetSpec, put: Put, track: Track | None) -> Target | None:
    """Return a body; one without a height stands on the ground."""
    shape: BodyShape
    if target.size is None:
        assert target.radius is not None
        shape = CylinderShape(target.radius, target.tall)
    else:
        # A standing box is oriented by its heading, a compass bearing; a moving one by its course.
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
    """Return bodies that stand as one target, with its centre in the middle of their bounding box."""
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
    """Yield invalid parts of a group: not defined, moving, a group itself, or named twice."""
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
    """Yield the warning of a moving box that is wider than long, because sizes of zones begin with
    the width.
    """
    if target.track is None or target.size is None or target.size[1] <= target.size[0]:
        return
    length, width, height = target.size
    path = ("targets", name, "size")
    note = f"it is {length:g} m long, the way it goes, {width:g} m wide and {height:g} m high"
    help_ = (
        f"write `size: [{width:g}, {length:g}, {height:g}]` if it goes lengthways: [length, width, height]"
    )
    yield Diagnostic("G040", f"target `{name}` goes sideways", (origins.value(path),), (note,), help_)

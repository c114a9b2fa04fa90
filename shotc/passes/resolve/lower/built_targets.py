"""Targets that are buildings: found by a name or an id, enclosed by few boxes and cylinders. Plain Python."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from shotc.diag.model import Diagnostic
from shotc.geom.enclosing import EnclosingShape, UprightPrism, bodies_about
from shotc.ir.origin import OriginMap
from shotc.passes.resolve.lower.obstacles import Obstacles
from shotc.spec.mission import MissionSpec
from shotc.spec.words import closest

if TYPE_CHECKING:  # missions without these do not load numpy
    from shotc.ir.obstacle_mesh import ObstacleMesh

MOST_BODIES = 8
"""Most bodies of one target, which is the limit of a group's parts."""
_LISTED_NAMES = 5  # names in a diagnostic


class _Candidate(NamedTuple):
    """A candidate of a target: a building, a part of one, or a part of a scene.

    called : its name and its ids
    own : numbers of its prisms, or of the part of its mesh
    mesh : the scene that it is a part of
    """

    called: tuple[str, ...]
    own: frozenset[int]
    mesh: ObstacleMesh | None = None

    def blocks(self, standing: Obstacles) -> tuple[UprightPrism, ...]:
        """Return its prisms in W, without those outside of the terrain."""
        if self.mesh is not None:
            return tuple(self.mesh.block(part) for part in self.own)
        its = [standing.standing[i] for i in sorted(self.own)]
        return tuple(UprightPrism(h.ring, z + h.bottom, z + h.top, h.name) for h, z in its if z is not None)

    def described(self, building: str, standing: Obstacles) -> str:
        """Return its other names and its position, as a note."""
        sort = "a building" if self.mesh is None else "a part of the scene"
        blocks = self.blocks(standing)
        x, y = blocks[0].ring[0] if blocks else (0.0, 0.0)
        where = f"at [{x:.0f}, {y:.0f}]" if blocks else "beyond the terrain"
        return f"{sort}{''.join(f' `{name}`' for name in self.called if name != building)} {where}"


def bodies_of_building(
    spec: MissionSpec, name: str, standing: Obstacles, origins: OriginMap
) -> tuple[EnclosingShape, ...] | Diagnostic | None:
    """Return the bodies of the target ``name``, which is a building, or its fault.

    None where the files that contain it cannot be used, which is reported for these.
    """
    building = (spec.targets[name].building or "").strip()
    label = (origins.value(("targets", name, "building")),)
    if spec.world.buildings is None and spec.world.scene is None:
        message = f"target `{name}` is a building, and the mission names no file of buildings"
        help_ = (
            "give the file under `world` as `buildings: {file: ...}`, or say where it stands: `at` and `size`"
        )
        return Diagnostic("G050", message, label, help=help_)
    matching = _candidates(building, standing)
    if len(matching) > 1:
        return _ambiguous(building, matching, standing)._replace(labels=label)
    if matching:
        blocks = matching[0].blocks(standing)
        beyond = Diagnostic("G048", f"`{building}` stands beyond the terrain", label, help=_COVER)
        return bodies_about(blocks, MOST_BODIES) if blocks else beyond
    if standing.unread:
        return None
    return _unknown(spec, building, standing)._replace(labels=label)


_COVER = "take an elevation model that covers it"


def _candidates(name: str, standing: Obstacles) -> list[_Candidate]:
    """Return the candidates with a name; if a building and a part of it have it, only the building."""
    matching = [named for named in _all(standing) if name in named.called]
    largest: list[_Candidate] = []
    for named in sorted(matching, key=lambda n: -len(n.own)):
        if not any(named.mesh is other.mesh and named.own <= other.own for other in largest):
            largest.append(named)
    return largest


def _all(standing: Obstacles) -> Iterator[_Candidate]:
    """Yield all candidates."""
    called: dict[int, tuple[str, ...]] = {}
    own: dict[int, list[int]] = {}
    for i, (house, _) in enumerate(standing.standing):
        for feature in house.features:
            called[feature.number] = feature.called
            own.setdefault(feature.number, []).append(i)
    yield from (_Candidate(called[number], frozenset(houses)) for number, houses in own.items())
    for mesh in standing.meshes:
        if mesh.kind == "scene":
            yield from (_Candidate((name,), frozenset([i]), mesh) for i, name in enumerate(mesh.names))


def _ambiguous(building: str, matching: list[_Candidate], standing: Obstacles) -> Diagnostic:
    notes = tuple(named.described(building, standing) for named in matching[:_LISTED_NAMES])
    others = [name for named in matching for name in named.called if name != building]
    help_ = f"write `building: {others[0]}` if that one is meant" if others else "give each a name of its own"
    return Diagnostic("G049", f"{len(matching)} buildings are called `{building}`", (), notes, help_)


def _unknown(spec: MissionSpec, building: str, standing: Obstacles) -> Diagnostic:
    files = [place.file for place in (spec.world.buildings, spec.world.scene) if place is not None]
    names = [named.called[0] for named in _all(standing) if named.called]
    every = {name: None for named in _all(standing) for name in named.called}
    close = closest(building, every)
    listed = ", ".join(f"`{name}`" for name in sorted(dict.fromkeys(names), key=_words_first)[:_LISTED_NAMES])
    more = len(set(names)) - _LISTED_NAMES
    note = f"there are {listed}" + (f" and {more} more" if more > 0 else "")
    help_ = f"did you mean `{close}`?" if close else "write the `name` or the id that the file gives it"
    message = f"{' and '.join(f'`{file}`' for file in files)} has no building `{building}`"
    return Diagnostic("G048", message, (), (note,) if listed else ("none of them has a name",), help_)


def _words_first(name: str) -> tuple[bool, str]:
    """Return a sort key that puts names before ids, which contain digits."""
    return any(c.isdigit() for c in name), name

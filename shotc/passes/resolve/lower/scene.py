"""A mesh or a point cloud as obstacles in W. This module needs numpy, so it is imported where one is
named.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from math import cos, sin
from pathlib import PurePosixPath
from typing import NamedTuple

import numpy as np

from shotc.diag.model import Diagnostic, Label
from shotc.geom.bernstein import Array
from shotc.geom.surface.cloud import cloud_of, median_spacing
from shotc.geom.surface.ground import height_at
from shotc.geom.surface.inside import bodies
from shotc.geom.surface.tree import surface_of
from shotc.ir.limits import Vec3
from shotc.ir.obstacle_mesh import ObstacleMesh
from shotc.ir.terrain import Terrain
from shotc.kinds.base import bad_file
from shotc.kinds.earth import FARTHEST_M
from shotc.kinds.files import FileFault
from shotc.kinds.models import cloud_file, mesh_file
from shotc.kinds.models.endings import METRES
from shotc.kinds.models.parts import ModelFault, NodePart, wrong_corners
from shotc.passes.resolve.lower.files import Files
from shotc.passes.resolve.lower.obstacles import SCENE, Obstacles
from shotc.requirements import remedy
from shotc.rounding import up
from shotc.spec.world import SceneSpec
from shotc.units import LARGEST

MOST_TRIANGLES = 4_000_000
LARGEST_COORDINATE = 1e9
"""In the file's unit; beyond it a file is invalid in any unit."""
EXACT_M = 1e4
"""Metres from a file's origin up to which 32-bit numbers are accurate to half a millimetre."""
SINGLE = frozenset({"glb", "stl"})
"""Formats with 32-bit coordinates; in .ply the header states the type."""
LEAST_M, LARGE_M = 0.5, 3_000.0
"""Longest side of a scene: below the first it is smaller than a drone, above the second probably a
mistake.
"""
USUAL_M = (3.0, 1_000.0)
"""Usual longest sides of scenes, for the choice of a unit that is proposed."""
_LIKELY = ("m", "mm", "ft", "cm", "in", "km")
BELOW_M = 0.5
"""Depth in the ground of a corner that rounding of the scene's position does not explain."""
UNDER_GROUND_SHARE = 0.4
"""Share of corners at that depth, above which there is a warning; half of them if a house lies on its
side.
"""
_SAMPLED_CORNERS = 10_000  # most corners that are compared with the ground


_DOUBLES = re.compile(rb"^property\s+(double|float64)\s+x\s*$", re.MULTILINE)


class SceneReading(NamedTuple):
    """How a file is read: its format, its unit in metres, and the axis that points up."""

    kind: str
    metres: float
    up: str


def scene_mesh(
    written: SceneSpec, data: bytes, where: tuple[SceneReading, Vec3], terrain: Terrain | None, files: Files
) -> Obstacles:
    """Return a file's triangles and points in W, or their faults.

    where : how the file is read, and the position of its origin in W, metres
    """
    placed, at = where
    parts = _read_model(placed.kind, data)
    fault = parts if isinstance(parts, ModelFault) else wrong_corners(parts, LARGEST_COORDINATE)
    if isinstance(fault, ModelFault):
        return Obstacles(faults=(_unusable(written, fault, files),))
    assert isinstance(parts, list)
    scene = _PlacedScene(written, placed, at, files)
    wrong = next(iter((*scene.of_no_size(parts), *scene.inexact(data, parts), *scene.away(parts))), None)
    if wrong is not None:
        return Obstacles(faults=(wrong,))
    mesh = scene.mesh(parts)
    if isinstance(mesh, ModelFault):
        return Obstacles(faults=(_unusable(written, mesh, files),))
    return Obstacles((mesh,), tuple(scene.doubts(parts, terrain)))


def _unusable(written: SceneSpec, fault: ModelFault, files: Files) -> Diagnostic:
    if fault.library:
        label = (files.origins.value(SCENE),)
        return Diagnostic("P004", fault.message, label, help=remedy([fault.library]))
    return bad_file(files.origins, SCENE, written.file, FileFault(fault.message, fault.line, fault.help))


class _PlacedScene(NamedTuple):
    """A scene as written, and its position."""

    written: SceneSpec
    placed: SceneReading
    at: Vec3
    files: Files

    def inexact(self, data: bytes, parts: list[NodePart]) -> Iterator[Diagnostic]:
        """Yield the fault of 32-bit coordinates that are so large that rounding is notable."""
        single = self.placed.kind in SINGLE or (
            self.placed.kind == "ply" and not _DOUBLES.search(data[:2000])
        )
        most = max(float(np.abs(p.corners).max()) for p in parts if len(p.corners))
        if not single or most * self.placed.metres <= EXACT_M:
            return
        grain = float(np.spacing(np.float32(most))) * self.placed.metres
        low, high = _box(parts)
        notes = [f"it holds 32-bit numbers, and they reach {most:.7g} {self._unit}"]
        help_ = _moved(low, high)
        size = float((high - low).max()) * self.placed.metres
        if size > LARGE_M:
            notes.append(f"the scene measures {_length(size)}")
            help_ = f"{self._fitting(size)}; if it is so large, {help_}"
        message = f"the coordinates of `{self.written.file}` are rounded to {grain:.2g} m"
        yield Diagnostic("G033", message, self._label, tuple(notes), help_)

    def of_no_size(self, parts: list[NodePart]) -> Iterator[Diagnostic]:
        """Yield the fault of a scene that is smaller than a drone, or larger than the range of a mission."""
        low, high = _box(parts)
        size = float((high - low).max()) * self.placed.metres
        if not LEAST_M <= size <= FARTHEST_M:
            message = f"the scene `{self.written.file}` measures {_length(size)}"
            yield Diagnostic("G031", message, self._label, (self._says(low, high),), self._fitting(size))

    def away(self, parts: list[NodePart]) -> Iterator[Diagnostic]:
        """Yield the fault of a scene that is out of the mission's range."""
        low, high = _box(parts)
        corners = self._world(np.array([low, high]))
        middle, foot = corners.mean(axis=0), float(corners[:, 2].min())
        distance = float(np.linalg.norm(middle[:2]) - 0.5 * self.placed.metres * np.linalg.norm(high - low))
        if distance > FARTHEST_M:
            message = (
                f"the scene `{self.written.file}` is {distance / 1000:.1f} km away from the world's origin"
            )
            onto_origin = np.array(self.at) - [*middle[:2], foot]
            help_ = (
                f"write where it stands: {_key(onto_origin)} puts it on the world's origin"
                if float(np.abs(onto_origin).max()) <= LARGEST["length"]
                else _moved(low, high)
            )
            yield Diagnostic("G031", message, self._label, (self._says(low, high),), help_)

    def mesh(self, parts: list[NodePart]) -> ObstacleMesh | ModelFault:
        """Return the triangles of all parts in W; points are triangles without size."""
        stem = PurePosixPath(self.written.file).stem
        solid = [p for p in parts if len(p.triangles)]
        loose = [p for p in parts if len(p.corners) and not len(p.triangles)]
        clouds = [cloud_of(self._world(p.corners)) for p in loose]
        pieces = [self._world(p.corners)[p.triangles] for p in solid]
        pieces += [c.surface.triangles for c in clouds]
        count = sum(map(len, pieces))
        if count > MOST_TRIANGLES:
            message = f"it has {count} triangles; {MOST_TRIANGLES} are the most"
            return ModelFault(message, "thin it, or cut it to the mission")
        half = max((0.5 * median_spacing(c.surface) + c.moved for c in clouds), default=0.0)
        lengths = [len(piece) for piece in pieces]
        whole = np.concatenate(pieces)
        solids = bodies(whole[: sum(lengths[: len(solid)])])  # points enclose no volume, and there are many
        points = np.full(sum(lengths[len(solid) :]), len(solids.closed))
        return ObstacleMesh(
            kind="scene",
            file=self.written.file,
            surface=clouds[0].surface if clouds and not pieces[1:] else surface_of(whole),
            part=np.repeat(np.arange(len(pieces)), lengths),
            names=tuple(p.name or stem for p in (*solid, *loose)),
            body=np.concatenate([solids.body, points]),
            closed=np.append(solids.closed, [False]),
            spacing=half,
        )

    def doubts(self, parts: list[NodePart], terrain: Terrain | None) -> Iterator[Diagnostic]:
        """Yield warnings for a scene whose size, or height above ground, looks like a mistake."""
        low, high = _box(parts)
        size = float((high - low).max()) * self.placed.metres
        if size > LARGE_M:
            message = f"the scene `{self.written.file}` measures {_length(size)}"
            help_ = f"{self._fitting(size)}, unless it is so large"
            yield Diagnostic("G030", message, self._label, (self._unit_says(),), help_)
        over = self._over(parts, terrain)
        under = float(np.mean(over < -BELOW_M))
        if under > UNDER_GROUND_SHARE:
            every = self._over(parts, terrain, most=None)
            yield self._under_ground(under, every, self._other_axis(parts, terrain))

    def _under_ground(self, under: float, over: Array, other: str | None) -> Diagnostic:
        """Return the fault of a scene that lies under the ground, or the doubt about one that mostly does.

        under : the share that does; over : heights above the ground, metres; other : the axis that puts it
            above the ground if it points up, or None
        """
        low, high = float(over.min()), float(over.max())
        x, y, z = self.at
        lift = _key(np.array([x, y, z + up(-low, 1)]))
        top = f"{high:.1f} m above it" if high > 0.0 else f"{-high:.1f} m below it"
        ways_out = [f"write {lift}, which raises it by {up(-low, 1):.1f} m"]
        if other is not None:
            ways_out.insert(0, f"write `up: {other}` if that axis points up")
        whole = high < BELOW_M
        return Diagnostic(
            "G051" if whole else "G032",
            f"the scene `{self.written.file}` lies below the ground"
            if whole
            else f"{100 * under:.0f} % of the scene `{self.written.file}` lies under the ground",
            self._label,
            (f"it reaches from {-low:.1f} m below the ground to {top}, with `up: {self.placed.up}`",),
            ", or ".join((*ways_out, *(("turn it over in the program that made it",) if whole else ()))),
        )

    def _over(
        self, parts: list[NodePart], terrain: Terrain | None, most: int | None = _SAMPLED_CORNERS
    ) -> Array:
        """Return the heights above the ground of about so many corners, or of all, metres."""
        corners = np.concatenate([p.corners for p in parts if len(p.corners)])
        some = self._world(corners[:: 1 if most is None else max(1, len(corners) // most)])
        ground = np.zeros(len(some)) if terrain is None else height_at(terrain.ground, some[:, :2])
        return np.asarray(some[:, 2] - np.nan_to_num(ground))

    def _other_axis(self, parts: list[NodePart], terrain: Terrain | None) -> str | None:
        """Return the other axis, if the scene is above the ground where that one points up, or None."""
        other = "z" if self.placed.up == "y" else "y"
        turned = self._replace(placed=self.placed._replace(up=other))._over(parts, terrain)
        return other if float(np.mean(turned < -BELOW_M)) <= UNDER_GROUND_SHARE else None

    def _world(self, corners: Array) -> Array:
        """Return positions of the file as positions in W; its north points along the heading."""
        x, y, z = (self.placed.metres * corners).T
        if self.placed.up == "y":
            y, z = -z, y
        north, east = cos(self.written.heading), sin(self.written.heading)
        return np.column_stack([x * north + y * east, y * north - x * east, z]) + self.at

    @property
    def _label(self) -> tuple[Label, ...]:
        return (self.files.origins.value(SCENE),)

    @property
    def _unit(self) -> str:
        return self.written.units or "m"

    def _unit_says(self) -> str:
        return f"`units: {self._unit}`" if self.written.units else "its format is in metres"

    def _says(self, low: Array, high: Array) -> str:
        return f"its coordinates go from {_rounded(low)} to {_rounded(high)} {self._unit}"

    def _fitting(self, size: float) -> str:
        """Return which unit gives the scene a usual size, as a remedy."""
        bare = size / self.placed.metres
        least, most = USUAL_M
        fits = [unit for unit in _LIKELY if least <= bare * METRES[unit] <= most]
        if not fits:
            return "export it again in metres"
        return f"write `units: {fits[0]}`, which makes it {_length(bare * METRES[fits[0]])}"


def _box(parts: list[NodePart]) -> tuple[Array, Array]:
    """Return the lowest and the highest coordinates of a file."""
    filled = [p.corners for p in parts if len(p.corners)]
    low = np.min([corners.min(axis=0) for corners in filled], axis=0)
    return np.asarray(low), np.asarray(np.max([corners.max(axis=0) for corners in filled], axis=0))


def _moved(low: Array, high: Array) -> str:
    """Return as a remedy how a file with large coordinates is exported."""
    middle = _rounded(0.5 * (low + high))
    return f"export it with {middle} taken off, and write as `at` where that place is in the mission"


def _rounded(place: Array) -> str:
    return f"[{', '.join(f'{c:.6g}' for c in place + 0.0)}]"


def _key(place: Array) -> str:
    """Return a place as the key `at`, to 0.1 m."""
    return f"`at: [{', '.join(f'{c:.1f}' for c in np.round(place, 1) + 0.0)}]`"


def _length(metres: float) -> str:
    if metres >= 1000.0:
        return f"{metres / 1000:.3g} km"
    return f"{metres:.3g} m" if metres >= 1.0 else f"{100 * metres:.3g} cm"


def _read_model(kind: str, data: bytes) -> list[NodePart] | ModelFault:
    """Return the parts of a file, or its fault. The bytes may be anything.

    kind : the ending of its name, one of ``endings.ENDINGS``
    """
    return cloud_file.read_cloud(kind, data) if kind in cloud_file.KINDS else mesh_file.read_mesh(kind, data)

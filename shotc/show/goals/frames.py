"""The frames of a model source: every file at its place, all with one scale and rotation."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from math import log10

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.show import Model
from shotc.show.goals.body import Fill, PlacedShape, SourceFault, upright_axes
from shotc.show.goals.model import mesh_body, open_edges
from shotc.show.goals.model_file import ModelMesh, UnreadableModel, read_model

LARGEST_M = 1000.0
"""Largest extent of a picture, metres; a larger file must be in another unit."""
UNITS = (("mm", 1e-3), ("cm", 1e-2), ("in", 0.0254), ("ft", 0.3048))
LIKELY_M = 20.0
"""Typical extent of pictures, metres; of the plausible units the one nearest to it is proposed."""
LEAP_RATIO = 5.0
"""Largest factor between the extents of consecutive frames in one unit."""


def model_bodies(source: Model, files: Mapping[str, bytes], fill: Fill) -> list[PlacedShape] | SourceFault:
    """Return the body of every frame at its place in W, or the fault of the first faulty one."""
    meshes: list[ModelMesh] = []
    for name in source.files:
        mesh = read_model(name, files[name], source.up)
        if isinstance(mesh, UnreadableModel):
            return SourceFault("D050", "files", f"model `{name}` cannot be drawn", (mesh.note,), mesh.help)
        fault = _open(name, mesh) if fill == "volume" else None
        if fault is not None:
            return fault
        meshes.append(mesh)
    fault = _uneven(source, meshes) or _out_of_scale(source, meshes[0])
    if fault is not None:
        return fault
    place = _FileToWorld(source, meshes[0].corners)
    if source.height is not None and not np.ptp(meshes[0].corners[:, 2]) > 0:
        message = f"model `{source.files[0]}` is flat and cannot be scaled to a `height`"
        return SourceFault("D050", "height", message, ("all of its points are level",), "leave `height` out")
    return [mesh_body(ModelMesh(place.of(m.corners), m.triangles, m.colors)) for m in meshes]


class _FileToWorld:
    """Maps a file's coordinates to W, about the middle of the first frame's bounding box."""

    def __init__(self, source: Model, first: Array) -> None:
        low, high = first.min(axis=0), first.max(axis=0)
        self._middle = (low + high) / 2.0
        self._scale = (
            source.unit if source.height is None else source.height / max(float(high[2] - low[2]), 1e-300)
        )
        self._axes = upright_axes(source.heading)
        self._centre = source.unit * self._middle if source.centre is None else np.array(source.centre)

    def of(self, corners: Array) -> Array:
        return np.asarray(self._centre + self._scale * (corners - self._middle) @ self._axes)


def _open(name: str, mesh: ModelMesh) -> SourceFault | None:
    number = open_edges(mesh)
    if not number:
        return None
    note = f"{number} of its edges {'have' if number > 1 else 'has'} a face on one side only"
    help_ = "use `fill: surface`, or close the mesh"
    return SourceFault("D051", "files", f"mesh `{name}` is not closed, so it has no inside", (note,), help_)


def _uneven(source: Model, meshes: list[ModelMesh]) -> SourceFault | None:
    sizes = [float(np.linalg.norm(np.ptp(m.corners, axis=0))) for m in meshes]
    for k, (one, other) in enumerate(pairwise(sizes)):
        factor = max(one, other) / min(one, other)
        if factor > LEAP_RATIO:
            names = source.files[k : k + 2]
            message = f"frames `{names[0]}` and `{names[1]}` differ in size by a factor of {factor:.3g}"
            note = f"their bounding boxes are {one:.4g} and {other:.4g} across, corner to corner"
            return SourceFault("D053", "files", message, (note,), "export all frames in one unit and scale")
    return None


def _out_of_scale(source: Model, mesh: ModelMesh) -> SourceFault | None:
    size = source.unit * np.ptp(mesh.corners, axis=0)
    largest = float(size.max())
    if source.height is not None or largest <= LARGEST_M:
        return None
    unit, factor = min(UNITS, key=lambda u: abs(log10(u[1] / source.unit * largest / LIKELY_M)))
    message = f"model `{source.files[0]}` is {largest:.5g} m large"
    likely = factor / source.unit
    note = f"were it in {unit}, it would be {largest * likely:.3g} m large"
    tall = max(float(size[2]) * likely, 1.0)
    help_ = f"write `units: {unit}`, or say how tall it is to be, such as `height: {tall:.3g}`"
    return SourceFault("D052", "units", message, (note,), help_)

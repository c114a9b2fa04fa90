"""mission.glb: the world and the animated cameras as binary glTF 2.0, which Blender and browsers open.

Y is up in glTF, so x, y, z are East, Up, South of W. Zoom animates the camera's ``yfov`` with
KHR_animation_pointer. Format: registry.khronos.org/glTF/specs/2.0.
"""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass, field
from math import atan, degrees, tan
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from shotc import __version__
from shotc.emit.attitude import upright
from shotc.emit.base import Artifact, Emission
from shotc.emit.cameras import without_fleets
from shotc.emit.previs.film_set import (
    FAR_M,
    NEAR_M,
    CameraSamples,
    FilmSet,
    Paint,
    SceneBody,
    frames_note,
    scene_of,
)
from shotc.geom.bernstein import Array
from shotc.ir.trajectory import VerifiedIR

FILE = "mission.glb"
POINTER = "KHR_animation_pointer"
FLOAT, UNSIGNED = 5126, 5125
VERTICES, INDICES = 34962, 34963
POINTS, LINE_STRIP, TRIANGLES = 0, 3, 4
ROUGHNESS_SHARE = 0.9
SHAPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}


@dataclass(frozen=True, slots=True)
class Gltf:
    """Writes one file with all cameras."""

    name: ClassVar[str] = "gltf"
    summary: ClassVar[str] = "mission.glb: animated cameras and the world, for Blender and browsers"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return mission.glb; no file if there are no cameras."""
        fleets = without_fleets(plan, "gltf")
        if not plan.trajectory.drones:
            return Emission((), notes=fleets)
        scene = scene_of(plan)
        clock = (
            f"{frames_note(scene, FILE)}; set Blender's frame rate before the import, its last frame after"
        )
        zooms = tuple(
            f"{FILE}: {camera.name} zooms by {POINTER}; what does not know that shows"
            f" {degrees(camera.film):.1f} deg"
            for camera in scene.cameras
            if camera.zooms
        )
        return Emission((Artifact(FILE, written(scene)),), notes=(clock, *zooms, *fleets))


EMITTER = Gltf()


def written(scene: FilmSet) -> bytes:
    """Return a scene as the bytes of a GLB file."""
    file = _Document(scene.paints)
    for body in scene.bodies:
        _body(file, body)
    for camera in scene.cameras:
        _camera(file, camera)
    return file.binary(scene.title)


@dataclass(slots=True)
class _Document:
    """A glTF document under construction: its lists, and the bytes behind its accessors."""

    paints: tuple[Paint, ...]
    data: bytearray = field(default_factory=bytearray)
    views: list[dict[str, Any]] = field(default_factory=list)
    accessors: list[dict[str, Any]] = field(default_factory=list)
    nodes: list[dict[str, Any]] = field(default_factory=list)
    meshes: list[dict[str, Any]] = field(default_factory=list)
    cameras: list[dict[str, Any]] = field(default_factory=list)
    channels: list[dict[str, Any]] = field(default_factory=list)
    samplers: list[dict[str, Any]] = field(default_factory=list)

    def accessor(self, values: NDArray[Any], target: int | None = None, *, bounds: bool = False) -> int:
        """Store values, shape (N,) or (N, k), and return the index of their accessor.

        Unsigned integers are stored as 32-bit integers, everything else as 32-bit floats.

        bounds : whether the accessor states the minimum and maximum
        """
        kind = np.dtype("<u4") if values.dtype.kind == "u" else np.dtype("<f4")
        stored = np.ascontiguousarray(values, dtype=kind)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": stored.nbytes}
        self.views.append(view if target is None else {**view, "target": target})
        self.data += stored.tobytes()
        wide = stored.reshape(len(stored), -1)
        accessor: dict[str, Any] = {
            "bufferView": len(self.views) - 1,
            "componentType": UNSIGNED if kind.kind == "u" else FLOAT,
            "count": len(stored),
            "type": SHAPES[wide.shape[1]],
        }
        if bounds:
            accessor |= {"min": wide.min(axis=0).tolist(), "max": wide.max(axis=0).tolist()}
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def animate(self, times: int, values: Array, target: dict[str, Any]) -> None:
        """Animate a target with values at the times of an accessor, linear between them."""
        sampler = {"input": times, "output": self.accessor(values), "interpolation": "LINEAR"}
        self.samplers.append(sampler)
        self.channels.append({"sampler": len(self.samplers) - 1, "target": target})

    def binary(self, title: str) -> bytes:
        """Return the file: a header, the document and the bytes, each padded to a multiple of four (GLB,
        version 2).
        """
        pointed = any("extensions" in channel["target"] for channel in self.channels)
        document = {
            "asset": {"version": "2.0", "generator": f"shotc {__version__}"},
            **({"extensionsUsed": [POINTER]} if pointed else {}),
            "scene": 0,
            "scenes": [{"name": title, "nodes": list(range(len(self.nodes)))}],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "cameras": self.cameras,
            "materials": [_material(paint) for paint in self.paints],
            "animations": [{"name": "flight", "channels": self.channels, "samplers": self.samplers}],
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": len(self.data)}],
        }
        text = json.dumps(document, separators=(",", ":"), ensure_ascii=False).encode()
        text += b" " * (-len(text) % 4)
        data = bytes(self.data) + b"\0" * (-len(self.data) % 4)
        head = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(data))
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0")
        return head + chunks + data


def _material(paint: Paint) -> dict[str, Any]:
    color = [*paint.linear, paint.opacity]
    surface = {"baseColorFactor": color, "metallicFactor": 0.0, "roughnessFactor": ROUGHNESS_SHARE}
    blend = {"alphaMode": "BLEND"} if paint.opacity < 1.0 else {}
    return {"name": paint.name, "pbrMetallicRoughness": surface, "doubleSided": True, **blend}


def _body(file: _Document, body: SceneBody) -> None:
    node: dict[str, Any] = {"name": body.name, "mesh": len(file.meshes)}
    file.meshes.append({"name": body.name, "primitives": _primitives(file, body)})
    if body.motion is not None:
        at = body.motion
        none = np.zeros(len(at.turns))
        times = file.accessor(at.times, bounds=True)
        turn = np.column_stack([none, np.sin(at.turns / 2), none, np.cos(at.turns / 2)])
        node["translation"] = _south(at.places)[0].tolist()
        file.animate(times, _south(at.places), {"node": len(file.nodes), "path": "translation"})
        if at.turns.any():
            file.animate(times, turn, {"node": len(file.nodes), "path": "rotation"})
    file.nodes.append(node)


def _primitives(file: _Document, body: SceneBody) -> list[dict[str, Any]]:
    material = file.paints.index(body.paint)
    points = _south(body.points)
    if body.kind == "lines":
        ends = np.cumsum(body.runs)[:-1]
        return [
            {
                "attributes": {"POSITION": file.accessor(line, VERTICES, bounds=True)},
                "mode": LINE_STRIP,
                "material": material,
            }
            for line in np.split(points, ends)
        ]
    primitive: dict[str, Any] = {"attributes": {"POSITION": file.accessor(points, VERTICES, bounds=True)}}
    if body.kind == "mesh":
        primitive["indices"] = file.accessor(body.runs.ravel(), INDICES)
    return [{**primitive, "mode": TRIANGLES if body.kind == "mesh" else POINTS, "material": material}]


def _camera(file: _Document, camera: CameraSamples) -> None:
    node, places = len(file.nodes), _south(camera.places)
    turns = upright(camera.yaw, camera.pitch)
    index = len(file.cameras)
    lens = {"aspectRatio": camera.aspect, "yfov": _yfov(camera.film, camera.aspect)}
    file.cameras.append(
        {"name": camera.name, "type": "perspective", "perspective": {**lens, "znear": NEAR_M, "zfar": FAR_M}}
    )
    here = {"translation": places[0].tolist(), "rotation": turns[0].tolist()}
    file.nodes.append({"name": camera.name, "camera": index, **here})
    times = file.accessor(camera.times, bounds=True)
    file.animate(times, places, {"node": node, "path": "translation"})
    file.animate(times, turns, {"node": node, "path": "rotation"})
    if camera.zooms:
        pointer = {POINTER: {"pointer": f"/cameras/{index}/perspective/yfov"}}
        yfov = np.array([_yfov(hfov, camera.aspect) for hfov in camera.hfov.tolist()])
        file.animate(times, yfov, {"path": "pointer", "extensions": pointer})


def _south(points: Array) -> Array:
    """Return points of W (N, 3) along East, Up and South, shape (N, 3)."""
    return np.stack([points[:, 0], points[:, 2], -points[:, 1]], axis=-1) + 0.0


def _yfov(hfov: float, aspect: float) -> float:
    """Return the vertical field of view, rad."""
    return 2.0 * atan(tan(hfov / 2.0) / aspect)

"""mission.usda: the world and the animated cameras as USD text, for Blender, Unreal, Houdini and Unity.

Z is up and a unit is a metre, so coordinates are those of W. Time codes are ticks of the output clock. A
camera's aperture and focal length are in tenths of a unit, and zoom is an animated focal length. Format:
openusd.org/release/api/class_usd_geom_camera.html and the text form of its layers.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from shotc.emit.attitude import graphics
from shotc.emit.base import Artifact, Emission
from shotc.emit.cameras import without_fleets
from shotc.emit.previs.film_set import (
    FAR_M,
    NEAR_M,
    BodyMotion,
    CameraSamples,
    FilmSet,
    Paint,
    SceneBody,
    frames_note,
    scene_of,
)
from shotc.geom.bernstein import Array
from shotc.geom.focal import focal_length
from shotc.ir.trajectory import VerifiedIR

FILE = "mission.usda"
APERTURE_DM = 0.36
"""Width of the film in tenths of a metre: 36 mm."""
LINE_WIDTH_M = 0.1
PLACE, TURN = "%d: (%.6f, %.6f, %.6f)", "%d: (%.9f, %.9f, %.9f, %.9f)"


@dataclass(frozen=True, slots=True)
class Usd:
    """Writes one file with all cameras."""

    name: ClassVar[str] = "usd"
    summary: ClassVar[str] = "mission.usda: animated cameras and the world, for Blender, Unreal and Houdini"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return mission.usda; no file if there are no cameras."""
        fleets = without_fleets(plan, "usd")
        if not plan.trajectory.drones:
            return Emission((), notes=fleets)
        scene = scene_of(plan)
        clock = f"{frames_note(scene, FILE)}; set Blender's frame rate, it takes the frames alone"
        return Emission((Artifact(FILE, written(scene).encode()),), notes=(clock, *fleets))


EMITTER = Usd()


def written(scene: FilmSet) -> str:
    """Return a scene as the text of a USD layer."""
    names = _Names()
    lines = [
        "#usda 1.0",
        "(",
        '    defaultPrim = "World"',
        f"    doc = {_quoted(scene.title)}",
        f"    endTimeCode = {scene.frames}",
        f"    framesPerSecond = {scene.rate:.9g}",
        "    metersPerUnit = 1",
        "    startTimeCode = 0",
        f"    timeCodesPerSecond = {scene.rate:.9g}",
        '    upAxis = "Z"',
        ")",
        "",
        'def Xform "World"',
        "{",
        '    def Scope "Paints"',
        "    {",
        *(f"        {line}" for paint in scene.paints for line in _material(paint)),
        "    }",
        *(f"    {line}" for body in scene.bodies for line in _body(names.of(body.name), body)),
        *(f"    {line}" for camera in scene.cameras for line in _camera(names.of(camera.name), camera)),
        "}",
        "",
    ]
    return "\n".join(lines)


class _Names:
    """Makes unique USD identifiers from the mission's names."""

    def __init__(self) -> None:
        self._taken = {"Paints"}

    def of(self, name: str) -> tuple[str, str]:
        """Return a name as a unique identifier, and unchanged."""
        plain = _identifier(name)
        free = next(
            n for i in range(len(self._taken) + 1) if (n := f"{plain}_{i}" if i else plain) not in self._taken
        )
        self._taken.add(free)
        return free, name


def _identifier(name: str) -> str:
    plain = re.sub(r"[^A-Za-z0-9_]", "_", name)
    return f"_{plain}" if plain[:1].isdigit() else plain


def _material(paint: Paint) -> list[str]:
    name = _identifier(paint.name)
    return [
        f'def Material "{name}"',
        "{",
        f"    token outputs:surface.connect = </World/Paints/{name}/Surface.outputs:surface>",
        '    def Shader "Surface"',
        "    {",
        '        uniform token info:id = "UsdPreviewSurface"',
        f"        color3f inputs:diffuseColor = {_tuple(paint.linear)}",
        f"        float inputs:opacity = {paint.opacity:.9g}",
        "        float inputs:roughness = 0.9",
        "        token outputs:surface",
        "    }",
        "}",
    ]


def _prim(kind: str, name: tuple[str, str], lines: Iterable[str], schema: str = "") -> Iterator[str]:
    yield f'def {kind} "{name[0]}" ('
    if schema:
        yield f'    prepend apiSchemas = ["{schema}"]'
    yield f"    displayName = {_quoted(name[1])}"
    yield ")"
    yield "{"
    yield from (f"    {line}" for line in lines)
    yield "}"


def _body(name: tuple[str, str], body: SceneBody) -> Iterator[str]:
    low, high = body.points.min(axis=0), body.points.max(axis=0)
    lines = [
        f"float3[] extent = [{_tuple(low)}, {_tuple(high)}]",
        f"point3f[] points = [{_tuples(body.points, '%.4f')}]",
        f"rel material:binding = </World/Paints/{_identifier(body.paint.name)}>",
        f"color3f[] primvars:displayColor = [{_tuple(body.paint.linear)}]",
        f"float[] primvars:displayOpacity = [{body.paint.opacity:.9g}]",
    ]
    kind = {"mesh": "Mesh", "lines": "BasisCurves", "points": "Points"}[body.kind]
    if body.kind == "mesh":
        lines += [
            f"int[] faceVertexCounts = [{_numbers(np.full(len(body.runs), 3))}]",
            f"int[] faceVertexIndices = [{_numbers(body.runs.ravel())}]",
            'uniform token subdivisionScheme = "none"',
            "uniform bool doubleSided = 1",
        ]
    elif body.kind == "lines":
        lines += [
            'uniform token type = "linear"',
            f"int[] curveVertexCounts = [{_numbers(body.runs)}]",
            f'float[] widths = [{LINE_WIDTH_M:g}] (\n        interpolation = "constant"\n    )',
        ]
    else:
        lines.append(f'float[] widths = [{body.width:.9g}] (\n        interpolation = "constant"\n    )')
    if body.motion is not None:
        lines += _carried(body.motion)
    yield from _prim(kind, name, lines, "MaterialBindingAPI")


def _carried(motion: BodyMotion) -> list[str]:
    none, half = np.zeros(len(motion.turns)), motion.turns / 2
    return _moved(motion.places, np.column_stack([none, none, np.sin(half), np.cos(half)]))


def _camera(name: tuple[str, str], camera: CameraSamples) -> Iterator[str]:
    focal = [focal_length(hfov, APERTURE_DM) for hfov in camera.hfov.tolist()]
    lens = f"float focalLength = {focal[0]:.9g}"
    if camera.zooms:
        lens = (
            f"float focalLength.timeSamples = {{{', '.join(f'{i}: {f:.9g}' for i, f in enumerate(focal))}}}"
        )
    lines = [
        f"float2 clippingRange = ({NEAR_M:g}, {FAR_M:g})",
        lens,
        f"float horizontalAperture = {APERTURE_DM:g}",
        f"float verticalAperture = {APERTURE_DM / camera.aspect:.9g}",
        'token projection = "perspective"',
        *_moved(camera.places, graphics(camera.yaw, camera.pitch)),
    ]
    yield from _prim("Camera", name, lines)


def _moved(places: Array, turns: Array) -> list[str]:
    """Return the transform of a prim: positions, then quaternions, whose real part USD writes first."""
    where = (PLACE % (i, *row) for i, row in enumerate((places + 0.0).tolist()))
    orientations = (TURN % (i, *row) for i, row in enumerate((turns[:, [3, 0, 1, 2]] + 0.0).tolist()))
    return [
        f"double3 xformOp:translate.timeSamples = {{{', '.join(where)}}}",
        f"quatd xformOp:orient.timeSamples = {{{', '.join(orientations)}}}",
        'uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:orient"]',
    ]


def _tuple(values: Iterable[float]) -> str:
    return f"({', '.join(f'{value:.9g}' for value in values)})"


def _tuples(rows: Array, form: str) -> str:
    line = f"({form}, {form}, {form})"
    return ", ".join([line % tuple(row) for row in (rows + 0.0).tolist()])


def _numbers(values: np.ndarray) -> str:
    return ", ".join(map(str, values.tolist()))


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)

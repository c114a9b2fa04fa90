"""Models of scenes and buildings in pictures: their triangles, and the lightness of each."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from shotc.emit.hillshade import LIGHT, shades
from shotc.emit.palette import STONE
from shotc.geom.bernstein import Array
from shotc.geom.surface.triangles import cross
from shotc.ir.obstacle_mesh import ObstacleMesh

LEVEL_LIGHTNESS, CONTRAST_LIGHTNESS = 0.86, 0.4
"""Lightness of a face parallel to the light, and the amount added for one that faces it."""


class _Planes(NamedTuple):
    """Triangles (N, 3, 3), their unit normals (0 without area) and middles, shape (N, 3) each."""

    triangles: Array
    normals: Array
    middles: Array


_NONE = _Planes(np.zeros((0, 3, 3)), np.zeros((0, 3)), np.zeros((0, 3)))


@dataclass(frozen=True, slots=True, eq=False)
class Faces:
    """Triangles (N, 3, 3), metres in W, and their colours (N, 3), from 0 to 1."""

    triangles: Array
    colors: Array


def faces_of(meshes: Iterable[ObstacleMesh], eye: Array) -> Faces:
    """Return the triangles of meshes, shaded with the light of a hillshade and seen from an eye (3,), metres
    in W.

    Each face is shaded on the side that the eye sees. A point of a cloud is drawn as a square that faces the
    eye and has the size that the point stands for.
    """
    parts = [
        _NONE,
        *(_whole(mesh) if mesh.spacing <= 0.0 else _planes(_turned(mesh, eye)) for mesh in meshes),
    ]
    triangles, normal, middle = (np.concatenate(each) for each in zip(*parts, strict=True))
    turned_away = np.einsum("nd,nd->n", normal, eye - middle) < 0.0
    normal[turned_away] *= -1.0
    light = np.clip(LEVEL_LIGHTNESS + CONTRAST_LIGHTNESS * (normal @ LIGHT), 0.45, 1.3)
    return Faces(triangles, shades(np.array(STONE), light))


@lru_cache(maxsize=4)
def _whole(mesh: ObstacleMesh) -> _Planes:
    """Return the triangles of a mesh; cached, because a storyboard draws the mesh in many pictures."""
    return _planes(mesh.surface.triangles)


def _planes(triangles: Array) -> _Planes:
    """Return triangles (N, 3, 3) with their planes."""
    normal = cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    return _Planes(triangles, normal / np.where(size > 0.0, size, 1.0), triangles.mean(axis=1))


def _turned(mesh: ObstacleMesh, eye: Array) -> Array:
    triangles = mesh.surface.triangles
    points = (triangles == triangles[:, :1]).all(axis=(1, 2))
    if not points.any():
        return triangles
    p = triangles[points, 0]
    to = eye - p
    right = np.column_stack([-to[:, 1], to[:, 0], np.zeros(len(p))])
    level = np.linalg.norm(right, axis=1, keepdims=True)
    right = np.where(level > 0.0, right / np.where(level > 0.0, level, 1.0), [1.0, 0.0, 0.0])
    up = cross(to, right)
    up /= np.maximum(np.linalg.norm(up, axis=1, keepdims=True), 1e-9)
    a, b = mesh.spacing * (right + up), mesh.spacing * (right - up)
    one, other = np.stack([p - a, p + b, p + a], axis=1), np.stack([p - a, p + a, p - b], axis=1)
    return np.concatenate([triangles[~points], one, other])

"""The scene of ``specs/identified``: a quay of a few buildings, as the text of an OBJ file with z up."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import cos, pi, sin

Corner = tuple[float, float, float]
Solid = tuple[list[Corner], list[list[int]]]
"""Corners, and faces as numbers of them, counter-clockwise from outside."""


def drum(x: float, y: float, radius: float, top: float, sides: int = 16) -> Solid:
    """Return a cylinder on the ground, as a prism over a regular polygon."""
    return lathed(x, y, [(radius, 0), (radius, top)], sides)


def lathed(x: float, y: float, profile: Sequence[tuple[float, float]], sides: int = 16) -> Solid:
    """Return what a profile of (radius, height) makes that turns about an upright axis."""
    turn = [2 * pi * k / sides for k in range(sides)]
    corners = [(round(x + r * cos(a), 2), round(y + r * sin(a), 2), z) for r, z in profile for a in turn]
    rings = [[sides * k + i for i in range(sides)] for k in range(len(profile))]
    walls = [[a[i - 1], a[i], b[i], b[i - 1]] for a, b in pairwise(rings) for i in range(sides)]
    return corners, [*walls, rings[0][::-1], rings[-1]]


def block(x: float, y: float, length: float, width: float, top: float) -> Solid:
    """Return a box on the ground that lies from west to east."""
    a, b = length / 2, width / 2
    ring = [(x - a, y - b), (x + a, y - b), (x + a, y + b), (x - a, y + b)]
    walls = [[i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i] for i in range(4)]
    return [(x, y, z) for z in (0.0, top) for x, y in ring], [*walls, [3, 2, 1, 0], [4, 5, 6, 7]]


QUAY: dict[str, Sequence[Solid]] = {
    "silo": [drum(0, 0, 6, 26)],
    "elevator": [block(22, 4, 12, 12, 38)],
    "warehouse": [block(-42, 6, 44, 18, 11)],
    "office": [block(52, 2, 18, 14, 13)],
    "water-tower": [lathed(-2, 60, [(2.2, 0), (2.2, 17), (6, 20), (6, 28)])],
    "shed-1": [block(-30, 46, 16, 10, 6)],
    "shed-2": [block(30, 44, 20, 12, 7)],
    "bollards": [drum(x, -24, 0.4, 0.9, 8) for x in range(-60, 61, 12)],
}


def text() -> str:
    """Return the OBJ file: an object each, with faces of as many corners as they have."""
    lines, count = ["# A quay: metres, x east, y north, z up."], 0
    for name, solids in QUAY.items():
        lines.append(f"o {name}")
        for corners, faces in solids:
            lines += [f"v {x:g} {y:g} {z:g}" for x, y, z in corners]
            lines += ["f " + " ".join(str(count + i + 1) for i in face) for face in faces]
            count += len(corners)
    return "\n".join(lines) + "\n"

"""The names of screen points and compositions, with their screen coordinates.

Screen coordinates (u, v) in [-1, 1]^2, u right, v up.
"""

from __future__ import annotations

from shotc.ir.limits import Vec2
from shotc.ir.mission import Composition

_THIRD_SHARE = 1 / 3
_PHI_SHARE = 0.236


def _centre_and_corners(distance: float) -> tuple[Vec2, ...]:
    return (
        (0.0, 0.0),
        (-distance, distance),
        (distance, distance),
        (-distance, -distance),
        (distance, -distance),
    )


COMPOSITIONS: dict[str, Composition] = {
    "center": Composition("center", points=((0.0, 0.0),)),
    "thirds": Composition("thirds", points=_centre_and_corners(_THIRD_SHARE)),
    "thirds-first": Composition("thirds-first", u_lines=(-_THIRD_SHARE, _THIRD_SHARE), last=((0.0, 0.0),)),
    "thirds-lines": Composition(
        "thirds-lines", u_lines=(-_THIRD_SHARE, _THIRD_SHARE), v_lines=(-_THIRD_SHARE, _THIRD_SHARE)
    ),
    "phi": Composition("phi", points=_centre_and_corners(_PHI_SHARE)),
    "keep": Composition("keep", keep=True),
}

NAMED_POINTS: dict[str, Vec2] = {
    "center": (0.0, 0.0),
    "left-third": (-_THIRD_SHARE, 0.0),
    "right-third": (_THIRD_SHARE, 0.0),
    "upper-third": (0.0, _THIRD_SHARE),
    "lower-third": (0.0, -_THIRD_SHARE),
    "upper-left": (-_THIRD_SHARE, _THIRD_SHARE),
    "upper-right": (_THIRD_SHARE, _THIRD_SHARE),
    "lower-left": (-_THIRD_SHARE, -_THIRD_SHARE),
    "lower-right": (_THIRD_SHARE, -_THIRD_SHARE),
}

# The names for a keyframe's `frame`: a point, or a composition.
FRAMES: dict[str, Composition] = {
    **COMPOSITIONS,
    **{name: Composition(name, points=(point,)) for name, point in NAMED_POINTS.items()},
}

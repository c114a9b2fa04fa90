"""The metric of a fleet's separation, and the spacing of its goals. Plain Python.

Heights are stretched so that the separation of two drones is a ball, or lies in one. If two formations are
matched by least squared stretched distance, then r0.r1 >= 0 for the relative positions of each pair, and
straight synchronous moves keep |(1-s) r0 + s r1|^2 >= ((1-s)^2 + s^2) d^2 >= d^2 / 2. So goals that are
sqrt(2) balls apart stay one ball apart on the whole move. On elliptic arcs (``show.geom.arcs``) goals may be
as near as the separation.
"""

from math import sqrt
from typing import Protocol

ROUNDING_RATIO = 1.001
"""Factor of the goals' spacing over the separation, as a reserve for rounding in moves."""

SLACK_SHARE = 1e-6
"""Tolerance of a proved distance, as a share of the distance but at least of a metre, as in verification."""


class Distances(Protocol):
    """The separation of ``ir.show.Apart``: its shape, and its half axes with the margin, metres."""

    @property
    def shape(self) -> str:
        """Return "ellipsoid" or "cylinder"."""
        ...

    @property
    def across(self) -> float:
        """Return the horizontal distance, metres."""
        ...

    @property
    def upright(self) -> float:
        """Return the vertical distance, metres."""
        ...


def stretch(apart: Distances) -> float:
    """Return the factor on heights that makes the ellipsoid a ball, and the cylinder as high as wide."""
    return apart.across / apart.upright


def ball(apart: Distances) -> float:
    """Return the stretched distance at which two drones are separated in every direction, metres.

    It is exact for an ellipsoid. A cylinder lies in a ball that is larger by sqrt(2).
    """
    return apart.across * (sqrt(2.0) if apart.shape == "cylinder" else 1.0)


def spacing(apart: Distances) -> float:
    """Return the least distance of two goals of one formation, in the fleet's metric, metres."""
    return ROUNDING_RATIO * apart.across


def straight_spacing(apart: Distances) -> float:
    """Return the stretched distance of two goals at which straight moves between formations are safe."""
    return sqrt(2.0) * ball(apart)


def keeps_separation(proven: float, across: float) -> bool:
    """Return whether a proved distance keeps the required one, metres, within SLACK_SHARE."""
    return proven >= across - SLACK_SHARE * max(1.0, across)

"""The metric in which a fleet keeps its distance, and how far apart its goals have to be. Plain Python.

Heights are stretched so that what two drones keep free between them is a ball, or lies in one. Between two
formations matched by least squared stretched distance, straight synchronous moves keep
|(1-s) r0 + s r1|^2 >= ((1-s)^2 + s^2) d^2 >= d^2 / 2, for r0.r1 >= 0: goals that are sqrt(2) balls apart
stay one ball apart all the way. On elliptic arcs (``show.geom.arcs``) goals may be as near as the separation.
"""

from math import sqrt
from typing import Protocol

ROOMIER = 1.001
"""Goals are farther apart than the separation by this factor, so that moves have something to round."""

SLACK_SHARE = 1e-6
"""What the proof may fall short of, a share of the distance and of a metre at least, as in verification."""


class Distances(Protocol):
    """What ``ir.show.Apart`` says: the shape that is kept free, and its half axes with the margin, metres."""

    @property
    def shape(self) -> str:
        """Return "ellipsoid" or "cylinder"."""
        ...

    @property
    def across(self) -> float:
        """Return the horizontal distance."""
        ...

    @property
    def upright(self) -> float:
        """Return the vertical distance."""
        ...


def stretch(apart: Distances) -> float:
    """Return the factor for heights that makes the ellipsoid a ball, the cylinder as high as wide."""
    return apart.across / apart.upright


def ball(apart: Distances) -> float:
    """Return the stretched distance at which two drones are apart whatever the direction, metres.

    It is exact for an ellipsoid; a cylinder lies in a ball that is sqrt(2) larger.
    """
    return apart.across * (sqrt(2.0) if apart.shape == "cylinder" else 1.0)


def spacing(apart: Distances) -> float:
    """Return the least distance of two goals of one formation, in the fleet's own sense, metres."""
    return ROOMIER * apart.across


def straight_spacing(apart: Distances) -> float:
    """Return the stretched distance of two goals at which straight moves between formations need no proof."""
    return sqrt(2.0) * ball(apart)


def kept(proven: float, across: float) -> bool:
    """Tell whether a proved distance is the one to be kept, metres."""
    return proven >= across - SLACK_SHARE * max(1.0, across)

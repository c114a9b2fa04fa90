"""Targets: their positions, their shapes, and the solids that clearances refer to. Plain Python.

World frame W (East, North, Up, metres), radians, seconds.
"""

from functools import lru_cache
from math import cos, sin
from typing import TYPE_CHECKING, NamedTuple

from shotc.geom.same import Same
from shotc.geom.shapes import BoxShape, CylinderShape, GroupShape, TargetShape
from shotc.geom.solids import Solid
from shotc.geom.vec import Vec3
from shotc.ir.origin import KeyPath

if TYPE_CHECKING:  # a mission with standing targets only does not load it
    from shotc.geom.track import Track

STRAIGHT_SINE = 2e-6  # sine of the angle by which a straight course may vary; twice that of ``geom.track``


class Target(NamedTuple):
    """A camera target with a shape about its centre.

    centre : where it stands, or is at mission time 0; track : its motion, None if it stands
    shape : of the standing target, or at mission time 0; parts : names of the bodies of a group
    """

    name: str
    centre: Vec3
    shape: TargetShape
    path: KeyPath
    track: "Track | None" = None
    parts: tuple[str, ...] = ()

    @property
    def radius(self) -> float:
        """The radius of its upright bounding cylinder about its centre, metres."""
        return self.shape.radius

    @property
    def height(self) -> float:
        """Its height, metres."""
        return self.shape.height

    @property
    def foot(self) -> Vec3:
        """The lowest point of its axis, standing or at mission time 0."""
        x, y, z = self.centre
        return (x, y, z - self.height / 2)

    @property
    def solid(self) -> Solid:
        """Its body, standing or at mission time 0."""
        return _body(self.shape, self.centre)

    @property
    def kept_clear(self) -> Solid:
        """The solid that clearances refer to, with its centre as at mission time 0.

        For a shape that turns with its course it is the upright cylinder about it.
        """
        if self.track is None or not self.shape.turns:
            return self.solid
        if isinstance(self.shape, BoxShape) and not self.turns:
            return _body(self.shape.wider(self.radius * STRAIGHT_SINE), self.centre)
        return _body(CylinderShape(self.radius, self.height), self.centre)

    @property
    def turns(self) -> bool:
        """Whether its shape turns over time."""
        return self.track is not None and self.shape.turns and not goes_one_way(Same(self.track))

    @property
    def counts_from(self) -> str:
        """A sentence about the solid of its clearances, if that is not its body; else empty."""
        if not self.turns:
            return ""
        return (
            f"`{self.name}` turns with its course: distances from it count from the upright cylinder "
            f"about it, {self.radius:.2f} m in radius"
        )

    def kept_clear_at(self, t: float) -> Solid:
        """Return the solid that clearances refer to at a mission time."""
        return self.kept_clear if self.track is None else self._replace(centre=self.at(t)).kept_clear

    def shape_at(self, t: float) -> TargetShape:
        """Return its shape at a mission time."""
        if self.track is None or not self.shape.turns:
            return self.shape
        yaw = self.track.heading(t)
        return self.shape.facing((cos(yaw), sin(yaw)))

    def solid_at(self, t: float) -> Solid:
        """Return its body at a mission time."""
        return _body(self.shape_at(t), self.at(t))

    def foot_at(self, t: float) -> Vec3:
        """Return the lowest point of its axis at a mission time, metres."""
        x, y, z = self.at(t)
        return (x, y, z - self.height / 2)

    def at(self, t: float) -> Vec3:
        """Return its centre at a mission time, metres."""
        return self.centre if self.track is None else self.track.at(t)


@lru_cache(maxsize=64)
def goes_one_way(track: "Same[Track]") -> bool:
    """Return whether the heading along a track is constant, but for STRAIGHT_SINE."""
    headings = track.it.headings
    return max(headings) == min(headings) if headings else track.it.straight


def _body(shape: TargetShape, centre: Vec3) -> Solid:
    assert not isinstance(shape, GroupShape), "a group has no body of its own"
    return shape.solid(centre)

"""Input and output of the conversion of a role: its action, target and time, and the shot made from it."""

from __future__ import annotations

from math import cos, sin
from typing import NamedTuple

from shotc.geom.vec import Vec3
from shotc.importers.multidrone.frames import CoordinateFrame
from shotc.importers.multidrone.read import Role, ShootingAction
from shotc.importers.multidrone.targets import GroundTrack
from shotc.importers.notes import Notes, plain

NEAREST_M = 3.0  # least distance of a camera from its target, metres
LOWEST_M = 2.0  # lowest height above the ground, metres

Said = tuple[str, ...]
Path = tuple[Vec3, Vec3, Vec3]


class ImportedShot(NamedTuple):
    """A shot as text: its kind and parameters as YAML, and the comments above it.

    path    : camera positions at the start, in the middle and at the end: East, North, Up in metres
    fixed   : whether the file gives its distance
    watches : whether it films a target
    """

    kind: str
    params: str
    path: Path
    comments: Said
    fixed: bool = True
    watches: bool = True


class RoleTask(NamedTuple):
    """One role to convert to a shot that begins at mission time ``start`` and lasts ``duration``, seconds."""

    action: ShootingAction
    role: Role
    course: GroundTrack
    frame: CoordinateFrame
    start: float
    duration: float
    target: str
    notes: Notes

    @property
    def middle(self) -> float:
        """The mission time in the middle of the shot."""
        return self.start + self.duration / 2

    def assume(self, message: str, taken: str) -> str:
        """Record an assumption about the parameters of the role, and return its comment."""
        return self.notes.assume(self.role.given, message, taken)

    def param(self, name: str, otherwise: float) -> tuple[float, Said]:
        """Return a parameter and no comment, or the default for a missing one and a comment."""
        if name in self.role.params:
            return self.role.params[name], ()
        kind = plain(self.role.kind, 30)
        return otherwise, (self.assume(f"{kind} without `{name}`", f"{name} = {otherwise:g}"),)

    def altitude(self, name: str = "z_0") -> tuple[float, Said]:
        """Return a height above the ground under the target, metres, and comments."""
        z, said = self.param(name, 5.0)
        if z >= LOWEST_M:
            return z, said
        more = self.assume(f"{name} = {z:g} m is too low to be flown", f"{LOWEST_M:g} m")
        return LOWEST_M, (*said, more)

    def along(self, begin: Vec3, end: Vec3) -> Path:
        """Return the path of a camera that moves with the target.

        begin, end : position relative to the target: ahead, left, height above ground, metres
        """
        half = (begin[0] + end[0]) / 2, (begin[1] + end[1]) / 2, (begin[2] + end[2]) / 2
        return (
            self.beside(begin, self.start),
            self.beside(half, self.middle),
            self.beside(end, self.start + self.duration),
        )

    def beside(self, spot: Vec3, t: float) -> Vec3:
        """Return the position in W at ``spot``: ahead of the target, to its left, height above ground."""
        (x, y), heading, (ahead, left, z) = self.course.at(t), self.course.heading(t), spot
        return (
            x + ahead * cos(heading) - left * sin(heading),
            y + ahead * sin(heading) + left * cos(heading),
            z,
        )

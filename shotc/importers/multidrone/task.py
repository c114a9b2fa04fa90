"""What a shot is made of, and what comes out: an action's role with its target and its time."""

from __future__ import annotations

from math import cos, sin
from typing import NamedTuple

from shotc.importers.multidrone.frames import Frame, Place
from shotc.importers.multidrone.read import Action, Role
from shotc.importers.multidrone.targets import Course
from shotc.importers.notes import Notes, plain

NEAREST = 3.0  # metres beside a target that a shot keeps where nothing is said
LOWEST = 2.0  # metres over the ground

Said = tuple[str, ...]


class Made(NamedTuple):
    """A shot as written: its kind and parameters as YAML, and the comments above it.

    camera : where it is in the middle of the shot, East and North in metres; None where it films no target
    fixed : whether the file gives its distance
    """

    kind: str
    params: str
    camera: Place | None
    comments: Said
    fixed: bool = True


class Task(NamedTuple):
    """One role to be made a shot, from mission time ``start`` on, for ``lasts`` seconds."""

    action: Action
    role: Role
    course: Course
    frame: Frame
    start: float
    lasts: float
    target: str
    notes: Notes

    @property
    def middle(self) -> float:
        """The mission time in the middle of the shot."""
        return self.start + self.lasts / 2

    def assume(self, message: str, taken: str) -> str:
        """Note an assumption about the parameters of the role, and return the comment that goes with it."""
        return self.notes.assume(self.role.given, message, taken)

    def param(self, name: str, otherwise: float) -> tuple[float, Said]:
        """Return a parameter, or what is taken where it is missing, with the comment for that."""
        if name in self.role.params:
            return self.role.params[name], ()
        kind = plain(self.role.kind, 30)
        return otherwise, (self.assume(f"{kind} without `{name}`", f"{name} = {otherwise:g}"),)

    def altitude(self, name: str = "z_0") -> tuple[float, Said]:
        """Return an altitude over the ground, on which the target stands."""
        z, said = self.param(name, 5.0)
        if z >= LOWEST:
            return z, said
        more = self.assume(f"{name} = {z:g} m is too low to be flown", f"{LOWEST:g} m")
        return LOWEST, (*said, more)

    def beside(self, ahead: float, left: float) -> Place:
        """Return the place so far ahead and to the left of the target in the middle of the shot."""
        (x, y), way = self.course.at(self.middle), self.course.heading(self.middle)
        return (x + ahead * cos(way) - left * sin(way), y + ahead * sin(way) + left * cos(way))

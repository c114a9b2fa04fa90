"""Framing: the camera goes where its subjects appear as asked. Checked, but not planned yet."""

from typing import Literal

from pydantic import Field

from shotc.ir.mission import Deferred
from shotc.kinds.base import Expansion, Kind, Scene, unknown_target
from shotc.spec.fields import Angle, Frame, Name, Pitch, ShotSize
from shotc.spec.model import Model
from shotc.spec.shot import ShotBase


class ViewSpec(Model):
    """The side from which a subject is seen."""

    azimuth: Angle = Field(description="compass bearing from the subject to the camera")
    elevation: Pitch = Field(default=0.0, description="how high the camera stands above the subject")


class SubjectSpec(Model):
    """One subject and how it is to appear."""

    target: Name = Field(description="name of the target")
    frame: Frame | None = Field(default=None, description="where on screen its centre goes")
    size: ShotSize | None = Field(
        default=None, description="projected height over frame height, or the name of a shot size"
    )
    view: ViewSpec | None = Field(default=None, description="the side from which it is seen")


class FramingShot(ShotBase):
    """The parameters of a framing."""

    kind: Literal["framing"] = Field(description="what sort of shot it is")
    subjects: tuple[SubjectSpec, ...] = Field(min_length=1, description="who is in the picture, and how")


def expand(shot: FramingShot, scene: Scene) -> Expansion:
    """Check the subjects' names; planning waits for a later version."""
    wrong = [
        unknown_target(scene.origins, (*scene.path, "subjects", i, "target"), subject.target, scene.targets)
        for i, subject in enumerate(shot.subjects)
        if subject.target not in scene.targets
    ]
    return Expansion.of([*wrong, Deferred("a shot of kind `framing`", (*scene.path, "kind"))])


KIND = Kind("framing", "go where the subjects appear as asked", FramingShot, expand, planned=False)

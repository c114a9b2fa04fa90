"""Framing: the camera moves with its subjects and keeps their required appearance."""

from typing import Any, Literal

from pydantic import Field, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from shotc.diag.model import Diagnostic
from shotc.geom.camera import yaw_of
from shotc.ir.mission import Deferred, Ideal, Near, Subject
from shotc.kinds.base import Expansion, Kind, Scene, Stand
from shotc.kinds.moving import evenly
from shotc.kinds.setpoints import WHAT, SetpointSpec, ViewSpec, setpoint_faults, setpoints_of
from shotc.spec.fields import Angle, Frame, Name, Pitch, ShotSize, Station
from shotc.spec.model import Model
from shotc.spec.places import STATION
from shotc.spec.shot import ShotBase

ORIGIN = (0.0, 0.0, 0.0)


class SubjectSpec(Model):
    """One subject and its required appearance."""

    target: Name = Field(description="name of the target")
    frame: Frame | None = Field(default=None, description="where on screen its centre goes")
    size: ShotSize | None = Field(
        default=None, description="projected height over frame height, or the name of a shot size"
    )
    view: ViewSpec | None = Field(default=None, description="the side from which it is seen")
    setpoints: tuple[SetpointSpec, ...] = Field(
        default=(), description="how it is to appear later in the shot, in the order of their times"
    )


class NearSpec(Model):
    """The preferred pose of the camera; a position, or a place relative to a target, is enough."""

    at: Station = Field(description="place of the camera, or a place that counts from a target")
    heading: Angle | None = Field(default=None, description="compass heading of the camera")
    pitch: Pitch | None = Field(default=None, description="elevation of the camera")

    @classmethod
    def shorthand(cls, data: Any) -> Any:
        """Return the mapping for a place alone."""
        written = isinstance(data, dict) and data.keys() & {"at", "heading", "pitch"}
        return data if written or isinstance(data, NearSpec) else {"at": data}

    @classmethod
    def __get_pydantic_json_schema__(
        cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Return the schema of the mapping or of a place."""
        schema = handler.resolve_ref_schema(handler(core_schema))
        return {"anyOf": [STATION.reference(), schema]}


class FramingShot(ShotBase):
    """The parameters of a framing."""

    kind: Literal["framing"] = Field(description="what sort of shot it is")
    subjects: tuple[SubjectSpec, ...] = Field(min_length=1, description="who is in the picture, and how")
    near: NearSpec | None = Field(
        default=None, description="pose near which the camera stays as far as the picture lets it"
    )


def expand(shot: FramingShot, scene: Scene) -> Expansion:
    """Return the subjects; the course of the camera is computed later, when all shots and zones are known."""
    subjects_or_faults = [
        scene.subject(s.target, "subjects", i, "target") for i, s in enumerate(shot.subjects)
    ]
    against = [f for f in subjects_or_faults if isinstance(f, Diagnostic | Deferred)]
    against += _twice(shot, scene)
    against += _setpoint_faults(shot, scene)
    if shot.timing.duration is None:
        message = f"how long does this {shot.kind} last? it is planned on the mission's own time"
        against.append(scene.lasting("M003", message, "kind"))
    if against:
        return Expansion.of(against)
    subjects = tuple(
        Subject(
            s.target,
            s.frame or scene.composition,
            s.size if s.size is not None or i else shot.size,
            None if s.view is None else s.view.angles,
            (*scene.path, "subjects", i, "target"),
            setpoints_of(s.setpoints, scene, "subjects", i, "setpoints"),
        )
        for i, s in enumerate(shot.subjects)
    )
    near = None if shot.near is None else _near(shot, shot.near, scene)
    if isinstance(near, Diagnostic | Deferred):
        return Expansion.of([near])
    ideal = Ideal("about", subjects[0].target, evenly([ORIGIN]), framed=True, near=near)
    return Expansion(ideal=ideal, subjects=subjects)


def _near(shot: FramingShot, near: NearSpec, scene: Scene) -> Near | Diagnostic | Deferred:
    under = ("near", "at") if (*scene.path, "near", "at") in scene.origins.values else ("near",)
    stand = scene.stand(shot, near.at, *under)
    if not isinstance(stand, Stand):
        return stand
    return Near(*stand, None if near.heading is None else yaw_of(near.heading), near.pitch)


def _setpoint_faults(shot: FramingShot, scene: Scene) -> list[Diagnostic]:
    faults: list[Diagnostic] = []
    for i, s in enumerate(shot.subjects):
        view, size = s.view or ViewSpec(), s.size if s.size is not None or i else shot.size
        said = dict(zip(WHAT, (s.frame, size, *view.angles), strict=True))
        known = frozenset(what for what, value in said.items() if value is not None)
        faults += setpoint_faults(
            s.setpoints, scene, (s.target, known), shot.timing.duration, "subjects", i, "setpoints"
        )
    return faults


def _twice(shot: FramingShot, scene: Scene) -> list[Diagnostic]:
    """Return the fault of every target that is a subject twice."""
    first: dict[str, int] = {}
    faults = []
    for i, subject in enumerate(shot.subjects):
        k = first.setdefault(subject.target, i)
        if k != i:
            fault = scene.fault(
                "M030",
                f"target `{subject.target}` is twice a subject of this {shot.kind}",
                "name another target, or say all of it in one place",
                "subjects",
                i,
                "target",
            )
            beside = scene.origins.value((*scene.path, "subjects", k, "target"), "its first time")
            faults.append(fault._replace(labels=(*fault.labels, beside)))
    return faults


KIND = Kind("framing", "go where the subjects appear as asked", FramingShot, expand)

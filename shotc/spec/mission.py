"""The model of a whole mission."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, PlainValidator, ValidationInfo

from shotc.spec.drones import DroneSpec
from shotc.spec.fields import Name, Title
from shotc.spec.fleets import FleetSpec
from shotc.spec.model import Model, section
from shotc.spec.music import MusicSpec
from shotc.spec.pydantic_faults import fault
from shotc.spec.rehearse import RehearseSpec
from shotc.spec.rules import OutputSpec, RulesSpec
from shotc.spec.shot import ShotBase
from shotc.spec.world import TargetSpec, WorldSpec
from shotc.units import describe

VERSION = 1


def is_version(value: object) -> bool:
    """Return whether a value is the supported version of the language."""
    return value == VERSION and not isinstance(value, bool)


def _read_shot(value: Any, info: ValidationInfo) -> ShotBase:
    """Validate a shot by the model of its kind, or for an unknown kind by the common fields.

    ``load`` reports the unknown kind together with the other faults of the file.
    """
    if not isinstance(value, dict):
        raise fault(
            "empty-value" if value is None else "wrong-type",
            f"expected a shot, got {describe(value)}",
            "write a mapping with id, kind, drone and the parameters of the kind",
        )
    kinds: Mapping[str, type[ShotBase]] = (info.context or {}).get("kinds", {})
    kind = value.get("kind")
    model = kinds.get(kind) if isinstance(kind, str) else None
    if model is not None:
        return model.model_validate(value)
    return ShotBase.model_validate({key: item for key, item in value.items() if key in ShotBase.model_fields})


# A function instead of a union of models, because kinds also come from other packages, and loading and
# building all our models takes 50 ms, half of the time of a check without imports.
Shot = Annotated[ShotBase, PlainValidator(_read_shot)]


class MissionSpec(Model):
    """A mission."""

    shotc: Literal[1] = Field(description="version of the language")
    mission: Title = Field(description="name of the mission; its output folder is named after it")
    world: WorldSpec = section("the place and what stands in it")
    targets: dict[Name, TargetSpec] = Field(default={}, description="what is filmed")
    drones: dict[Name, DroneSpec] = Field(default={}, description="what films")
    fleets: dict[Name, FleetSpec] = Field(default={}, description="drones that make pictures in the sky")
    music: MusicSpec | None = Field(default=None, description="what a show is flown to, and its beats")
    rules: RulesSpec = section("rules for the whole mission")
    shots: tuple[Shot, ...] = Field(default=(), description="what is filmed when, in order")
    output: OutputSpec = section("what is written out")
    rehearse: RehearseSpec | None = Field(
        default=None,
        description="what `shotc simulate` asks of the runs, in which wind; plan and verify do not read it",
    )

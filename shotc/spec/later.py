"""Mappings that are read by a model of their own, loaded and built when a mission first has one.

``check`` runs at every keystroke and commit, and most of its time is loading. Pydantic builds a model anew
inside every model that has it as a field: these are built once. Every shot has a timing, and is a model of
its kind's, so that timing is here too.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Annotated, Any

from pydantic.json_schema import JsonSchemaValue

from shotc.spec.fieldtypes import FieldType

__all__ = [
    "Fleet",
    "Gimbal",
    "Later",
    "MutualVisibility",
    "Refine",
    "Require",
    "Timing",
    "Track",
    "TransitClearance",
]


class Later(FieldType):
    """A mapping read by the model at ``place``, such as ``shotc.spec.fleets:FleetSpec``."""

    label = "Later"

    def __init__(self, place: str) -> None:
        self.place = place

    @property
    def model(self) -> Any:
        """The model, loaded if it was not yet."""
        module, _, name = self.place.partition(":")
        return getattr(import_module(module), name)

    def read(self, value: Any) -> Any:
        """Return the mapping as its model reads it."""
        return self.model.model_validate(value)

    def schema(self) -> JsonSchemaValue:
        """Return the model, in whose place its definition is put (see spec.schema)."""
        return {"$model": self.model}

    def reference(self) -> JsonSchemaValue:
        """Return the same: definitions of models are shared as they are."""
        return self.schema()


if TYPE_CHECKING:
    from shotc.spec.fleets import FleetSpec as Fleet
    from shotc.spec.gimbal import GimbalSpec as Gimbal
    from shotc.spec.shot_terms import RefineSpec as Refine
    from shotc.spec.shot_terms import RequireSpec as Require
    from shotc.spec.shot_terms import TimingSpec as Timing
    from shotc.spec.tracks import TrackSpec as Track
    from shotc.spec.transits import TransitClearanceSpec as TransitClearance
    from shotc.spec.visibility import MutualVisibilitySpec as MutualVisibility
else:
    Fleet = Annotated[Any, Later("shotc.spec.fleets:FleetSpec")]
    Gimbal = Annotated[Any, Later("shotc.spec.gimbal:GimbalSpec")]
    MutualVisibility = Annotated[Any, Later("shotc.spec.visibility:MutualVisibilitySpec")]
    Refine = Annotated[Any, Later("shotc.spec.shot_terms:RefineSpec")]
    Require = Annotated[Any, Later("shotc.spec.shot_terms:RequireSpec")]
    Timing = Annotated[Any, Later("shotc.spec.shot_terms:TimingSpec")]
    Track = Annotated[Any, Later("shotc.spec.tracks:TrackSpec")]
    TransitClearance = Annotated[Any, Later("shotc.spec.transits:TransitClearanceSpec")]

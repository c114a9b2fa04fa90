"""What is said of a shot as a whole: when it is filmed, what it promises, how it is refined."""

from math import inf
from typing import Annotated, Any

from pydantic import Field, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from shotc.spec.faults import fault
from shotc.spec.fields import Name, NonNegativeDuration, ScreenDistance, Share, ShareRange, Switch
from shotc.spec.fieldtypes import Hinted
from shotc.spec.model import Model
from shotc.spec.quantities import Quantity
from shotc.units import SMALLEST, clip, describe

_DURATION = Hinted(
    Quantity("Duration", "duration", SMALLEST["duration"]),
    "auto",
    "leave `duration` out, or write `timing: auto` where nothing else is given",
)


class TimingSpec(Model):
    """When a shot is filmed; nothing given is ``auto``."""

    start: NonNegativeDuration | None = Field(
        default=None, description="first filmed frame, from mission start"
    )
    after: Name | None = Field(default=None, description="id of the shot that has to end first")
    duration: Annotated[float, _DURATION] | None = Field(
        default=None, description="length of the shot, holds included"
    )

    @classmethod
    def shorthand(cls, data: Any) -> Any:
        """Return an empty mapping for ``auto``."""
        if data == "auto":
            return {}
        if isinstance(data, str | int | float) and not isinstance(data, bool):
            seconds = data[:1].isdigit() if isinstance(data, str) else 0 < data < inf
            raise fault(
                "wrong-type",
                f"expected a timing, got {describe(data)}",
                f"write `auto`, or `{{duration: {clip(str(data))}}}`"
                if seconds
                else "write `auto`, or a mapping with start, after, duration",
            )
        return data

    @classmethod
    def __get_pydantic_json_schema__(
        cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Return the mapping's schema beside ``auto``."""
        schema = handler.resolve_ref_schema(handler(core_schema))
        return {"anyOf": [{"const": "auto"}, schema]}


class RequireSpec(Model):
    """What a shot promises; verification holds the plan to it."""

    in_frame: Share | None = Field(
        default=None, description="least share of the shot with the whole target in frame"
    )
    screen_error: ScreenDistance | None = Field(
        default=None, description="largest distance on screen between target and reference"
    )
    size: ShareRange | None = Field(
        default=None, description="lowest and highest projected height over frame height"
    )


class RefineSpec(Model):
    """How refinement is used on a shot."""

    optional: Switch = Field(
        default=False, description="whether the unrefined path will do where refinement fails"
    )

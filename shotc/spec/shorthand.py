"""Mappings that may be written as one quantity: ``wind: 3 m/s`` for ``wind: {speed: 3 m/s}``."""

from typing import Any, ClassVar

from pydantic import GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from shotc.spec.model import Model
from shotc.spec.quantities import Quantity


class QuantityModel(Model):
    """A mapping that may be written as the quantity of one of its keys, ``SHORT``."""

    SHORT: ClassVar[tuple[str, Quantity]]

    @classmethod
    def shorthand(cls, data: Any) -> Any:
        """Return the mapping for one quantity."""
        key, quantity = cls.SHORT
        return {key: quantity.read(data)} if isinstance(data, str | int | float) else data

    @classmethod
    def __get_pydantic_json_schema__(
        cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Return the schema of the mapping or of the quantity."""
        schema = handler.resolve_ref_schema(handler(core_schema))
        return {"anyOf": [cls.SHORT[1].reference(), schema]}

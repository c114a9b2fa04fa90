"""The JSON Schema (2020-12) of a mission, generated from the models, for editors and other tools.

The schema contains what follows from the shape alone: keys, types, lengths, words, units. ``load`` and the
passes check the order of ranges, names, and everything that needs the world.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue, models_json_schema
from pydantic_core import core_schema

from shotc.spec.mission import MissionSpec
from shotc.spec.shot import ShotBase

DIALECT = "https://json-schema.org/draft/2020-12/schema"
IDENTIFIER = "https://shotc.dev/schema/mission-1.json"
_References = dict[type[Any], JsonSchemaValue]


def json_schema(kinds: Mapping[str, type[ShotBase]]) -> dict[str, Any]:
    """Return the schema of a mission whose shots are of these kinds."""
    references, definitions = _of_models({MissionSpec, *kinds.values()})
    mission = definitions.pop(references[MissionSpec]["$ref"].rpartition("/")[2])
    mission["properties"]["shots"]["items"] = _shots(
        {name: references[kinds[name]] for name in sorted(kinds)}
    )
    shared = _Shared(references)
    mission = shared.hoist(mission)
    definitions = {name: shared.hoist(schema) for name, schema in definitions.items()} | shared.definitions
    head = {"$schema": DIALECT, "$id": IDENTIFIER, "title": "shotc mission"}
    used = _reachable(mission, definitions)
    return {**head, **mission, "$defs": {name: definitions[name] for name in sorted(used)}}


def _of_models(models: set[type[Any]]) -> tuple[_References, dict[str, JsonSchemaValue]]:
    """Return references to all models, also those that fields only mark, and the definitions."""
    by_model, whole = models_json_schema(
        [(model, "validation") for model in models], schema_generator=_Generator
    )
    marked = models | {part["$model"] for part in _parts(whole) if "$model" in part}
    if marked > models:
        return _of_models(marked)
    return {model: by_model[model, "validation"] for model in models}, dict(whole["$defs"])


def _parts(schema: Any) -> Iterator[JsonSchemaValue]:
    """Yield a schema and every schema in it."""
    if isinstance(schema, dict):
        yield schema
    below = schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ()
    for part in below:
        yield from _parts(part)


def _shots(references: Mapping[str, JsonSchemaValue]) -> JsonSchemaValue:
    """Return the schema of one shot: its kind selects the definition."""
    if not references:
        return {"type": "object"}
    branches = [
        {"if": {"properties": {"kind": {"const": name}}, "required": ["kind"]}, "then": reference}
        for name, reference in references.items()
    ]
    kind = {"enum": list(references), "description": "what sort of shot it is"}
    return {"type": "object", "required": ["kind"], "properties": {"kind": kind}, "allOf": branches}


class _Generator(GenerateJsonSchema):
    """Pydantic's generator for values as written, not as stored in the models."""

    def nullable_schema(self, schema: core_schema.NullableSchema) -> JsonSchemaValue:
        """Omit null, because a key without a value is a fault."""
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        """Omit defaults, because models store them in SI, and a bare number would be refused for an angle."""
        return self.generate_inner(schema["schema"])

    def dict_schema(self, schema: core_schema.DictSchema) -> JsonSchemaValue:
        """Require the pattern of names for every key."""
        values = self.generate_inner(schema["values_schema"])
        names = self.generate_inner(schema["keys_schema"])
        return {"type": "object", "propertyNames": names, "additionalProperties": values}

    def sort(self, value: JsonSchemaValue, parent_key: str | None = None) -> JsonSchemaValue:
        """Keep the order of the models, because editors propose keys in it."""
        return value

    def field_title_should_be_set(self, schema: Any) -> bool:
        """Omit titles, because they repeat the key."""
        return False


class _Shared:
    """Moves marked schemas into definitions and leaves references (see ``FieldType.reference``)."""

    def __init__(self, models: _References) -> None:
        self.definitions: dict[str, JsonSchemaValue] = {}
        self._models = models

    def hoist(self, schema: Any) -> Any:
        """Return the schema with references instead of marked schemas; descriptions stay beside them."""
        if isinstance(schema, list):
            return [self.hoist(item) for item in schema]
        if not isinstance(schema, dict):
            return schema
        about = {"description": schema["description"]} if "description" in schema else {}
        if "$model" in schema:
            return {**self._models[schema["$model"]], **about}
        if "$shared" not in schema:
            return {key: self.hoist(value) for key, value in schema.items()}
        name = schema["$shared"]
        self.definitions[name] = self.hoist(schema["$of"])
        return {"$ref": f"#/$defs/{name}", **about}


def _reachable(mission: JsonSchemaValue, definitions: Mapping[str, JsonSchemaValue]) -> set[str]:
    """Return the names of the definitions that a mission refers to, directly or indirectly."""
    seen: set[str] = set()
    waiting = [mission]
    while waiting:
        named = {str(part.get("$ref", "")).removeprefix("#/$defs/") for part in _parts(waiting.pop())}
        new = (named & definitions.keys()) - seen
        seen |= new
        waiting += (definitions[name] for name in new)
    return seen

"""The base of every model of the language: frozen, closed to unknown keys, reporting all its faults.

Modules that define models do without ``from __future__ import annotations``: pydantic would have to
compile every annotation again.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple, Self, get_args

from pydantic import BaseModel, ConfigDict, Field, GetJsonSchemaHandler, ValidationError, model_validator
from pydantic.fields import FieldInfo
from pydantic.functional_validators import ModelWrapValidatorHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, InitErrorDetails, PydanticCustomError

from shotc.spec.faults import details_of, fault, together
from shotc.spec.words import closest, key_help
from shotc.units import clip, describe

# Looking for the nearest word takes time; nobody reads a thousand proposals.
_ADVISED = 100


class OneOf(NamedTuple):
    """Keys of one mapping that exclude each other: exactly one of ``forms`` may be given.

    forms : each a tuple of keys that belong together, such as ``(("look_at",), ("heading", "pitch"))``
    required : whether none of them is a fault
    """

    forms: tuple[tuple[str, ...], ...]
    required: bool = True

    def faults(self, given: Mapping[str, object]) -> list[InitErrorDetails]:
        """Return what is wrong with the keys that are given."""
        present = [key for key in given if any(key in form for form in self.forms)]
        if not present:
            return [_detail((), "missing-field", f"missing {self._choice()}")] if self.required else []
        fitting = [form for form in self.forms if set(present) <= set(form)]
        if not fitting:
            return [self._conflict(present)]
        missing = [key for key in fitting[0] if key not in present]
        return [
            _detail((), "missing-field", f"missing key `{key}`", f"`{present[0]}` needs `{key}` beside it")
            for key in missing
        ]

    def schema(self) -> JsonSchemaValue:
        """Return the same rule as JSON Schema."""
        every = {key for form in self.forms for key in form}
        branches = [_exactly(form, every - set(form)) for form in self.forms]
        return {"anyOf": branches if self.required else [*branches, _exactly((), every)]}

    def _conflict(self, present: list[str]) -> InitErrorDetails:
        first, last = present[0], next(k for k in present if not self._together(present[0], k))
        message = f"`{last}` cannot stand beside `{first}`"
        clash = fault("conflicting-fields", message, f"give {self._choice()}", beside=first)
        return InitErrorDetails(type=clash, loc=(last,), input=None)

    def _together(self, one: str, other: str) -> bool:
        return any(one in form and other in form for form in self.forms)

    def _choice(self) -> str:
        return " or ".join(" with ".join(f"`{key}`" for key in form) for form in self.forms)


class Model(BaseModel):
    """A mapping of the language.

    All faults of one mapping are raised together: those of its fields, unknown and missing keys with
    the nearest known key, and keys that exclude each other.
    """

    # Deferred: a mission uses a few of the many models, and building one costs milliseconds.
    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        defer_build=True,
        hide_input_in_errors=True,
        model_title_generator=lambda model: model.__name__.removesuffix("Spec"),
    )
    exclusive: ClassVar[tuple[OneOf, ...]] = ()

    @model_validator(mode="wrap")
    @classmethod
    def _with_all_faults(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        if isinstance(data, cls):
            return data
        data = cls.shorthand(data)
        if not isinstance(data, dict):
            raise _no_mapping(data, cls.model_fields)
        details = [_empty(key) for key, value in data.items() if value is None and key in cls.model_fields]
        details += [detail for rule in cls.exclusive for detail in rule.faults(data)]
        try:
            model = handler(
                {key: value for key, value in data.items() if value is not None} if details else data
            )
        except ValidationError as error:
            raise together([*cls._explained(error, data), *details]) from None
        if details:
            raise together(details)
        return model

    @classmethod
    def shorthand(cls, data: Any) -> Any:
        """Return the mapping that a value stands for where there is a shorter way to write it."""
        return data

    @classmethod
    def __get_pydantic_json_schema__(
        cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Return the model's schema with its exclusive keys."""
        schema = handler(core_schema)
        if cls.exclusive:
            handler.resolve_ref_schema(schema)["allOf"] = [rule.schema() for rule in cls.exclusive]
        return schema

    @classmethod
    def _explained(cls, error: ValidationError, data: Mapping[str, object]) -> list[InitErrorDetails]:
        """Put pydantic's faults about this mapping's own keys into the language's words."""
        details = details_of(error)
        missing = [str(d["loc"][0]) for d in details if _is(d, "missing")]
        unknown = [str(d["loc"][0]) for d in details if _is(d, "extra_forbidden")]
        strange = [_unknown(key, missing, cls.model_fields) for key in unknown[:_ADVISED]]
        strange += [
            _detail((key,), "unknown-field", f"unknown key `{clip(key)}`") for key in unknown[_ADVISED:]
        ]
        # A missing key that an unknown one resembles is one slip of the pen, not two faults.
        accounted = {closest(key, missing) for key in unknown[:_ADVISED]} | data.keys()
        absent = [_missing(key, cls.model_fields[key]) for key in missing if key not in accounted]
        others = [
            d for d in details if not (_is(d, "missing") or _is(d, "extra_forbidden") or _echo(d, details))
        ]
        return [*(_few(d, cls.model_fields) for d in others), *absent, *strange]


def section(description: str) -> Any:
    """Return a field for a mapping that may be left out and then has all its defaults.

    An empty mapping is validated in its place: an instance as default would build its model on import.
    """
    return Field(default={}, validate_default=True, description=description)


def _exactly(given: tuple[str, ...], absent: set[str]) -> JsonSchemaValue:
    rule: JsonSchemaValue = {"required": list(given)}
    if absent:
        rule["not"] = {"anyOf": [{"required": [key]} for key in sorted(absent)]}
    return rule


def _no_mapping(value: object, known: Mapping[str, object]) -> PydanticCustomError:
    slug = "empty-value" if value is None else "wrong-type"
    return fault(
        slug, f"expected a mapping, got {describe(value)}", f"write a mapping with {', '.join(known)}"
    )


def _is(detail: InitErrorDetails, kind: str) -> bool:
    """Tell whether a fault is pydantic's about a key of this very mapping."""
    error = detail["type"]
    return len(detail.get("loc", ())) == 1 and not isinstance(error, str) and error.type == kind


def _echo(detail: InitErrorDetails, details: list[InitErrorDetails]) -> bool:
    """Tell whether pydantic calls a list too short only because it does not count faulty items."""
    loc = detail["loc"]
    if isinstance(detail["type"], str) or detail["type"].type != "too_short":
        return False
    return any(len(d["loc"]) > len(loc) and d["loc"][: len(loc)] == loc for d in details)


def _few(detail: InitErrorDetails, known: Mapping[str, FieldInfo]) -> InitErrorDetails:
    """Say of a list of this mapping that is too short what it holds; return any other fault as it is."""
    if not _is(detail, "too_short"):
        return detail
    error, key = detail["type"], str(detail["loc"][0])
    assert isinstance(error, PydanticCustomError)
    context = error.context or {}
    message = f"`{key}` has {context['actual_length']}, and {context['min_length']} or more are needed"
    return _detail((key,), "wrong-length", message, f"give {known[key].description}")


def _empty(key: str) -> InitErrorDetails:
    return _detail((key,), "empty-value", f"`{key}` has no value", f"write its value, or remove `{key}`")


def _missing(key: str, field: FieldInfo) -> InitErrorDetails:
    help_ = f"add `{key}`: {field.description}" if field.description else f"add `{key}`"
    return _detail((), "missing-field", f"missing key `{key}`", help_)


def _unknown(key: str, missing: list[str], known: Mapping[str, FieldInfo]) -> InitErrorDetails:
    below = [name for name, field in known.items() if key in _keys_below(field)]
    close = closest(key, missing)
    help_ = f"did you mean `{close}`?" if close else key_help(key, known)
    if below:
        help_ = f"`{key}` belongs under `{below[0]}`"
    return _detail((key,), "unknown-field", f"unknown key `{clip(key)}`", help_)


def _keys_below(field: FieldInfo) -> Mapping[str, object]:
    """Return the keys of the mapping that a field holds, if it holds one."""
    for part in (field.annotation, *get_args(field.annotation)):
        if isinstance(part, type) and issubclass(part, Model):
            return part.model_fields
    return {}


def _detail(loc: tuple[str | int, ...], slug: str, message: str, help_: str = "") -> InitErrorDetails:
    return InitErrorDetails(type=fault(slug, message, help_), loc=loc, input=None)

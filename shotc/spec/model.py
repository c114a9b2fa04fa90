"""The base of every model of the language: frozen, closed to unknown keys, reporting all its faults."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any, ClassVar, Self

from pydantic import BaseModel, ConfigDict, GetJsonSchemaHandler, ValidationError, model_validator
from pydantic.functional_validators import ModelWrapValidatorHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, InitErrorDetails

from shotc.spec.faults import details_of, fault, together
from shotc.units import clip, describe


@dataclass(frozen=True, slots=True)
class OneOf:
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
        branches: list[JsonSchemaValue] = [
            {
                "required": list(form),
                "not": {"anyOf": [{"required": [key]} for key in self._others(form)]},
            }
            for form in self.forms
        ]
        if not self.required:
            every = sorted({key for form in self.forms for key in form})
            branches.append({"not": {"anyOf": [{"required": [key]} for key in every]}})
        return {"anyOf": branches}

    def _others(self, form: tuple[str, ...]) -> list[str]:
        return sorted({key for other in self.forms for key in other} - set(form))

    def _conflict(self, present: list[str]) -> InitErrorDetails:
        first, last = present[0], next(k for k in present if not self._together(present[0], k))
        return _detail(
            (last,),
            "conflicting-fields",
            f"`{last}` cannot stand beside `{first}`",
            f"give {self._choice()}",
        )

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
    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True, hide_input_in_errors=True)
    exclusive: ClassVar[tuple[OneOf, ...]] = ()

    @model_validator(mode="wrap")
    @classmethod
    def _with_all_faults(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        if isinstance(data, cls):
            return data
        data = cls.shorthand(data)
        if not isinstance(data, dict):
            known = ", ".join(cls.model_fields)
            raise fault(
                "wrong-type", f"expected a mapping, got {describe(data)}", f"write a mapping with {known}"
            )
        details = [detail for rule in cls.exclusive for detail in rule.faults(data)]
        try:
            model = handler(data)
        except ValidationError as error:
            raise together([*map(cls._explained, details_of(error)), *details]) from None
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
    def _explained(cls, detail: InitErrorDetails) -> InitErrorDetails:
        """Put pydantic's faults about this mapping's own keys into the language's words."""
        loc = detail.get("loc", ())
        kind = detail["type"].type if not isinstance(detail["type"], str) else detail["type"]
        if len(loc) != 1 or kind not in {"missing", "extra_forbidden", "invalid_key"}:
            return detail
        key = str(loc[0])
        if kind == "missing":
            about = cls.model_fields[key].description
            help_ = f"add `{key}`: {about}" if about else f"add `{key}`"
            return _detail((), "missing-field", f"missing key `{key}`", help_)
        return _detail((key,), "unknown-field", f"unknown key `{clip(key)}`", nearest(key, cls.model_fields))


def nearest(word: str, known: Mapping[str, object]) -> str:
    """Return a help that proposes the nearest known word, or lists them all."""
    close = get_close_matches(word, known, n=1, cutoff=0.6)
    return f"did you mean `{close[0]}`?" if close else f"known are {', '.join(known)}"


def _detail(loc: tuple[str | int, ...], slug: str, message: str, help_: str = "") -> InitErrorDetails:
    return InitErrorDetails(type=fault(slug, message, help_), loc=loc, input=None)

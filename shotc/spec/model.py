"""The base of every model of the language: frozen, closed to unknown keys, with reports of all faults.

Modules that define models do not use ``from __future__ import annotations``, because pydantic would have to
compile every annotation again.
"""

from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple, Self, get_args, get_origin

from pydantic import BaseModel, ConfigDict, Field, GetJsonSchemaHandler, ValidationError, model_validator
from pydantic.fields import FieldInfo
from pydantic.functional_validators import ModelWrapValidatorHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, InitErrorDetails, PydanticCustomError

from shotc.spec.pydantic_faults import details_of, fault, together
from shotc.spec.words import closest, elsewhere, nearest
from shotc.units import clip, describe

# The search for the nearest word takes time, and nobody reads a thousand proposals.
_ADVISED_KEYS = 100


class MissingKey(NamedTuple):
    """A required part that a mapping lacks.

    keys : the keys that can provide it; name : in messages; detail : the fault
    """

    keys: tuple[str, ...]
    name: str
    detail: InitErrorDetails


class OneOf(NamedTuple):
    """Keys of one mapping that exclude each other: exactly one of ``forms`` may be given.

    forms : each a tuple of keys that belong together, such as ``(("look_at",), ("heading", "pitch"))``
    required : whether a mapping with none of them is a fault
    help : advice for a conflict, if the list of keys is not enough
    """

    forms: tuple[tuple[str, ...], ...]
    required: bool = True
    help: str = ""

    def conflicts(self, given: Mapping[str, object]) -> list[InitErrorDetails]:
        """Return the faults of given keys that exclude each other."""
        present = self._present(given)
        return [] if not present or self._fitting(present) else [self._conflict(present)]

    def lacks(self, given: Mapping[str, object]) -> list[MissingKey]:
        """Return the keys that are missing besides the given ones."""
        present = self._present(given)
        if not present:
            every = tuple(dict.fromkeys(key for form in self.forms for key in form))
            absent = _detail((), "missing-field", f"missing {self._choice()}")
            return [MissingKey(every, self._choice(), absent)] if self.required else []
        missing = [key for form in self._fitting(present)[:1] for key in form if key not in present]
        help_ = "`{}` needs `{}` beside it"
        return [
            MissingKey(
                (key,),
                f"`{key}`",
                _detail((), "missing-field", f"missing key `{key}`", help_.format(present[0], key)),
            )
            for key in missing
        ]

    def _present(self, given: Mapping[str, object]) -> list[str]:
        return [key for key in given if any(key in form for form in self.forms)]

    def _fitting(self, present: list[str]) -> list[tuple[str, ...]]:
        return [form for form in self.forms if set(present) <= set(form)]

    def schema(self) -> JsonSchemaValue:
        """Return the same rule as JSON Schema."""
        every = {key for form in self.forms for key in form}
        branches = [_exactly(form, every - set(form)) for form in self.forms]
        return {"anyOf": branches if self.required else [*branches, _exactly((), every)]}

    def _conflict(self, present: list[str]) -> InitErrorDetails:
        first, last = present[0], next(k for k in present if not self._together(present[0], k))
        message = f"`{last}` cannot stand beside `{first}`"
        clash = fault("conflicting-fields", message, self.help or f"give {self._choice()}", beside=first)
        return InitErrorDetails(type=clash, loc=(last,), input=None)

    def _together(self, one: str, other: str) -> bool:
        return any(one in form and other in form for form in self.forms)

    def _choice(self) -> str:
        """Return the alternatives in words, without the optional keys beside them."""
        least = [form for form in self.forms if not any(set(other) < set(form) for other in self.forms)]
        return " or ".join(" with ".join(f"`{key}`" for key in form) for form in least)


class Model(BaseModel):
    """A mapping of the language.

    All faults of one mapping are raised together: those of its fields, unknown and missing keys with
    the nearest known key, and keys that exclude each other.
    """

    # Deferred, because a mission uses few of the many models, and building one costs milliseconds.
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
            raise _no_mapping(data, cls.keys())
        known = cls.keys()
        details = [_empty(key, known[key]) for key, value in data.items() if value is None and key in known]
        details += [detail for rule in cls.exclusive for detail in rule.conflicts(data)]
        lacks = [lack for rule in cls.exclusive for lack in rule.lacks(data)]
        try:
            model = handler(
                {key: value for key, value in data.items() if value is not None} if details else data
            )
        except ValidationError as error:
            raise together([*cls._explained(error, data, lacks), *details]) from None
        if details or lacks:
            raise together([*details, *(lack.detail for lack in lacks)])
        return model

    @classmethod
    def keys(cls) -> Mapping[str, FieldInfo]:
        """Return the fields by their keys in missions; `from` is an alias, because it is a Python keyword."""
        return {field.alias or name: field for name, field in cls.model_fields.items()}

    @classmethod
    def shorthand(cls, data: Any) -> Any:
        """Return the mapping for a value in a shorter notation; other values stay as they are."""
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
    def _explained(
        cls, error: ValidationError, data: Mapping[str, object], lacks: list[MissingKey]
    ) -> list[InitErrorDetails]:
        """Translate pydantic's faults about this mapping's own keys to the language's terms."""
        details, known = details_of(error), cls.keys()
        missing = [str(d["loc"][0]) for d in details if _is(d, "missing")]
        lacks = [*lacks, *(_missing(key, known[key]) for key in missing if key not in data)]
        unknown = [str(d["loc"][0]) for d in details if _is(d, "extra_forbidden")]
        others = [
            d for d in details if not (_is(d, "missing") or _is(d, "extra_forbidden") or _echo(d, details))
        ]
        absent = {key: field for key, field in known.items() if key not in data}
        return [*(_few(d, known) for d in others), *_wrong_keys(unknown, lacks, known, absent)]


def section(description: str) -> Any:
    """Return a field for an optional mapping that has all its defaults if it is omitted.

    Its default is an empty mapping that is validated, because an instance would build its model on import.
    """
    return Field(default={}, validate_default=True, description=description)


def _exactly(given: tuple[str, ...], absent: set[str]) -> JsonSchemaValue:
    rule: JsonSchemaValue = {"required": list(given)}
    if absent:
        rule["not"] = {"anyOf": [{"required": [key]} for key in sorted(absent)]}
    return rule


def _no_mapping(value: object, known: Mapping[str, object]) -> PydanticCustomError:
    slug = "empty-value" if value is None else "wrong-type"
    rule = f"write a mapping with {', '.join(known)}"
    if len(known) == 1 and isinstance(value, str | int | float) and not isinstance(value, bool):
        rule = f"write `{{{next(iter(known))}: {clip(str(value))}}}`"
    return fault(slug, f"expected a mapping, got {describe(value)}", rule)


def _is(detail: InitErrorDetails, kind: str) -> bool:
    """Return whether a fault is pydantic's about a key of this mapping itself."""
    error = detail["type"]
    return len(detail.get("loc", ())) == 1 and not isinstance(error, str) and error.type == kind


def _echo(detail: InitErrorDetails, details: list[InitErrorDetails]) -> bool:
    """Return whether pydantic reports a list as too short only because it does not count faulty items."""
    loc = detail["loc"]
    if isinstance(detail["type"], str) or detail["type"].type != "too_short":
        return False
    return any(len(d["loc"]) > len(loc) and d["loc"][: len(loc)] == loc for d in details)


def _few(detail: InitErrorDetails, known: Mapping[str, FieldInfo]) -> InitErrorDetails:
    """Return the fault of a too short list of this mapping with its content; other faults stay as they
    are.
    """
    if not _is(detail, "too_short"):
        return detail
    error, key = detail["type"], str(detail["loc"][0])
    assert isinstance(error, PydanticCustomError)
    context = error.context or {}
    message = f"`{key}` has {context['actual_length']}, and {context['min_length']} or more are needed"
    return _detail((key,), "wrong-length", message, f"give {known[key].description}")


def _empty(key: str, field: FieldInfo) -> InitErrorDetails:
    help_ = "write its value" if field.is_required() else f"write its value, or remove `{key}`"
    return _detail((key,), "empty-value", f"`{key}` has no value", help_)


def _missing(key: str, field: FieldInfo) -> MissingKey:
    help_ = f"add `{key}`: {field.description}" if field.description else f"add `{key}`"
    return MissingKey((key,), f"`{key}`", _detail((), "missing-field", f"missing key `{key}`", help_))


def _wrong_keys(
    unknown: list[str],
    lacks: list[MissingKey],
    known: Mapping[str, FieldInfo],
    absent: Mapping[str, FieldInfo],
) -> list[InitErrorDetails]:
    """Return the faults of unknown and missing keys; one misspelt key is one fault, not two."""
    placed = {key: _place(key, known) for key in unknown[:_ADVISED_KEYS]}
    meant = {key: closest(key, absent) for key, place in placed.items() if not place}
    still = [lack for lack in lacks if not set(lack.keys) & set(meant.values())]
    if len(unknown) == len(still) == 1 and not (placed[unknown[0]] or closest(unknown[0], known)):
        return [_instead(unknown[0], still[0], known)]
    strange = [
        _detail((key,), "unknown-field", f"unknown key `{clip(key)}`", _key_help(key, placed, meant, known))
        for key in unknown
    ]
    return [*(lack.detail for lack in still), *strange]


def _key_help(
    key: str, placed: Mapping[str, str], meant: Mapping[str, str | None], known: Mapping[str, FieldInfo]
) -> str:
    if key not in placed:
        return ""
    close = meant.get(key)
    return placed[key] or (f"did you mean `{close}`?" if close else nearest(key, known))


def _place(key: str, known: Mapping[str, FieldInfo]) -> str:
    """Return the other place where a key belongs, in words; empty if there is none."""
    below = [name for name, field in known.items() if key in _keys_below(field)]
    if not below:
        return elsewhere(key, known)
    named = "a name in " if get_origin(known[below[0]].annotation) is dict else ""
    return f"`{key}` belongs under {named}`{below[0]}`"


def _instead(key: str, lack: MissingKey, known: Mapping[str, FieldInfo]) -> InitErrorDetails:
    """Return one fault for a dissimilar pair of the only unknown key and the only missing one."""
    message = f"unknown key `{clip(key)}`, and {lack.name} is missing"
    about = known[lack.keys[0]].description if len(lack.keys) == 1 else ""
    help_ = f"write {lack.name} instead" + (f": {about}" if about else "")
    return _detail((key,), "unknown-field", message, help_)


def _keys_below(field: FieldInfo) -> Mapping[str, object]:
    """Return the keys of the mapping in a field, if it is one."""
    parts = (field.annotation, *get_args(field.annotation))
    return next((m.keys() for m in parts if isinstance(m, type) and issubclass(m, Model)), {})


def _detail(loc: tuple[str | int, ...], slug: str, message: str, help_: str = "") -> InitErrorDetails:
    return InitErrorDetails(type=fault(slug, message, help_), loc=loc, input=None)

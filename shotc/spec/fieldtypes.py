"""Field types as annotations for pydantic: each reads a YAML value and describes itself in the schema.

A field type chooses between alternative shapes itself, not pydantic, so that one fault gives one report.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from shotc.spec.pydantic_faults import fault
from shotc.spec.words import nearest
from shotc.units import a, clip, describe


class FieldType(ABC):
    """An annotation that reads and describes one kind of value.

    label : name of its definition in the JSON Schema
    """

    label: str

    @abstractmethod
    def read(self, value: Any) -> Any:
        """Return the value as stored in the models; raise a fault if it is invalid."""

    @abstractmethod
    def schema(self) -> JsonSchemaValue:
        """Return the JSON Schema of valid values."""

    def reference(self) -> JsonSchemaValue:
        """Return the schema marked for hoisting into the shared definitions (see spec.schema)."""
        return {"$shared": self.label, "$of": self.schema()}

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, core: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        return self.reference()


class Integer(FieldType):
    """An integer between ``low`` and ``high``, inclusive."""

    def __init__(self, label: str, low: int, high: int) -> None:
        self.label = label
        self.low = low
        self.high = high

    def read(self, value: Any) -> int:
        """Return the number; 3.0 is valid too. Raise a fault if it is not whole, or out of range."""
        if isinstance(value, bool) or not isinstance(value, int | float) or value != value // 1:
            raise fault("wrong-type", f"expected a whole number, got {describe(value)}")
        if not self.low <= value <= self.high:
            raise fault(
                "out-of-range",
                f"{clip(repr(value) if isinstance(value, float) else _digits(value))} is out of range",
                f"give a whole number from {self.low} to {self.high}",
            )
        return int(value)

    def schema(self) -> JsonSchemaValue:
        """Return an integer schema."""
        return {"type": "integer", "minimum": self.low, "maximum": self.high}


def _digits(value: int) -> str:
    # Python refuses to print integers with thousands of digits.
    return str(value) if abs(value) < 10**30 else "a number of many digits"


class Text(FieldType):
    """Text that matches ``pattern``; anything else is reported with ``rule`` as help."""

    def __init__(self, label: str, pattern: str, fault: str, rule: str) -> None:
        self.label = label
        self.pattern = pattern
        self.fault = fault
        self.rule = rule

    def read(self, value: Any) -> str:
        """Return the text. Raise a fault unless the pattern fits."""
        if not isinstance(value, str):
            raise fault("wrong-type", f"expected text, got {describe(value)}", self.rule)
        if re.fullmatch(self.pattern, value) is None:
            raise fault(self.fault, f"`{clip(value)}` cannot be used as {self.what}", self.rule)
        return value

    @property
    def what(self) -> str:
        """Return the label in words."""
        return a(re.sub(r"(?<!^)(?=[A-Z])", " ", self.label).lower())

    def schema(self) -> JsonSchemaValue:
        """Return a string schema."""
        return {"type": "string", "pattern": self.pattern, "description": self.rule}


def one_line(label: str, most: int, example: str) -> Text:
    """Return the type of one line of visible text, without control characters and line ends."""
    pattern = rf"^(?=.*\S)[^\x00-\x1f\x7f-\x9f\u2028\u2029]{{1,{most}}}$"
    rule = f'give one line of at most {most} characters, such as "{example}"'
    return Text(label, pattern, "wrong-length", rule)


class TextOrNumber(Text):
    """Text that may look like an integer, such as an id; stored as text."""

    def read(self, value: Any) -> str:
        """Return the text."""
        return super().read(_digits(value) if type(value) is int else value)

    def schema(self) -> JsonSchemaValue:
        """Return the schema of both notations."""
        return {"anyOf": [super().schema(), {"type": "integer"}]}


class Hinted(FieldType):
    """Another field type with a special help for a text that people write there by mistake.

    slip : pattern of that text, case-insensitive
    """

    def __init__(self, of: FieldType, slip: str, help: str) -> None:
        self.label = of.label
        self.of = of
        self.slip = slip
        self.help = help

    def read(self, value: Any) -> Any:
        """Return the value as the other type reads it, or raise its fault, with the help for a slip."""
        try:
            return self.of.read(value)
        except PydanticCustomError as error:
            if not (isinstance(value, str) and re.fullmatch(self.slip, clip(value), re.IGNORECASE)):
                raise
            details = error.context or {}
            raise fault(error.type, details["message"], self.help, details["notes"]) from None

    def schema(self) -> JsonSchemaValue:
        """Return the other type's schema."""
        return self.of.schema()


class NamedOr(FieldType):
    """A name from a table, stored as the table's value, or a value that ``other`` reads.

    what : the noun for messages about unknown names; all_by : the command that lists the names
    """

    def __init__(
        self,
        label: str,
        named: Mapping[str, Any],
        what: str,
        other: FieldType | None = None,
        all_by: str = "",
    ) -> None:
        self.label = label
        self.named = named
        self.what = what
        self.other = other
        self.listed = f" (`{all_by}` shows all)" if all_by else ""

    def read(self, value: Any) -> Any:
        """Return the table's entry, or the value as ``other`` reads it. Raise a fault for an unknown name."""
        if isinstance(value, str) and (self.other is None or value[:1].isalpha()):
            if value not in self.named:
                help_ = nearest(value, self.named) + self.listed
                raise fault("unknown-value", f"unknown {self.what} `{clip(value)}`", help_)
            return self.named[value]
        if self.other is None:
            raise fault("wrong-type", f"expected the name of {a(self.what)}, got {describe(value)}")
        return self.other.read(value)

    def schema(self) -> JsonSchemaValue:
        """Return the schema of the names or of the other type."""
        names = {"enum": list(self.named)}
        return names if self.other is None else {"anyOf": [names, self.other.reference()]}

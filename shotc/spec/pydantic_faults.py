"""Faults as pydantic errors: the error type is a code's slug, with message, notes and help.

A field or a validator raises ``fault(...)``, or ``fault_at(...)`` for a place below its value. ``load``
converts each into one diagnostic. Kinds use the same two functions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, TypeVar

from pydantic import ValidationError
from pydantic_core import InitErrorDetails, PydanticCustomError

from shotc.units import QuantityError

Loc = tuple[str | int, ...]
T = TypeVar("T")


def fault(
    slug: str, message: str, help: str = "", notes: tuple[str, ...] = (), beside: str = ""
) -> PydanticCustomError:
    """Return an error for pydantic that ``load`` reports under the code with this slug.

    message : lower case, no final stop; help : the change that would fix it; notes : facts
    beside : a related key of the same mapping, also shown
    """
    # pydantic fills the template from the context. We read only the context back.
    context = {"message": message, "help": help, "notes": notes, "beside": beside}
    return PydanticCustomError(slug, "{message}", context)


def fault_at(loc: Loc, slug: str, message: str, help: str = "") -> ValidationError:
    """Return the same fault at ``loc`` below the value under validation."""
    return together([InitErrorDetails(type=fault(slug, message, help), loc=loc, input=None)])


def unit_fault(error: QuantityError) -> PydanticCustomError:
    """Return a unit fault as a pydantic error; its slug is the kind."""
    return fault(error.kind, error.message, error.help)


def together(details: list[InitErrorDetails]) -> ValidationError:
    """Return several placed faults as one error."""
    return ValidationError.from_exception_data("mission", details, hide_input=True)


def details_of(error: ValidationError | PydanticCustomError, loc: Loc = ()) -> list[InitErrorDetails]:
    """Return an error's faults, below ``loc``, to raise them again with others."""
    if isinstance(error, PydanticCustomError):
        return [InitErrorDetails(type=error, loc=loc, input=None)]
    return [
        InitErrorDetails(type=_again(item), loc=(*loc, *item["loc"]), input=item["input"])
        for item in error.errors(include_url=False)
    ]


def _again(item: Any) -> PydanticCustomError:
    ctx = item.get("ctx", {})
    if "message" in ctx:
        return fault(item["type"], ctx["message"], ctx["help"], ctx["notes"], ctx["beside"])
    return PydanticCustomError(item["type"], item["msg"].replace("{", "("), ctx)


def read_each(readers: Iterable[tuple[Loc, Callable[[], T]]]) -> list[T]:
    """Return the results of all readers.

    Raise the faults of all of them as one ValidationError, each at its place.
    """
    values: list[T] = []
    details: list[InitErrorDetails] = []
    for loc, reader in readers:
        try:
            values.append(reader())
        except (ValidationError, PydanticCustomError) as error:
            details.extend(details_of(error, loc))
    if details:
        raise together(details)
    return values

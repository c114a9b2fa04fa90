"""Translation of pydantic's errors to the language's terms: one finding for each fault, with its place."""

import re
from collections.abc import Callable, Mapping
from typing import Any, Literal, NamedTuple

from pydantic import ValidationError

from shotc.ir.origin import KeyPath
from shotc.spec.words import nearest
from shotc.units import clip, describe

# Faults of a key, or of a missing value, are reported at the key.
_ON_KEY = frozenset({"unknown-field", "missing-field", "conflicting-fields", "empty-value"})


class UnplacedFault(NamedTuple):
    """A fault before it has a place in the text.

    path : key path from the top of the mission; slug : of its code; blame : the part to underline
    beside : path of a related key
    """

    path: KeyPath
    slug: str
    message: str
    help: str = ""
    notes: tuple[str, ...] = ()
    blame: Literal["key", "value"] = "value"
    beside: KeyPath | None = None


def findings(error: ValidationError) -> list[UnplacedFault]:
    """Return pydantic's faults in its order."""
    return [_finding(item) for item in error.errors(include_url=False)]


def _finding(item: Any) -> UnplacedFault:
    path, slug, ctx = tuple(item["loc"]), item["type"], item.get("ctx", {})
    on_key = slug in _ON_KEY
    if path[-1:] == ("[key]",):  # pydantic's mark for the key of a mapping of names
        path, on_key = path[:-1], True
    if "message" not in ctx:
        return _own_words(path, item)
    blame: Literal["key", "value"] = "key" if on_key else "value"
    beside = (*path[:-1], ctx["beside"]) if ctx["beside"] else None
    return UnplacedFault(path, slug, ctx["message"], ctx["help"], tuple(ctx["notes"]), blame, beside)


def _own_words(path: KeyPath, item: Any) -> UnplacedFault:
    """Translate an error of pydantic's own types."""
    describe_ = _WORDS.get(item["type"])
    if describe_ is None:
        return UnplacedFault(path, "wrong-type", clip(item["msg"], 120).rstrip(".").lower())
    words = describe_(item.get("ctx", {}), item.get("input"))
    return UnplacedFault(path, words.slug, words.message, words.help)


class _Words(NamedTuple):
    slug: str
    message: str
    help: str = ""


def _choice(ctx: Mapping[str, Any], value: Any) -> _Words:
    known = dict.fromkeys(re.findall(r"'([^']*)'", str(ctx.get("expected", ""))))
    if not isinstance(value, str):
        return _Words("wrong-type", f"expected one of {', '.join(known)}, got {describe(value)}")
    return _Words("unknown-value", f"unknown value `{clip(value)}`", nearest(value, known))


def _mapping(ctx: Mapping[str, Any], value: Any) -> _Words:
    return _Words(
        "wrong-type",
        f"expected a mapping of names, got {describe(value)}",
        "write `name: {...}` lines under it",
    )


def _list(ctx: Mapping[str, Any], value: Any) -> _Words:
    return _Words(
        "wrong-type", f"expected a list, got {describe(value)}", "write [...], or one `- ` line per item"
    )


def _short(ctx: Mapping[str, Any], value: Any) -> _Words:
    few = f"expected at least {ctx.get('min_length')} items, got {ctx.get('actual_length')}"
    return _Words("wrong-length", few)


def _long(ctx: Mapping[str, Any], value: Any) -> _Words:
    return _Words("wrong-length", f"expected at most {ctx.get('max_length')} items, got more")


def _flag(ctx: Mapping[str, Any], value: Any) -> _Words:
    return _Words("wrong-type", f"expected true or false, got {describe(value)}")


def _text(ctx: Mapping[str, Any], value: Any) -> _Words:
    return _Words("wrong-type", f"expected text, got {describe(value)}")


_WORDS: dict[str, Callable[[Mapping[str, Any], Any], _Words]] = {
    "literal_error": _choice,
    "dict_type": _mapping,
    "tuple_type": _list,
    "list_type": _list,
    "too_short": _short,
    "too_long": _long,
    "string_type": _text,
    "bool_type": _flag,
}

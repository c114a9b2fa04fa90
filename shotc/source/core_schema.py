"""Convert plain scalars to values by the core schema of YAML 1.2 (section 10.3.2)."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from math import inf, nan

ScalarValue = str | int | float | bool | None

_INT = re.compile(r"[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?")
_WORDS: dict[str, ScalarValue] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL"), None),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **{sign + word: inf for sign in ("", "+") for word in (".inf", ".Inf", ".INF")},
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), -inf),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), nan),
}
_NUMBER_STARTS = frozenset("+-.0123456789")
# Longer integers exceed the largest float, and their exact conversion takes quadratic time.
_LONGEST_INT = 320
_LARGEST = int(sys.float_info.max)


def resolve(text: str) -> ScalarValue:
    """Return the value of a plain (unquoted) scalar. A number beyond the range of floats is infinite."""
    if text in _WORDS:
        return _WORDS[text]
    if text[0] not in _NUMBER_STARTS:
        return text
    if _INT.fullmatch(text):
        return _integer(text)
    return float(text) if _FLOAT.fullmatch(text) else text


def _integer(text: str) -> int | float:
    """Read a decimal, octal (0o) or hexadecimal (0x) integer."""
    endless = -inf if text[0] == "-" else inf
    if len(text) > _LONGEST_INT:
        return endless
    value = int(text, {"0o": 8, "0x": 16}.get(text[:2], 10))
    return value if abs(value) <= _LARGEST else endless


def _is_float(value: ScalarValue) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


_TAGGED: dict[str, Callable[[ScalarValue], bool]] = {
    "int": lambda value: isinstance(value, int) and not isinstance(value, bool),
    "float": _is_float,
    "bool": lambda value: isinstance(value, bool),
    "null": lambda value: value is None,
}
CORE_TAG = "tag:yaml.org,2002:"


def resolve_tagged(tag: str, text: str) -> tuple[bool, ScalarValue]:
    """Return whether the core schema has ``tag`` and ``text`` fits it, and the value."""
    if tag in ("!", CORE_TAG + "str"):
        return True, text
    value = resolve(text)
    fits = _TAGGED.get(tag.removeprefix(CORE_TAG)) if tag.startswith(CORE_TAG) else None
    if fits is None or not fits(value):
        return False, text
    return True, float(value) if tag.endswith(":float") and isinstance(value, int) else value

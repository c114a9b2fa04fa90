"""Quantities: a number in SI, or text with a unit from a closed table.

A bare number is SI (metres, seconds, m/s). For an angle it is refused, because degrees and radians look
alike. Nothing is evaluated and no units are composed: a unit outside the table is unknown.
"""

from __future__ import annotations

import re
from difflib import get_close_matches
from functools import cache
from math import inf, isfinite, pi
from typing import Literal

Dimension = Literal[
    "length",
    "duration",
    "speed",
    "acceleration",
    "jerk",
    "angle",
    "angular rate",
    "angular acceleration",
    "ratio",
    "frequency",
    "mass",
    "energy",
]
Kind = Literal[
    "unknown-unit", "wrong-dimension", "bare-angle", "missing-unit", "not-a-quantity", "absurd-value"
]

_SI = (1.0, 1.0)
_DEG = (pi / 180, 1.0)
_FOOT = (0.3048, 1.0)
_KMH = (1.0, 3.6)
_KNOT = (1852.0, 3600.0)

# The accepted spellings of each dimension, with the factor and then the divisor for SI. With a divisor 95 %
# is 0.95 to the last digit.
UNITS: dict[Dimension, dict[str, tuple[float, float]]] = {
    "length": {"m": _SI, "mm": (1.0, 1e3), "cm": (1.0, 1e2), "km": (1e3, 1.0), "ft": _FOOT},
    "duration": {"s": _SI, "ms": (1.0, 1e3), "min": (60.0, 1.0), "h": (3600.0, 1.0)},
    "speed": {
        "m/s": _SI,
        "km/h": _KMH,
        "kmh": _KMH,
        "kn": _KNOT,
        "kt": _KNOT,
        "mph": (1609.344, 3600.0),
        "ft/s": _FOOT,
    },
    "acceleration": dict.fromkeys(("m/s^2", "m/s²", "m/s2"), _SI),
    "jerk": dict.fromkeys(("m/s^3", "m/s³", "m/s3"), _SI),
    "angle": {"deg": _DEG, "°": _DEG, "rad": _SI},
    "angular rate": {"deg/s": _DEG, "°/s": _DEG, "rad/s": _SI},
    "angular acceleration": {
        **dict.fromkeys(("deg/s^2", "deg/s²", "deg/s2", "°/s²", "°/s^2"), _DEG),
        **dict.fromkeys(("rad/s^2", "rad/s²", "rad/s2"), _SI),
    },
    "ratio": {"%": (1.0, 1e2)},
    "frequency": {"Hz": _SI},
    "mass": {"kg": _SI, "g": (1.0, 1e3), "lb": (0.45359237, 1.0)},
    "energy": {"J": _SI, "kJ": (1e3, 1.0), "Wh": (3600.0, 1.0), "kWh": (3.6e6, 1.0)},
}

# No camera drone operates beyond these magnitudes (SI): a larger number is a mistake.
LARGEST: dict[Dimension, float] = {
    "length": 1e5,
    "duration": 1e5,
    "speed": 1e3,
    "acceleration": 1e3,
    "jerk": 1e5,
    "angle": 1e3,
    "angular rate": 1e3,
    "angular acceleration": 1e5,
    "ratio": 1e3,
    "frequency": 1e3,
    "mass": 1e3,
    "energy": 1e9,
}

# A value that must be positive counts as zero below these magnitudes.
SMALLEST: dict[Dimension, float] = {
    "length": 1e-4,
    "duration": 1e-3,
    "speed": 1e-3,
    "acceleration": 1e-3,
    "jerk": 1e-3,
    "angle": 1e-4,
    "angular rate": 1e-4,
    "angular acceleration": 1e-4,
    "ratio": 1e-4,
    "frequency": 1e-2,
    "mass": 1e-3,
    "energy": 1e2,
}

EXAMPLES: dict[Dimension, str] = {
    "length": "12 m",
    "duration": "20 s",
    "speed": "8 m/s",
    "acceleration": "3 m/s^2",
    "jerk": "8 m/s^3",
    "angle": "45 deg",
    "angular rate": "60 deg/s",
    "angular acceleration": "90 deg/s^2",
    "ratio": "80 %",
    "frequency": "50 Hz",
    "mass": "2 kg",
    "energy": "77 Wh",
}

ANGULAR: frozenset[Dimension] = frozenset({"angle", "angular rate", "angular acceleration"})

NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
# Longer text is no quantity; the bound keeps messages and the search for a similar unit short.
_LONGEST_TEXT_CHARACTERS = 60
# A unit starts with a letter or with % ° ': `1,5` and `9**9` are no numbers with units.
_QUANTITY = re.compile(rf"\s*({NUMBER})\s*((?:[^\W\d_]|[°%'])\S*)?\s*")

_WINDS = ("north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west")
# Compass bearings in words, which people write for a heading, in degrees.
_COMPASS = {
    name: 45 * i
    for i, wind in enumerate(_WINDS)
    for name in (wind, wind.replace("-", ""), "".join(part[0] for part in wind.split("-")))
}

_TURNS = ("turn", "turns", "rev", "revs", "revolution", "revolutions", "rotation", "rotations")

# Spellings that are not similar to the intended unit in the table, or more similar to another one.
_MEANT = {
    "meter": "m",
    "meters": "m",
    "metre": "m",
    "metres": "m",
    "feet": "ft",
    "foot": "ft",
    "'": "ft",
    "sec": "s",
    "secs": "s",
    "second": "s",
    "seconds": "s",
    "mins": "min",
    "minute": "min",
    "minutes": "min",
    "hr": "h",
    "hrs": "h",
    "hour": "h",
    "hours": "h",
    "kph": "km/h",
    "mps": "m/s",
    "fps": "ft/s",
    "kts": "kn",
    "knot": "kn",
    "knots": "kn",
    "degree": "deg",
    "degrees": "deg",
    "degs": "deg",
    "radian": "rad",
    "radians": "rad",
    "percent": "%",
    "hz": "Hz",
}


class QuantityError(ValueError):
    """A value that is no quantity of the required dimension.

    kind : of the fault; message, help : for a diagnostic
    """

    def __init__(self, kind: Kind, message: str, help_: str = "") -> None:
        super().__init__(message)
        self.kind: Kind = kind
        self.message = message
        self.help = help_


def parse_quantity(value: object, dimension: Dimension) -> float:
    """Return ``value`` in SI (radians for angles).

    value : a number (SI; refused for an angular ``dimension``) or text such as ``12 km/h``

    Raise QuantityError for anything else, for values that are not finite, and for magnitudes beyond
    ``LARGEST``.
    """
    if isinstance(value, str):
        return _bounded(_parse_text(value, dimension), dimension, value.strip())
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise QuantityError(
            "not-a-quantity", f"expected {a(dimension)}, got {describe(value)}", _such_as(dimension)
        )
    if dimension in ANGULAR:
        raise QuantityError(
            "bare-angle",
            f"{a(dimension)} needs a unit",
            _with_unit(value, dimension) if isfinite(_real(value)) else _such_as(dimension),
        )
    return _bounded(_real(value), dimension, _short(value))


def a(noun: str) -> str:
    """Return the noun with its indefinite article."""
    return f"{'an' if noun[0] in 'aeiou' else 'a'} {noun}"


def describe(value: object) -> str:
    """Return the kind of a YAML value in words."""
    names = {dict: "a mapping", list: "a list", bool: "true or false", int: "a number", float: "a number"}
    if value is None:
        return "nothing"
    if isinstance(value, str):
        return f"the text `{clip(value)}`"
    return names.get(type(value), "something else")


def clip(text: str, width: int = 40) -> str:
    """Return the text on one line, shortened to ``width``."""
    line = " ".join(text.split())
    return line if len(line) <= width else line[: width - 1] + "…"


def _parse_text(text: str, dimension: Dimension) -> float:
    match = _QUANTITY.fullmatch(text) if len(text) <= _LONGEST_TEXT_CHARACTERS else None
    if match is None:
        message = f"expected {a(dimension)}, got {describe(text)}"
        raise QuantityError("not-a-quantity", message, _likely_meaning(text, dimension))
    number, unit = float(match[1]), match[2] or ""
    scale = UNITS[dimension].get(unit)
    if scale is not None:
        return number * scale[0] / scale[1]
    if not unit:
        raise _without_unit(match[1], dimension)
    other = _dimension_of(unit)
    if other is not None:
        raise QuantityError(
            "wrong-dimension",
            f"expected {a(dimension)}, got {a(other)}",
            f"`{clip(text)}` is {a(other)}; {_such_as(dimension)}",
        )
    help_ = _whole_turns(number, unit, dimension) or _nearest(unit, dimension)
    raise QuantityError("unknown-unit", f"unknown unit `{clip(unit)}`", help_)


def _likely_meaning(text: str, dimension: Dimension) -> str:
    """Return the help for text that is no quantity: its most likely meaning."""
    bearing = _COMPASS.get(text.strip().lower()) if dimension == "angle" else None
    if bearing is not None:
        return f"write `{bearing} deg`"
    point = text.strip().replace(",", ".")
    if text.count(",") == 1 and len(point) <= _LONGEST_TEXT_CHARACTERS and _QUANTITY.fullmatch(point):
        return f"decimals have a point: `{point}`"
    return _such_as(dimension)


def _whole_turns(number: float, unit: str, dimension: Dimension) -> str:
    """Return the help for an angle in turns; empty for any other."""
    if dimension != "angle" or unit.lower() not in _TURNS:
        return ""
    return f"a turn is 360 deg: write `{_short(360 * number)} deg`"


def _with_unit(value: float, dimension: Dimension) -> str:
    """Return the help for a bare angle: in degrees, or also in radians if it is small."""
    degrees = f"write `{_short(value)} {_unit(dimension)}`"
    if abs(value) > 2 * pi:
        return degrees
    return f"{degrees}, or `{_short(value)} {_unit(dimension, 'rad')}` if radians are meant"


def _without_unit(number: str, dimension: Dimension) -> QuantityError:
    if dimension in ANGULAR:
        return QuantityError(
            "bare-angle", f"{a(dimension)} needs a unit", f"write `{number} {_unit(dimension)}`"
        )
    unit = _unit(dimension)
    return QuantityError(
        "missing-unit",
        f'a number in quotes needs a unit, got `"{number}"`',
        f"write {number} without quotes, or `{number} {unit}`",
    )


def _bounded(value: float, dimension: Dimension, text: str) -> float:
    if not (isfinite(value) and abs(value) <= LARGEST[dimension]):
        unit = _unit(dimension, "rad")
        raise QuantityError(
            "absurd-value",
            f"`{clip(text)}` is no usable {dimension}",
            f"a {dimension} is a finite number of at most {LARGEST[dimension]:g} {unit}",
        )
    return value


def _real(value: float) -> float:
    try:
        return float(value)
    except OverflowError:  # an int beyond 1e308
        return inf


def _unit(dimension: Dimension, angular: str = "deg") -> str:
    if dimension in ANGULAR:
        return next(unit for unit in UNITS[dimension] if unit.startswith(angular))
    return next(iter(UNITS[dimension]))


def _such_as(dimension: Dimension) -> str:
    return f"write {a(dimension)} such as `{EXAMPLES[dimension]}`"


def _short(value: float) -> str:
    # The repr of an int can have thousands of digits, or be refused for that.
    try:
        return f"{value:.10g}"
    except OverflowError:
        return "a number beyond all bounds"


@cache
def _dimension_of(unit: str) -> Dimension | None:
    return next((name for name, units in UNITS.items() if unit in units), None)


def _nearest(unit: str, dimension: Dimension) -> str:
    known = list(UNITS[dimension])
    meant = _MEANT.get(unit.lower())
    near = [name for name in known if name.lower() == unit.lower()]
    near += [meant] if meant in known else get_close_matches(unit, known, n=1, cutoff=0.5)
    if near:
        return f"did you mean `{near[0]}`?"
    return f"{a(dimension)} is written in {', '.join(known)}"

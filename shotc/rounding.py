"""Numbers rounded to one side, so that a number from a message suffices when written into a mission."""

from math import ceil, floor, log10

EXACT_SHARE = 2e-8
"""Share of the last digit that counts as rounding error: a number above a decimal by less is that decimal.

It is below the tolerance of checks, a micrometre or microsecond, so the number in a message still passes
them.
"""

MOST_DECIMALS = 9
"""Decimals at which a value that is still not below its limit counts as the limit."""


def up(value: float, digits: int = 2) -> float:
    """Return the least number with so many decimals that is not below a value."""
    return _decimal(ceil(_steps(value, digits) - EXACT_SHARE), digits)


def down(value: float, digits: int = 2) -> float:
    """Return the greatest number with so many decimals that is not above a value."""
    return _decimal(floor(_steps(value, digits) + EXACT_SHARE), digits)


def at_least(value: float, digits: int = 2) -> str:
    """Return a value rounded up as text, with all its decimals."""
    return f"{up(value, digits):.{max(digits, 0)}f}"


def at_most(value: float, digits: int = 2) -> str:
    """Return a value rounded down as text, with all its decimals."""
    return f"{down(value, digits):.{max(digits, 0)}f}"


def nearer_than(value: float, limit: float) -> str:
    """Return a value rounded up as text, with enough decimals to stay below a limit that it is below.

    So two things come within the distance that is told, and it is told to be too small.
    """
    digits = 2
    while value < limit <= up(value, digits) and digits < MOST_DECIMALS:
        digits += 1
    return at_least(value, digits)


def rounded_outward(value: float, *, upper: bool, digits: int) -> float:
    """Return a value rounded to so many significant digits, up for an upper limit, else down."""
    if value == 0:
        return 0.0
    decimals = digits - 1 - floor(log10(abs(value)))
    return up(value, decimals) if upper else down(value, decimals)


def plain(value: float, digits: int = 3) -> str:
    """Return a value as text with at most so many decimals, without trailing zeros."""
    return f"{value:.{digits}f}".rstrip("0").rstrip(".")


def _steps(value: float, digits: int) -> float:
    return float(value * 10**digits)


def _decimal(steps: int, digits: int) -> float:
    return steps / 10**digits if digits >= 0 else float(steps * 10**-digits)


def as_minutes(seconds: float) -> str:
    """Return a time as text: minutes, seconds and tenths."""
    tenths = round(seconds * 10)
    return f"{tenths // 600}:{tenths // 10 % 60:02d}.{tenths % 10}"


def exposure(seconds: float) -> str:
    """Return an exposure time as photographers write it, with at most four digits."""
    return f"1/{1 / seconds:.4g} s" if seconds < 0.5 else f"{seconds:g} s"

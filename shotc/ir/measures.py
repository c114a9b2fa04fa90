"""Numbers of claims as people read them: degrees for radians, percent for shares, digits that tell apart."""

from __future__ import annotations

from math import degrees, isfinite

from shotc.ir.trajectory import Claim
from shotc.rounding import away

DIGITS = 4
"""Digits that a value is shown with where nothing needs more."""

SHARES = frozenset({"of samples", "of its outline"})
"""Units of shares, which people read in percent."""

MOST_DIGITS = 12
"""Digits beyond which two values are the same."""


def measure(value: float, unit: str, digits: int = DIGITS) -> str:
    """Return a value with its unit as people read it; lengths to the millimetre."""
    if not isfinite(value):
        return "unlimited"
    number, sign = _as_read(value, unit)
    if unit == "m" and abs(number) >= 1e-3:
        return f"{number:.{digits - 1}f} m"
    return f"{0.0 if abs(number) < 1e-9 else number:.{digits}g} {sign}".strip()


def told_apart(first: float, second: float, unit: str) -> tuple[str, str]:
    """Return two values as ``measure`` shows them, with as many digits as it takes to see which is which."""
    for digits in range(DIGITS, MOST_DIGITS):
        shown = measure(first, unit, digits), measure(second, unit, digits)
        if shown[0] != shown[1]:
            return shown
    return measure(first, unit, MOST_DIGITS), measure(second, unit, MOST_DIGITS)


def enough(claim: Claim) -> str:
    """Return the worst value as a limit that it keeps, rounded away from it to four digits."""
    number, unit = _as_read(claim.worst, claim.unit)
    return f"{away(number, upper=claim.upper, digits=DIGITS):.{DIGITS}g} {unit}".strip()


def _as_read(value: float, unit: str) -> tuple[float, str]:
    if unit.startswith("rad"):
        return degrees(value), f"deg{unit[3:]}"
    return (100 * value, "%") if unit in SHARES else (value, unit)

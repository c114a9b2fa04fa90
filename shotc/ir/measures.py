"""Values of claims as text: degrees for radians, percent for shares, and enough digits to differ."""

from __future__ import annotations

from math import degrees, isfinite

from shotc.ir.trajectory import Claim
from shotc.rounding import rounded_outward

USUAL_DIGITS = 4
"""Default number of digits."""

SHARES = frozenset({"of samples", "of its outline"})
"""Units of shares, which are shown in percent."""

OUT_OF_PICTURE = " out of the picture"
"""Ending of the claim that another drone is not seen, after that drone's name."""

MOST_DIGITS = 12
"""Number of digits at which two values that still look alike count as the same."""


def measure(value: float, unit: str, digits: int = USUAL_DIGITS) -> str:
    """Return a value with its unit as text; lengths to the millimetre."""
    if not isfinite(value):
        return "unlimited"
    number, sign = _as_read(value, unit)
    if unit == "m" and abs(number) >= 1e-3:
        return f"{number:.{digits - 1}f} m"
    return f"{0.0 if abs(number) < 1e-9 else number:.{digits}g} {sign}".strip()


def distinct_measures(first: float, second: float, unit: str) -> tuple[str, str]:
    """Return two values as text by ``measure``, with enough digits to differ."""
    for digits in range(USUAL_DIGITS, MOST_DIGITS):
        texts = measure(first, unit, digits), measure(second, unit, digits)
        if texts[0] != texts[1]:
            return texts
    return measure(first, unit, MOST_DIGITS), measure(second, unit, MOST_DIGITS)


def enough(claim: Claim) -> str:
    """Return a limit that the claim's worst value keeps, as text: the value rounded away to four digits."""
    number, unit = _as_read(claim.worst, claim.unit)
    return (
        f"{rounded_outward(number, upper=claim.upper, digits=USUAL_DIGITS):.{USUAL_DIGITS}g} {unit}".strip()
    )


def _as_read(value: float, unit: str) -> tuple[float, str]:
    if unit.startswith("rad"):
        return degrees(value), f"deg{unit[3:]}"
    return (100 * value, "%") if unit in SHARES else (value, unit)

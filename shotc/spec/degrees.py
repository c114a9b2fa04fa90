"""Latitudes and longitudes as text from a map, and their notation in the language."""

import re
from typing import NamedTuple

_DEGREES = (
    r"([+-]?\d{1,3}(?:\.\d+)?)\s*°?\s*"
    r"(?:(\d{1,2}(?:\.\d+)?)\s*['′’]\s*(?:(\d{1,2}(?:\.\d+)?)\s*(?:\"|″|”|'')\s*)?)?"
)
_PASTED = (  # compiled at first use, because few missions need it
    rf"\s*\(?\s*{_DEGREES}([NSns])?\s*[,;\s]\s*{_DEGREES}([EWew])?\s*"
    r"(?:[,;\s]\s*([+-]?\d{1,5}(?:\.\d+)?)\s*(?:m|metres|meters)?)?\s*\)?\s*"
)
LONGEST_CHARACTERS = 80  # most characters of such a text


class Pasted(NamedTuple):
    """A geographic place, degrees; height : metres, as given, or None."""

    lat: float
    lon: float
    height: float | None = None


def pasted(value: object) -> Pasted | None:
    """Return the place that a text such as `46.68, 7.68` or `46°40'48"N 7°40'48"E` gives, if it is one."""
    if not isinstance(value, str) or len(value) > LONGEST_CHARACTERS:
        return None
    match = re.fullmatch(_PASTED, value)
    if match is None:
        return None
    lat, lon = _angle(match.groups()[:4], "S"), _angle(match.groups()[4:8], "W")
    if abs(lat) > 90.0 or abs(lon) > 180.0:
        return None
    return Pasted(lat, lon, None if match[9] is None else float(match[9]))


def place_on_earth(lat: float, lon: float, height: str = "") -> str:
    """Return a place in the notation of the language; height : as text, empty without one."""
    over = f", height: {height}" if height else ""
    return f"{{lat: {lat:.10g}, lon: {lon:.10g}{over}}}"


def instead_of(value: object, *, heights: bool = True) -> str:
    """Return the help for a pasted text; empty for other values. heights : whether the place may have one."""
    place = pasted(value)
    if place is None:
        return ""
    height = "" if place.height is None or not heights else f"{place.height:g}"
    return f"write `{place_on_earth(place.lat, place.lon, height)}`"


def _angle(parts: tuple[str | None, ...], negative: str) -> float:
    degrees, minutes, seconds, side = parts
    size = abs(float(degrees or 0)) + float(minutes or 0) / 60.0 + float(seconds or 0) / 3600.0
    below = (degrees or "").startswith("-") or (side or "").upper() == negative
    return -size if below else size

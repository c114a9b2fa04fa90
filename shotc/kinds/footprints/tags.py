"""The height extent and the name of a building from its OpenStreetMap tags.

The keys are those of Simple 3D Buildings: heights are above the lowest ground at the building, and include
its roof.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, NamedTuple

LEVEL_M = 3.0
"""Height of a level, for buildings with a number of levels and no height, metres."""
LONGEST_NAME_CHARACTERS = 80
HIGHEST_M = 1_000.0
"""No building is higher."""
_FEET = re.compile(r"(\d+(?:\.\d+)?)\s*(?:'|’|ft|feet)(?:\s*(\d+(?:\.\d+)?)\s*(?:\"|''|”|in)?)?")
_METRES = re.compile(r"([+-]?\d+(?:[.,]\d+)?)\s*(?:m|metres?|meters?)?")
_NO = frozenset({"no", "false", "0", "none", ""})

Tags = Mapping[str, Any]


class HeightExtent(NamedTuple):
    """The extent of a building above the lowest ground at it, metres; top : None if unknown.

    unread : a tag that should be a height and is none, as `key: text`; empty if all can be read
    """

    bottom: float
    top: float | None
    unread: str = ""


def extent_of(tags: Tags) -> HeightExtent:
    """Return the extent of a building from its tags.

    Heights at or below zero count as unknown, as in some collections of footprints.
    """
    unread = [
        f"{key}: {str(tags[key])[:30]}"
        for key in ("height", "min_height", "building:levels", "building:min_level")
        if tags.get(key) not in (None, "") and _metres(tags[key]) is None
    ]
    bottom = _positive(tags, "min_height")
    if bottom is None:
        bottom = LEVEL_M * (_positive(tags, "building:min_level") or 0.0)
    top = _positive(tags, "height")
    levels = _positive(tags, "building:levels")
    if top is None and levels is not None:
        roof = _positive(tags, "roof:height")
        top = LEVEL_M * levels + (LEVEL_M * (_positive(tags, "roof:levels") or 0.0) if roof is None else roof)
    return HeightExtent(bottom, top, unread[0] if unread else "")


def _positive(tags: Tags, key: str) -> float | None:
    value = _metres(tags.get(key))
    return value if value is not None and value > 0.0 else None


def _metres(value: Any) -> float | None:
    """Return a height in metres: a number, or text such as `12`, `12 m`, `12,5 m`, `40'` or `7'4"`."""
    if isinstance(value, bool) or value is None:
        return None
    if isinstance(value, int | float):
        return float(value) if abs(value) <= HIGHEST_M else None
    text = str(value).strip().lower()
    if feet := _FEET.fullmatch(text):
        metres = 0.3048 * float(feet[1]) + 0.0254 * float(feet[2] or 0.0)
    elif plain := _METRES.fullmatch(text):
        metres = float(plain[1].replace(",", "."))
    else:
        return None
    return metres if abs(metres) <= HIGHEST_M else None


def is_building(tags: Tags) -> bool:
    """Return whether tags describe a building or a part of one."""
    return any(_yes(tags, key) for key in ("building", "building:part"))


def is_part(tags: Tags) -> bool:
    """Return whether tags describe a part of a building, which replaces the building's outline."""
    return _yes(tags, "building:part")


def _yes(tags: Tags, key: str) -> bool:
    return key in tags and str(tags[key]).strip().lower() not in _NO


def name_of(value: Any) -> str:
    """Return a name or an id as printable text; empty for a value that is neither."""
    if isinstance(value, bool) or not isinstance(value, str | int):
        return ""
    return "".join(c if c.isprintable() else " " for c in str(value)[:LONGEST_NAME_CHARACTERS]).strip()

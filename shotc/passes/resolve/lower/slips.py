"""Positions in metres that look like degrees: numbers near the origin's latitude and longitude."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from math import hypot
from typing import Any, NamedTuple, get_args

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from shotc.diag.model import Diagnostic
from shotc.geom.geodetic import to_world
from shotc.ir.limits import Vec2
from shotc.ir.mission import GeoOrigin
from shotc.ir.origin import KeyPath, OriginMap
from shotc.kinds.earth import stray
from shotc.spec.degrees import place_on_earth
from shotc.spec.heights import AboveGround
from shotc.spec.mission import MissionSpec
from shotc.spec.places import PlaceType

LEAST_DEG = 1.0  # degrees from latitude and longitude 0, within which degrees look like any metres
TENTHS_PER_DEG = 10.0  # a position in degrees has more than one decimal, which is accurate to 11 km only
MOST_REPORTED = 10  # most warnings of one mission


class _WrittenPosition(NamedTuple):
    """A position in metres, as its field reads it, and its key path."""

    path: KeyPath
    place: tuple[Any, ...]


def check_slips(spec: MissionSpec, origin: GeoOrigin | None, origins: OriginMap) -> list[Diagnostic]:
    """Return a warning for each position in metres that would be near the origin in degrees."""
    if origin is None or hypot(origin.lat_deg, origin.lon_deg) < LEAST_DEG:
        return []
    slips: list[Diagnostic] = []
    for written in _in_metres(spec, ()):
        for swapped in (False, True):
            lat, lon = written.place[1::-1] if swapped else written.place[:2]
            if _looks_like_degrees(origin, lat, lon):
                slips.append(_slip(written, (lat, lon), origin, origins))
                break
    if len(slips) > MOST_REPORTED:
        more = f"{len(slips) - MOST_REPORTED} more places of this mission look like this"
        last = slips[MOST_REPORTED - 1]
        slips[MOST_REPORTED - 1 :] = [last._replace(notes=(*last.notes, more))]
    return slips


def _looks_like_degrees(origin: GeoOrigin, lat: float, lon: float) -> bool:
    if abs(lat) > 90.0 or abs(lon) > 180.0 or stray(origin, lat, lon) is not None:
        return False
    return any(abs(TENTHS_PER_DEG * value - round(TENTHS_PER_DEG * value)) > 1e-6 for value in (lat, lon))


def _slip(written: _WrittenPosition, place: Vec2, origin: GeoOrigin, origins: OriginMap) -> Diagnostic:
    x, y = written.place[:2]
    base = (origin.lat_deg, origin.lon_deg, 0.0)
    distance = hypot(*to_world((*place, 0.0), base)[:2])
    return Diagnostic(
        "G045",
        f"[{x:.10g}, {y:.10g}] is in metres here, and looks like latitude and longitude",
        (origins.value(written.path), origins.key(("world", "origin"), "the origin")),
        (
            f"it is {hypot(x, y):.1f} m from the origin in metres, and {distance:.0f} m in degrees "
            f"({origin.lat_deg:.10g}, {origin.lon_deg:.10g})",
        ),
        f"write `{_key(written.path)}{place_on_earth(*place, _height(written.place))}`",
    )


def _key(path: KeyPath) -> str:
    """Return the key of a value with its colon; empty for an item of a list."""
    return f"{path[-1]}: " if isinstance(path[-1], str) else ""


def _height(place: tuple[Any, ...]) -> str:
    """Return the height of a position as it is written; empty where it has none."""
    if len(place) < 3:
        return ""
    height = place[2]
    if not isinstance(height, AboveGround):
        return f"{height:.10g}"
    return "" if height.stands else f"{{above: ground, height: {height.height:.10g}}}"


def _in_metres(value: Any, path: KeyPath, *, place: bool = False) -> Iterator[_WrittenPosition]:
    """Yield the positions in metres within a value; place : whether its field contains positions."""
    if isinstance(value, BaseModel):
        for name, field in type(value).model_fields.items():
            if isinstance(part := getattr(value, name), BaseModel | dict | list | tuple):
                yield from _in_metres(part, (*path, field.alias or name), place=_places(field))
    elif isinstance(value, dict):
        for key, item in value.items():
            yield from _in_metres(item, (*path, key), place=place)
    elif isinstance(value, list | tuple):
        if place and value and isinstance(value[0], int | float):
            yield _WrittenPosition(path, tuple(value))
            return
        for i, item in enumerate(value):
            yield from _in_metres(item, (*path, i), place=place)


def _places(field: FieldInfo) -> bool:
    """Return whether a field contains positions, or lists of them."""
    annotation: Any = field.annotation
    return any(isinstance(part, PlaceType) for part in field.metadata) or _reads_places(annotation)


@lru_cache(maxsize=512)
def _reads_places(annotation: Any) -> bool:
    return any(isinstance(part, PlaceType) or _reads_places(part) for part in _parts(annotation))


def _parts(annotation: Any) -> tuple[Any, ...]:
    """Return the parts of an annotation: its arguments and its metadata."""
    return (*get_args(annotation), *getattr(annotation, "__metadata__", ()))

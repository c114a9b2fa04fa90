"""Positions in latitude and longitude: an origin ties W to the earth, and they have to be near it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

from shotc.diag.model import Diagnostic
from shotc.ir.mission import GeoOrigin
from shotc.ir.origin import KeyPath, OriginMap
from shotc.kinds.earth import stray
from shotc.spec.fields import OnMap
from shotc.spec.mission import MissionSpec


def geo_origin(spec: MissionSpec) -> GeoOrigin | None:
    """Return the origin of W on the earth, if the mission has one."""
    origin = spec.world.origin
    return None if origin is None else GeoOrigin(origin.lat, origin.lon, origin.alt)


def check_earth(spec: MissionSpec, origins: OriginMap) -> list[Diagnostic]:
    """Return one fault for all geodetic positions without a place in W, at the first of them."""
    if not any(path[-1:] == ("lat",) and path[:2] != ("world", "origin") for path in origins.values):
        return []
    places = sorted(_geodetic(spec, ()), key=lambda entry: origins.value(entry[0]).span)
    origin = geo_origin(spec)
    if origin is None:
        return [_without_origin(places, origins)] if places else []
    if not places:
        return []
    far = [(path, stray(origin, place.lat, place.lon)) for path, place in places]
    strays = [(path, outlier) for path, outlier in far if outlier is not None]
    if not strays:
        return []
    path, outlier = strays[0]
    labels = (origins.value(path), origins.key(("world", "origin"), "the origin"))
    notes = (outlier.note, *_count(len(strays)))
    return [Diagnostic("G017", outlier.message, labels, notes, outlier.help)]


def _without_origin(places: list[tuple[KeyPath, OnMap]], origins: OriginMap) -> Diagnostic:
    return Diagnostic(
        "G015",
        "a position in latitude and longitude, but the mission has no origin",
        (origins.value(places[0][0]),),
        ("without `world.origin` it cannot be put into the world", *_count(len(places))),
        "add `world: {origin: {lat: ..., lon: ..., alt: ...}}`",
    )


def _count(number: int) -> tuple[str, ...]:
    return (f"{number} positions of this mission have this fault",) if number > 1 else ()


def _geodetic(value: Any, path: KeyPath) -> Iterator[tuple[KeyPath, OnMap]]:
    if isinstance(value, OnMap):
        yield path, value
    elif isinstance(value, BaseModel):
        for name in type(value).model_fields:
            yield from _geodetic(getattr(value, name), (*path, name))
    elif isinstance(value, dict):
        for key, item in value.items():
            yield from _geodetic(item, (*path, key))
    elif isinstance(value, list | tuple):
        for i, item in enumerate(value):
            yield from _geodetic(item, (*path, i))

"""GeoJSON (RFC 7946) to footprints: outer rings of polygons, and their properties. Plain Python.

Longitude is before latitude, both in WGS84 degrees. Holes are filled.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from shotc.geom.vec import Vec2
from shotc.kinds.files import FileFault, utf8_text
from shotc.kinds.footprints.tags import Tags, name_of

MOST_FEATURES = 200_000
MOST_CORNERS = 1_000
"""Most corners of one ring; no house has more."""
_WGS84 = re.compile(r"(CRS:?84|EPSG:+([\d.]+:)?(4326|4979)|OGC:[\d.]*:?CRS84h?)$", re.IGNORECASE)
_NO_DEGREES = 1e9
_EXPORT = "export it as GeoJSON in WGS84 (EPSG:4326)"
_SIMPLE = ("Point", "MultiPoint", "LineString", "MultiLineString", "GeometryCollection")


class Footprint(NamedTuple):
    """A ring in geographic coordinates.

    ring   : (longitude, latitude), degrees, without a repeated first corner
    tags   : the properties of its feature
    name   : of its feature, else its id; number : of the feature in the file, from 1
    called : its name and its ids, as far as it has them
    """

    ring: tuple[Vec2, ...]
    tags: Tags
    name: str
    number: int
    called: tuple[str, ...] = ()


class FeatureCollection(NamedTuple):
    """The polygons of a file, and the number of features of other types, by type."""

    footprints: tuple[Footprint, ...]
    others: Mapping[str, int]


class _Wrong(Exception):
    """A fault of a feature."""


def read_geojson(data: bytes) -> FeatureCollection | FileFault:
    """Return the footprints of a file, or its first fault; the bytes may be anything."""
    value = _parsed(data)
    if isinstance(value, FileFault):
        return value
    features = _features(value)
    if isinstance(features, FileFault):
        return features
    footprints: list[Footprint] = []
    others: Counter[str] = Counter()
    for number, feature in enumerate(features, 1):
        try:
            rings = _rings(feature)
            if rings is None:
                others[_type_of(feature)] += 1
                continue
            tags, called = _tags(feature), _name_of(feature)
            name = next(iter(called), f"feature {number}")
            footprints += [Footprint(ring, tags, name, number, called) for ring in map(_ring, rings)]
        except _Wrong as wrong:
            return FileFault(f"feature {number}: {wrong}", None, _EXPORT)
    return FeatureCollection(tuple(footprints), others)


def _parsed(data: bytes) -> Any:
    text = utf8_text(data, _EXPORT)
    if isinstance(text, FileFault):
        return text
    try:
        return json.loads(text, parse_constant=_constant)
    except json.JSONDecodeError as error:
        return FileFault(f"it is not JSON, {error.msg[:1].lower()}{error.msg[1:]}", error.lineno, _EXPORT)
    except RecursionError:
        return FileFault("its values are nested too deeply", None, _EXPORT)
    except ValueError as error:
        return FileFault(str(error)[:100], None, _EXPORT)


def _constant(text: str) -> float:
    raise ValueError(f"{text} is not a number of JSON")


def _features(value: Any) -> list[Any] | FileFault:
    kind = value.get("type") if isinstance(value, dict) else None
    if kind == "Topology":
        return FileFault("it is TopoJSON, not GeoJSON", None, _EXPORT)
    if isinstance(value, dict) and "elements" in value:
        help_ = "export it as GeoJSON (in overpass turbo: Export, GeoJSON)"
        return FileFault("it is an answer of Overpass, not GeoJSON", None, help_)
    if kind not in ("FeatureCollection", "Feature"):
        return FileFault("it is no GeoJSON: its `type` is no FeatureCollection", None, _EXPORT)
    system = _foreign_system(value)
    if system:
        return FileFault(f"its `crs` is {system}, not WGS84", None, _EXPORT)
    features = [value] if kind == "Feature" else value.get("features")
    if not isinstance(features, list):
        return FileFault("it has no list of `features`", None, _EXPORT)
    if len(features) > MOST_FEATURES:
        help_ = "cut it to where the mission is flown"
        return FileFault(f"it has {len(features)} features; {MOST_FEATURES} are the most", None, help_)
    return features


def _foreign_system(value: Mapping[str, Any]) -> str:
    """Return the coordinate system in the old GeoJSON member `crs`, empty for WGS84 or none."""
    crs = value.get("crs")
    if crs is None:
        return ""
    properties = crs.get("properties") if isinstance(crs, dict) else None
    name = properties.get("name") if isinstance(properties, dict) else None
    if isinstance(name, str) and _WGS84.search(name):
        return ""
    return f"`{name[:60]}`" if isinstance(name, str) else "one without a name"


def _geometry(feature: Any) -> Any:
    if not isinstance(feature, dict) or feature.get("type") != "Feature":
        raise _Wrong("it is no Feature")
    return feature.get("geometry")


def _type_of(feature: Any) -> str:
    geometry = _geometry(feature)
    return "no geometry" if geometry is None else str(geometry["type"])


def _rings(feature: Any) -> list[Any] | None:
    """Return the outer rings of a feature's polygons; None for a feature without a polygon."""
    geometry = _geometry(feature)
    if geometry is None:
        return None
    kind = geometry.get("type") if isinstance(geometry, dict) else None
    if kind in _SIMPLE:
        return None
    if kind not in ("Polygon", "MultiPolygon"):
        raise _Wrong("its geometry is of no type of GeoJSON")
    polygons = geometry.get("coordinates")
    polygons = [polygons] if kind == "Polygon" else polygons
    if not isinstance(polygons, list) or not all(isinstance(p, list) and p for p in polygons):
        raise _Wrong("its polygon has no rings")
    return [polygon[0] for polygon in polygons]


def _ring(written: Any) -> tuple[Vec2, ...]:
    """Return the corners of a ring without consecutive repetitions."""
    if not isinstance(written, list) or not written:
        raise _Wrong("a ring of its polygon is no list of positions")
    if len(written) > MOST_CORNERS:
        raise _Wrong(f"a ring of its polygon has {len(written)} corners; {MOST_CORNERS} are the most")
    corners = list(map(_position, written))
    return tuple(p for i, p in enumerate(corners) if p != corners[i - 1] or len(corners) == 1)


def _position(written: Any) -> Vec2:
    pair = written[:2] if isinstance(written, list) else ()
    if len(pair) != 2 or not all(type(c) in (int, float) and abs(c) < _NO_DEGREES for c in pair):
        raise _Wrong("a position in it is not [longitude, latitude]")
    lon, lat = map(float, pair)
    if abs(lon) > 180.0 or abs(lat) > 90.0:
        raise _Wrong(f"[{lon:g}, {lat:g}] is no longitude and latitude in degrees")
    return (lon, lat)


def _tags(feature: Mapping[str, Any]) -> Tags:
    """Return the properties; some exports store those of OpenStreetMap under `tags`."""
    properties = feature.get("properties")
    if not isinstance(properties, dict):
        return {}
    below = properties.get("tags")
    return {**below, **properties} if isinstance(below, dict) else properties


def _name_of(feature: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the name of a feature and its ids, each once."""
    tags = _tags(feature)
    known = (tags.get("name"), feature.get("id"), tags.get("@id"), tags.get("id"))
    return tuple(dict.fromkeys(filter(None, map(name_of, known))))


def described(others: Mapping[str, int]) -> Iterator[str]:
    """Yield the number of features of each type in words, the most frequent first."""
    for kind, count in sorted(others.items(), key=lambda item: -item[1]):
        yield f"{count} of type {kind}" if kind != "no geometry" else f"{count} without geometry"

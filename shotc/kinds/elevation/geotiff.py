"""GeoTIFF files, read by Pillow: the heights of the first image, and its georeference tags.

Formats that Pillow does not read (64-bit floats, LERC, JPEG) are faults. Tags and keys are those of GeoTIFF
1.1 (OGC 19-008r4); 42113 is GDAL's.
"""

from __future__ import annotations

import io
import warnings
from typing import Any, NamedTuple

import numpy as np
from PIL import Image, UnidentifiedImageError

from shotc.geom.bernstein import Array
from shotc.geom.terrain.posts import MOST_POSTS, Posts, TerrainFault, posts_of

PIXEL_SCALE, TIE_POINTS, MATRIX, KEYS, NO_DATA = 33550, 33922, 34264, 34735, 42113
MODEL, RASTER, GEOGRAPHIC, ANGLES, PROJECTED, UNITS_UP = 1024, 1025, 2048, 2054, 3072, 4099
PIXEL_IS_POINT = 2
"""Value of RASTER for posts at the tie point of their pixel; else they are at the pixel's middle."""
DEGREE_UNIT = 9102
USER_DEFINED = 32767
METRE_UNIT = 9001
METRES = {METRE_UNIT: 1.0, 9002: 0.3048, 9003: 1200 / 3937}
"""Metres of a unit of heights: metre, foot, and US survey foot."""
BANDS = frozenset({"L", "I", "F", "I;16", "I;16B", "I;16L", "I;16N"})
SAVE_AS = "save it as float32 or int16, uncompressed or with deflate or LZW: `gdal_translate -ot Float32`"


class HeightRaster(NamedTuple):
    """Heights (R, C) in the file's unit, and its tags."""

    heights: Array
    tags: dict[int, Any]


class Along(NamedTuple):
    """The coordinate of columns or rows: first + step * k for pixel k."""

    first: float
    step: float


class RasterTags(NamedTuple):
    """The georeference: coordinates of columns and rows, EPSG code, and metres of a unit of heights."""

    x: Along
    y: Along
    system: int
    unit: float


def read_geotiff(data: bytes, system: int | None = None) -> Posts | TerrainFault:
    """Return the posts of a file with heights in metres, or its fault."""
    raster = _raster(data)
    if isinstance(raster, TerrainFault):
        return raster
    placed = _placed(raster.tags, system)
    if isinstance(placed, TerrainFault):
        return placed
    fault = _mark_unknown(raster)
    if fault is not None:
        return fault
    rows, columns = raster.heights.shape
    x, y = _along(placed.x, columns), _along(placed.y, rows)
    return posts_of(raster.heights * placed.unit, x, y, placed.system)


def _along(axis: Along, count: int) -> Array:
    return np.asarray(axis.first + axis.step * np.arange(count))


def _placed(tags: dict[int, Any], system: int | None) -> RasterTags | TerrainFault:
    keys = _keys(tags.get(KEYS, ()))
    axes = _axes(tags, keys.get(RASTER) == PIXEL_IS_POINT)
    if isinstance(axes, TerrainFault):
        return axes
    code = _system(keys, system)
    if isinstance(code, TerrainFault):
        return code
    unit = keys.get(UNITS_UP, METRE_UNIT)
    if unit not in METRES:
        return TerrainFault("system", f"its heights are in the unit {unit} of EPSG, which is not known")
    return RasterTags(*axes, code, METRES[unit])


def _raster(data: bytes) -> HeightRaster | TerrainFault:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about damaged tags, and about sizes, which we check ourselves
            with Image.open(io.BytesIO(data), formats=("TIFF",)) as image:
                return _pixels(image)
    except Image.DecompressionBombError:
        return TerrainFault("size", f"it has more than {MOST_POSTS} posts", None, "cut it to the mission")
    except UnidentifiedImageError:
        return TerrainFault("format", "it is no TIFF that can be read", None, SAVE_AS)
    except Exception as error:  # noqa: BLE001  the reader's faults of foreign bytes
        reason = (str(error).splitlines() or [""])[0][:200] or type(error).__name__
        if "truncated" in reason:
            return TerrainFault("truncated", f"Pillow says: {reason}", None, "copy the file anew")
        return TerrainFault("format", f"Pillow says: {reason}", None, SAVE_AS)


def _pixels(image: Image.Image) -> HeightRaster | TerrainFault:
    columns, rows = image.size
    if columns * rows > MOST_POSTS:
        message = f"it has {rows} x {columns} posts; {MOST_POSTS} are the most"
        return TerrainFault("size", message, None, "cut it to the mission, or thin it")
    if image.mode not in BANDS:
        message = f"its pixels are {image.mode}, not one number each"
        return TerrainFault("format", message, None, "export heights, not a picture of them")
    tags: dict[int, Any] = dict(getattr(image, "tag_v2", {}))
    heights = np.asarray(image)
    if heights.dtype.kind == "u" and heights.dtype.itemsize == 4:
        heights = heights.astype(np.int64)
    return HeightRaster(heights.astype(np.float64), tags)


def _keys(directory: Any) -> dict[int, int]:
    """Return the keys with values in the directory itself: codes; no others are needed here."""
    numbers = [int(n) for n in directory] if isinstance(directory, tuple) else []
    rows = [numbers[k : k + 4] for k in range(4, len(numbers) - 3, 4)]
    return {key: value for key, place, _, value in rows if place == 0}


def _system(keys: dict[int, int], given: int | None) -> int | TerrainFault:
    code = keys.get(PROJECTED, keys.get(GEOGRAPHIC) if keys.get(MODEL) != 1 else None)
    if code == USER_DEFINED:
        code = None
    if code is None and given is None:
        help_ = "give its `epsg` beside `file`, such as `epsg: 32632`"
        return TerrainFault("system", "its tags name no system of coordinates with an EPSG code", None, help_)
    if code is not None and given is not None and code != given:
        message = f"its tags say EPSG:{code}, the mission says EPSG:{given}"
        return TerrainFault("system", message, None, "leave `epsg` out")
    if PROJECTED not in keys and keys.get(ANGLES, DEGREE_UNIT) != DEGREE_UNIT:
        return TerrainFault("system", f"its angles are in the unit {keys[ANGLES]} of EPSG, not in degrees")
    epsg = code if code is not None else given
    assert epsg is not None
    return epsg


def _axes(tags: dict[int, Any], at_points: bool) -> tuple[Along, Along] | TerrainFault:
    half = 0.0 if at_points else 0.5
    try:
        if MATRIX in tags:
            a, b, _, x, d, e, _, y = (float(v) for v in tags[MATRIX][:8])
            if b != 0.0 or d != 0.0:
                help_ = "turn it upright: `gdalwarp`"
                return TerrainFault("grid", "its rows and columns are turned", None, help_)
            axes = Along(x + half * a, a), Along(y + half * e, e)
        elif PIXEL_SCALE in tags and TIE_POINTS in tags:
            i, j, _, x, y, _ = (float(v) for v in tags[TIE_POINTS][:6])
            a, e = (float(v) for v in tags[PIXEL_SCALE][:2])
            axes = Along(x + (half - i) * a, a), Along(y - (half - j) * e, -e)
        else:
            return TerrainFault("format", "it has no tags that say where it is: it is a plain TIFF")
    except (TypeError, ValueError):
        return TerrainFault("format", "its tags that say where it is are damaged")
    if not all(np.isfinite(along).all() and along.step for along in axes):
        return TerrainFault("number", "its tags give posts no finite places")
    return axes


def _mark_unknown(raster: HeightRaster) -> TerrainFault | None:
    """Set heights with the file's no-data value to NaN; return a fault if this value is no number."""
    said = raster.tags.get(NO_DATA)
    if said is None:
        return None
    try:
        mark = float(str(said).strip("\0 \t\r\n"))
    except ValueError:
        return TerrainFault("format", f"its mark of no height is `{str(said)[:30]}`, which is no number")
    # No-data values such as -3.4e38 are written with fewer digits than the pixels have.
    raster.heights[np.isclose(raster.heights, mark, rtol=1e-6, atol=0.0)] = np.nan
    return None

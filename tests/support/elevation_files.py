"""Elevation models as bytes: each format written by hand, or by Pillow with the tags of GeoTIFF."""

from __future__ import annotations

import io
from collections.abc import Mapping
from typing import Any

import numpy as np
from PIL import Image, TiffImagePlugin

KEYS = 34735


def ascii_grid(heights: np.ndarray, header: Mapping[str, Any]) -> bytes:
    """Rows from the north, as given; the header's sizes are those of the heights unless it has them."""
    sizes = {"ncols": heights.shape[1], "nrows": heights.shape[0]}
    lines = [f"{name} {value}" for name, value in {**sizes, **header}.items()]
    lines += [" ".join(f"{h:g}" for h in row) for row in heights]
    return ("\n".join(lines) + "\n").encode()


def tile(heights: np.ndarray) -> bytes:
    """An SRTM tile, rows from the north."""
    return heights.astype(">i2").tobytes()


def table(columns: str, rows: np.ndarray) -> bytes:
    return (columns + "\n" + "".join(",".join(f"{v:.12g}" for v in row) + "\n" for row in rows)).encode()


def geo_keys(**codes: int) -> tuple[int, ...]:
    """A directory of keys by their short names."""
    numbers = {
        "model": 1024,
        "raster": 1025,
        "geographic": 2048,
        "angles": 2054,
        "projected": 3072,
        "up": 4099,
    }
    entries = sorted((numbers[name], code) for name, code in codes.items())
    return (1, 1, 0, len(entries), *(n for key, code in entries for n in (key, 0, 1, code)))


UTM = geo_keys(model=1, raster=1, projected=32632)
PLACED: dict[int, Any] = {
    33550: (10.0, 10.0, 0.0),
    33922: (0.0, 0.0, 0.0, 400_000.0, 5_170_000.0, 0.0),
    KEYS: UTM,
}


def geotiff(heights: np.ndarray, tags: Mapping[int, Any] = PLACED, **options: Any) -> bytes:
    """One image, rows from the north; tags by number: floats, shorts for the keys, text."""
    directory = TiffImagePlugin.ImageFileDirectory_v2()
    for tag, value in tags.items():
        text, whole = isinstance(value, str), tag == KEYS
        directory.tagtype[tag] = 2 if text else 3 if whole else 12
        directory[tag] = value
    out = io.BytesIO()
    Image.fromarray(heights).save(out, "TIFF", tiffinfo=directory, **options)
    return out.getvalue()

"""Texts as outlines of their letters, by matplotlib's FreeType."""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from shotc.geom.bernstein import Array
from shotc.ir.show import Lettering
from shotc.show.goals.body import SourceFault
from shotc.show.goals.flat import FlatBody, FlatPart, closed, standing
from shotc.spec.words import closest

OUTLINE_PX = 200.0
"""Size at which letters are outlined; curves become lines of about a pixel, which is below a hundredth of
them.
"""


def lettering_body(source: Lettering, files: Mapping[str, bytes]) -> FlatBody | SourceFault:
    """Return a text as a flat picture about the middle of its bounding box, or a fault of its font.

    files : bytes of the mission's files by name; any other font is one of the system's
    """
    font = _font(source.font, files)
    if isinstance(font, SourceFault):
        return font
    missing = sorted({c for c in source.text if not c.isspace() and not font.get_char_index(ord(c))})
    if missing or not source.text.split():
        return _unwritable(source, missing)
    letters = _outlined(font, source.text)
    if not letters:
        return _unwritable(source, [])
    corners = np.concatenate(letters)
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2.0
    scale = source.height / _capital(font, corners)
    edges = np.concatenate([closed((polygon - middle) * scale) for polygon in letters])
    return standing([FlatPart(edges, True, False, 0.0)], source.centre, source.heading)


def _unwritable(source: Lettering, missing: list[str]) -> SourceFault:
    if not missing:
        return SourceFault("D055", "text", "the text has no letters to show", (), "write some")
    letters = ", ".join(f"`{c}`" for c in missing[:10])
    note = f"{len(missing)} of its letters are missing: {letters}"
    message = f"the font cannot write `{source.text[:40]}`"
    return SourceFault("D055", "text", message, (note,), "take another `font`, or write it without them")


def _font(name: str | None, files: Mapping[str, bytes]) -> Any:
    """Return FreeType's font, or the fault."""
    import matplotlib
    from matplotlib.ft2font import FT2Font

    if name is None:
        return _sized(FT2Font(str(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf")))
    if name in files:
        try:
            return _sized(FT2Font(io.BytesIO(files[name])))
        except Exception as error:  # noqa: BLE001  FreeType's faults of foreign bytes
            message = f"`{name}` cannot be read as a font"
            return SourceFault("D055", "font", message, (_reason(error),), "give a .ttf or .otf file")
    from matplotlib import font_manager

    try:
        path = font_manager.findfont(font_manager.FontProperties(family=name), fallback_to_default=False)
    except ValueError:
        known = sorted({entry.name for entry in font_manager.fontManager.ttflist})
        near = closest(name, known)
        help_ = (
            f"did you mean `{near}`?" if near else "name a .ttf file beside the mission, or leave `font` out"
        )
        note = f"this machine has {len(known)} fonts, and none of that name"
        return SourceFault("D055", "font", f"unknown font `{name}`", (note,), help_)
    return _sized(FT2Font(path))


def _reason(error: Exception) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0][:200]


def _sized(font: Any) -> Any:
    font.set_size(OUTLINE_PX, 72)
    return font


def _outlined(font: Any, text: str) -> list[Array]:
    """Return the closed polygons of a line of text with kerning, in pixels."""
    from matplotlib.ft2font import Kerning, LoadFlags
    from matplotlib.path import Path as Curve

    polygons: list[Array] = []
    pen, before = 0.0, 0
    for letter in text:
        index = font.get_char_index(ord(letter))
        if before and index:
            pen += font.get_kerning(before, index, Kerning.UNFITTED) / 64.0
        glyph = font.load_char(ord(letter), flags=LoadFlags.NO_HINTING)
        corners, codes = font.get_path()
        if len(corners):
            outline = Curve(np.asarray(corners) + np.array([pen, 0.0]), codes)
            rings = [np.asarray(ring) for ring in outline.to_polygons(closed_only=True)]
            polygons += [ring[:-1] for ring in rings if len(ring) > 3]
        pen += glyph.linearHoriAdvance / 65536.0
        before = index
    return polygons


def _capital(font: Any, corners: Array) -> float:
    """Return the height of a capital, or that of the text if the font has none."""
    if font.get_char_index(ord("H")):
        capital = _outlined(font, "H")
        if capital:
            return float(np.ptp(np.concatenate(capital)[:, 1]))
    return float(np.ptp(corners[:, 1]))

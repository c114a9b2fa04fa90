"""SVG files as flat pictures. A file must be self-contained: no script is run and nothing is fetched."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from shotc.geom.bernstein import Array
from shotc.importers.xml_tree import Node, XmlFault, parse_xml
from shotc.ir.effects import Color
from shotc.ir.show import Drawing
from shotc.show.goals.body import SourceFault
from shotc.show.goals.flat import FlatBody, FlatPart, chain, standing

CURVE_LINES = 16
"""Lines that replace a Bezier curve."""
ARC_LINES = 48
"""Lines that replace an elliptic arc; the error of a circle is at most a five-hundredth of its radius."""
MOST_ELEMENTS = 100_000
"""Most elements, with the repetitions by `use`, and most lines."""

DARK_LEVEL = 32
"""Largest channel of a colour, of 255, below which a light with it would not be visible."""

_FOREIGN = re.compile(r"url\(\s*['\"]?\s*(?![#'\"\s])|@import", re.IGNORECASE)
_DEEPEST_LEVEL = 200  # depth of elements, with those inserted by `use`
_REFUSED = {
    "script": ("a script", "remove the script"),
    "foreignObject": ("a foreign object", "remove it"),
    "image": ("an image", "trace the image into paths"),
    "text": ("a text", "turn texts into paths, or draw them by `text`"),
}


def drawing_body(source: Drawing, data: bytes) -> FlatBody | SourceFault:
    """Return an SVG's shapes about the middle of their bounding box, or a fault.

    A filled shape has an inside; a shape without fill is a line of its stroke's width.
    """
    root = parse_xml(data)
    if isinstance(root, XmlFault):
        return _fault(source, "cannot be read", f"line {root.line}: {root.message}", "save it as plain SVG")
    if _name(root.tag) != "svg":
        return _fault(source, "is no SVG", f"its root is `{root.tag[:40]}`", "save it as plain SVG")
    refused = next(_refused(root), None) or _repeated(root)
    if refused is not None:
        return _fault(source, "is refused", *refused)
    try:
        shapes = _shapes(data)
    except Exception as error:  # noqa: BLE001  the reader's faults of foreign text
        reason = (str(error).splitlines() or [type(error).__name__])[0][:200]
        return _fault(source, "cannot be read", reason, "save it as plain SVG")
    if not shapes:
        return _fault(source, "has nothing to draw", "no path, no shape", "draw paths that are filled")
    if sum(len(shape.edges) for shape in shapes) > 10 * MOST_ELEMENTS:
        return _fault(
            source, "is too large", f"its curves are more than {10 * MOST_ELEMENTS} lines", "simplify it"
        )
    return _scaled(source, shapes)


def _fault(source: Drawing, what: str, note: str, help_: str) -> SourceFault:
    return SourceFault("D054", "file", f"drawing `{source.file}` {what}", (note,), help_)


def _scaled(source: Drawing, shapes: list[FlatPart]) -> FlatBody | SourceFault:
    corners = np.concatenate([s.edges.reshape(-1, 2) for s in shapes])
    if not np.isfinite(corners).all() or np.abs(corners).max() > 1e12:
        return _fault(source, "is broken", "some of its numbers are no numbers", "save it anew")
    low, high = corners.min(axis=0), corners.max(axis=0)
    if high[1] - low[1] <= 1e-9 * (high[0] - low[0]) or high[1] <= low[1]:
        return _fault(source, "has no height", "all of it lies on one level line", "draw something taller")
    scale = source.height / (high[1] - low[1])
    placed = [replace(s, edges=(s.edges - (low + high) / 2.0) * scale, width=s.width * scale) for s in shapes]
    return standing(placed, source.centre, source.heading)


def _refused(root: Node) -> Iterator[tuple[str, str]]:
    """Yield the refused parts of a file, each as a fact and a remedy."""
    for node in root.everything():
        where = f"line {node.line}: "
        if _name(node.tag) in _REFUSED:
            what, help_ = _REFUSED[_name(node.tag)]
            yield f"{where}it has {what}", help_
        if _name(node.tag) == "style" and _FOREIGN.search(node.text):
            yield f"{where}its style names another file", "put all into the one file"
        for key, value in node.attributes.items():
            if _name(key).lower().startswith("on"):
                yield f"{where}`{key[:40]}` is a script", "remove the script"
            elif _name(key) == "href" and not value.strip().startswith("#"):
                yield f"{where}it refers to `{value[:60]}`, which is not in it", "put all into the one file"
            elif _FOREIGN.search(value):
                yield f"{where}`{key[:40]}` refers to something outside of it", "put all into the one file"


def _repeated(root: Node) -> tuple[str, str] | None:
    """Return the fault of elements that contain themselves, or of too many elements."""
    by_id = {node.attributes["id"]: node for node in root.everything() if "id" in node.attributes}
    sizes: dict[int, int | None] = {}

    def size(node: Node, depth: int) -> int:
        if depth > _DEEPEST_LEVEL:
            return MOST_ELEMENTS + 1
        if id(node) in sizes:
            known = sizes[id(node)]
            return MOST_ELEMENTS + 1 if known is None else known  # None: it contains itself
        sizes[id(node)] = None
        total = 1 + sum(size(child, depth + 1) for child in node.children)
        if _name(node.tag) == "use":
            name = next((v for k, v in node.attributes.items() if _name(k) == "href"), "").strip()[1:]
            total += size(by_id[name], depth + 1) if name in by_id else 0
        sizes[id(node)] = min(total, MOST_ELEMENTS + 1)
        return min(total, MOST_ELEMENTS + 1)

    if size(root, 0) <= MOST_ELEMENTS:
        return None
    return (
        f"with all that its `use` repeats it has more than {MOST_ELEMENTS} elements, or goes on for ever",
        "simplify it",
    )


def _name(tag: str) -> str:
    return tag.rsplit(":", 1)[-1]


def _shapes(data: bytes) -> list[FlatPart]:
    """Return the drawn shapes in the file's units, up positive."""
    from svgelements import SVG
    from svgelements import Path as Curves
    from svgelements import Shape as Drawn

    shapes: list[FlatPart] = []
    for element in SVG.parse(io.BytesIO(data), on_error="raise").select(lambda e: isinstance(e, Drawn)):
        filled, stroked = (element.values.get(key) != "none" for key in ("fill", "stroke"))
        if not (filled or stroked) or _hidden(element.values):
            continue
        edges = _edges(abs(Curves(element)), filled)
        if len(edges):
            width = float(element.stroke_width or 0.0) if stroked else 0.0
            parity = element.values.get("fill-rule") == "evenodd"
            width = max(width, 1e-6 * float(np.ptp(edges)))
            color = _color(element.fill if filled else element.stroke)
            shapes.append(FlatPart(edges * (1.0, -1.0), filled, parity, width, color))
    return shapes


def _color(paint: Any) -> Color | None:
    """Return a colour that a light can have, or None; colours that the reader cannot read count as black."""
    if paint is None or paint.value is None or paint.alpha == 0:
        return None
    color = (int(paint.red), int(paint.green), int(paint.blue))
    return color if max(color) >= DARK_LEVEL else None


def _hidden(values: dict[str, Any]) -> bool:
    return values.get("visibility") in ("hidden", "collapse") or values.get("opacity") in ("0", "0.0", "0%")


def _edges(path: Any, filled: bool) -> Array:
    """Return the lines of a path, (E, 2, 2); every part of a filled path is closed."""
    parts = []
    for sub in path.as_subpaths():
        corners = _corners(sub)
        if filled and len(corners) > 2:
            corners = np.concatenate([corners, corners[:1]])
        if len(corners) > 1:
            parts.append(chain(corners))
    return np.concatenate(parts) if parts else np.zeros((0, 2, 2))


def _corners(sub: Any) -> Array:
    from svgelements import Arc, CubicBezier, QuadraticBezier

    corners: list[tuple[float, float]] = []
    for segment in sub:
        curved = isinstance(segment, CubicBezier | QuadraticBezier)
        steps = ARC_LINES if isinstance(segment, Arc) else CURVE_LINES if curved else 1
        places = [segment.end] if steps == 1 else [segment.point(k / steps) for k in range(1, steps + 1)]
        corners += [(float(p.x), float(p.y)) for p in places if p is not None]
    return np.array(corners) if corners else np.zeros((0, 2))

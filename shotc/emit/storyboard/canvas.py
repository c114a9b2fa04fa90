"""A page to draw on, in inches from its lower left corner; the only module that uses matplotlib.

It leaves the figures of pyplot alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from io import BytesIO
from typing import Any
from warnings import catch_warnings, filterwarnings

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection, QuadMesh
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.image import BboxImage
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from matplotlib.transforms import Bbox, TransformedBbox
from numpy.typing import NDArray
from PIL import Image

from shotc.emit.palette import INK, PAPER, WHITE, Rgb
from shotc.geom.bernstein import Array

Color = tuple[float, ...]
COMPRESSION_LEVEL = 3
"""Compression level of PNG, from 0 to 9."""

LEAST_CAPITAL_PX = 9.0
"""Height of a capital letter in the smallest text of a page, pixels of the file."""

SEAM_PT = 0.6
"""Width of the edges that close the seams between the quads of a mesh, points."""

ELLIPSIS = "…"

CAPITAL_RATIO = 1493 / 2048
"""Height of a capital letter of the font, DejaVu Sans, over the size of the text."""


@dataclass(frozen=True, slots=True)
class PageRectangle:
    """A rectangle on the page, inches."""

    x: float
    y: float
    width: float
    height: float

    @property
    def right(self) -> float:
        """Right edge."""
        return self.x + self.width

    @property
    def top(self) -> float:
        """Upper edge."""
        return self.y + self.height

    def meets(self, other: PageRectangle) -> bool:
        """Return whether two rectangles overlap."""
        return self.x < other.right and other.x < self.right and self.y < other.top and other.y < self.top

    def holds(self, other: PageRectangle) -> bool:
        """Return whether another rectangle lies inside this one."""
        return self.x <= other.x and self.y <= other.y and other.right <= self.right and other.top <= self.top

    def with_box(self, other: PageRectangle) -> PageRectangle:
        """Return the smallest rectangle that holds both."""
        x, y = min(self.x, other.x), min(self.y, other.y)
        return PageRectangle(x, y, max(self.right, other.right) - x, max(self.top, other.top) - y)

    def outline(self) -> Array:
        """Return its corners, shape (4, 2)."""
        return np.array([[self.x, self.y], [self.right, self.y], [self.right, self.top], [self.x, self.top]])


@dataclass(frozen=True, slots=True)
class Type:
    """The style of a text: size in points, weight, position of the anchor, and colour of a halo."""

    size: float = 9.0
    color: Rgb = INK
    bold: bool = False
    across: str = "left"
    along: str = "baseline"
    halo: Rgb | None = None


@dataclass(frozen=True, slots=True)
class Fitted:
    """A text fitted into a width: its words, its style, and its width in inches."""

    text: str
    style: Type
    width: float


@contextmanager
def house_style() -> Iterator[None]:
    """Suspend the user's matplotlib settings; the page is measured and drawn inside this context."""
    with mpl.rc_context():
        mpl.rcdefaults()
        # Without hinting a text has its measured width at every size.
        mpl.rcParams["text.hinting"] = "no_hinting"
        yield


class Canvas:
    """A page; later drawings lie on top of earlier ones. It is used inside ``house_style``."""

    def __init__(self, width: float, height: float, dpi: float) -> None:
        self._figure = Figure(figsize=(width, height), dpi=dpi, facecolor=PAPER)
        self._agg = FigureCanvasAgg(self._figure)
        self._inches = self._figure.dpi_scale_trans
        self._order = 0

    def polygons(
        self,
        shapes: Sequence[Array],
        face: Color | Sequence[Color] | str,
        edge: Color | Sequence[Color] | str = "none",
        width: float = 0.0,
        clip: PageRectangle | None = None,
    ) -> None:
        """Fill closed shapes, shape (k, 2) each, with one colour for all or one for each."""
        self._add(
            PolyCollection(
                list(shapes), facecolors=face, edgecolors=edge, linewidths=width, transform=self._inches
            ),
            clip,
        )

    def union(self, shapes: Sequence[Array], face: Color, clip: PageRectangle | None = None) -> None:
        """Fill the union of closed shapes, (k, 2) each and all of one orientation, as one shape."""
        parts = [Path(np.concatenate([s, s[:1]]), closed=True) for s in shapes]
        path = Path.make_compound_path(*parts)
        self._add(PathPatch(path, facecolor=face, edgecolor="none", transform=self._inches), clip)

    def lines(
        self,
        strips: Sequence[Array],
        color: Color | Sequence[Color] | Array,
        width: float = 1.0,
        clip: PageRectangle | None = None,
        dash: tuple[float, ...] | None = None,
    ) -> None:
        """Draw open lines, shape (k, 2) each.

        width : points
        dash : in line widths
        """
        style: Any = "solid" if dash is None else (0.0, dash)
        self._add(
            LineCollection(
                list(strips),
                colors=color,
                linewidths=width,
                linestyles=[style],
                capstyle="butt" if dash else "round",
                joinstyle="round",
                transform=self._inches,
            ),
            clip,
        )

    def pieces(self, ends: Array, color: Color, width: float, clip: PageRectangle) -> None:
        """Draw many short lines, shape (n, 2, 2), in one colour."""
        codes = np.tile(np.array([Path.MOVETO, Path.LINETO], dtype=Path.code_type), len(ends))
        path = Path(ends.reshape(-1, 2), codes)
        self._add(
            PathPatch(path, facecolor="none", edgecolor=color, linewidth=width, transform=self._inches), clip
        )

    def image(self, pixels: NDArray[np.uint8], box: PageRectangle) -> None:
        """Draw a raster picture into a rectangle.

        pixels : (rows, columns, 3), the upper left one first; or (rows, columns, 4) with transparency
        """
        smooth = "bilinear" if pixels.shape[2] == 3 else "nearest"  # no blending with transparent pixels
        picture = BboxImage(self._window(box), interpolation=smooth, origin="upper")
        picture.set_data(pixels)
        self._add(picture, None)

    def mesh(self, corners: Array, faces: Array, clip: PageRectangle) -> None:
        """Fill the quads of a mesh, row by row, with the last row on top; a quad with a NaN corner is left
        out.

        corners : shape (m + 1, n + 1, 2)
        faces : colours, shape (m, n, 3)
        """
        net = QuadMesh(corners, antialiased=True, transform=self._inches, linewidths=SEAM_PT)
        net.set_facecolor(faces.reshape(-1, 3))
        net.set_edgecolor(faces.reshape(-1, 3))  # closes the seams between the quads
        self._add(net, clip)

    def disc(
        self, at: tuple[float, float], radius: float, face: Color | str, edge: Color | str, width: float
    ) -> None:
        """Draw a disc; radius in inches."""
        turn = np.linspace(0.0, 2 * np.pi, 49)[:-1]
        ring = np.stack([at[0] + radius * np.cos(turn), at[1] + radius * np.sin(turn)], axis=-1)
        self.polygons([ring], face, edge, width)

    def text(self, x: float, y: float, text: str, style: Type, clip: PageRectangle | None = None) -> None:
        """Write one line of text."""
        self._order += 1
        artist = self._figure.text(
            x,
            y,
            text,
            fontsize=style.size,
            color=style.color,
            fontweight="bold" if style.bold else "normal",
            fontfamily="DejaVu Sans",
            ha=style.across,
            va=style.along,
            transform=self._inches,
            zorder=self._order,
            parse_math=False,
        )
        if style.halo is not None:
            artist.set_path_effects([withStroke(linewidth=style.size / 4, foreground=style.halo)])
        if clip is not None:
            artist.set_clip_box(self._window(clip))
            artist.set_clip_on(True)

    def extent(self, text: str, style: Type) -> tuple[float, float]:
        """Return the width and height of a text, inches."""
        font = FontProperties(
            family="DejaVu Sans", size=style.size, weight="bold" if style.bold else "normal"
        )
        with _without_glyph_warnings():
            width, height, _ = self._agg.get_renderer().get_text_width_height_descent(text, font, False)
        return width / self._figure.dpi, height / self._figure.dpi

    @property
    def least_size(self) -> float:
        """The smallest readable size of text in the file, points."""
        return LEAST_CAPITAL_PX / CAPITAL_RATIO * 72.0 / float(self._figure.dpi)

    def fitted(self, text: str, style: Type, limit: float) -> Fitted:
        """Return a text that is at most ``limit`` inches wide.

        The text is made smaller, down to the smallest readable size, and then shortened.
        """
        width = self.extent(text, style)[0]
        if width <= limit:
            return Fitted(text, style, width)
        size = style.size * 0.99 * max(limit, 0.0) / width
        style = replace(style, size=min(style.size, max(size, self.least_size)))
        shorter = text
        while (width := self.extent(shorter, style)[0]) > limit and len(shorter) > 1:
            length = min(len(shorter) - 2, int(len(shorter) * limit / width))
            shorter = shorter[: max(length, 0)].rstrip(" ,·") + ELLIPSIS
        return Fitted(shorter, style, width)

    def write(self, x: float, y: float, text: str, style: Type, width: float) -> float:
        """Write one line of text at most ``width`` inches wide, and return its width."""
        fitted = self.fitted(text, style, width)
        self.text(x, y, fitted.text, fitted.style)
        return fitted.width

    def png(self) -> bytes:
        """Return the page as PNG bytes; the same drawing gives the same bytes."""
        with _without_glyph_warnings():
            self._agg.draw()
        # matplotlib would also write an alpha channel, which is not needed, and take three times as long for
        # a file of the same size.
        page = Image.fromarray(np.ascontiguousarray(np.asarray(self._agg.buffer_rgba())[..., :3]))
        stream = BytesIO()
        page.save(stream, "PNG", compress_level=COMPRESSION_LEVEL, dpi=(self._figure.dpi, self._figure.dpi))
        return stream.getvalue()

    def _add(self, artist: Any, clip: PageRectangle | None) -> None:
        self._order += 1
        artist.set_zorder(self._order)
        self._figure.add_artist(artist, clip=False)
        if clip is not None:
            artist.set_clip_box(self._window(clip))

    def _window(self, clip: PageRectangle) -> Any:
        return TransformedBbox(Bbox([[clip.x, clip.y], [clip.right, clip.top]]), self._inches)


@contextmanager
def _without_glyph_warnings() -> Iterator[None]:
    """Draw a box for a letter that the font lacks, for example in a Chinese title, without a warning."""
    with catch_warnings():
        filterwarnings("ignore", message=r"Glyph \d+ .*missing from font")
        yield


def chip(canvas: Canvas, at: tuple[float, float], text: str, face: Rgb, size: float = 7.5) -> PageRectangle:
    """Write white text on a coloured rectangle whose upper right corner is ``at``; return the rectangle."""
    style = Type(size, WHITE, bold=True, across="center", along="center")
    width, height = canvas.extent(text, style)
    box = PageRectangle(at[0] - width - 0.12, at[1] - height - 0.08, width + 0.12, height + 0.08)
    canvas.polygons([box.outline()], face)
    canvas.text(box.x + box.width / 2, box.y + box.height / 2, text, style)
    return box

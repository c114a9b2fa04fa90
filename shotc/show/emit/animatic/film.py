"""The frames of an animatic: the lights of all fleets in a dark sky, with one palette for all frames."""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO
from itertools import pairwise
from math import ceil

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw
from scipy.ndimage import gaussian_filter

from shotc.emit.audience import ASPECT, audience
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.light_colors import light_colors
from shotc.ir.light_paints import Levels
from shotc.ir.trajectory import VerifiedIR
from shotc.rounding import as_minutes
from shotc.show.emit.contact_sheet.night import GLOW_M
from shotc.show.emit.contact_sheet.scenery import Scenery, scenery

WIDTH_PX, HEIGHT_PX = 480, 270
RATE_HZ, MOST_FRAMES = 4.0, 180
"""Frames a second, and most frames of the film; a longer show has fewer frames a second in real time."""

SPOT_PX, SPREAD_PX = 1.3, 7.0
"""Standard deviations of a light's spot and of its bloom, pixels."""
SPOT_STRENGTH, BLOOM_STRENGTH = 9.0, 5.0
"""Strengths of spot and bloom; brightness saturates exponentially."""

COARSE_PX = 5
"""Side of the pixel blocks on which the bloom is computed."""
PALETTE_FRAMES = 12
"""Frames from which the palette is chosen."""
BRIGHT_LEVEL, SKY_COLORS = 40, 40
"""Level from which a pixel counts as a light, and palette colours of all other pixels."""
DIM_LEVEL = 170
"""Grey of the time stamp."""


def film(plan: VerifiedIR) -> bytes:
    """Return the whole film as a GIF that repeats."""
    times, step = _times(plan)
    pictures = list(_pictures(plan, times))
    palette = _palette(pictures)
    frames = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    stream = BytesIO()
    frames[0].save(
        stream, "GIF", save_all=True, append_images=frames[1:], duration=round(1000 * step), loop=0
    )
    return stream.getvalue()


def _times(plan: VerifiedIR) -> tuple[Array, float]:
    """Return the times of the frames, from the first light to the last, and their period.

    The period is a whole number of hundredths of a second, as GIF demands.
    """
    flights = plan.trajectory.fleets
    seconds = np.arange(0.0, max(float(flight.breaks[-1]) for flight in flights) + 1.0)
    lit = np.any([light_colors(flight, seconds).any(axis=(0, 2)) for flight in flights], axis=0)
    shining = seconds[lit] if lit.any() else seconds
    start, end = max(float(shining[0]) - 1.0, 0.0), float(shining[-1]) + 1.0
    step = ceil(100.0 * max(1.0 / RATE_HZ, (end - start) / MOST_FRAMES)) / 100.0
    return np.arange(start, end, step), step


def _pictures(plan: VerifiedIR, times: Array) -> Iterator[Image.Image]:
    """Yield a picture of each time, seen by the audience of the current or next display."""
    flights = plan.trajectory.fleets
    marks = [-np.inf, *_ends(plan)[:-1], np.inf]
    for display, (first, last) in zip(_displays(plan), pairwise(marks), strict=True):
        these = times[(times > first) & (times <= last)]
        if not len(these):
            continue
        mission = plan.trajectory.keyframes.mission
        behind = scenery(mission, audience(plan, mission.display(display), ASPECT), (WIDTH_PX, HEIGHT_PX))
        sky = behind.colors.astype(np.float32)
        views = [_seen(flight, these, behind) for flight in flights]
        for k, time in enumerate(these):
            light = np.zeros((HEIGHT_PX, WIDTH_PX, 3), dtype=np.float32)
            for spots, colors in views:
                _add(light, spots[:, k], colors[:, k])
            yield _picture(sky, light, float(time))


def _displays(plan: VerifiedIR) -> list[str]:
    """Return the displays in the order of their start."""
    starts = {s.display: s.start for f in plan.trajectory.fleets for s in reversed(f.shown)}
    return sorted(starts, key=lambda name: starts[name])


def _ends(plan: VerifiedIR) -> list[float]:
    ends = {s.display: s.end for f in plan.trajectory.fleets for s in f.shown}
    return [ends[name] for name in _displays(plan)]


def _seen(flight: FleetTrajectory, times: Array, behind: Scenery) -> tuple[Array, Levels]:
    """Return the lights in the picture (column, row, radius of the glow in pixels) and their colours.

    Both have shape (n, T, 3); the radius is 0 for a light that is hidden or outside the picture.
    """
    at = places(flight.breaks, flight.coef, times)
    offset = at - np.array(behind.seen.eye)
    view = behind.seen.view(WIDTH_PX / HEIGHT_PX)
    u, v, depth = view.project((offset[..., 0], offset[..., 1], offset[..., 2]))
    inside = (depth > 0.5) & (np.abs(u) < 1.0) & (np.abs(v) < 1.0)
    inside &= ~behind.hides(at.reshape(-1, 3)).reshape(inside.shape)
    pixels = np.where(
        inside, GLOW_M / (np.maximum(depth, 0.5) * 2.0 * float(view.half_width)) * WIDTH_PX, 0.0
    )
    spots = np.stack([(u + 1.0) / 2.0 * WIDTH_PX - 0.5, (1.0 - v) / 2.0 * HEIGHT_PX - 0.5, pixels], axis=-1)
    shine = light_colors(flight, times).astype(np.float32) / 255.0
    return spots, shine


def _add(light: Levels, spots: Array, colors: Levels) -> None:
    """Add lights to a picture, each distributed over the four nearest pixels."""
    bright = spots[:, 2] > 0
    x, y, pixels = spots[bright].T
    glow = colors[bright] * np.clip(pixels, 0.7, 2.0)[:, None].astype(np.float32) ** 2
    column, row = np.floor(x).astype(np.intp), np.floor(y).astype(np.intp)
    across, down = x - column, y - row
    for i, j in ((0, 0), (0, 1), (1, 0), (1, 1)):
        share = (down if i else 1.0 - down) * (across if j else 1.0 - across)
        at = np.clip(row + i, 0, HEIGHT_PX - 1), np.clip(column + j, 0, WIDTH_PX - 1)
        np.add.at(light, at, glow * share[:, None].astype(np.float32))


def _picture(sky: Levels, light: Levels, time: float) -> Image.Image:
    spot = gaussian_filter(light, (SPOT_PX, SPOT_PX, 0.0), truncate=3.0)
    coarse = light.reshape(HEIGHT_PX // COARSE_PX, COARSE_PX, WIDTH_PX // COARSE_PX, COARSE_PX, 3).mean(
        axis=(1, 3)
    )
    wide = gaussian_filter(coarse, (SPREAD_PX / COARSE_PX, SPREAD_PX / COARSE_PX, 0.0), truncate=3.0)
    spread = np.stack([_wide(wide[..., k]) for k in range(3)], axis=-1)
    shade = 1.0 - (1.0 - sky) * np.exp(-(SPOT_STRENGTH * spot + BLOOM_STRENGTH * spread))
    picture = Image.fromarray(np.asarray(np.round(255.0 * shade), dtype=np.uint8))
    ImageDraw.Draw(picture).text(
        (6, HEIGHT_PX - 16), as_minutes(time), fill=(DIM_LEVEL, DIM_LEVEL, DIM_LEVEL)
    )
    return picture


def _wide(channel: Levels) -> NDArray[np.float32]:
    """Return one channel of a coarse picture in full size."""
    image = Image.fromarray(channel, "F").resize((WIDTH_PX, HEIGHT_PX), Image.Resampling.BILINEAR)
    return np.asarray(image, dtype=np.float32)


def _palette(pictures: list[Image.Image]) -> Image.Image:
    """Return an image with the palette of all frames; lights get most of it, although they cover
    few pixels.
    """
    chosen = pictures[:: max(1, len(pictures) // PALETTE_FRAMES)]
    pixels = np.concatenate([np.asarray(picture).reshape(-1, 3) for picture in chosen])
    bright = pixels.max(axis=1) >= BRIGHT_LEVEL
    parts = [_colors(pixels[~bright], SKY_COLORS), _colors(pixels[bright], 256 - SKY_COLORS)]
    palette = Image.new("P", (1, 1))
    palette.putpalette([level for colors in parts for level in colors])
    return palette


def _colors(pixels: NDArray[np.uint8], count: int) -> list[int]:
    """Return colours, three levels each, that represent pixels (n, 3)."""
    if not len(pixels):
        return []
    strip = Image.fromarray(pixels[None])
    return strip.quantize(count, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE).getpalette() or []

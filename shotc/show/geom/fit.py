"""An upper bound of the number of drones in a shape, so that no feasible picture is rejected.

Goals of a picture are at least the separation apart, in space scaled along z by the horizontal over the
vertical distance. Balls of that diameter around them do not overlap, whether the drones keep balls or
cylinders free.
"""

from __future__ import annotations

from math import asin, inf, pi, sqrt

from shotc.geom.apart import spacing, stretch
from shotc.ir.show import Apart, Box, Picture, Sphere, Torus
from shotc.show.geom.sizes import resized

MOST_DARK_SHARE = 0.95
"""Largest share of a fleet that may stay dark in a picture without enough room."""
ROGERS_SHARE = 0.7797
"""Largest share of a truncated Voronoi cell that its ball fills in space (Rogers 1958)."""
TRUNCATED_RADII = sqrt(1.5)
"""Radius of truncation in that theorem, in radii of the ball."""
ROUNDING_TOLERANCE = 1e-9
GROWTH_STEP_SHARE = 0.01  # accuracy of the growth factor


def most_drones(picture: Picture, apart: Apart) -> float:
    """Return an upper bound of the number of drones in a picture; infinity if its size is unknown."""
    source, gap = picture.source, spacing(apart)
    if isinstance(source, Sphere | Box | Torus):
        factor = stretch(apart)
        inside = _in_volume(source, gap, factor)
        # The edges of a box lie on its surface.
        return inside if picture.fill == "volume" else min(inside, _on_surface(source, gap, factor))
    return inf


def growth(picture: Picture, apart: Apart, count: int) -> float:
    """Return a lower bound of the factor by which a picture has to grow to hold ``count`` drones."""
    low, high = 1.0, 2.0
    while most_drones(_scaled(picture, high), apart) < count:
        low, high = high, 2.0 * high
    while high - low > GROWTH_STEP_SHARE:
        middle = 0.5 * (low + high)
        fits = most_drones(_scaled(picture, middle), apart) >= count
        low, high = (low, middle) if fits else (middle, high)
    return high


def _scaled(picture: Picture, factor: float) -> Picture:
    return picture._replace(source=resized(picture.source, lambda metres: factor * metres))


def _in_volume(source: Sphere | Box | Torus, gap: float, stretch: float) -> float:
    """Bound by volume: every ball has its own truncated cell near the shape."""
    reach = TRUNCATED_RADII * gap / 2
    wide = reach * max(1.0, 1 / stretch)  # contains the cells' reach in unscaled space
    if isinstance(source, Sphere):
        volume = stretch * 4 / 3 * pi * (source.radius + wide) ** 3
    elif isinstance(source, Torus):
        volume = stretch * 2 * pi**2 * source.radius * (source.tube + wide) ** 2  # Pappus
    else:
        volume = _round_box(source.size[0], source.size[1], source.size[2] * stretch, reach)
    return ROGERS_SHARE * volume / (pi / 6 * gap**3)


def _round_box(a: float, b: float, c: float, r: float) -> float:
    """Return the volume within ``r`` of a box (Steiner's formula)."""
    return a * b * c + 2 * (a * b + b * c + c * a) * r + pi * (a + b + c) * r**2 + 4 / 3 * pi * r**3


def _on_surface(source: Sphere | Box | Torus, gap: float, stretch: float) -> float:
    """Bound by area: on a sphere by Fejes Toth, on a box face by face by Oler."""
    if isinstance(source, Sphere):
        # Compressing space never increases a distance.
        return _on_sphere(gap / max(1.0, stretch) / source.radius)
    if isinstance(source, Box):
        a, b, c = source.size[0], source.size[1], source.size[2] * stretch
        return 2 * (_on_face(a, b, gap) + _on_face(b, c, gap) + _on_face(c, a, gap))
    return inf


def _on_sphere(gap: float) -> float:
    """Return the most points on a unit sphere ``gap`` apart: at most 2q / (q - 1) (Fejes Toth 1943)."""
    if gap > sqrt(3.0) + ROUNDING_TOLERANCE:
        return 2.0 if gap <= 2 + ROUNDING_TOLERANCE else 1.0
    q = 6 / pi * asin(min(1.0, 1 / sqrt(4 - gap * gap)))
    return 2 * q / (q - 1)


def _on_face(a: float, b: float, gap: float) -> float:
    """Return the most points in a rectangle ``gap`` apart (Oler 1961)."""
    return 2 / sqrt(3) * a * b / gap**2 + (a + b) / gap + 1

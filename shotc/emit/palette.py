"""The colours of all drawings: each has one meaning, and colour-blind readers can tell them apart.

The hues follow Okabe and Ito. Blue is a subject, amber is the camera, vermilion is a keep-out zone, green is
a keep-in zone.
"""

from __future__ import annotations

Rgb = tuple[float, float, float]

SUBJECT: Rgb = (0.16, 0.36, 0.60)
CAMERA: Rgb = (0.93, 0.58, 0.03)
KEEP_OUT: Rgb = (0.84, 0.37, 0.0)
KEEP_IN: Rgb = (0.0, 0.55, 0.41)
FLIGHT: Rgb = (0.50, 0.55, 0.62)
VERTICAL: Rgb = (0.70, 0.74, 0.79)
INK: Rgb = (0.11, 0.13, 0.17)
QUIET: Rgb = (0.40, 0.44, 0.50)
FAINT: Rgb = (0.80, 0.82, 0.85)
PAPER: Rgb = (0.985, 0.98, 0.97)
SKY: Rgb = (0.82, 0.88, 0.93)
SKY_LOW: Rgb = (0.93, 0.95, 0.96)
GROUND: Rgb = (0.80, 0.79, 0.73)
GROUND_FAR: Rgb = (0.88, 0.88, 0.85)
STONE: Rgb = (0.66, 0.63, 0.60)
"""Scenes and buildings: obstacles that are neither filmed nor zones."""
WHITE: Rgb = (1.0, 1.0, 1.0)

PICTURES: tuple[Rgb, ...] = (
    (0.00, 0.35, 0.71), (0.79, 0.22, 0.12), (0.00, 0.49, 0.36), (0.55, 0.24, 0.64),
    (0.60, 0.40, 0.05), (0.00, 0.53, 0.64), (0.78, 0.13, 0.45), (0.33, 0.46, 0.05),
    (0.30, 0.30, 0.33), (0.42, 0.32, 0.83), (0.55, 0.13, 0.13), (0.10, 0.36, 0.42),
)  # fmt: skip
"""Colours of a show's pictures, in order. All are dark enough for a white number, and neighbours differ in
lightness and hue.
"""


def shade(color: Rgb, light: float) -> Rgb:
    """Return a colour darker (light < 1) or, blended with white, lighter (light > 1)."""
    if light <= 1.0:
        return (color[0] * light, color[1] * light, color[2] * light)
    share = min(light - 1.0, 1.0)
    return (
        color[0] + (1 - color[0]) * share,
        color[1] + (1 - color[1]) * share,
        color[2] + (1 - color[2]) * share,
    )


def rgba8(color: Rgb, alpha: float = 1.0) -> tuple[int, int, int, int]:
    """Return a colour as four bytes."""
    return (round(color[0] * 255), round(color[1] * 255), round(color[2] * 255), round(alpha * 255))

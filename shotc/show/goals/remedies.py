"""What would do where a picture has no room for a fleet: found about, then tried as it would be written."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from shotc.ir.show import Picture
from shotc.show.geom.sizes import enlarged, size_words
from shotc.show.goals.spaced import Fit, Setting

STEP, TRIES = 1.06, 10
"""Factor from one try to the next, and after how many a remedy is not told."""

Fits = Callable[[Picture, int, float], bool]
"""Whether a picture shows so many drones, all of them, at a share of the spacing."""


class Remedies(NamedTuple):
    """What does, each alone; None where nothing was found.

    number : of drones; size : what to write of the picture, and how many times as large it is then
    share : of the spacing
    """

    number: int | None
    size: tuple[str, float] | None
    share: float | None


def remedies(fits: Fits, picture: Picture, setting: Setting, about: tuple[Fit, float, float]) -> Remedies:
    """Return what does.

    about : what about would; the share of the spacing at which bodies touch, below which none is looked
    for; the height of a model as it is, metres
    """
    fit, touching, tall = about
    full = setting.number
    numbers = dict.fromkeys(max(1, int(fit.number / STEP**k)) for k in range(TRIES))
    number = next((n for n in numbers if fits(picture, n, 1.0)), None)
    shares = (fit.share / STEP**k for k in range(TRIES))
    share = next((s for s in shares if s > touching and fits(picture, full, s)), None)
    factors = [STEP**k / fit.share for k in range(TRIES)]
    sizes = ((enlarged(picture, f, setting.room.lowest, tall), f) for f in factors)
    size = next(((size_words(picture.source, p.source), f) for p, f in sizes if fits(p, full, 1.0)), None)
    return Remedies(number, size, share)

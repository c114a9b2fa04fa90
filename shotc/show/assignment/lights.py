"""The lights of a fleet: dark on the way up and down, each frame's colours while it stands, faded between."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from shotc.ir.fleet import Colors, Lights


def lights(dark: tuple[float, float], shown: Iterable[tuple[float, float, Colors]]) -> Lights:
    """Return the programme.

    dark : until when and from when on no light is lit, seconds
    shown : (start, end, colours of shape (n, 3)) of every frame, in their order
    """
    rows: dict[float, Colors] = {}
    for start, end, colors in shown:
        rows[start] = rows[end] = colors
    black = np.zeros_like(next(iter(rows.values())))
    rows = {dark[0]: black, **rows, dark[1]: black}
    times = sorted(rows)
    return Lights(np.array(times), np.stack([rows[t] for t in times], axis=1))

"""Lights as a show file carries them: a program of bytes that fades and sets colours, in steps of 20 ms.

Opcodes: 0 end, 4 set a colour for a time, 8 fade to a colour over a time; a time is a variable-length
number of steps, seven bits a byte, the low ones first. A program begins at the show's first instant.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from shotc.ir.fleet import Lights

STEP = 0.02
"""Seconds of one step."""

END, SET, FADE = 0x00, 0x04, 0x08


def programs(lights: Lights) -> Iterator[bytes]:
    """Yield the program of every drone's light, in the order of their numbers."""
    steps = np.maximum(np.round(lights.times / STEP).astype(int), 0).tolist()
    for colors in lights.colors.tolist():
        yield program(steps, [bytes(color) for color in colors])


def program(steps: list[int], colors: list[bytes]) -> bytes:
    """Return the program that has these colours, of three bytes, at these steps, which do not fall."""
    code = bytearray()
    now, color, stands = 0, colors[0], 0
    for step, wanted in zip(steps, colors, strict=True):
        if wanted == color:
            stands += step - now
        else:
            # A fade begins where what was before ends; a jump is a colour that is set.
            code += _order(SET, color, stands)
            stands = 0
            if step > now:
                code += _order(FADE, wanted, step - now)
        now, color = step, wanted
    # Players go on along a last fade: a program ends with a colour that stands.
    code += _order(SET, color, max(stands, 1))
    return bytes([*code, END])


def _order(what: int, color: bytes, steps: int) -> bytes:
    return bytes([what, *color]) + _number(steps)


def _number(value: int) -> bytes:
    found = bytearray()
    while value > 0x7F:
        found.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes([*found, value])

"""Convert the lights of a Skybrush show, programs of bytes that set and fade colours, to times and colours.

The orders are those of `libskybrush`. A duration is a variable-length number of steps of 20 ms, seven bits
per byte, the low bits first. Orders that change the clock, jump, or take colours from a remote control are
refused: their times are not in the file.
"""

from __future__ import annotations

from typing import NamedTuple

from shotc.importers.flights.points import BROKEN, refuse
from shotc.importers.words import EXPORT_AGAIN
from shotc.importers.xml_tree import Node

STEP_S = 0.02
JUMP_S = 0.001
"""Duration of the change when an order sets a colour, seconds."""
MOST_ORDERS = 100_000
"""Most executed orders of one program. Each pass of a loop counts."""
WHOLE = Node("", 1, 1, wide=1)

END, NOTHING, SLEEP = 0x00, 0x01, 0x02
SETS = {0x04: 3, 0x05: 1, 0x06: 0, 0x07: 0}
FADES = {0x08: 3, 0x09: 1, 0x0A: 0, 0x0B: 0}
WHITES = (0x07, 0x0B)
LOOP, LOOP_END = 0x0C, 0x0D

Color = tuple[int, int, int]
BLACK: Color = (0, 0, 0)


class KeyedLight(NamedTuple):
    """A light: colours at rising times, s. It is linear between them, and constant before and after."""

    times: tuple[float, ...]
    colors: tuple[Color, ...]


def keyed(program: bytes, where: str, end: float) -> KeyedLight:
    """Return the light of a program. A faulty program is refused.

    where : description of the program for messages
    end   : end of the flight, s; later orders are not read
    """
    return _Player(program, where, end).played()


class _Player:
    """Executes the orders of a program."""

    def __init__(self, program: bytes, where: str, end: float) -> None:
        self._code, self._where, self._end = program, where, end
        self._at = 0
        self._steps, self._color = 0, BLACK
        self._times, self._colors = [0.0], [BLACK]
        self._loops: list[tuple[int, int]] = []

    def played(self) -> KeyedLight:
        for _ in range(MOST_ORDERS):
            if self._steps * STEP_S > self._end or not self._order():
                return KeyedLight(tuple(self._times), tuple(self._colors))
        self._refuse(f"does more than {MOST_ORDERS} orders")
        raise AssertionError

    def _order(self) -> bool:
        """Execute the next order. Return whether there may be more."""
        start, order = self._at, self._byte()
        if order == END:
            return False
        if order in SETS or order in FADES:
            color = self._next_color(order, SETS.get(order, FADES.get(order, 0)))
            self._show(color, self._number(), fades=order in FADES)
        elif order == SLEEP:
            self._show(self._color, self._number(), fades=False)
        elif order == LOOP:
            self._loops.append((self._byte() or MOST_ORDERS, self._at))
        elif order == LOOP_END:
            self._again(start)
        elif order != NOTHING:
            self._refuse(f"has an order {order:#04x} at byte {start}, whose time the file does not give")
        return True

    def _again(self, start: int) -> None:
        if not self._loops:
            self._refuse(f"ends a loop at byte {start} that has not begun")
        left, begin = self._loops.pop()
        if left > 1:
            self._loops.append((left - 1, begin))
            self._at = begin

    def _next_color(self, order: int, count: int) -> Color:
        if count == 0:
            return (255, 255, 255) if order in WHITES else BLACK
        red = self._byte()
        return (red, self._byte(), self._byte()) if count > 1 else (red, red, red)

    def _show(self, color: Color, steps: int, *, fades: bool) -> None:
        now = self._steps * STEP_S
        self._key(now - JUMP_S if not fades and color != self._color else now, self._color)
        self._steps += steps
        self._key(self._steps * STEP_S if fades else now, color)
        self._color = color

    def _key(self, time: float, color: Color) -> None:
        if time > self._times[-1] + JUMP_S / 2:
            self._times.append(time)
            self._colors.append(color)
        else:
            self._colors[-1] = color if time >= self._times[-1] - JUMP_S / 2 else self._colors[-1]

    def _byte(self) -> int:
        if self._at >= len(self._code):
            self._refuse(f"breaks off after {len(self._code)} bytes")
        self._at += 1
        return self._code[self._at - 1]

    def _number(self) -> int:
        value, shift = 0, 0
        while True:
            part = self._byte()
            value |= (part & 0x7F) << shift
            shift += 7
            if part < 0x80:
                return value
            if shift > 28:
                self._refuse(f"has a time of more than 28 bits at byte {self._at - 1}")

    def _refuse(self, why: str) -> None:
        refuse(BROKEN, f"`{self._where}` {why}", WHOLE, EXPORT_AGAIN)

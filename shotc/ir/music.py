"""The music of a show, and when its beats fall. Plain Python, no numpy; part of MissionIR."""

from math import ceil, floor
from typing import NamedTuple

from shotc.ir.origin import KeyPath

SAME_BEAT = 1e-6
"""Share of a beat by which one may be missed."""


class Music(NamedTuple):
    """A song on the mission's clock, its beats counted from 1.

    file : of the song, or None where only its beats are known
    start : when it begins on the mission's clock, s
    listed : times of its beats in the song, s, rising; empty where they are even
    first, period : of even beats, s in the song; period None where nothing is known of beats
    per_bar : beats in a bar
    unread : whether its beats cannot be used: what stands on them is not judged
    """

    file: str | None
    start: float
    listed: tuple[float, ...]
    first: float
    period: float | None
    per_bar: int
    path: KeyPath
    unread: bool = False

    @property
    def has_beats(self) -> bool:
        """Tell whether times of beats are known."""
        return bool(self.listed) or self.period is not None

    def time(self, beat: float) -> float | None:
        """Return when a beat falls on the mission's clock, s, or None before the first and after the last.

        A part of a beat is a part of the time from one beat to the next.
        """
        if beat < 1.0 or not self.has_beats:
            return None
        if self.period is not None:
            return self.start + self.first + (beat - 1.0) * self.period
        whole = floor(beat)
        part = beat - whole
        if whole > len(self.listed) or (part > 0.0 and whole == len(self.listed)):
            return None
        here = self.listed[whole - 1]
        way = self.listed[whole] - here if part > 0.0 else 0.0
        return self.start + here + part * way

    def next_beat(self, time: float) -> int | None:
        """Return the first whole beat at a time of the mission's clock or after it, or None without one."""
        if self.period is not None:
            passed = ceil((time - self.start - self.first) / self.period - SAME_BEAT)
            return max(1, 1 + passed)
        later = (k for k, at in enumerate(self.listed, 1) if self.start + at >= time - SAME_BEAT)
        return next(later, None)


def beat_of_bar(bar: float, beat: float, per_bar: int) -> float:
    """Return the number of a beat from that of its bar and its own in the bar, all counted from 1."""
    return (bar - 1.0) * per_bar + beat

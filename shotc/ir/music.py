"""The music of a show and the times of its beats. Plain Python, no numpy; part of MissionIR."""

from math import ceil, floor
from typing import NamedTuple

from shotc.ir.origin import KeyPath

SAME_BEAT_SHARE = 1e-6
"""Tolerance at a beat, as a share of a beat."""


class Music(NamedTuple):
    """A song on the mission's clock, its beats counted from 1.

    file : of the song, None if only its beats are known
    start : its mission time, s
    listed : times of its beats in the song, s, rising; empty for even beats
    first, period : of even beats, s in the song; period is None if beats are unknown
    per_bar : beats in a bar
    unread : whether its beats are unusable; then nothing that depends on them is judged
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
        """Whether the times of beats are known."""
        return bool(self.listed) or self.period is not None

    def time(self, beat: float) -> float | None:
        """Return the mission time of a beat, s, or None before the first and after the last.

        Fractions of a beat are linear in the time from one beat to the next.
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
        interval = self.listed[whole] - here if part > 0.0 else 0.0
        return self.start + here + part * interval

    def next_beat(self, time: float) -> int | None:
        """Return the number of the first beat at or after a mission time, s; None if there is none."""
        if self.period is not None:
            passed = ceil((time - self.start - self.first) / self.period - SAME_BEAT_SHARE)
            return max(1, 1 + passed)
        later = (k for k, at in enumerate(self.listed, 1) if self.start + at >= time - SAME_BEAT_SHARE)
        return next(later, None)


def beat_of_bar(bar: float, beat: float, per_bar: int) -> float:
    """Return the number of a beat from the number of its bar and its number in the bar, all from 1."""
    return (bar - 1.0) * per_bar + beat

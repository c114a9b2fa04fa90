"""The flight of one drone: its polynomials by SciPy, its phases, and the times at which it is looked at."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BPoly

Array = NDArray[np.float64]
PER_PIECE = 17  # samples of every polynomial piece, both ends among them
PER_SECOND = 100.0
CAM_YAW, CAM_PITCH, BODY_YAW, HFOV = 3, 4, 5, 6
AT_HOME = ("takeoff", "land")


class Phase(NamedTuple):
    """A part of a flight."""

    name: str
    shot: str | None
    start: float
    end: float


def polynomial(curve: dict[str, Any]) -> BPoly:
    """Return a curve of plan.json."""
    return BPoly(np.array(curve["control"], dtype=float).transpose(1, 0, 2), np.array(curve["breaks"]))


@dataclass(frozen=True)
class Flight:
    """One entry of ``drones`` in plan.json."""

    drone: str
    curve: BPoly
    phases: tuple[Phase, ...]
    keyframes: tuple[dict[str, Any], ...]
    framing: tuple[dict[str, Any], ...]

    @staticmethod
    def read(found: dict[str, Any]) -> Flight:
        return Flight(
            found["drone"],
            polynomial(found["curve"]),
            tuple(Phase(p["name"], p["shot"], p["start"], p["end"]) for p in found["phases"]),
            tuple(found["keyframes"]),
            tuple(found["framing"]),
        )

    @property
    def start(self) -> float:
        return float(self.curve.x[0])

    @property
    def end(self) -> float:
        return float(self.curve.x[-1])

    def at(self, t: Array, order: int = 0) -> Array:
        """Return all channels, or a derivative, at times (M,), shape (M, 7); at rest before and after."""
        inside = (t >= self.start) & (t <= self.end)
        values = self._derivatives[order](np.clip(t, self.start, self.end))
        return np.asarray(values if order == 0 else np.where(inside[:, None], values, 0.0))

    @cached_property
    def _derivatives(self) -> tuple[BPoly, ...]:
        return (self.curve, *(self.curve.derivative(k) for k in (1, 2, 3)))

    @cached_property
    def pieces(self) -> tuple[Array, tuple[Array, ...]]:
        """Return times (P, K) and the curve and three derivatives there (P, K, 7), with both ends."""
        x = (1.0 - np.cos(np.linspace(0.0, np.pi, PER_PIECE))) / 2
        step = np.diff(self.curve.x)[:, None]
        values = []
        for polynomial_ in self._derivatives:
            own = BPoly(polynomial_.c, np.arange(len(step) + 1.0))  # every piece over its own unit
            inside = own(np.arange(len(step))[:, None] + x[None, 1:-1])
            first, last = polynomial_.c[0][:, None], polynomial_.c[-1][:, None]
            values.append(np.concatenate([first, inside, last], axis=1))
        return self.curve.x[:-1, None] + step * x, tuple(values)

    @cached_property
    def dense(self) -> Array:
        """All times of the pieces' samples, and an even grid."""
        even = np.arange(self.start, self.end, 1.0 / PER_SECOND)
        ends = [edge for phase in self.phases for edge in (phase.start, phase.end)]
        return np.unique(np.concatenate([self.pieces[0].ravel(), even, ends]))

    def spans(self, names: tuple[str, ...], *, outside: bool = False) -> list[Array]:
        """Return the dense times within every phase of some names, or every other, with its ends."""
        chosen = [p for p in self.phases if (p.name in names) != outside]
        return [self.dense[(self.dense >= p.start) & (self.dense <= p.end)] for p in chosen]

    def during(self, names: tuple[str, ...]) -> Array:
        """Return the dense times within the phases of some names."""
        return np.concatenate([np.empty(0), *self.spans(names)])

    def shot(self, name: str) -> Phase:
        """Return the phase that films a shot."""
        (found,) = (p for p in self.phases if p.shot == name)
        return found

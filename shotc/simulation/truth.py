"""True positions of targets in a run: on their track, with a random deviation, or from a file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.track import Track
from shotc.geom.track_array import places
from shotc.ir.target import Target
from shotc.simulation.wind import wandering

WANDER_MEMORY_S = 3.0
"""Time constant of a target's deviation from its track, seconds."""


@dataclass(frozen=True, slots=True)
class Truth:
    """The true motion of targets.

    wander : standard deviation of a moving target from its track, along East and along North, metres
    tracks : true tracks of targets that differ from the mission, by name
    """

    wander: float = 0.0
    tracks: tuple[tuple[str, Track], ...] = ()

    def places(self, target: Target, times: Array, chances: Sequence[np.random.Generator]) -> Array:
        """Return a target's positions at uniform times (M,) from the mission's start on; shape (M, R, 3),
        metres.

        A target that wanders begins on its track.

        chances : random generator of each run
        """
        shape = (len(times), len(chances), 3)
        track = dict(self.tracks).get(target.name, target.track)
        if track is None:
            return np.broadcast_to(np.array(target.centre), shape)
        course = np.broadcast_to(places(track, times)[:, None], shape)
        if self.wander == 0.0:
            return course
        return np.asarray(course + self.wander * _off(times, chances))


def _off(times: Array, chances: Sequence[np.random.Generator]) -> Array:
    """Return a smooth horizontal deviation with standard deviation 1, (M, R, 3): a filtered OU process."""
    step = float(times[1] - times[0])
    noise = np.stack([rng.standard_normal((len(times), 2)) for rng in chances], axis=1)
    pulled = wandering(noise, step / WANDER_MEMORY_S)
    out = np.zeros((len(times), len(chances), 3))
    share = step / WANDER_MEMORY_S
    for k in range(1, len(times)):
        out[k, :, :2] = out[k - 1, :, :2] + share * (sqrt(2.0) * pulled[k - 1] - out[k - 1, :, :2])
    return out

"""Rows of trajectory.csv for the drones of a fleet: no camera, the body turned north, and a light.

Rows of one drone differ in numbers alone, so that all of them are set by one format.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import pi

import numpy as np

from shotc.emit.table_numbers import DEGREES, NUMBER
from shotc.geom.bernstein import Array
from shotc.geom.earth import of_world
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.light_colors import light_colors
from shotc.ir.mission import MissionIR
from shotc.ir.sampling import clock, phase_index
from shotc.ir.show import drone_names
from shotc.spec.presets import SHOW_RATE

NORTH = pi / 2
"""Yaw of every body, counter-clockwise from East."""

BATCH = 250
"""Drones that are evaluated at once."""

_NAME = "\0"


def fleet_rows(mission: MissionIR, track: FleetTrajectory) -> Iterator[tuple[str, str]]:
    """Yield every drone's name and its rows, lines without the last line break."""
    t = clock(fleet_rate(mission), float(track.breaks[-1]))
    names = drone_names(mission.fleet(track.fleet))
    form = _form(mission, track, t)
    for first in range(0, len(names), BATCH):
        some = slice(first, first + BATCH)
        numbers = _numbers(mission, track, (track.coef[some], t))
        values = np.concatenate([numbers + 0.0, light_colors(track, t, some)], axis=2)  # no negative zeros
        for name, rows in zip(names[some], values, strict=True):
            yield name, form.replace(_NAME, _plain(name)) % tuple(rows.ravel().tolist())


def fleet_rate(mission: MissionIR) -> float:
    """Return how many rows a second tables have for a drone of a fleet."""
    # Beside cameras, which ask for a row a frame, a table of many drones stays a table that opens.
    return min(mission.rate, SHOW_RATE) if mission.shots else mission.rate


def _form(mission: MissionIR, track: FleetTrajectory, t: Array) -> str:
    """Return the rows of a drone with places for its name and its numbers."""
    earth = [DEGREES, DEGREES, NUMBER] if mission.origin is not None else []
    camera = [""] * 5
    unknown = [""] * 4 if mission.drones else []  # of the columns of drones that film
    numbers = ",".join([*[NUMBER] * 9, NUMBER % NORTH, *camera, *earth, "%d", "%d", "%d", *unknown])
    whats = [_plain(f"{phase.name},{phase.shot or ''}") for phase in track.phases]
    return "\n".join(
        f"{NUMBER % time},{_NAME},{whats[k]},{numbers}"
        for time, k in zip(t.tolist(), phase_index(track.phases, t).tolist(), strict=True)
    )


def _plain(text: str) -> str:
    """Return a text as a format has to hold it."""
    return text.replace("%", "%%")


def _numbers(mission: MissionIR, track: FleetTrajectory, of: tuple[Array, Array]) -> Array:
    """Return positions, velocities, accelerations and geodetic places of drones at times, (n, T, 9 or 12)."""
    coef, t = of
    columns = [places(track.breaks, coef, t, order) for order in range(3)]
    columns[1][:, -1] = columns[2][:, -1] = 0.0  # at or after the end the drones stand on their pads
    if mission.origin is not None:
        flat = columns[0].reshape(-1, 3)
        columns.append(of_world(flat, mission.origin).reshape(columns[0].shape))
    return np.concatenate(columns, axis=2)

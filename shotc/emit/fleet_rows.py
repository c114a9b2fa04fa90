"""Rows of trajectory.csv for the drones of a fleet: no camera, the body heading north, and a light.

The rows of all drones of a fleet differ only in numbers, so one format string serves all of them.
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
from shotc.spec.presets import SHOW_RATE_HZ

NORTH_RAD = pi / 2
"""Yaw of every body, rad counter-clockwise from East."""

BATCH_DRONES = 250
"""Drones that are evaluated in one batch."""

_NAME = "\0"


def fleet_rows(mission: MissionIR, track: FleetTrajectory) -> Iterator[tuple[str, str]]:
    """Yield every drone's name and its rows; the last row has no line break."""
    t = clock(fleet_rate(mission), float(track.breaks[-1]))
    names = drone_names(mission.fleet(track.fleet))
    form = _form(mission, track, t)
    for first in range(0, len(names), BATCH_DRONES):
        some = slice(first, first + BATCH_DRONES)
        numbers = _numbers(mission, track, (track.coef[some], t))
        values = np.concatenate([numbers + 0.0, light_colors(track, t, some)], axis=2)  # no negative zeros
        for name, rows in zip(names[some], values, strict=True):
            yield name, form.replace(_NAME, _plain(name)) % tuple(rows.ravel().tolist())


def fleet_rate(mission: MissionIR) -> float:
    """Return the rows a second for a drone of a fleet."""
    # A mission with cameras asks for one row a frame; with many drones the file would be too large to open.
    return min(mission.rate, SHOW_RATE_HZ) if mission.shots else mission.rate


def _form(mission: MissionIR, track: FleetTrajectory, t: Array) -> str:
    """Return the rows of a drone with placeholders for its name and its numbers."""
    earth = [DEGREES, DEGREES, NUMBER] if mission.origin is not None else []
    camera = [""] * 5
    unknown = [""] * 4 if mission.drones else []  # columns that only filming drones have
    numbers = ",".join([*[NUMBER] * 9, NUMBER % NORTH_RAD, *camera, *earth, "%d", "%d", "%d", *unknown])
    whats = [_plain(f"{phase.name},{phase.shot or ''}") for phase in track.phases]
    return "\n".join(
        f"{NUMBER % time},{_NAME},{whats[k]},{numbers}"
        for time, k in zip(t.tolist(), phase_index(track.phases, t).tolist(), strict=True)
    )


def _plain(text: str) -> str:
    """Return a text escaped for a format string."""
    return text.replace("%", "%%")


def _numbers(mission: MissionIR, track: FleetTrajectory, of: tuple[Array, Array]) -> Array:
    """Return positions, velocities, accelerations and geodetic positions of drones, shape (n, T, 9 or 12).

    of : coefficients of the drones, and times (T,)
    """
    coef, t = of
    columns = [places(track.breaks, coef, t, order) for order in range(3)]
    columns[1][:, -1] = columns[2][:, -1] = 0.0  # at and after the end the drones stand on their pads
    if mission.origin is not None:
        flat = columns[0].reshape(-1, 3)
        columns.append(of_world(flat, mission.origin).reshape(columns[0].shape))
    return np.concatenate(columns, axis=2)

"""Flights with a clock: rows of a table, or curves of a show, as cubics over mission time.

Between two rows with velocities a flight is the cubic with the positions and velocities of both. Without
velocities it is straight. The drone's limits bound how far another flight through the same rows can be from
it.

Let A bound the acceleration, J the jerk, and let h be the seconds between rows. The difference of the two
flights vanishes with its rate at both rows. Its second and third derivatives are at most 8 A / 3 and 2 J: the
cubic's jerk is a weighted mean of the flight's, and its acceleration is one with weights whose absolute
values add up to 5 / 3. So the difference is at most A h^2 / 6 and J h^3 / 12, and its rate at most 2 A h / 3
and J h^2 / 4. For straight lines the difference is at most A h^2 / 8, and their speeds are means that every
flight reaches.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil, log10

import numpy as np

from shotc.diag.model import Label
from shotc.geom.bernstein import Array, Piecewise, bernstein_basis
from shotc.geom.proof import norm
from shotc.importers.flights.rows import PLACE, SHORTEST_S, DroneRows
from shotc.importers.flights.skyc import ShowFlight, SkycShow, shift
from shotc.importers.notes import label
from shotc.importers.xml_tree import Node
from shotc.ir.limits import Limits
from shotc.ir.mission import GeoOrigin

UPRIGHT_M = 0.1
"""Metres from the vertical over its pad, within which a drone counts as taking off or landing."""
PIECE_PARTS = 64
"""Parts of the piece on which a drone leaves the vertical, one of which ends its take-off."""
SAMPLED_ROWS = 500
"""Most rows whose digits are counted."""
MOST_M, MOST_M_S = 0.02, 0.1
"""Most metres and m/s of a table's uncertainty between rows that are granted against a limit."""
SHOW_PLACE_M = 1e-3
"""Rounding of show files, metres: a tenth of a millimetre, and half a millimetre in shotc's own files."""


@dataclass(frozen=True, slots=True)
class Leeway:
    """The granted uncertainty of a file, metres and m/s.

    between : largest distance of a flight within the drone's limits from the rebuilt one, metres
    """

    place: float
    speed: float
    between: float


@dataclass(frozen=True, slots=True, eq=False)
class ClockedFlight:
    """One drone's flight on the clock.

    name : of the drone
    curve : x, y, z in metres, cubic, from 0 s
    rows : of a table; None for a .skyc
    show : whether the file is of a show, whose drones may have other names than the mission's
    at : returns the place in the file of a time
    """

    name: str
    file: str
    curve: Piecewise
    rows: DroneRows | None
    leeway: Leeway
    at: Callable[[float], Label]
    show: bool = False


def of_rows(rows: DroneRows, name: str, file: str, limits: Limits) -> ClockedFlight:
    """Return the flight of a drone from its rows.

    limits : of the drone
    """
    time, place = rows.time, rows.place
    step = np.diff(time)[:, None]
    third = place[:-1] + step / 3 * _rate(rows)[0], place[1:] - step / 3 * _rate(rows)[1]
    breaks, ctrl = time, np.stack([place[:-1], *third, place[1:]], axis=1)
    if time[0] > SHORTEST_S:
        breaks, ctrl = np.append(0.0, time), np.concatenate([np.repeat(ctrl[:1, :1], 4, axis=1), ctrl])
    else:
        breaks = np.append(0.0, time[1:])
    h = float(step.max())
    rounding = max(quantum([rows.texts(column) or [] for column in PLACE]), 1e-9)
    between, faster = limits.acceleration * h * h / 8, 0.0
    if rows.velocity is not None:
        between = min(limits.acceleration * h * h / 6, limits.jerk * h**3 / 12)
        faster = min(2 * limits.acceleration * h / 3, limits.jerk * h * h / 4)
    leeway = Leeway(
        2 * rounding + min(between, MOST_M),
        min(3 * rounding / float(step.min()) + min(faster, MOST_M_S), MOST_M_S),
        between,
    )

    member = inside(file, rows)

    def at(when: float) -> Label:
        index = int(np.clip(np.searchsorted(time, when), 0, len(time) - 1))
        return label(member, rows.node(index))._replace(text="up to this row")

    return ClockedFlight(name, file, Piecewise(breaks, ctrl), rows, leeway, at, bool(rows.member))


def inside(file: str, rows: DroneRows) -> str:
    """Return the displayed name of the rows' file, which may be a member of an archive."""
    return f"{file}/{rows.member}" if rows.member else file


def _rate(rows: DroneRows) -> tuple[Array, Array]:
    """Return velocities at the beginning and at the end of every interval, shape (N - 1, 3) each."""
    if rows.velocity is not None:
        return rows.velocity[:-1], rows.velocity[1:]
    mean = np.diff(rows.place, axis=0) / np.diff(rows.time)[:, None]
    return mean, mean


def quantum(columns: Sequence[Sequence[str]]) -> float:
    """Return half a unit of the last digit of the largest numbers in columns."""
    texts = [text for column in columns for text in column[:: max(1, len(column) // SAMPLED_ROWS)]]
    largest = max((abs(float(text)) for text in texts if text), default=0.0)
    if largest == 0.0:
        return 0.0
    digits = max(len(text.lower().partition("e")[0].lstrip("-+0.").replace(".", "")) for text in texts)
    return 0.5 * 10.0 ** (ceil(log10(largest) + 1e-12) - max(digits, 1))


def of_show(flight: ShowFlight, show: SkycShow, file: str, origin: GeoOrigin | None) -> ClockedFlight:
    """Return the flight of a show's drone, moved from the show's frame to the mission's."""
    there = shift(show.origin, origin)
    node = Node("", 1, 1, wide=1)
    steps = np.diff(flight.breaks)
    leeway = Leeway(SHOW_PLACE_M, min(3 * SHOW_PLACE_M / float(steps.min()), MOST_M_S), 0.0)

    def at(when: float) -> Label:
        index = int(np.searchsorted(flight.breaks, when))
        return label(file, node)._replace(text=f"{flight.element}, up to key point {index}")

    return ClockedFlight(
        flight.name, file, Piecewise(flight.breaks, flight.ctrl + there), None, leeway, at, show=True
    )


def leaves(curve: Piecewise, pad: Array, pads: Array) -> tuple[float, float]:
    """Return the times at which a drone leaves the vertical over its pad and is over its landing pad,
    seconds.

    pad : of the drone, (3,); pads : those it may land on, (n, 3), metres
    """
    last = curve.ctrl[-1, -1]
    end = pads[int(np.argmin(norm(pads - last)))]
    up = _first_beyond(curve.breaks, curve.ctrl, pad)
    down = curve.end - _first_beyond((curve.end - curve.breaks)[::-1], curve.ctrl[::-1, ::-1], end)
    return up, max(up, down)


def _first_beyond(breaks: Array, ctrl: Array, pad: Array) -> float:
    """Return the time until which a curve stays within ``UPRIGHT_M`` of a vertical, to a part of a piece."""
    beyond = norm(ctrl[:, :, :2] - pad[:2]).max(axis=1) > UPRIGHT_M
    if not beyond.any():
        return float(breaks[-1])
    k = int(np.argmax(beyond))
    share = np.linspace(0.0, 1.0, PIECE_PARTS + 1)
    inside = norm(bernstein_basis(ctrl.shape[1] - 1, share) @ ctrl[k][:, :2] - pad[:2]) <= UPRIGHT_M
    count = max(int(np.argmin(inside)) - 1, 0) if not inside.all() else PIECE_PARTS
    return float(breaks[k] + (breaks[k + 1] - breaks[k]) * count / PIECE_PARTS)

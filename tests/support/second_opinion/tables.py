"""trajectory.csv against the polynomials, and the Earth."""

from __future__ import annotations

import numpy as np
import pymap3d

from tests.support.second_opinion.case import Case, Finding, Findings, column
from tests.support.second_opinion.flight import BODY_YAW, CAM_PITCH, CAM_YAW, HFOV, Array, Flight
from tests.support.second_opinion.quantities import number

DIGITS = 5e-9  # of the value: nine significant digits
NOISE = 1e-9  # of a value that is zero but for rounding
ON_EARTH = 5e-4  # metres: nine decimals of a degree are 0.06 mm
COLUMNS = {
    **{name: (0, k) for k, name in enumerate(("x_m", "y_m", "z_m"))},
    **{name: (1, k) for k, name in enumerate(("vx_m_s", "vy_m_s", "vz_m_s"))},
    **{name: (2, k) for k, name in enumerate(("ax_m_s2", "ay_m_s2", "az_m_s2"))},
    "body_yaw_rad": (0, BODY_YAW),
    "cam_yaw_rad": (0, CAM_YAW),
    "cam_pitch_rad": (0, CAM_PITCH),
    "cam_yaw_rate_rad_s": (1, CAM_YAW),
    "cam_pitch_rate_rad_s": (1, CAM_PITCH),
    "hfov_rad": (0, HFOV),
}


def trajectory(case: Case) -> Findings:
    """Every row says what the polynomials say, at every tick, in order, and where that is on Earth."""
    order = list(dict.fromkeys(row["drone"] for row in case.motion))
    if order != sorted(order) or set(order) != set(case.flights):
        yield Finding("rows sorted by drone", "trajectory.csv", len(order), len(case.flights))
    for name, flight in case.flights.items():
        rows = [row for row in case.motion if row["drone"] == name]
        t = column(rows, "t_s")
        ticks = np.arange(len(t)) + np.round(t[0] * case.mission.rate)
        late = np.abs(t - ticks / case.mission.rate).max()
        if late > 1e-8 * max(1.0, t[-1]):
            yield Finding("ticks of the clock", name, float(late), 0.0)
        over = float(t[-1] - flight.end)
        if not -1e-8 * t[-1] <= over < 1 / case.mission.rate + 1e-8 * t[-1]:
            yield Finding("last row at rest", name, over, 0.0)
        yield from _values(rows, flight, t)
        yield from _names(rows, flight, t)
        if case.mission.origin is not None:
            yield from _earth(case, rows, name)


def _values(rows: list[dict[str, str]], flight: Flight, t: Array) -> Findings:
    t = np.round(t, 9)
    for name, (order, channel) in COLUMNS.items():
        wanted, found = flight.at(t, order)[:, channel], column(rows, name)
        change = np.abs(flight.at(t, order + 1)[:, channel]) if order < 3 else 0.0
        off = np.abs(found - wanted) - DIGITS * np.abs(wanted) - change * DIGITS * np.abs(t)
        if not off.max() <= NOISE * 10**order * 10:
            k = int(np.argmax(off))
            yield Finding(f"column {name}", flight.drone, float(found[k]), float(wanted[k]), float(t[k]))


def _names(rows: list[dict[str, str]], flight: Flight, t: Array) -> Findings:
    """The phase of a row; within rounding of a boundary either side is right."""
    for row, time in zip(rows, t, strict=True):
        near = [p for p in flight.phases if p.start - 1e-7 <= time < p.end + 1e-7] or [flight.phases[-1]]
        if (row["phase"], row["shot"]) not in {(p.name, p.shot or "") for p in near}:
            yield Finding("phase of a row", flight.drone, 1, 0, float(time))


def _earth(case: Case, rows: list[dict[str, str]], drone: str) -> Findings:
    """Latitude, longitude and altitude by pymap3d, as metres East, North, Up."""
    origin = case.mission.origin
    assert origin is not None
    alt = number(origin.get("alt", 0.0))
    lat, lon, up = (column(rows, name) for name in ("lat_deg", "lon_deg", "alt_m"))
    back = pymap3d.geodetic2enu(lat, lon, up, float(origin["lat"]), float(origin["lon"]), alt)
    local = [column(rows, name) for name in ("x_m", "y_m", "z_m")]
    off = np.linalg.norm(np.array(back) - np.array(local), axis=0)
    if not off.max() <= ON_EARTH:
        yield Finding("latitude, longitude, altitude", drone, float(off.max()), 0.0)

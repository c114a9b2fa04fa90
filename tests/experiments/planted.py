"""`python -m tests.experiments.planted [COUNT]`: violations planted between the places of files of flights.

Each lasts less than a quarter of a second, and none of the file's own places shows it: rows 0.25 s apart
whose cubics dip in between, key points of a show with control points that do, and thin poles beside legs of
waypoint files and beside the curves of DJI's machines. How long each lasts is told by samples of formulas
that are written here once more. Printed is how many ``shotc verify`` finds, each at its time and its limit.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import hypot, sqrt

import numpy as np
from numpy.typing import NDArray

from shotc.flightfiles.verify import FlightsReport
from tests.support.flight_files import kmz, litchi_file, mark, verified, waypoints_file, wpml_text, zipped

Array = NDArray[np.float64]
Row = tuple[float, Array, Array]

LONGEST_S = 0.25
STEP_S = 0.25
CRUISE = 4.0
RADIUS = 0.6  # of an x500's body, metres
DRONES = """\
shotc: 1
mission: planted
world: {{origin: {{lat: 47.3769, lon: 8.5417, alt: 408}}, zones: {{{zones}}}}}
rules: {{separation: 3, ground_clearance: 2}}
drones:
  cam1: {{model: x500, home: [0, -60, 0], limits: {limits}}}
  cam2: {{model: x500, home: [0, 60, 0], limits: {limits}}}
shots:
  - {{id: wide, kind: static, drone: cam1, at: [0, -50, 15], heading: 0 deg, pitch: 0 deg}}
"""
FLEET = """\
shotc: 1
mission: planted
world: {{origin: {{lat: 47.3769, lon: 8.5417, alt: 408}}, zones: {{{zones}}}}}
rules: {{ground_clearance: 2}}
fleets:
  swarm: {{count: 4, layout: {{grid: {{spacing: 4, origin: [0, 0, 0]}}}}, separation: 1.5, rise: 5,
    limits: {limits}}}
shots:
  - {{id: ball, kind: display, fleet: swarm,
     frames: [{{sphere: {{center: [0, 0, 30], radius: 8}}, hold: 2}}]}}
"""
LIMITS = "{speed: 8, climb: 90, descent: 90, acceleration: 300, jerk: 90000}"


@dataclass(frozen=True)
class Planted:
    """A violation: the report, the constraint that it breaks, and when, as sampled here."""

    kind: str
    report: FlightsReport
    constraint: str
    times: Array

    @property
    def lasts(self) -> float:
        """How long it lasts, s."""
        return float(self.times[-1] - self.times[0]) if len(self.times) else 0.0

    @property
    def found(self) -> bool:
        """Whether it is told, and at that time."""
        broken = [c for c in self.report.certificate if c.constraint == self.constraint and not c.holds]
        early, late = self.times[0] - 0.01, self.times[-1] + 0.01
        return any(c.time is not None and early <= c.time <= late for c in broken)


def hermite(rows: list[Row], t: Array) -> tuple[Array, Array]:
    """Place and velocity of the cubics through rows; written out, as in any textbook."""
    times = np.array([row[0] for row in rows])
    k = np.clip(np.searchsorted(times, t, side="right") - 1, 0, len(rows) - 2)
    h = (times[k + 1] - times[k])[:, None]
    s = ((t - times[k])[:, None]) / h
    p, v = np.array([row[1] for row in rows]), np.array([row[2] for row in rows])
    at = (2 * s**3 - 3 * s**2 + 1) * p[k] + (s**3 - 2 * s**2 + s) * h * v[k]
    at += (3 * s**2 - 2 * s**3) * p[k + 1] + (s**3 - s**2) * h * v[k + 1]
    rate = (6 * s**2 - 6 * s) / h * (p[k] - p[k + 1]) + (3 * s**2 - 4 * s + 1) * v[k]
    return at, rate + (3 * s**2 - 2 * s) * v[k + 1]


def cruise(home: tuple[float, float, float], height: float, speed: float, seconds: float) -> list[Row]:
    """Up from the pad at 2 m/s, then East."""
    rows: list[Row] = []
    rise = np.ceil(height / 2.0 / STEP_S) * STEP_S
    for k in range(int((rise + seconds) / STEP_S) + 1):
        t = k * STEP_S
        at = np.add(home, [max(t - rise - STEP_S / 2, 0.0) * speed, 0.0, min(t / rise, 1.0) * height])
        on, up = float(t > rise), float(t < rise)
        rows.append((t, at, np.array([on * speed, 0.0, up * height / rise])))
    return rows


def table(drones: dict[str, list[Row]]) -> bytes:
    lines = ["t_s,drone,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s"]
    for name, rows in drones.items():
        lines += [",".join([f"{t:.2f}", name, *(f"{c:.9g}" for c in (*p, *v))]) for t, p, v in rows]
    return "\n".join([*lines, ""]).encode()


def show(drones: list[list[Row]]) -> bytes:
    """The same motion as key points and inner control points, North-West-Up."""
    listed = []
    for i, rows in enumerate(drones):
        points: list[object] = []
        for k, (t, at, rate) in enumerate(rows):
            control = []
            if k:
                before, h = rows[k - 1], t - rows[k - 1][0]
                control = [_turned(before[1] + before[2] * h / 3), _turned(at - rate * h / 3)]
            points.append([t, _turned(at), control])
        path = {"version": 1, "takeoffTime": 0, "points": points}
        listed.append({"type": "generic", "settings": {"name": f"swarm-{i + 1}", "trajectory": path}})
    return zipped({"show.json": json.dumps({"version": 1, "swarm": {"drones": listed}}).encode()})


def _turned(place: Array) -> list[float]:
    return [float(place[1]), -float(place[0]), float(place[2])]


def dipped(rows: list[Row], k: int, way: Array, depth: float) -> list[Row]:
    """Rows whose cubic between k and k + 1 dips along a way; their places stay."""
    rate = 4.0 * depth / STEP_S * way
    out = list(rows)
    out[k] = (rows[k][0], rows[k][1], rows[k][2] + rate)
    out[k + 1] = (rows[k + 1][0], rows[k + 1][1], rows[k + 1][2] - rate)
    return out


def during(rows: list[Row], broken: Callable[[Array, Array], NDArray[np.bool_]]) -> Array:
    """When a flight breaks something, by samples a half millisecond apart; no row may show it."""
    times = np.arange(0.0, rows[-1][0], 5e-4)
    at, rate = hermite(rows, times)
    own = np.array([row[0] for row in rows])
    places, rates = np.array([row[1] for row in rows]), np.array([row[2] for row in rows])
    flying = own >= own[-1] / 2
    assert not broken(places[flying], rates[flying]).any()
    return times[broken(at, rate) & (times > own[-1] / 2)]


def beside(rows: list[Row], apart: float) -> list[Row]:
    """The same flight 4 m farther North, which comes as near as that on the first metres of its cruise."""
    first = next(k for k, (_, _, v) in enumerate(rows) if v[0] > 0.0)
    norths = [apart + (4.0 - apart) * max(0.0, 1.0 - max(k - first, 0) / 8) for k in range(len(rows))]
    return [(t, np.add(p, [0.0, north, 0.0]), v) for (t, p, v), north in zip(rows, norths, strict=True)]


def of_clock(rng: np.random.Generator, what: str, *, shown: bool) -> Planted:
    """A violation of a flight on the clock."""
    home = (0.0, 0.0, 0.0) if shown else (0.0, -60.0, 0.0)
    radius = 0.25 if shown else RADIUS
    spare, depth = rng.uniform(0.0, 0.1), rng.uniform(0.04, 0.25)
    ground = what == "ground"
    height = 2.0 + radius + spare if ground else CRUISE + rng.uniform(1.0, 9.0)
    speed = 8.0 - rng.uniform(0.05, 0.3) if what == "speed" else rng.uniform(2.0, 6.0)
    rows = cruise(home, height, speed, 12.0)
    k = int(rng.integers(len(rows) // 2 + 4, len(rows) - 4))
    zones, others = "", []
    middle = 0.5 * (rows[k][1] + rows[k + 1][1])
    if what == "ground":
        rows = dipped(rows, k, np.array([0.0, 0.0, -1.0]), spare + depth)
        times = during(rows, lambda p, v: p[:, 2] < 2.0 + radius)
        constraint = "ground clearance"
    elif what == "speed":
        farther = (8.0 - speed + 0.1 + depth) * STEP_S / 3.0
        for i, away in ((k, -farther), (k + 1, farther)):
            rows[i] = (rows[i][0], np.add(rows[i][1], [away, 0.0, 0.0]), rows[i][2])
        times = during(rows, lambda p, v: np.hypot(v[:, 0], v[:, 1]) > 8.0)
        constraint = "speed"
    elif what == "zone":
        side = middle[1] + radius + spare
        zones = f"wall: {{keep: out, box: {{center: [{middle[0]}, {side + 0.5}, 10], size: [4, 1, 60]}}}}"
        rows = dipped(rows, k, np.array([0.0, 1.0, 0.0]), spare + depth)
        times = during(rows, lambda p, v: p[:, 1] + radius > side)
        constraint = "zone wall"
    else:
        apart = 1.5 if shown else 3.0
        others = [beside(rows, apart + spare)]
        rows = dipped(rows, k, np.array([0.0, 1.0, 0.0]), spare + depth)
        line = middle[1] + apart + spare
        times = during(rows, lambda p, v: line - p[:, 1] < apart)
        constraint = "separation" if shown else "separation from cam2"
    if not shown:
        text = DRONES.format(zones=zones, limits=LIMITS)
        drones = {"cam1": rows} | ({"cam2": others[0]} if others else {})
        return Planted(f"table, {what}", verified(("all.csv", table(drones)), text=text), constraint, times)
    text = FLEET.format(zones=zones, limits=LIMITS)
    straight = cruise(home, height, speed, 12.0)
    pads = ((4.0, 0.0), (0.0, 4.0), (4.0, 4.0))
    far = [[(t, np.add(p, [*away, 0.0]), v) for t, p, v in straight] for away in pads]
    flights = [rows, far[0], *(others or far[1:2]), far[2]]
    return Planted(f"show, {what}", verified(("all.skyc", show(flights)), text=text), constraint, times)


def of_waypoints(rng: np.random.Generator, form: str) -> Planted:
    """A thin pole beside a leg, or beside the curve that a machine of DJI may fly."""
    start = np.array([0.0, -60.0, 12.0])
    places = [start]
    turn = rng.uniform(0.0, 2 * np.pi)
    for _ in range(5):
        turn += rng.uniform(-1.2, 1.2)
        places.append(places[-1] + rng.uniform(15.0, 30.0) * np.array([np.cos(turn), np.sin(turn), 0.0]))
    leg = int(rng.integers(1, 4))
    speed, share = rng.uniform(3.0, 7.0), np.linspace(0.0, 1.0, 4001)[:, None]
    curve = places[leg] + share * (places[leg + 1] - places[leg])
    if form == "a curve of DJI":
        curve = catmull_rom(places, leg, share)
    k = int(rng.integers(1200, 2800))
    along = curve[k + 1] - curve[k - 1]
    across = np.array([-along[1], along[0], 0.0]) / hypot(along[0], along[1])
    pole, depth = rng.uniform(0.05, 0.3), rng.uniform(0.06, 0.08)
    centre = curve[k] + (pole + RADIUS - depth) * across * rng.choice([-1.0, 1.0])
    foot = f"center: [{centre[0]}, {centre[1]}], radius: {pole}, height: [0, 40]"
    zones = f"pole: {{keep: out, cylinder: {{{foot}}}}}"
    text = DRONES.format(zones=zones, limits=LIMITS)
    listed = tuple((float(x), float(y), float(z)) for x, y, z in places)
    files = {
        "waypoints": ("cam1.waypoints", waypoints_file(listed)),
        "Litchi": ("cam1.csv", litchi_file(listed, speed=speed)),
        "a curve of DJI": ("cam1.kmz", kmz(wpml_text([mark(p, speed) for p in listed], finish="noAction"))),
    }
    report = verified(files[form], text=text)
    inside = np.hypot(*(curve[:, :2] - centre[:2]).T) < pole + RADIUS
    lasts = float(np.linalg.norm(np.diff(curve, axis=0), axis=1)[inside[1:]].sum()) / speed
    broken = [c for c in report.certificate if c.constraint == "zone pole" and c.time is not None]
    at = broken[0].time if broken and broken[0].time is not None else np.nan
    return Planted(form, report, "zone pole", at + np.array([0.0, lasts]))


def catmull_rom(places: list[Array], leg: int, share: Array) -> Array:
    """A leg of the centripetal spline by Barry and Goldman's pyramid, which shotc does not use."""
    p = places[leg - 1 : leg + 3]
    t = [0.0]
    for a, b in pairwise(p):
        t.append(t[-1] + sqrt(float(np.linalg.norm(b - a))))
    u = t[1] + share * (t[2] - t[1])
    a = [((t[i + 1] - u) * p[i] + (u - t[i]) * p[i + 1]) / (t[i + 1] - t[i]) for i in range(3)]
    b = [((t[i + 2] - u) * a[i] + (u - t[i]) * a[i + 1]) / (t[i + 2] - t[i]) for i in range(2)]
    return np.asarray(((t[2] - u) * b[0] + (u - t[1]) * b[1]) / (t[2] - t[1]))


KINDS: tuple[Callable[[np.random.Generator], Planted], ...] = (
    *(
        lambda rng, what=what, shown=shown: of_clock(rng, what, shown=shown)
        for shown in (False, True)
        for what in ("ground", "zone", "separation", "speed")
    ),
    *(lambda rng, form=form: of_waypoints(rng, form) for form in ("waypoints", "Litchi", "a curve of DJI")),
)


def planted(count: int, seed: int = 0) -> Iterator[Planted]:
    """Violations of every kind in turn."""
    for i in range(count):
        yield KINDS[i % len(KINDS)](np.random.default_rng([seed, i]))


def main() -> None:
    """Plant them, and print how many are found."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    found: dict[str, list[bool]] = {}
    longest = 0.0
    for each in planted(count):
        assert 0.0 < each.lasts < LONGEST_S, (each.kind, each.lasts)
        longest = max(longest, each.lasts)
        found.setdefault(each.kind, []).append(each.found)
    for kind, hits in found.items():
        sys.stdout.write(f"{kind:24} {sum(hits)} of {len(hits)}\n")
    every = [hit for hits in found.values() for hit in hits]
    sys.stdout.write(f"{'all':24} {sum(every)} of {len(every)}, none longer than {longest:.3f} s\n")


if __name__ == "__main__":
    main()

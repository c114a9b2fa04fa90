"""Files of 200 drones that fly for ten minutes, as any tool may write them, for `shotc verify`."""

from __future__ import annotations

import json
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

import numpy as np

DRONES, SECONDS, SIDE, SPACING = 200, 600.0, 15, 4.0
KEY_S, ROW_S = 1.0, 0.2
"""Seconds between key points of a show, on average, and between rows of a table."""
RISE_S, HEIGHT = 30.0, 30.0
SWAY, SWAY_S = 1.2, 40.0
"""Metres by which each drone sways about its place, and seconds that it takes."""


def mission() -> str:
    """Return the mission that the files are held against: an airspace, a mast and a fleet."""
    half = 0.5 * (SIDE - 1) * SPACING
    return f"""\
shotc: 1
mission: long-show
world:
  zones:
    airspace: {{keep: in, box: {{center: [0, 0, 40], size: [120, 120, 80]}}}}
    mast: {{keep: out, cylinder: {{center: [50, 50], radius: 1, height: [0, 40]}}}}
fleets:
  swarm: {{count: {DRONES}, layout: {{grid: {{spacing: {SPACING}, origin: [{-half}, {-half}, 0]}}}},
    separation: 1.2, rise: 5, endurance: 20 min}}
shots:
  - {{id: ball, kind: display, fleet: swarm,
     frames: [{{sphere: {{center: [0, 0, 40], radius: 14}}, hold: 2}}]}}
"""


def pads() -> list[tuple[float, float]]:
    """Return the pads of the fleet, row by row as the mission has them."""
    from shotc.api import MissionFile
    from shotc.lowering import lower_for_flights

    lowered = lower_for_flights(*MissionFile(mission().encode(), "mission.yaml", None), dict)
    assert lowered.keyframes is not None
    return [(x, y) for x, y, _ in lowered.keyframes.mission.fleets[0].pads]


def motion(t: np.ndarray, pad: tuple[float, float], phase: float) -> tuple[np.ndarray, np.ndarray]:
    """Return places and velocities: up, sway about the pad's vertical as the neighbours do not, and down."""
    share, rate = _eased(t, 0.0), _eased(t, 0.0, slope=True)
    down, fall = _eased(t, SECONDS - RISE_S), _eased(t, SECONDS - RISE_S, slope=True)
    level, sink = share - down, rate - fall
    turn = 2 * np.pi * t / SWAY_S + phase
    ease = level**3
    sway = SWAY * np.stack([np.cos(turn), np.sin(turn), 0.3 * np.sin(2 * turn)], axis=1)
    going = (
        SWAY * 2 * np.pi / SWAY_S * np.stack([-np.sin(turn), np.cos(turn), 0.6 * np.cos(2 * turn)], axis=1)
    )
    at = ease[:, None] * sway + np.stack([0 * t + pad[0], 0 * t + pad[1], HEIGHT * level], axis=1)
    v = ease[:, None] * going + (3 * level**2 * sink)[:, None] * sway
    return at, v + np.stack([0 * t, 0 * t, HEIGHT * sink], axis=1)


def _eased(t: np.ndarray, start: float, *, slope: bool = False) -> np.ndarray:
    s = np.clip((t - start) / RISE_S, 0.0, 1.0)
    return 30 * (s**2 - 2 * s**3 + s**4) / RISE_S if slope else 10 * s**3 - 15 * s**4 + 6 * s**5


def write(folder: Path) -> dict[str, Path]:
    """Write the mission and its flights: a table, a show of common times, and one of each drone's own."""
    (folder / "mission.yaml").write_text(mission())
    rng = np.random.default_rng(0)
    places = pads()
    even = np.arange(0.0, SECONDS + KEY_S / 2, KEY_S)
    own = [np.unique(np.round([0, *rng.uniform(0, SECONDS, len(even) - 2), SECONDS], 2)) for _ in places]
    rows = np.arange(0.0, SECONDS + ROW_S / 2, ROW_S)
    return {
        "a table, 5 rows a second": _table(folder / "rows.csv", places, rows),
        "a show, key points at common times": _show(folder / "even.skyc", places, [even] * DRONES),
        "a show, key points at own times": _show(folder / "own.skyc", places, own),
    }


def _table(path: Path, places: list[tuple[float, float]], t: np.ndarray) -> Path:
    with path.open("w") as stream:
        stream.write("t_s,drone,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s\n")
        for i, pad in enumerate(places):
            numbers = np.column_stack([*motion(t, pad, 0.1 * i)])
            form = f"%.9g,swarm-{i + 1:03d},{','.join(['%.9g'] * 6)}\n"
            stream.writelines(
                form % (time, *row) for time, row in zip(t.tolist(), numbers.tolist(), strict=True)
            )
    return path


def _show(path: Path, places: list[tuple[float, float]], times: list[np.ndarray]) -> Path:
    drones = []
    for i, (pad, t) in enumerate(zip(places, times, strict=True)):
        at, v = motion(t, pad, 0.1 * i)
        third = np.diff(t)[:, None] / 3
        inner = np.stack([at[:-1] + third * v[:-1], at[1:] - third * v[1:]], axis=1)
        turned = [
            np.round(np.stack([p[..., 1], -p[..., 0], p[..., 2]], axis=-1), 4).tolist() for p in (at, inner)
        ]
        points = [[float(t[0]), turned[0][0], []]]
        points += [list(each) for each in zip(t[1:].tolist(), turned[0][1:], turned[1], strict=True)]
        settings = {
            "name": f"swarm-{i + 1:03d}",
            "trajectory": {"version": 1, "takeoffTime": 0, "points": points},
        }
        drones.append({"type": "generic", "settings": settings})
    with ZipFile(path, "w", ZIP_DEFLATED) as archive:
        archive.writestr("show.json", json.dumps({"version": 1, "swarm": {"drones": drones}}))
    return path

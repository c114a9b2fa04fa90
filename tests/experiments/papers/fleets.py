"""Several drones: the moving-target paper's Sec. 5.3 and field mission of Sec. 6, and production missions.

Run it alone by `python -m tests.experiments.papers --only fleets`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import numpy as np

from shotc.api import PlanOptions, compile_source
from shotc.diag.registry import has_errors
from shotc.geom.bernstein import lift_off
from shotc.geom.sight import off_axis
from shotc.importers.mission import import_multidrone
from shotc.ir.sampling import cameras
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR
from tests.experiments.papers.report import Section, Table
from tests.support.multidrone_originals import ORIGINALS

STEP = 0.02  # seconds
CONE = 30.0  # deg: half the cone that is kept free (the paper's alpha)

TWO = """\
shotc: 1
mission: two
targets: {{walker: {{track: {{start: [-30, 0, 0.9], velocity: [1.5, 0, 0]}}, radius: 0.3, height: 1.8}}}}
drones:
  cam1: {{model: alta-x, radius: 0.5, home: [-30, 20, 0], priority: 1, limits: {limits}}}
  cam2: {{model: alta-x, radius: 0.5, home: [-40, 20, 0], priority: 2, limits: {limits}}}
rules: {{separation: {separation}, ground_clearance: 1, target_clearance: 0.5, allow: [fast-pan],
        mutual_visibility: {{half_angle: {cone:g} deg, strength: "{strength}"}}}}
shots:
  - {{id: side, kind: lateral, drone: cam1, target: walker, side: left, distance: 4, altitude: 2,
     timing: {{start: 20, duration: 20}}}}
  - {{id: pass, kind: flyby, drone: cam2, target: walker, behind: 5, ahead: 5, offset: 6, altitude: 4,
     timing: {{start: 20, duration: 20}}}}
"""
THREE = """\
shotc: 1
mission: three
targets: {walker: {track: {start: [0, 0, 0.9], velocity: [1.3, 0, 0]}, radius: 0.3, height: 1.8}}
drones:
  cam1: {model: alta-x, radius: 0.5, home: [10, -40, 0], priority: 1}
  cam2: {model: alta-x, radius: 0.5, home: [0, -40, 0], priority: 2}
  cam3: {model: alta-x, radius: 0.5, home: [10, 40, 0], priority: 3}
rules: {separation: 5, ground_clearance: 1, allow: [fast-pan], mutual_visibility: {strength: prefer}}
shots:
  - {id: side, kind: lateral, drone: cam1, target: walker, side: right, distance: 20, altitude: 3,
     timing: {start: 30, duration: 60}}
  - {id: pass, kind: flyby, drone: cam2, target: walker, behind: 15, ahead: 15, altitude: 10,
     timing: {start: 30, duration: 60}}
  - {id: other, kind: lateral, drone: cam3, target: walker, side: left, distance: 15, altitude: 7,
     timing: {start: 30, duration: 60}}
"""
LIMITS = "{speed: 5 m/s, acceleration: 5 m/s^2}"


def planned(text: str) -> VerifiedIR:
    """Plan a mission with the refiner; it is one that can be planned."""
    done = compile_source(text.encode(), "m.yaml", None, PlanOptions())
    if done.plan is None:
        raise SystemExit("\n".join(d.message for d in done.diagnostics))
    return done.plan


def section(say: Callable[[str], None]) -> Section:
    """Run all of it."""
    say("two drones")
    tables = [two()]
    say("three drones")
    tables.append(three())
    if ORIGINALS:
        tables.append(production(say))
    return Section("Several drones", tuple(tables))


def two() -> Table:
    """Return the test of Sec. 5.3, with and without coordination."""
    rows = []
    for title, strength, separation in (("without", "off", 0), ("with", "require", 2)):
        plan = planned(TWO.format(limits=LIMITS, cone=CONE, strength=strength, separation=separation))
        one, other = plan.trajectory.drones
        t = np.arange(20.0, 40.0, STEP)
        apart = np.linalg.norm(one.curve(t)[:, :3] - other.curve(t)[:, :3], axis=1).min()
        walker = plan.trajectory.keyframes.mission.target("walker").at(40.0)
        ahead = float(other.curve(40.0)[0]) - walker[0]
        seen = [_seen(plan, a, b, t) for a, b in ((one, other), (other, one))]
        rows.append(
            (
                title,
                f"{apart:.2f} m",
                *(f"{100 * s[0]:.1f} %, {s[1]:.1f} deg" for s in seen),
                f"{ahead:.1f} m",
            )
        )
    return Table(
        "Two drones, a lateral and a flyby of 20 s (Sec. 5.3)",
        (
            "coordination",
            "nearest",
            "2 in 1's cone, least angle",
            "1 in 2's cone, least angle",
            "flyby ends ahead",
        ),
        tuple(rows),
        (
            f"the cone is {CONE:g} deg about the optical axis, the drones are balls of 0.5 m; r_col is 2 m",
            "the paper gives pictures and no figures; the flyby passes 6 m to the left of the walker's way, "
            "beyond the other drone, so that it has to give way, and ends 5 m ahead by its ideal",
            "assumed: a walker at 1.5 m/s and drones of 5 m/s, since the paper's 1 m/s is slower than its "
            "target; no tree; planned whole (planned anew at 2 Hz, as in the paper, above)",
            "the ground clearance is 1 m; separation and pictures are proved for all times",
        ),
    )


def _seen(
    plan: VerifiedIR, film: DroneTrajectory, other: DroneTrajectory, t: np.ndarray
) -> tuple[float, float]:
    view = cameras(plan.trajectory.keyframes.mission, film, t)
    away = np.degrees(off_axis(view, other.curve(t)[:, :3], 0.5))
    return float((away < CONE).mean()), float(away.min())


def three() -> Table:
    """Return the field mission of Sec. 6, simulated, by the metrics of Table 4."""
    plan = planned(THREE)
    tracks = plan.trajectory.drones
    t = np.arange(30.0, 90.0, STEP)
    places = [track.curve(t)[:, :3] for track in tracks]
    paper = {
        "cam1": ("95", "0.125", "9.543"),
        "cam2": ("141.4", "0.108", "9.543"),
        "cam3": ("98.6", "0.100", "14.711"),
    }
    rows = []
    for i, track in enumerate(tracks):
        way = np.linalg.norm(np.diff(places[i], axis=0), axis=1).sum()
        pull = np.linalg.norm(track.curve.derivative(2)(t)[:, :3], axis=1).mean()
        near = min(
            float(np.linalg.norm(places[i][:, :2] - places[j][:, :2], axis=1).min())
            for j in range(len(tracks))
            if j != i
        )
        said = paper[track.drone]
        rows.append((track.drone, f"{way:.1f}", said[0], f"{pull:.3f}", said[1], f"{near:.2f}", said[2]))
    return Table(
        "Three drones film a walker (Sec. 6, Table 4)",
        ("drone", "way, m", "paper", "acceleration, m/s^2", "paper", "nearest across, m", "paper"),
        tuple(rows),
        (
            "lateral 20 m at 3 m, flyby from 15 m behind to 15 m ahead at 10 m, lateral 15 m at 7 m",
            "assumed: a walker at 1.3 m/s on a straight way for 60 s; the paper's walked as people do, "
            "in wind, and its drones were replanned on the way",
        ),
    )


def production(say: Callable[[str], None]) -> Table:
    """Return what becomes of the MultiDrone project's production missions."""
    rows = list(_production(say))
    done = sum("planned and proved" in row for row in rows)
    return Table(
        f"Production missions: {done} of {len(rows)} planned and proved",
        (
            "mission",
            "drones",
            "shots",
            "film, s",
            "in the air, s",
            "assumptions",
            "outcome",
            "planning",
            "a drone and minute",
        ),
        tuple(rows),
        (
            "imported by `shotc import multidrone` and planned without a refiner",
            "the originals are not part of this repository: without them this table is not made",
            "film and time in the air are sums over the drones; a minute is one in the air",
            "the time is that of the process once its libraries are loaded",
        ),
    )


def _production(say: Callable[[str], None]) -> Iterator[tuple[str, ...]]:
    for path in ORIGINALS:
        say(f"production mission {path.stem[:20]}")
        made = import_multidrone(path.read_bytes(), path.name, strict=False)
        if made.text is None:
            yield (path.stem[:2], "-", "-", "-", "-", str(len(made.diagnostics)), "not imported", "-", "-")
            continue
        began = time.perf_counter()
        done = compile_source(made.text.encode(), "m.yaml", None, PlanOptions(refiner="none"))
        took = time.perf_counter() - began
        if done.plan is None:
            first = next(d for d in done.diagnostics if has_errors([d]))
            yield (
                path.stem[:2],
                "-",
                str(made.shots),
                "-",
                "-",
                str(len(made.diagnostics)),
                first.message,
                "-",
                "-",
            )
            continue
        drones = done.plan.trajectory.drones
        film = sum(p.end - p.start for d in drones for p in d.phases if p.shot)
        air = sum(d.curve.end - lift_off(d.curve) for d in drones)
        yield (
            path.stem[:2],
            str(len(drones)),
            str(made.shots),
            f"{film:.0f}",
            f"{air:.0f}",
            str(len(made.diagnostics)),
            "planned and proved",
            f"{took:.1f} s",
            f"{took / (air / 60):.2f} s",
        )

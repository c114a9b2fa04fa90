"""The viewpoint paper's Experiments 1 to 4 (Naegeli et al., Sec. V), as missions that are planned whole.

Run it alone by `python -m tests.experiments.papers --only viewpoint`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import atan, degrees
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from shotc.api import PlanOptions, compile_source
from shotc.geom.bernstein import Array
from shotc.ir.framed import at_start
from shotc.ir.ideal import ideal_place
from shotc.ir.mission import MissionIR
from shotc.ir.occlusion import hiders
from shotc.ir.sampling import seen
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR
from tests.experiments.papers.report import Section, Table
from tests.experiments.papers.shown import percentile

WIDE, HIGH, FOCAL = 640.0, 368.0, 400.0  # pixels: the camera's picture, and its focal length
STEP = 0.04  # seconds between frames that are measured
START, LASTS = 12.0, 30.0  # seconds: when a film begins, and how long it is
PACE = 0.9  # m/s of a walker
TIMES = np.arange(0.0, START + LASTS + 5, 0.2)  # of the rows of a walk
SEEDS = (0, 1, 2)
SOLID = np.array([0.6, 0.6, 1.1])  # semi-axes of a person's ellipsoid, m
CAMERA = (0.0, -3.9)  # about where the camera of Experiments 2 and 3 would stand
SIZE, BEARING = 0.5, 180.0
PLANNERS = {"guide": "none", "refined": "ours"}

MISSION = """\
shotc: 1
mission: faces
world: {{zones: {{room: {{keep: in, box: {{center: [0, 0, 1.5], size: [{room:g}, {room:g}, 5]}}}}}}}}
targets:
{targets}
drones:
  cam: {{model: x500, radius: 0.25, home: [-4, -4.2, 0],
        camera: {{hfov: {hfov:.4f} deg, aspect: {aspect:.6f}}},
        limits: {{speed: 2 m/s, climb: 1 m/s, descent: 1 m/s, acceleration: 2 m/s^2, jerk: 10 m/s^3}}}}
rules: {{ground_clearance: 0.4, target_clearance: 0.3, allow: [jump-cut, fast-pan, short-shot]}}
shots:
{shots}
"""
PERSON_SIZE = (0.3, 1.8)  # radius and height, m
PERSON = "radius: {:g}, height: {:g}".format(*PERSON_SIZE)
NOTES = (
    "planned whole, offline: every walk is known. The paper replans over N = 25 steps all the time; its "
    "Experiment 5 (the time of a replan) stands with replanning",
    "assumed, since the paper does not give it: 640 x 368 pixels and a focal length of 400 (77 deg across); "
    "a drone of 0.25 m with 2 m/s, 2 m/s^2 and 10 m/s^3; a room of 10 m and 4 m high; persons as cylinders "
    "of 0.3 m and 1.8 m, whose middle is framed and seen, where the paper frames heads; 0.3 m kept from "
    "them; a person half as high as the picture; walkers at 0.9 m/s, three walks each (seeds 0 to 2)",
    "of the paper's results there are pictures, and no figures but the times",
)
MEASURES = (
    "frames hidden",
    "screen error px, mean",
    "95 %",
    "size",
    "off its place m",
    "least ellipsoid value",
    "nearest m",
    "planning s",
)


@dataclass(frozen=True, eq=False)
class Seen:
    """What a film shows of one subject, frame by frame, shape (M,).

    error : pixels from its place; size : of the frame's height; whole, hidden : by frame
    value : least x^T Omega x of the camera from any person's ellipsoid, below 1 inside; near : metres to the
    nearest person's axis; off : metres from the ideal place
    """

    error: Array
    size: Array
    whole: Array
    hidden: Array
    value: Array
    near: Array
    off: Array


def mission(targets: Sequence[str], shots: Sequence[str], room: float = 10.0) -> str:
    """Return a mission's text; targets, shots : a line of YAML each."""
    return MISSION.format(
        room=room,
        targets="\n".join(f"  {line}" for line in targets),
        shots="\n".join(f"  - {{{line}}}" for line in shots),
        hfov=2 * degrees(atan(0.5 * WIDE / FOCAL)),
        aspect=WIDE / HIGH,
    )


def planned(text: str, refiner: str, walks: dict[str, Array] | None = None) -> tuple[VerifiedIR, float]:
    """Return the plan of a mission that can be planned, and the seconds it took.

    walks : rows t, x, y of targets, by name
    """
    with TemporaryDirectory() as folder:
        for name, walk in (walks or {}).items():
            rows = "\n".join(f"{t:.2f},{x:.4f},{y:.4f},0.9" for t, x, y in walk)
            (Path(folder) / f"{name}.csv").write_text(f"t,x,y,z\n{rows}\n", encoding="utf-8")
        began = time.perf_counter()
        done = compile_source(text.encode(), "m.yaml", Path(folder), PlanOptions(refiner=refiner))
        took = time.perf_counter() - began
    if done.plan is None:
        raise SystemExit("\n".join(d.message for d in done.diagnostics))
    return done.plan, took


def look(plan: VerifiedIR, shot: str, subject: str) -> Seen:
    """Measure what a flown shot shows of a subject."""
    ir = plan.trajectory
    world, track = ir.keyframes.mission, ir.drones[0]
    (phase,) = (p for p in track.phases if p.shot == shot)
    t = np.arange(phase.start, phase.end, STEP)
    frames = seen(world, track, subject, t)
    (placed,) = (p for p in ir.keyframes.shots if p.shot.id == shot)
    (asked,) = (s for s in placed.subjects if s.target == subject)
    u, v = np.array([asked.asked(float(x) - phase.start).place or (0.0, 0.0) for x in t]).T
    error = np.hypot((frames.u - u) * WIDE / 2, (frames.v - v) * HIGH / 2)
    eyes, ideal = track.curve(t)[:, :3], _ideal(world, track, shot, phase.start, t)
    value, near = _apart(world, eyes, t)
    off = np.linalg.norm(eyes - ideal, axis=1)
    return Seen(
        np.nan_to_num(error, nan=np.inf), frames.size, frames.in_frame, frames.hidden, value, near, off
    )


def ideal_look(plan: VerifiedIR, shot: str, subject: str) -> tuple[float, float, float]:
    """Return of the ideal, which avoids nothing: share of hidden frames, least ellipsoid value, nearest m."""
    world, track = plan.trajectory.keyframes.mission, plan.trajectory.drones[0]
    (phase,) = (p for p in track.phases if p.shot == shot)
    t = np.arange(phase.start, phase.end, STEP)
    eyes = _ideal(world, track, shot, phase.start, t)
    hidden = np.any([hides for _, hides in hiders(world, (), subject, eyes, t)], axis=0)
    value, near = _apart(world, eyes, t)
    return float(hidden.mean()), float(value.min()), float(near.min())


def _ideal(world: MissionIR, track: DroneTrajectory, shot: str, start: float, t: Array) -> Array:
    (asked,) = (s for s in world.shots if s.id == shot and s.drone == track.drone)
    begun = at_start(world, asked, start)
    return np.array([ideal_place(world, begun, start, float(u)) for u in t])


def _apart(world: MissionIR, eyes: Array, t: Array) -> tuple[Array, Array]:
    away = np.array([[eye - np.array(target.at(float(u))) for eye, u in zip(eyes, t, strict=True)]
                     for target in world.targets])  # fmt: skip
    value = ((away / SOLID) ** 2).sum(axis=2).min(axis=0)
    return value, np.linalg.norm(away[:, :, :2], axis=2).min(axis=0)


def section(say: Callable[[str], None]) -> Section:
    """Run the four experiments."""
    say("setpoints")
    tables = [setpoints()]
    say("occlusion")
    tables.append(walked("Experiment 2: two others cross and stop in the line of sight", crossing))
    say("collision")
    tables.append(walked("Experiment 3: two others walk about, half the time at the camera", roaming))
    say("several")
    tables.append(several())
    return Section("Viewpoints", tuple(tables), NOTES)


SETPOINTS = {
    "three-quarter frontal right": (225.0, 0.0),
    "three-quarter frontal left": (135.0, 0.0),
    "right on screen": (180.0, 0.4),
    "left on screen": (180.0, -0.4),
}


HELD_S, CHANGE_S = 3.0, 6.0  # seconds that a setpoint is held, and from one to the next


def setpoints() -> Table:
    """Return Experiment 1: one subject that faces South, asked for in four ways within one shot."""
    every, rows = list(SETPOINTS.values()), []
    written = []
    for k, (bearing, u) in enumerate(every):
        now = f"frame: [{u:g}, 0], view: {{azimuth: {bearing:g} deg"
        reached, left = k * (HELD_S + CHANGE_S), k * (HELD_S + CHANGE_S) + HELD_S
        written += [f"{{time: {t:g}, {now}}}}}" for t in (reached, left) if t > 0.0]
    lasts = len(every) * (HELD_S + CHANGE_S) - CHANGE_S
    first = f"target: face, frame: [{every[0][1]:g}, 0], size: {SIZE}"
    view = f"view: {{azimuth: {every[0][0]:g} deg, elevation: 5 deg}}"
    shot = (
        f"id: s, kind: framing, drone: cam, timing: {{start: {START:g}, duration: {lasts:g}}}, "
        f"subjects: [{{{first}, {view}, setpoints: [{', '.join(written)}]}}]"
    )
    plan, _ = planned(mission([f"face: {{at: [0, 0, 0.9], {PERSON}}}"], [shot]), "ours")
    found, off_view = look(plan, "s", "face"), _view_errors(plan)
    t = np.arange(len(found.error)) * STEP
    for k, name in enumerate(SETPOINTS):
        reached = k * (HELD_S + CHANGE_S)
        spans = [
            (name, reached, reached + HELD_S),
            ("to the next", reached + HELD_S, reached + HELD_S + CHANGE_S),
        ]
        for what, low, high in spans[: 1 if k == len(every) - 1 else 2]:
            at = (t >= low) & (t <= high)
            rows.append(
                (
                    what,
                    f"{found.error[at].mean():.2f}",
                    f"{percentile(found.error[at], 0.95):.2f}",
                    f"{np.abs(found.size[at] - SIZE).max():.4f}",
                    f"{off_view[at].max():.2f}",
                    _share(found.whole[at].mean()),
                )
            )
    columns = (
        "setpoint",
        "screen error px, mean",
        "95 %",
        "size off by",
        "view off by deg",
        "whole in frame",
    )
    return Table(
        "Experiment 1: one subject, four setpoints",
        columns,
        tuple(rows),
        (
            f"one shot, refined: each setpoint is held for {HELD_S:g} s, and {CHANGE_S:g} s lead from one to "
            "the next; errors on the way are from what is asked then. The paper's subject stands up from "
            "sitting, too",
        ),
    )


def _view_errors(plan: VerifiedIR) -> Array:
    """Return how far the bearing of the camera is off the one that is asked, degrees, by frame."""
    world, track = plan.trajectory.keyframes.mission, plan.trajectory.drones[0]
    (phase,) = (p for p in track.phases if p.shot == "s")
    t = np.arange(phase.start, phase.end, STEP)
    eyes = track.curve(t)[:, :3] - np.array(world.target("face").centre)
    (subject,) = world.shot("s").subjects
    asked = [subject.asked(float(u) - phase.start).view for u in t]
    bearing = np.arctan2(eyes[:, 0], eyes[:, 1]) - [0.0 if view is None else view[0] or 0.0 for view in asked]
    return np.abs(np.degrees(np.arctan2(np.sin(bearing), np.cos(bearing))))


def walked(title: str, walks: Callable[[int], dict[str, Array]]) -> Table:
    """Return an experiment with one subject that stands, and two others that walk."""
    rows = []
    for seed in SEEDS:
        flown = walks(seed)
        plans = {name: planned(portrait(flown), refiner, flown) for name, refiner in PLANNERS.items()}
        hidden, value, near = ideal_look(plans["guide"][0], "s", "face")
        rows.append((f"{seed}: ideal", _share(hidden), *["-"] * 4, f"{value:.2f}", f"{near:.2f}", "-"))
        for name, (plan, took) in plans.items():
            rows.append((f"{seed}: {name}", *_cells(look(plan, "s", "face")), f"{took:.1f}"))
    return Table(
        title,
        ("seed: motion", *MEASURES),
        tuple(rows),
        (
            f"{LASTS:g} s; the ideal avoids nothing, the guide keeps clear, refined it looks past others too",
            "an ellipsoid of 0.6 x 0.6 x 1.1 m about every person, the subject included: below 1 is inside",
        ),
    )


def portrait(walks: dict[str, Array]) -> str:
    """Return the mission of Experiments 2 and 3; walks : of the others, by name."""
    others = [f"{name}: {{track: {{file: {name}.csv}}, {PERSON}}}" for name in walks]
    view = f"view: {{azimuth: {BEARING:g} deg, elevation: 8 deg}}"
    shot = (
        f"id: s, kind: framing, drone: cam, timing: {{start: {START:g}, duration: {LASTS:g}}}, "
        f"subjects: [{{target: face, size: {SIZE}, {view}}}]"
    )
    return mission([f"face: {{at: [0, 0, 0.9], {PERSON}}}", *others], [shot])


def _share(value: float) -> str:
    return f"{100 * value:.1f} %"


def _cells(found: Seen) -> tuple[str, ...]:
    return (
        _share(found.hidden.mean()),
        f"{found.error.mean():.1f}",
        f"{percentile(found.error, 0.95):.1f}",
        f"{found.size.min():.2f} to {found.size.max():.2f}",
        f"{found.off.max():.2f}",
        f"{found.value.min():.2f}",
        f"{found.near.min():.2f}",
    )


def crossing(seed: int) -> dict[str, Array]:
    """Return the walks of two who cross the line of sight, and stop in it for a while, again and again."""
    rng = np.random.default_rng(seed)
    walks = {}
    for name, south, side in (("one", -1.5, 1.0), ("two", -2.1, -1.0)):
        t, x = 0.0, 3.0 * side
        stops = [(t, x)]
        while t < TIMES[-1]:
            into, past = rng.uniform(-0.3, 0.3), -np.sign(x) * 3.0
            for to, wait in ((into, rng.uniform(1, 4)), (past, rng.uniform(2, 6))):
                t += abs(to - x) / PACE
                stops += [(t, to), (t + wait, to)]
                t, x = t + wait, to
        at = np.interp(TIMES, [s for s, _ in stops], [s for _, s in stops])
        walks[name] = np.column_stack([TIMES, at, np.full(len(TIMES), south)])
    return walks


def roaming(seed: int) -> dict[str, Array]:
    """Return the walks of two who walk about, half the time straight to where the camera would stand."""
    rng = np.random.default_rng(seed)
    walks = {}
    for name, side in (("one", 1.0), ("two", -1.0)):
        places, way = [np.array([3.0 * side, -2.0])], 0.0
        while way < PACE * (LASTS - 8.0):
            aside = np.array([side * rng.uniform(1.5, 3.5), rng.uniform(-3.0, 0.5)])
            places.append(np.array(CAMERA) if rng.random() < 0.5 else aside)
            way += float(np.linalg.norm(places[-1] - places[-2]))
        places.append(places[0])
        lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))])
        gone = PACE * np.maximum(TIMES - START, 0.0)
        line = [np.interp(gone, lengths, np.array(places)[:, k]) for k in (0, 1)]
        walks[name] = np.column_stack([TIMES, *line])
    return walks


def several() -> Table:
    """Return Experiment 4: three subjects on one line of the picture, in a small room."""
    walks = {
        name: np.column_stack([t, x + 0.4 * np.sin(0.3 * t + k), y + 0.3 * np.cos(0.25 * t + k)])
        for t in (TIMES,)
        for k, (name, x, y) in enumerate((("left", -1.2, 1.5), ("middle", 0.0, 1.9), ("right", 1.2, 1.4)))
    }
    places = {"left": -0.5, "middle": 0.0, "right": 0.5}
    subjects = ", ".join(f"{{target: {name}, frame: [{u:g}, 0]}}" for name, u in places.items())
    shot = (
        f"id: s, kind: framing, drone: cam, timing: {{start: {START:g}, duration: {LASTS:g}}}, "
        f"subjects: [{subjects}]"
    )
    people = [f"{name}: {{track: {{file: {name}.csv}}, {PERSON}}}" for name in walks]
    plan, took = planned(mission(people, [shot], room=9.5), "ours", walks)
    rows = []
    for name in places:
        found = look(plan, "s", name)
        rows.append(
            (
                name,
                f"{found.error.mean():.1f}",
                f"{percentile(found.error, 0.95):.1f}",
                f"{found.error.max():.1f}",
                f"{found.size.min():.2f} to {found.size.max():.2f}",
                _share(found.whole.mean()),
                _share(found.hidden.mean()),
            )
        )
    columns = ("subject", "screen error px, mean", "95 %", "worst", "size", "whole in frame", "frames hidden")
    return Table(
        "Experiment 4: three subjects on one line of the picture",
        columns,
        tuple(rows),
        (
            f"three persons who sway where they stand, {LASTS:g} s; a room of 9.5 m; planned in {took:.1f} s",
            "their places are (-0.5, 0), (0, 0) and (0.5, 0); the squares of what is off are least",
        ),
    )

"""Random missions like those of the framing paper: a few cylinders, sloppy keyframes around them.

A mission is a YAML text that `shotc check` accepts. Where targets change from keyframe to keyframe, the
language has no word for an author's own angles at a target that is not the shot's: such a keyframe looks at
its target in the text, and its angles are put in after the names are resolved.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, degrees, hypot, pi, radians, sin, sqrt, tan

import numpy as np

from shotc.api import PlanOptions, compile_source
from shotc.checking import check_source
from shotc.diag.registry import has_errors
from shotc.geom.camera import aim_at, heading_of
from shotc.geom.vec import Vec2, Vec3
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.mission import MissionIR
from shotc.ir.passes import PassContext
from shotc.ir.path import PathIR
from shotc.passes.place_keyframes import PlaceKeyframes
from shotc.passes.solve_path_qp import SolvePathQp
from shotc.pipeline import run

SEED = 7
HFOV, ASPECT = radians(70), 16 / 9
RADIUS, HEIGHT = (4.0, 15.0), (10.0, 60.0)
DISTANCE = (1.25, 2.6)  # times the distance at which the cylinder just fits
STEP = (25.0, 70.0)  # degrees of azimuth from keyframe to keyframe
THIRDS = tuple((u / 3, v / 3) for u in (-1, 1) for v in (-1, 1))
CENTRED = 0.4  # share of keyframes that are meant to show their target in the centre
NOISE = 0.2  # standard deviation per screen axis, half frames
LOWEST = 3.0  # metres above the ground


@dataclass(frozen=True)
class Draft:
    """One mission.

    text : YAML; aims : (yaw, pitch) of each keyframe's camera, rad; intended : screen place of each
    targets : how many; rejected : drafts before this one that no check accepted
    """

    name: str
    text: str
    aims: tuple[Vec2, ...]
    intended: tuple[Vec2, ...]
    targets: int
    rejected: int


@dataclass(frozen=True)
class _Cylinder:
    x: float
    y: float
    radius: float
    height: float

    @property
    def fits_at(self) -> float:
        """Distance from which a level camera at half its height shows all of it, metres."""
        tall = self.radius + self.height / 2 / (tan(HFOV / 2) / ASPECT)
        return max(tall, self.radius / sin(HFOV / 2))


def missions(count: int, seed: int = SEED) -> list[Draft]:
    """Return that many missions; each depends on the seed and its own number only."""
    return [_accepted(seed, number) for number in range(count)]


def keyframes_of(draft: Draft) -> KeyframeIR | None:
    """Return the mission with its keyframes placed, or None where they cannot be."""
    done = compile_source(draft.text.encode(), draft.name, None, PlanOptions(stop_after="resolve"))
    mission = done.reports[-1].output if done.reports else None
    if not isinstance(mission, MissionIR) or has_errors(done.diagnostics):
        return None
    shot, *others = mission.shots
    drone = mission.drone(shot.drone)
    if any(not drone.gimbal.pitch[0] <= aim[1] <= drone.gimbal.pitch[1] for aim in draft.aims):
        return None
    framed = tuple(k._replace(aim=aim) for k, aim in zip(shot.keyframes, draft.aims, strict=True))
    aimed = mission._replace(shots=(shot._replace(keyframes=framed), *others))
    placed = PlaceKeyframes().run(aimed, PassContext())
    return None if has_errors(placed.diagnostics) else placed.value


def convex_path(draft: Draft) -> PathIR | None:
    """Return the mission's convex path, from which every refiner starts; None where there is none."""
    keyframes = keyframes_of(draft)
    assert keyframes is not None
    done = run((SolvePathQp(),), keyframes, PassContext())
    return done.value if isinstance(done.value, PathIR) and not has_errors(done.diagnostics) else None


def _accepted(seed: int, number: int) -> Draft:
    attempt = 0
    while True:
        draft = _draft(np.random.default_rng([seed, number, attempt]), f"framing-{number:02d}", attempt)
        if draft is not None and _clean(draft):
            return draft
        attempt += 1


def _clean(draft: Draft) -> bool:
    checked = check_source(draft.text.encode(), draft.name, None)
    return not has_errors(checked.diagnostics) and keyframes_of(draft) is not None


def _draft(rng: np.random.Generator, name: str, rejected: int) -> Draft | None:
    targets = _cylinders(rng, int(rng.integers(1, 4)))
    count = int(rng.integers(4, 8))
    azimuth, turn = rng.uniform(0, 2 * pi), rng.choice([-1.0, 1.0])
    rows, aims, intended = [], [], []
    for i in range(count):
        which = i * len(targets) // count
        target = targets[which]
        at = _viewpoint(rng, target, azimuth)
        azimuth += turn * radians(rng.uniform(*STEP))
        place = (0.0, 0.0) if rng.uniform() < CENTRED else THIRDS[int(rng.integers(4))]
        asked = tuple(float(c) for c in np.add(place, rng.normal(0.0, NOISE, 2)))
        offset = (target.x - at[0], target.y - at[1], target.height / 2 - at[2])
        aim = aim_at(offset, (asked[0], asked[1]), HFOV, ASPECT)
        if aim is None:
            return None
        rows.append(_row(at, aim, None if len(targets) == 1 else which))
        aims.append(aim)
        intended.append(place)
    text = _text(name, targets, rows)
    return Draft(name, text, tuple(aims), tuple(intended), len(targets), rejected)


def _cylinders(rng: np.random.Generator, count: int) -> list[_Cylinder]:
    made: list[_Cylinder] = []
    while len(made) < count:
        radius, height = (float(rng.uniform(*bounds)) for bounds in (RADIUS, HEIGHT))
        x = y = 0.0
        if made:
            bearing = rng.uniform(0, 2 * pi)
            apart = made[-1].radius + radius + rng.uniform(10.0, 40.0)
            x, y = made[-1].x + apart * cos(bearing), made[-1].y + apart * sin(bearing)
        if all(hypot(x - other.x, y - other.y) > radius + other.radius + 5.0 for other in made):
            made.append(_Cylinder(*(round(float(c), 2) for c in (x, y, radius, height))))
    return made


def _viewpoint(rng: np.random.Generator, target: _Cylinder, azimuth: float) -> Vec3:
    distance = target.fits_at * rng.uniform(*DISTANCE)
    z = max(LOWEST, target.height * rng.uniform(0.3, 1.3))
    level = sqrt(distance**2 - (z - target.height / 2) ** 2)
    x, y = target.x + level * cos(azimuth), target.y + level * sin(azimuth)
    return (round(x, 3), round(y, 3), round(float(z), 3))


def _row(at: Vec3, aim: Vec2, which: int | None) -> str:
    position = ", ".join(f"{c:.3f}" for c in at)
    if which is not None:
        return f"      - {{at: [{position}], look_at: t{which}}}"
    angles = f"heading: {degrees(heading_of(aim[0])):.6f} deg, pitch: {degrees(aim[1]):.6f} deg"
    return f"      - {{at: [{position}], {angles}}}"


def _text(name: str, targets: list[_Cylinder], rows: list[str]) -> str:
    first = rows[0].split("[")[1].split(",")
    named = [
        f"  t{i}: {{at: [{t.x}, {t.y}, {t.height / 2}], radius: {t.radius}, height: {t.height}}}"
        for i, t in enumerate(targets)
    ]
    return "\n".join(
        [
            "shotc: 1",
            f"mission: {name}",
            "targets:",
            *named,
            f"drones: {{cam: {{model: x500, home: [{first[0]}, {first[1].strip()}, 0], endurance: 60 min}}}}",
            "rules: {composition: thirds}",
            "shots:",
            "  - id: film",
            "    kind: keyframes",
            "    drone: cam",
            "    allow: [hidden-subject]  # how targets stand is drawn, and one may hide another",
            *(["    target: t0"] if len(targets) == 1 else []),
            "    keyframes:",
            *rows,
            "output: {rate: 10}",
            "",
        ]
    )

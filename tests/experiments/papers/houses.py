"""The framing missions with houses in the way: keyframes from which all is seen, and what lies between."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from statistics import fmean

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.surface.near import nearest
from shotc.geom.surface.tree import surface_of
from shotc.ir.allow import HIDDEN
from shotc.ir.coverage import coverage
from shotc.ir.hidden import HALF_SHARE
from shotc.ir.keyframes import KeyframeIR
from shotc.ir.obstacle_mesh import obstacle_mesh
from shotc.ir.passes import PassContext
from shotc.ir.path import PathIR
from shotc.ir.sampling import framed
from shotc.passes.solve_path_qp import SolvePathQp
from shotc.pipeline import run
from tests.experiments.papers.framing import Flown, fly
from tests.experiments.papers.missions import Draft, keyframes_of
from tests.experiments.papers.report import Section, Table
from tests.experiments.papers.shown import RATE
from tests.support.scenes import cone, house, turned

SEED = 19
HOUSES = 10
"""Houses of a mission, and as many trees."""
TRIES = 400
TOPS = (0.8, 1.3)
"""Times the height of the line of sight over it that a house or a tree is high."""
CLEARANCE_M = 2.0
AWAY_M = 4.0
"""Metres from everything that the keyframes and the home keep at least."""
SQUARE_M = 6.0
"""Metres about a target in which nothing stands."""
NOT_LED = "none, not led"


@dataclass(frozen=True, eq=False)
class Pictures:
    """One mission under one condition: shares of the outline that are covered, (M,), frame by frame."""

    flown: Flown
    covered: Array


def section(drafts: Sequence[Draft], conditions: Sequence[str], say: Callable[[str], None]) -> Section:
    """Run the comparison and return its table."""
    asked = [NOT_LED, *(name for name in conditions if name != "ours-4pt")]
    found: dict[str, list[Pictures | None]] = {name: [] for name in asked}
    for number, draft in enumerate(drafts, 1):
        say(f"houses: mission {number} of {len(drafts)}")
        placed = with_houses(draft, number)
        paths = {led: convex(placed, led=led) for led in (False, True)}
        for name in asked:
            path = paths[name != NOT_LED]
            found[name].append(None if path is None else pictures(name.partition(",")[0], path))
    return Section("Framing with houses in the way", (table(found),), (_described(len(drafts)),))


def with_houses(draft: Draft, number: int) -> KeyframeIR:
    """Return a mission with houses and trees about its targets, none of which hides one from a keyframe."""
    placed = keyframes_of(draft)
    assert placed is not None
    random, parts = np.random.default_rng([SEED, number]), []
    for k in range(TRIES):
        part = _some_part(random, placed, tree=k % 2 == 1)
        if _stands_free(placed, part):
            parts.append(part)
        if len(parts) == 2 * HOUSES:
            break
    triangles, mission = np.concatenate(parts), placed.mission
    mesh = obstacle_mesh("scene", "houses.ply", triangles, (np.zeros(len(triangles), int), ("houses",)))
    rules = mission.rules._replace(obstacle_clearance=CLEARANCE_M)
    return placed._replace(mission=mission._replace(meshes=(mesh,), rules=rules))


def convex(placed: KeyframeIR, *, led: bool) -> PathIR | None:
    """Return a convex path; led : whether it may be led to where its targets are seen."""
    shot = placed.shots[0].shot._replace(allow=() if led else (HIDDEN,))
    shots = (placed.shots[0]._replace(shot=shot), *placed.shots[1:])
    mission = placed.mission._replace(shots=(shot, *placed.mission.shots[1:]))
    done = run((SolvePathQp(),), placed._replace(mission=mission, shots=shots), PassContext())
    return done.value if isinstance(done.value, PathIR) else None


def pictures(condition: str, path: PathIR) -> Pictures | None:
    """Return what a condition's film shows; None where it is refused."""
    flown = fly(condition, path)
    if isinstance(flown, tuple):
        return None
    mission, flight = flown.plan.trajectory.keyframes.mission, flown.flight
    (phase,) = (p for p in flight.phases if p.shot == mission.shots[0].id)
    t = np.linspace(phase.start, phase.end, int(np.ceil((phase.end - phase.start) * RATE)) + 1)
    covered = np.zeros(len(t))
    for name in dict.fromkeys(span.target for span in flight.framing):
        inside = framed(flight, mission.shots[0].id, name, t)
        found = coverage(mission, (), name, flight.curve(t[inside])[:, :3], t[inside]).share
        covered[inside] = np.maximum(covered[inside], found)
    return Pictures(flown, covered)


def table(found: dict[str, list[Pictures | None]]) -> Table:
    """Return what the conditions show."""
    rows = []
    for name, of in found.items():
        seen = [p for p in of if p is not None]
        cells: tuple[str, ...] = ("-",) * 6
        if seen:
            covered = np.concatenate([p.covered for p in seen])
            margins = np.concatenate([p.flown.shown.margin for p in seen])
            cells = (
                _share(float((covered <= 1.0 - HALF_SHARE).mean())),
                _share(float((covered == 0.0).mean())),
                _share(1.0 - float(covered.mean())),
                f"{fmean(float(p.flown.shown.error.mean()) for p in seen):.4f}",
                _share(float((margins >= 0.0).mean())),
                f"{fmean(p.flown.shown.duration for p in seen):.1f}",
            )
        rows.append((name, *cells, f"{len(of) - len(seen)} of {len(of)}"))
    return Table(
        "What each condition shows, with houses in the way",
        (
            "condition",
            "half of the target is free",
            "all of it is free",
            "free in the mean",
            "screen error, mean",
            "whole target in frame",
            "duration, s",
            "refused",
        ),
        tuple(rows),
        (
            "free: by rays to the outline, as verification counts; shares of all frames, and of the outline",
            f"`{NOT_LED}`: the shot allows its target to be hidden, so that no way is led aside for it",
        ),
    )


def _some_part(random: np.random.Generator, placed: KeyframeIR, *, tree: bool) -> Array:
    """Return a house or a tree between a keyframe's camera and its target, or beside that line."""
    keyframes = placed.shots[0].keyframes
    i = int(random.integers(len(keyframes) - 1))
    share = random.uniform()
    eye = (1.0 - share) * np.array(keyframes[i].at) + share * np.array(keyframes[i + 1].at)
    to = np.array(placed.mission.target(str(keyframes[i].target)).centre)
    at = eye + random.uniform(0.1, 0.7) * (to - eye)
    top = max(6.0, random.uniform(*TOPS) * float(at[2]))
    if tree:
        return turned(cone(random.uniform(0.15, 0.3) * top, 0.2 * top, top), 0.0, at[:2])
    eaves = random.uniform(0.7, 0.9) * top
    made = house(random.uniform(6, 14), random.uniform(6, 12), eaves, top)
    return turned(made, random.uniform(0.0, np.pi), at[:2])


def _stands_free(placed: KeyframeIR, part: Array) -> bool:
    """Tell whether a part is clear of targets, keyframes and homes, and hides no target from a keyframe."""
    mission, surface = placed.mission, surface_of(part)
    plan = part.reshape(-1, 3)[:, :2]
    for target in mission.targets:
        away = np.linalg.norm(plan - np.array(target.centre[:2]), axis=1).min()
        if away < target.radius + SQUARE_M:
            return False
    places = [k.at for k in placed.shots[0].keyframes] + [d.home for d in mission.drones]
    if float(nearest(surface, np.array(places)).distance.min()) < AWAY_M:
        return False
    mesh = obstacle_mesh("scene", "part.ply", part, (np.zeros(len(part), int), ("part",)))
    beside = mission._replace(meshes=(mesh,), targets=mission.targets)
    for k in placed.shots[0].keyframes:
        seen = coverage(beside, (), str(k.target), np.array([k.at]), np.zeros(1))
        if any(share.any() for name, share in seen.by if name.startswith("scene")):
            return False
    return True


def _described(count: int) -> str:
    return (
        f"the first {count} framing missions, seed {SEED}, each with up to {HOUSES} houses "
        f"and as many trees between camera and target, {SQUARE_M:.0f} m from it at least, none of which "
        "hides it from a keyframe"
    )


def _share(value: float) -> str:
    return f"{100 * value:.2f} %"

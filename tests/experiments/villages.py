"""Flights and films in random villages: how many are planned and proved, and what their pictures show.

``python -m tests.experiments.villages`` draws scenes of gable houses, trees and walls with an arch.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np

from shotc.api import PlanOptions, compile_source
from shotc.geom.bernstein import Array, Piecewise
from shotc.geom.pieces import pieces
from shotc.geom.surface.distance import inf_distance
from shotc.ir.coverage import coverage
from shotc.ir.hidden import HALF_SHARE
from shotc.ir.sampling import clock, framed, projected
from shotc.ir.trajectory import VerifiedIR
from shotc.planning.path.lines import Polyline, straight_line
from shotc.planning.path.transit import smooth
from tests.support.mesh_spaces import CLEARANCE, space_of
from tests.support.path_scenes import mission
from tests.support.scenes import some_scene
from tests.support.village_films import SCENE_FILE, ply, some_film

FLIGHTS, FILMS = 200, 40
PROOF_GAP_M = 1e-6
ROUNDING_M = 1e-5
REFINER = "ours"


class Flight(NamedTuple):
    """A flight through a village; seconds : CPU time of its route, its curve and its proof."""

    seed: int
    fault: str
    seconds: tuple[float, float, float]


class Pictures(NamedTuple):
    """The frames of one film.

    whole : whether all of the target is in the frame, (M,); covered : share of its outline, (M,)
    codes : of what is told; seconds : CPU time
    """

    seed: int
    whole: Array
    covered: Array
    codes: tuple[str, ...]
    seconds: float


def flight(seed: int) -> Flight:
    """Find a way through a village, smooth it, and prove it."""
    scene, times = some_scene(np.random.default_rng(seed)), [time.process_time()]
    space = space_of(scene.triangles)
    line = straight_line(space, scene.start, scene.end)
    times.append(time.process_time())
    curve = smooth(space, mission().drones[0], line) if isinstance(line, Polyline) else line
    times.append(time.process_time())
    fault = "" if isinstance(curve, Piecewise) else type(curve).__name__
    if isinstance(curve, Piecewise):
        bound = inf_distance(pieces(curve), space.meshes[0].mesh.surface, lambda _: PROOF_GAP_M)
        fault = "" if bound.proven >= CLEARANCE - ROUNDING_M else f"{bound.proven:.3f} m"
    times.append(time.process_time())
    route, smoothing, proof = np.diff(times)
    return Flight(seed, fault, (float(route), float(smoothing), float(proof)))


def film(seed: int, folder: Path) -> Pictures | tuple[str, ...]:
    """Plan a film and look at its frames; codes of what is wrong where there is no plan."""
    made, began = some_film(np.random.default_rng([seed, 1])), time.process_time()
    (folder / SCENE_FILE).write_bytes(ply(made.triangles))
    options = PlanOptions(refiner=REFINER)
    done = compile_source(made.text.encode(), f"square-{seed}.yaml", folder, options)
    codes = tuple(d.code for d in done.diagnostics)
    if done.plan is None:
        return codes
    whole, covered = pictures(done.plan)
    return Pictures(seed, whole, covered, codes, time.process_time() - began)


def pictures(plan: VerifiedIR) -> tuple[Array, Array]:
    """Return whether a plan's frames show its target whole, and the share of it that is covered."""
    of, (track,) = plan.trajectory.keyframes.mission, plan.trajectory.drones
    (shot,), (target,) = of.shots, of.targets
    t = clock(of.rate, track.curve.end)
    t = t[framed(track, shot.id, target.name, t)]
    found = coverage(of, (), target.name, track.curve(t)[:, :3], t)
    return projected(of, track, target.name, t).in_frame, found.share


def say(text: str) -> None:
    """Print a line at once."""
    print(text, flush=True)  # noqa: T201


def flights(count: int) -> None:
    """Print how many flights are planned and proved, and how long that takes."""
    done = [flight(seed) for seed in range(count)]
    good = [f for f in done if not f.fault]
    say(f"flights: {len(good)} of {len(done)} are planned and proved")
    for f in done:
        if f.fault:
            say(f"  seed {f.seed}: {f.fault}")
    for name, seconds in zip(("route", "curve", "proof"), np.array([f.seconds for f in done]).T, strict=True):
        median, most = np.percentile(seconds, [50, 95])
        say(f"  {name}: {median:.3f} s of CPU time in the median, 95 % within {most:.3f} s")


def films(count: int) -> None:
    """Print what share of the frames of planned films show all of their target."""
    done: list[Pictures] = []
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(count):
            found = film(seed, Path(folder))
            if not isinstance(found, Pictures):
                say(f"  seed {seed}: no plan, {', '.join(found)}")
                continue
            done.append(found)
            worst, notes = found.covered.max(), ", ".join(found.codes)
            if not found.whole.all() or worst > 0.0:
                say(f"  seed {seed}: {found.whole.mean():.2%} whole, covered up to {worst:.2f}; {notes}")
    whole, covered = (np.concatenate([getattr(f, name) for f in done]) for name in ("whole", "covered"))
    say(f"films: {len(done)} of {count} are planned, {len(whole)} frames, refiner {REFINER}")
    say(f"  the whole target is in the frame in {whole.mean():.3%} of them")
    half, free = (covered <= 1.0 - HALF_SHARE).mean(), (covered == 0.0).mean()
    say(f"  half of it is free in {half:.3%} of them, all of it in {free:.3%}")
    say(f"  {np.median([f.seconds for f in done]):.2f} s of CPU time a film in the median")


def main() -> None:
    """Fly, film and print."""
    parser = argparse.ArgumentParser(prog="python -m tests.experiments.villages", description=__doc__)
    parser.add_argument("--flights", type=int, default=FLIGHTS, help="how many flights")
    parser.add_argument("--films", type=int, default=FILMS, help="how many films")
    asked = parser.parse_args()
    if asked.flights:
        flights(asked.flights)
    if asked.films:
        films(asked.films)


if __name__ == "__main__":
    main()

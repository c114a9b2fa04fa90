"""What places cost: a flight of 3 km over terrain that matplotlib ships, and shots beside a large scene."""

from __future__ import annotations

import time
from pathlib import Path

from shotc import plugins
from shotc.api import PlanOptions, compile_source
from shotc.emit.plan_json import EMITTER as PLAN_JSON

ALONG_M = ((-1400, -600), (-900, -900), (-300, -650), (300, -900), (900, -600), (1400, -800))
"""East and North of the places that the flight leads through: 3.1 km."""

MISSION = """\
shotc: 1
mission: ridge
world: {origin: {lat: 36.6, lon: -84.24, alt: 441}TERRAIN}
targets:
  mast: {at: [0, 0], radius: 3, height: 60}
drones:
  cam: {model: x500, home: [-1400, -700], endurance: 60 min}
rules: {max_height: 300 m}
shots:
  - {id: along, kind: follow-path, drone: cam, look_at: mast, points: [POINTS]}
"""

BESIDE = """\
shotc: 1
mission: village
world: {origin: {lat: 46.68, lon: 7.68, alt: 500}SCENE}
targets:
  statue: {at: [60, 0], radius: 1, height: 4}
drones:
  cam: {model: x500, home: [0, -40]}
rules: {max_height: 100 m}
shots:
  - {id: round, kind: orbit, drone: cam, target: statue, radius: 20, sweep: 200 deg,
     altitude: {above: target, height: 14}}
  - {id: rise, kind: crane, drone: cam, target: statue, azimuth: 200 deg, distance: 12,
     altitude: {above: target, height: [6, 26]}}
"""
TRIANGLES, SEED = 102_400, 4
FREE_M = 22.0
"""About the statue, and half as much about the home, in which no house stands."""

RUNS = 3


def missions(folder: Path) -> dict[str, Path]:
    """Write the flight into a folder, over both; by what rows of tables are called."""
    import numpy as np
    from matplotlib import cbook

    # A process that is measured begins with the memory of the one that starts it: hence no import above.
    model = cbook.get_sample_data("jacksboro_fault_dem.npz")
    rows, columns = model["elevation"].shape
    south, west = min(model["ymin"], model["ymax"]), model["xmin"]
    head = f"ncols {columns}\nnrows {rows}\nxllcorner {west}\nyllcorner {south}\ncellsize {model['dx']}"
    np.savetxt(folder / "jacksboro.asc", model["elevation"], fmt="%d", header=head, comments="")
    points = ", ".join(f"[{x}, {y}, {{above: ground, height: 60}}]" for x, y in ALONG_M)
    found = {"flat ground": "", "terrain of 275 000 triangles": ", terrain: {file: jacksboro.asc}"}
    paths = {f"shotc plan, 3 km over {name}": folder / f"{i}.yaml" for i, name in enumerate(found)}
    for path, terrain in zip(paths.values(), found.values(), strict=True):
        path.write_text(MISSION.replace("POINTS", points).replace("TERRAIN", terrain))
    return paths


def scenes(folder: Path) -> dict[str, Path]:
    """Write shots into a folder, without and with houses of many triangles about them."""
    import numpy as np

    from tests.support.meshes import ply
    from tests.support.scenes import fine, house, turned

    random, parts = np.random.default_rng(SEED), []
    while sum(map(len, parts)) < TRIANGLES:
        x, y = random.uniform(-150.0, 150.0, 2)
        if np.hypot(x - 60.0, y) > FREE_M and np.hypot(x, y + 40.0) > FREE_M / 2:
            made = house(random.uniform(8, 14), random.uniform(6, 10), 6.0, 9.0)
            parts.append(fine(turned(made, random.uniform(0.0, 3.0), (x, y)), 3))
    (folder / "houses.ply").write_bytes(ply(np.concatenate(parts)))
    found = {"alone": "", f"beside {TRIANGLES} triangles": ", scene: {file: houses.ply, units: m}"}
    paths = {f"shotc plan, two shots {name}": folder / f"scene-{i}.yaml" for i, name in enumerate(found)}
    for path, scene in zip(paths.values(), found.values(), strict=True):
        path.write_text(BESIDE.replace("SCENE", scene))
    return paths


def in_one_process(folder: Path) -> None:
    """Print what each pass and emitter takes over both, turn by turn."""
    paths = missions(folder)
    for path in paths.values():
        _seconds(path)  # imports are paid once
    found = [[_seconds(path) for path in paths.values()] for _ in range(RUNS)]
    print(f"\n| 3 km, CPU seconds, least of {RUNS} | flat ground | terrain | ratio |\n|---|---|---|---|")
    for name in [*found[0][0], "all"]:
        flat, terrain = (min(_of(turn[side], name) for turn in found) for side in (0, 1))
        print(f"| {name} | {flat:.3f} s | {terrain:.3f} s | x{terrain / flat:.2f} |")


def _of(seconds: dict[str, float], name: str) -> float:
    return sum(seconds.values()) if name == "all" else seconds[name]


def _seconds(path: Path) -> dict[str, float]:
    """Return the CPU seconds of planning and of every emitter that has something to write."""
    began = time.process_time()
    plan = compile_source(path.read_bytes(), path.name, path.parent, PlanOptions()).plan
    assert plan is not None
    found = {"plan": time.process_time() - began}
    for emitter in (PLAN_JSON, *plugins.discover("emitters").plugins.values()):
        began = time.process_time()
        artifacts = emitter.emit(plan).artifacts
        if artifacts:
            found[f"emit {emitter.name}"] = time.process_time() - began
    return found

"""`make bench`: whole-process times as ratios to bare imports, growth over keyframes and stages, memory.

Whole processes are medians of runs that take turns (A B A B ...), so that a machine whose speed drifts
slows both sides alike; CPU time stands beside wall time, for it suffers less from what else runs. The
ratios of a table stand over its own first row. Memory is that of all processes of a command together.
Nothing is asserted: the tables are for people.
"""

from __future__ import annotations

import os
import platform
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from math import cos, pi, sin
from pathlib import Path

from shotc import __version__, plugins
from shotc.api import PlanOptions, compile_source
from shotc.emit.plan_json import EMITTER as PLAN_JSON
from tests.experiments.bench import flights, places, shows
from tests.experiments.bench.fleets import fleets, mission
from tests.experiments.bench.memory import check_status, peak_memory, start

ROOT = Path(__file__).resolve().parents[3]
DEMO = ROOT / "specs" / "westerhever-lighthouse.yaml"
SHOTC = [sys.executable, "-m", "shotc"]
KEYFRAMES = (5, 20, 80)
STAGES = (50, 100, 200, 400)
REPEATS = 3
LEAST = """
import typer, yaml
from pydantic import BaseModel
class Model(BaseModel):
    value: int
app = typer.Typer()
@app.command()
def check(text: str) -> None:
    Model.model_validate(yaml.safe_load(text))
app(["value: 1"])
"""
"""A command line of typer with one argument, one field of pydantic, and PyYAML."""
# Without compiled modules on the disk every run would compile them anew.
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}


@dataclass(frozen=True)
class Timing:
    """Wall seconds and CPU seconds of one process and of what it waited for."""

    wall: float
    cpu: float


def run(command: Sequence[str]) -> Timing:
    """Run a command to its end with its output thrown away."""
    began = time.perf_counter()
    _, status, usage = os.wait4(start(command, ENVIRONMENT), 0)
    wall = time.perf_counter() - began
    check_status(command, status)
    return Timing(wall, usage.ru_utime + usage.ru_stime)


def in_turn(commands: Sequence[Sequence[str]], runs: int) -> list[Timing]:
    """Return the medians of commands that take turns, after one run of each to warm up."""
    for command in commands:
        run(command)
    rounds = [[run(command) for command in commands] for _ in range(runs)]

    def median(side: int, key: str) -> float:
        return statistics.median(getattr(times[side], key) for times in rounds)

    return [Timing(*(median(i, key) for key in ("wall", "cpu"))) for i in range(len(commands))]


def processes(runs: int, imports: str, commands: Mapping[str, Sequence[str]]) -> None:
    """Print whole-process times of commands against a process that only imports some libraries."""
    bare = [sys.executable, "-c", f"import {imports}"]
    base, *ours = in_turn([bare, *commands.values()], runs)
    print(f"\n| process, median of {runs} | wall | ratio | CPU | ratio | peak memory |")
    print("|---|---|---|---|---|---|")
    every = {f"python -c 'import {imports}'": bare, **commands}
    for (name, command), t in zip(every.items(), (base, *ours), strict=True):
        print(
            f"| `{name}` | {t.wall:.2f} s | x{t.wall / base.wall:.2f} "
            f"| {t.cpu:.2f} s | x{t.cpu / base.cpu:.2f} | {peak_memory(command, ENVIRONMENT):.0f} MiB |"
        )


def growing_mission(keyframes: int) -> bytes:
    """Return a mission whose one shot winds round a tower through that many keyframes."""
    rows = []
    for i in range(keyframes):
        turn = 2 * pi * i / 16
        radius = 45 + 5 * (i % 3)
        at = [round(radius * sin(turn), 3), round(radius * cos(turn), 3), round(12 + 0.3 * i, 3)]
        rows.append(f"      - {{at: {at}, look_at: tower}}")
    return "\n".join(
        [
            "shotc: 1",
            "mission: growth",
            "world: {origin: {lat: 47.3769, lon: 8.5417, alt: 408}}",
            "targets: {tower: {at: [0, 0, 12], radius: 4, height: 24}}",
            "drones: {cam: {model: x500, home: [0, -70, 0], endurance: 60 min}}",
            "rules: {composition: center}",
            "shots:",
            "  - id: wind",
            "    kind: keyframes",
            "    drone: cam",
            "    target: tower",
            "    keyframes:",
            *rows,
            "",
        ]
    ).encode()


def steps(keyframes: int) -> tuple[dict[str, float], dict[str, float]]:
    """Return the wall seconds of every pass and of every emitter for a mission of that size."""
    done = compile_source(growing_mission(keyframes), "growth.yaml", None, PlanOptions())
    if done.plan is None:
        raise SystemExit("\n".join(d.message for d in done.diagnostics))
    emitted = {}
    for emitter in (PLAN_JSON, *plugins.discover("emitters").plugins.values()):
        began = time.perf_counter()
        emitter.emit(done.plan)
        emitted[emitter.name] = time.perf_counter() - began
    return {report.name: report.seconds for report in done.reports}, emitted


def growth() -> None:
    """Print what each pass and emitter costs as the keyframes multiply."""
    steps(KEYFRAMES[0])  # imports are paid once
    found = {n: [steps(n) for _ in range(REPEATS)] for n in KEYFRAMES}
    more = KEYFRAMES[-1] / KEYFRAMES[0]
    sizes = " | ".join(f"{n} keyframes" for n in KEYFRAMES)
    for part, title in enumerate(("pass", "emitter")):
        print(f"\n| {title}, median of {REPEATS} | {sizes} | for x{more:.0f} keyframes |")
        print("|---|" + "---|" * (len(KEYFRAMES) + 1))
        names = list(found[KEYFRAMES[0]][0][part])
        rows = {
            name: [statistics.median(times[part][name] for times in found[n]) for n in KEYFRAMES]
            for name in names
        }
        rows["all"] = [sum(row[i] for row in rows.values()) for i in range(len(KEYFRAMES))]
        for name, row in rows.items():
            times = f"x{row[-1] / row[0]:.1f}" if row[0] > 0.001 else ""
            print(f"| {name} | {' | '.join(f'{s:.3f} s' for s in row)} | {times} |")


def stages() -> None:
    """Print what refining one shot costs as its stages multiply, by fatrop and by IPOPT."""
    # Late, for a process that is started counts the memory of the one that starts it.
    from shotc_casadi.program import solve
    from shotc_casadi.refiner import OURS, subjects
    from shotc_casadi.rounds import SOLVERS, refine_shot

    path = compile_source(DEMO.read_bytes(), "demo.yaml", None, PlanOptions(stop_after="solve-path-qp"))
    subject = subjects(path.reports[-1].output)[0]
    print(
        f"\n| stages of shot {subject.leg.shot}, median of {REPEATS} | " + " | ".join(map(str, STAGES)) + " |"
    )
    print("|---|" + "---|" * len(STAGES))
    rows: dict[str, list[str]] = {"building, once a process": [], "refining, solver warm": []}
    rows |= {f"{solver}, the same problem": [] for solver in SOLVERS}
    for count in STAGES:
        began = time.perf_counter()
        first = refine_shot(subject, OURS.condition, count)
        cold = time.perf_counter() - began
        warm = [_seconds(partial(refine_shot, subject, OURS.condition, count)) for _ in range(REPEATS)]
        rows["building, once a process"].append(f"{cold - statistics.median(warm):.3f} s")
        rows["refining, solver warm"].append(f"{statistics.median(warm):.3f} s")
        for solver in SOLVERS:
            found = [solve(first.problem, solver) for _ in range(REPEATS + 1)][1:]
            seconds = statistics.median(each.seconds for each in found)
            each = 1000 * seconds / found[0].iterations
            rows[f"{solver}, the same problem"].append(
                f"{seconds:.3f} s: {found[0].iterations} iterations of {each:.2f} ms"
            )
    for name, cells in rows.items():
        print(f"| {name} | {' | '.join(cells)} |")


def _seconds(work: Callable[[], object]) -> float:
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def main() -> None:
    """Print the tables."""
    print(f"shotc {__version__}, Python {platform.python_version()}, {platform.system()}")
    print(f"{platform.machine()}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
    # `import pydantic` loads little; what it loads once a model is used is the larger part of a check.
    least, check = [sys.executable, "-c", LEAST], [*SHOTC, "check", str(DEMO)]
    processes(31, "typer, pydantic", {"least command of both and PyYAML": least, "shotc check DEMO": check})
    with tempfile.TemporaryDirectory() as folder:
        plan = [*SHOTC, "plan", str(DEMO), "-o", folder]
        bare = [*plan, "--refiner", "none"]
        commands = {
            "shotc plan DEMO --refiner none": bare,
            "shotc plan DEMO --refiner none --jobs 1": [*bare, "--jobs", "1"],
        }
        processes(7, "cvxpy, toppra, rerun", commands)
        processes(7, "cvxpy, casadi, toppra, rerun", {"shotc plan DEMO": plan})
        three = Path(folder) / "three.yaml"
        three.write_bytes(mission(3))
        fleet = [*SHOTC, "plan", str(three), "-o", folder]
        processes(3, "cvxpy, casadi, toppra, rerun", {"shotc plan, 3 drones, 60 s each": fleet})
        rows = {
            name: [*SHOTC, "plan", str(path), "-o", folder]
            for name, path in shows.large(Path(folder)).items()
        }
        processes(1, "cvxpy, scipy.spatial, rerun", rows)
        against = ["--against", str(Path(folder) / "mission.yaml")]
        judged = {
            f"shotc verify, 200 drones of 10 minutes, {name}": [*SHOTC, "verify", str(path), *against]
            for name, path in flights.write(Path(folder)).items()
        }
        processes(3, "numpy, scipy.spatial", judged)
        for paths in (places.missions(Path(folder)), places.scenes(Path(folder))):
            both = {name: [*SHOTC, "plan", str(path), "-o", folder] for name, path in paths.items()}
            processes(3, "cvxpy, casadi, toppra, rerun", both)
        places.in_one_process(Path(folder))
    fleets()
    shows.growth()
    shows.splines()
    growth()
    stages()


if __name__ == "__main__":
    main()

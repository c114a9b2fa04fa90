"""`make bench`: whole-process times as ratios to bare imports, growth over keyframes, peak memory.

Every figure is a median of runs that take turns (A B A B ...), so that a machine whose speed drifts
slows both sides alike. Nothing is asserted: the table is for people.
"""

from __future__ import annotations

import os
import platform
import statistics
import sys
import tempfile
import time
from dataclasses import dataclass
from math import cos, pi, sin
from pathlib import Path

from shotc import __version__
from shotc.api import Compilation, PlanOptions, compile_source

ROOT = Path(__file__).resolve().parents[2]
DEMO = ROOT / "specs" / "westerhever-lighthouse.yaml"
SHOTC = [sys.executable, "-m", "shotc"]
KEYFRAMES = (5, 20, 80)


@dataclass(frozen=True)
class Timing:
    """Wall seconds, CPU seconds and peak memory (MiB) of one process."""

    wall: float
    cpu: float
    peak: float


def run(command: list[str]) -> Timing:
    """Run a command to its end with its output thrown away."""
    began = time.perf_counter()
    pid = os.posix_spawn(
        command[0],
        command,
        os.environ,
        file_actions=[(os.POSIX_SPAWN_OPEN, fd, os.devnull, os.O_WRONLY, 0) for fd in (1, 2)],
    )
    _, status, usage = os.wait4(pid, 0)
    if status:
        raise SystemExit(f"exit status {os.waitstatus_to_exitcode(status)}: {' '.join(command)}")
    wall = time.perf_counter() - began
    return Timing(wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)


def versus(ours: list[str], theirs: list[str], runs: int) -> tuple[Timing, Timing]:
    """Return the medians of two commands that take turns, after one run of each to warm up."""
    run(ours), run(theirs)
    pairs = [(run(ours), run(theirs)) for _ in range(runs)]

    def median(side: int) -> Timing:
        return Timing(
            *(statistics.median(getattr(p[side], k) for p in pairs) for k in ("wall", "cpu", "peak"))
        )

    return median(0), median(1)


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


def growth() -> None:
    """Print what each pass costs as the keyframes multiply."""
    done: dict[int, Compilation] = {}
    for count in (KEYFRAMES[0], *KEYFRAMES):  # the first run warms up
        done[count] = compile_source(growing_mission(count), "growth.yaml", None, PlanOptions())
        if done[count].plan is None:
            raise SystemExit("\n".join(d.message for d in done[count].diagnostics))
    print(f"\n| pass | {' | '.join(f'{n} keyframes' for n in KEYFRAMES)} | growth x16 |")
    print("|---|" + "---|" * (len(KEYFRAMES) + 1))
    names = [report.name for report in done[KEYFRAMES[0]].reports]
    for i, name in enumerate(names):
        seconds = [done[n].reports[i].seconds for n in KEYFRAMES]
        print(f"| {name} | {' | '.join(f'{s:.3f} s' for s in seconds)} | x{seconds[-1] / seconds[0]:.1f} |")
    totals = [sum(r.seconds for r in done[n].reports) for n in KEYFRAMES]
    print(f"| all | {' | '.join(f'{s:.3f} s' for s in totals)} | x{totals[-1] / totals[0]:.1f} |")


def main() -> None:
    """Print the tables."""
    print(f"shotc {__version__}, Python {platform.python_version()}, {platform.system()}")
    print(f"{platform.machine()}, {os.cpu_count()} cores. Medians of runs that take turns.\n")
    print("| command | wall | cpu | peak memory | against | wall ratio |")
    print("|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        plan = [*SHOTC, "plan", str(DEMO), "-o", folder]
        for name, ours, imports, runs in (
            ("shotc check", [*SHOTC, "check", str(DEMO)], "typer, pydantic", 15),
            ("shotc plan", plan, "cvxpy, toppra, rerun", 5),
        ):
            mine, bare = versus(ours, [sys.executable, "-c", f"import {imports}"], runs)
            print(
                f"| `{name}` of the demo | {mine.wall:.2f} s | {mine.cpu:.2f} s | {mine.peak:.0f} MiB "
                f"| `import {imports}`: {bare.wall:.2f} s | x{mine.wall / bare.wall:.2f} |"
            )
    growth()


if __name__ == "__main__":
    main()

"""What a mission costs as more drones film one moving target: the whole process, and its passes."""

from __future__ import annotations

import statistics
from math import cos, pi, sin

from shotc.api import PlanOptions, compile_source

DRONES = (1, 2, 4, 8)
FILM = 60  # seconds
REPEATS = 3


def mission(drones: int) -> bytes:
    """Return a mission in which so many drones circle one runner for a minute, each on its own side."""
    lines = [
        "shotc: 1",
        "mission: fleet",
        "world: {origin: {lat: 47.3769, lon: 8.5417, alt: 408}}",
        "targets:",
        "  runner: {track: {points: [[0, 0, 0.9], [80, 0, 0.9], [80, 160, 0.9]], speed: 2 m/s},",
        "           radius: 0.4, height: 1.8}",
        "drones:",
    ]
    for i in range(drones):
        turn = 2 * pi * i / max(drones, 2)
        home = [round(40 + 30 * cos(turn), 2), round(30 * sin(turn) - 5, 2), 0]
        lines.append(f"  cam{i + 1}: {{model: x500, home: {home}, priority: {i + 1}}}")
    lines += ["rules: {allow: [jump-cut, fast-pan, crossing-the-line]}", "shots:"]
    for i in range(drones):
        lines.append(f"  - {{id: s{i + 1}, kind: orbit, drone: cam{i + 1}, target: runner, radius: 18,")
        lines.append(f"     altitude: 9, sweep: 40 deg, start_azimuth: {360 * i / drones:.1f} deg,")
        lines.append(f"     timing: {{start: 30, duration: {FILM}}}}}")
    return "\n".join([*lines, ""]).encode()


def passes(drones: int, refiner: str) -> dict[str, float]:
    """Return the wall seconds of every pass for so many drones."""
    done = compile_source(mission(drones), "fleet.yaml", None, PlanOptions(refiner=refiner))
    if done.plan is None:
        raise SystemExit("\n".join(d.message for d in done.diagnostics))
    return {report.name: report.seconds for report in done.reports}


def fleets() -> None:
    """Print what each pass costs as the drones multiply."""
    for refiner in ("none", "ours"):
        passes(DRONES[0], refiner)  # imports are paid once
        found = {n: [passes(n, refiner) for _ in range(REPEATS)] for n in DRONES}
        sizes = " | ".join(f"{n} drone{'s' * (n > 1)}" for n in DRONES)
        title = f"{FILM} s of film each, refiner {refiner}, median of {REPEATS}"
        print(f"\n| {title} | {sizes} | for x{DRONES[-1]} drones |")
        print("|---|" + "---|" * (len(DRONES) + 1))
        names = [name for name in found[1][0] if found[DRONES[-1]][0][name] > 0.005]
        rows = {name: [statistics.median(t[name] for t in found[n]) for n in DRONES] for name in names}
        rows["all"] = [statistics.median(sum(t.values()) for t in found[n]) for n in DRONES]
        for name, row in rows.items():
            print(
                f"| {name} | {' | '.join(f'{s:.2f} s' for s in row)} | x{row[-1] / max(row[0], 1e-3):.1f} |"
            )

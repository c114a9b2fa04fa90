"""The scene of the framing paper's Figure 6: a tower between two sloppy keyframes, under every condition."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from shotc.comparison import Options, compare_source, ordered
from shotc.emit.palette import INK
from shotc.emit.storyboard.canvas import Canvas, PageRectangle, Type, house_style
from shotc.emit.storyboard.content import passing
from shotc.emit.storyboard.frame import Cell, draw_frame
from shotc.emit.storyboard.side_by_side import draw_comparison
from shotc.ir.comparison import Comparison, Condition
from tests.experiments.papers import plots
from tests.experiments.papers.report import Section, Table

MISSION = Path(__file__).resolve().parents[3] / "specs" / "tower-fly-past.yaml"
FRAMES = 6
WIDTH, GAP, LEFT, ROW = 2.6, 0.12, 1.1, 2.15
DPI = 100.0
GRID = 20.0


def section(conditions: Sequence[str], say: Callable[[str], None]) -> Section:
    """Plan the scene under every condition, with `ours` also by the framing cost alone, and draw it."""
    say("figure 6: the tower scene")
    report = compare_source(
        MISSION.read_bytes(),
        MISSION.name,
        MISSION.parent,
        Options(ordered({*conditions, *(("framing-only",) if "ours" in conditions else ())})),
    )
    if report.comparison is None:
        raise RuntimeError("the tower scene gives no plan")
    found = report.comparison
    columns = ("condition", "screen error, mean", "95th percentile", "whole target in frame", "duration, s")
    table = Table(
        "The tower scene",
        columns,
        tuple(_row(each) for each in found.conditions),
        (f"the mission is specs/{MISSION.name}; `shotc compare` makes the same comparison",),
    )
    pictures = (
        Table("Film by condition, evenly in time", (), (), (), _strips(found)),
        Table("The worst frame of each", (), (), (), draw_comparison(found, DPI)),
        Table("From above", (), (), ("the tower is the circle",), _map(found)),
    )
    return Section("Figure 6: a tower between two sloppy keyframes", (table, *pictures))


def _row(each: Condition) -> tuple[str, ...]:
    score = each.score
    if score is None or score.error_mean is None or score.error_p95 is None or score.in_frame is None:
        return (each.refiner, "no plan", "-", "-", "-")
    return (
        each.refiner,
        f"{score.error_mean:.4f}",
        f"{score.error_p95:.4f}",
        f"{100 * score.in_frame:.2f} %",
        f"{score.duration:.1f}",
    )


def _strips(found: Comparison) -> bytes:
    """Draw frames evenly in time, a row a condition."""
    flown = [each for each in found.conditions if each.plan is not None]
    with house_style():
        canvas = Canvas(LEFT + FRAMES * (WIDTH + GAP), len(flown) * ROW, DPI)
        for i, each in enumerate(flown):
            assert each.plan is not None
            trajectory = each.plan.trajectory
            (shot,) = each.shots
            pair = (trajectory.keyframes.shots[0], trajectory.drones[0])
            bottom = (len(flown) - 1 - i) * ROW + 0.6
            canvas.text(0.05, bottom + 0.7, each.refiner, Type(12, INK, bold=True))
            for j, time in enumerate(np.linspace(shot.start, shot.end, FRAMES)):
                moment = passing(each.plan, pair, float(time), j + 1)
                box = PageRectangle(LEFT + j * (WIDTH + GAP), bottom, WIDTH, WIDTH * 9 / 16)
                draw_frame(canvas, Cell(box, WIDTH), moment, found.mission, GRID)
        return canvas.png()


def _map(found: Comparison) -> bytes:
    lines: dict[str, list[tuple[float, float]]] = {}
    for each in found.conditions:
        if each.plan is not None:
            (shot,) = each.shots
            q = each.plan.trajectory.drones[0].curve(np.linspace(shot.start, shot.end, 200))
            lines[each.refiner] = [(float(x), float(y)) for x, y in q[:, :2]]
    (target,) = found.mission.targets
    turn = np.linspace(0, 2 * np.pi, 60)
    x, y = target.centre[0] + target.radius * np.cos(turn), target.centre[1] + target.radius * np.sin(turn)
    lines[target.name] = list(zip(map(float, x), map(float, y), strict=True))
    return plots.lines(lines, "East, m", "North, m", equal=True)

"""Long and wide lenses, near subjects, wide turns; and the framing missions beside a second drone."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from math import cos, hypot, pi, radians, sin, sqrt, tan
from statistics import fmean

import numpy as np

from tests.experiments.papers.framing import Result, compare, quality
from tests.experiments.papers.missions import ASPECT, Draft, convex_path
from tests.experiments.papers.report import Section, Table

LENSES = (20, 35, 50, 70, 100)
"""Horizontal fields of view, degrees."""
MISSIONS = 12
"""Missions of each lens."""
SEED = 11
DISTANCE = (1.05, 1.6)
"""Times the distance at which the whole subject just fits."""
TURN = (40.0, 110.0)
"""Degrees of azimuth from keyframe to keyframe."""
RADIUS, SLENDER = (0.4, 12.0), (1.0, 5.0)
"""Radius of a subject, metres, drawn evenly in its logarithm; its height over its radius."""
LOWEST = 3.0
"""Metres above the ground."""
MAST = (900, 900)
"""Place of what the second drone films, metres East and North."""
TOUCH = 1e-9
"""Share of the distance that is rounding."""


def section(drafts: Sequence[Draft], conditions: Sequence[str], say: Callable[[str], None]) -> Section:
    """Run both comparisons and return their tables."""
    lenses = {lens: drawn(lens, MISSIONS) for lens in LENSES}
    found = {lens: compare(of, conditions, say) for lens, of in lenses.items()}
    company = compare([beside(draft) for draft in drafts], conditions, say)
    table = quality(company)
    return Section(
        "Lenses and company",
        (
            _by_lens(found, conditions),
            Table(f"{table.title}, beside a drone that films something else", table.columns, table.rows),
        ),
        (
            f"{MISSIONS} missions a lens, seed {SEED}: one upright cylinder of {RADIUS[0]} to {RADIUS[1]} m "
            f"radius, 3 to 5 keyframes at {DISTANCE[0]} to {DISTANCE[1]} times the distance at which it just "
            f"fits, {TURN[0]:.0f} to {TURN[1]:.0f} degrees from one to the next, composed by thirds",
            "the second table is of the framing missions, each with a second drone that films a mast "
            f"{hypot(*MAST[:2]):.0f} m from the middle of the scene",
        ),
    )


def _by_lens(found: dict[int, dict[str, list[Result]]], conditions: Sequence[str]) -> Table:
    rows = [
        (name, *(_cell(found[lens][name]) for lens in LENSES), _error(found[lens][name] for lens in LENSES))
        for name in conditions
    ]
    return Table(
        "Whole target in frame, by lens",
        ("condition", *(f"{lens} deg" for lens in LENSES), "screen error, mean"),
        tuple(rows),
        ("whole target: by the exact silhouette, share of all frames of all missions, no tolerance",),
    )


def _cell(results: Sequence[Result]) -> str:
    """Return the share of frames that show the whole target, and how many missions have none if any."""
    seen = [r.shown for r in results if r.shown is not None]
    if not seen:
        return "-"
    share = float((np.concatenate([s.margin for s in seen]) >= -TOUCH).mean())
    missing = len(results) - len(seen)
    return f"{100 * share:.2f} %" + (f" ({missing} not solved)" if missing else "")


def _error(results: Iterable[Sequence[Result]]) -> str:
    means = [float(r.shown.error.mean()) for of in results for r in of if r.shown is not None]
    return f"{fmean(means):.4f}" if means else "-"


def drawn(lens: int, count: int) -> list[Draft]:
    """Return missions of one lens that have a convex path; each depends on its own number only."""
    found = []
    for number in range(count):
        attempt = 0
        while True:
            draft = _draft(
                np.random.default_rng([SEED, lens, number, attempt]), f"lens-{lens}-{number}", lens
            )
            try:
                if convex_path(draft) is not None:
                    break
            except AssertionError:  # check refuses it
                pass
            attempt += 1
        found.append(draft)
    return found


def _draft(rng: np.random.Generator, name: str, lens: int) -> Draft:
    radius = round(float(np.exp(rng.uniform(*np.log(RADIUS)))), 2)
    height = round(radius * float(rng.uniform(*SLENDER)), 2)
    half = tan(radians(lens) / 2)
    fits = max(radius + height / 2 / (half / ASPECT), radius / sin(radians(lens) / 2))
    azimuth, turn = float(rng.uniform(0, 2 * pi)), float(rng.choice([-1.0, 1.0]))
    rows, aims = [], []
    for _ in range(int(rng.integers(3, 6))):
        distance = fits * float(rng.uniform(*DISTANCE))
        z = max(LOWEST, height * float(rng.uniform(0.4, 1.0)))
        level = sqrt(max(distance**2 - (z - height / 2) ** 2, (2 * radius) ** 2))
        x, y = round(level * cos(azimuth), 3), round(level * sin(azimuth), 3)
        rows.append(f"      - {{at: [{x}, {y}, {z:.3f}], look_at: subject, hfov: {lens} deg}}")
        aims.append((azimuth + pi, float(np.arctan2(height / 2 - z, hypot(x, y)))))
        azimuth += turn * radians(float(rng.uniform(*TURN)))
    first = rows[0].split("[")[1].split(",")
    text = "\n".join(
        [
            "shotc: 1",
            f"mission: {name}",
            "targets:",
            f"  subject: {{at: [0, 0, {height / 2}], radius: {radius}, height: {height}}}",
            "drones:",
            f"  cam: {{model: x500, home: [{first[0]}, {first[1].strip()}, 0], endurance: 60 min}}",
            "rules: {composition: thirds}",
            "shots:",
            "  - {id: film, kind: keyframes, drone: cam, target: subject, keyframes: [",
            ",\n".join(row.strip().removeprefix("- ") for row in rows),
            "    ]}",
            "output: {rate: 10}",
            "",
        ]
    )
    return Draft(name, text, tuple(aims), ((0.0, 0.0),) * len(aims), 1, 0)


def beside(draft: Draft) -> Draft:
    """Return a mission with a second drone that films something else, far away."""
    lines, (x, y) = draft.text.splitlines(), MAST
    drones = next(i for i, line in enumerate(lines) if line.startswith("drones: {"))
    lines[drones] = (
        lines[drones].removesuffix("}") + f", aside: {{model: x500, home: [{x - 20}, {y}, 0], priority: 2}}}}"
    )
    lines.insert(drones, f"  mast: {{at: [{x}, {y}, 5], radius: 1, height: 10}}")
    output = next(i for i, line in enumerate(lines) if line.startswith("output:"))
    lines.insert(
        output, f"  - {{id: other, kind: static, drone: aside, at: [{x - 20}, {y - 5}, 8], look_at: mast}}"
    )
    text = "\n".join([*lines, ""])
    return Draft(f"{draft.name} beside", text, draft.aims, draft.intended, draft.targets, draft.rejected)

"""A plan as text that a person can read in a diff, and the comparison of two of them.

What is written is good to a millimetre and a milliradian, so that the same text comes from another processor
and from another version of a solver.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.light_colors import light_colors
from shotc.ir.path import CHANNELS
from shotc.ir.phases import Phase
from shotc.ir.trajectory import DroneTrajectory, VerifiedIR

EVERY = 2.0
"""Seconds between the rows of a drone."""

FLEET_EVERY = 4.0
"""Seconds between the rows of a fleet, of which a few drones are written, and the mean of all."""

FLEET_DRONES = 8
MEAN_COLUMNS = ("t", "x", "y", "z", "red", "green", "blue")

SAME = 3e-3
"""Metres, radians or seconds by which two numbers may differ.

Plans of one commit differ by up to 2e-3 between two x86-64 processors (specs/statue-moves.yaml): libraries
choose other instructions there, and a flat optimum moves. The rest is rounding.
"""

SAME_SHARE = 1.5e-3
"""Shares of frames by which two numbers may differ: half of it is rounding."""

IN_FRAME = " in frame"

SLOWER = "R013"
"""Which solver it took, which may depend on the processor."""


def sampled(plan: VerifiedIR, diagnostics: Sequence[Diagnostic]) -> str:
    """Return a plan as text: what is said of it, what its shots show, and where its drones are."""
    codes = sorted(d.code for d in diagnostics if d.code != SLOWER)
    lines = [f"told {' '.join(codes)}".rstrip(), *_shown(plan)]
    for track in plan.trajectory.drones:
        lines += _drone(track)
    for flight in plan.trajectory.fleets:
        lines += _fleet(flight)
    return "\n".join([*lines, ""])


def _shown(plan: VerifiedIR) -> Iterator[str]:
    for claim in plan.certificate:
        if claim.shot is not None and claim.constraint.endswith(IN_FRAME):
            yield f"shot {claim.shot} {claim.constraint.removesuffix(IN_FRAME)} {claim.worst:.3f}"


def _drone(track: DroneTrajectory) -> Iterator[str]:
    yield from _phases(f"drone {track.drone}", track.phases)
    times = np.append(np.arange(0.0, track.curve.end, EVERY), track.curve.end)
    yield from _table(("t", *CHANNELS), np.column_stack([times, track.curve(times)]))


def _fleet(flight: FleetTrajectory) -> Iterator[str]:
    """Yield the rows of a fleet: lights are shares of full brightness, in the mean of all drones."""
    yield from _phases(f"fleet {flight.fleet}", flight.phases)
    for frame in flight.shown:
        yield f"{frame.start:9.3f} {frame.end:9.3f} {frame.display} {frame.picture} {frame.index}"
    end = float(flight.breaks[-1])
    times = np.append(np.arange(0.0, end, FLEET_EVERY), end)
    flown = places(flight.breaks, flight.coef, times)
    lights = light_colors(flight, times).mean(axis=0) / 255.0
    yield from _table(MEAN_COLUMNS, np.column_stack([times, flown.mean(axis=0), lights]))
    for k in np.linspace(0, len(flown) - 1, FLEET_DRONES).astype(int):
        yield f"drone {k}"
        yield from _table(MEAN_COLUMNS[:4], np.column_stack([times, flown[k]]))


def _phases(head: str, phases: Sequence[Phase]) -> Iterator[str]:
    yield ""
    yield head
    for phase in phases:
        yield f"{phase.start:9.3f} {phase.end:9.3f} {phase.name} {phase.shot or ''}".rstrip()


def _table(names: Sequence[str], rows: Array) -> Iterator[str]:
    yield " ".join(f"{name:>9}" for name in names)
    for row in rows:
        yield " ".join(f"{value + 0.0:9.3f}" for value in row)


def differences(recorded: str, now: str) -> list[str]:
    """Return the lines that differ by more than numbers may, as a diff shows them; empty where none does."""
    old, new = recorded.splitlines(), now.splitlines()
    found = [
        line
        for a, b in zip(old, new, strict=False)
        if not _alike(a.split(), b.split())
        for line in (f"- {a}", f"+ {b}")
    ]
    longer = [f"- {a}" for a in old[len(new) :]] + [f"+ {b}" for b in new[len(old) :]]
    return found + longer


def _alike(old: Sequence[str], new: Sequence[str]) -> bool:
    most = SAME_SHARE if old[:1] == ["shot"] else SAME
    return len(old) == len(new) and all(_same(a, b, most) for a, b in zip(old, new, strict=True))


def _same(a: str, b: str, most: float) -> bool:
    try:
        return abs(float(a) - float(b)) <= most
    except ValueError:
        return a == b

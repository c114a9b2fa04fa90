"""Whether a trajectory is one flight: finite, phases without gaps, smooth at joints, at rest at home."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import factorial, isfinite

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array, Piecewise, lift_off
from shotc.ir.path import CHANNELS
from shotc.ir.phases import Phase
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.passes.verify.claims import TOLERANCE, Flight, Limit, Worst, claim

AT_HOME = 1e-3
"""Metres from home within which a flight begins and ends."""

AT_REST = 1e-6
"""m/s and rad/s (m/s^2, rad/s^2) of any channel that still count as rest."""

LARGEST = 1e6
"""Metres or radians beyond which nothing is a flight; within it doubles resolve a nanometre."""

SHORTEST = 1e-5
"""Seconds of the shortest piece; below it third derivatives drown in rounding."""

ROUNDING = 16 * np.finfo(float).eps
ORDERS = ("value", "rate", "acceleration")


def structure(ir: TrajectoryIR) -> Iterator[Diagnostic]:
    """Report what keeps a trajectory from being read as a flight at all."""
    mission = ir.keyframes.mission
    known = {drone.name: drone for drone in mission.drones}
    shots = {shot.id for shot in mission.shots}
    for name in sorted({t.drone for t in ir.drones} - set(known)):
        yield Diagnostic(
            "V014",
            f"the flight of `{name}` belongs to no drone of the mission",
            help="plan the mission again",
        )
    for track in ir.drones:
        if track.drone in known:
            label = mission.origins.key(known[track.drone].path)
            for fault in _faults(track, shots):
                yield Diagnostic(
                    "V014",
                    f"the flight of `{track.drone}` is not whole: {fault}",
                    labels=(label,),
                    help="plan the mission again",
                )


def _faults(track: DroneTrajectory, shots: set[str]) -> Iterator[str]:
    curve, phases = track.curve, track.phases
    if curve.ctrl.shape[2] != len(CHANNELS):
        yield f"its curve has {curve.ctrl.shape[2]} channels, not {len(CHANNELS)}"
        return
    if np.abs(curve.ctrl).max() > LARGEST:
        yield f"its curve reaches {np.abs(curve.ctrl).max():.3g}, beyond any flight"
        return
    if np.diff(curve.breaks).min() < SHORTEST:
        yield f"a piece of its curve lasts only {np.diff(curve.breaks).min():.3g} s"
        return
    times = [t for p in phases for t in (p.start, p.end)] + [k.time for k in track.keyframes]
    times += [t for f in track.framing for t in (f.start, f.end)]
    if not all(map(isfinite, times)):
        yield "a time is not a finite number"
        return
    if abs(curve.start) > TOLERANCE:
        yield f"it begins at {curve.start:.6g} s, not at 0 s"
    yield from gaps(phases, curve.start, curve.end)
    unknown = {p.shot for p in phases if p.shot is not None} - shots
    unknown |= {f.shot for f in track.framing} - shots
    if unknown:
        yield f"it names shots that the mission does not have: {', '.join(sorted(unknown))}"
    if any((p.name == "shot") != (p.shot is not None) for p in phases):
        yield "a phase is a shot without a name, or has one without being a shot"


def gaps(phases: tuple[Phase, ...], start: float, end: float) -> Iterator[str]:
    """Yield where phases do not follow one another from a start to an end, seconds."""
    if not phases:
        yield "it has no phases"
        return
    joints = [(start, phases[0].start), (phases[-1].end, end)]
    joints += [(a.end, b.start) for a, b in pairwise(phases)]
    for before, after in joints:
        if abs(before - after) > TOLERANCE:
            yield f"its phases leave {min(before, after):.6g} s to {max(before, after):.6g} s open"
    for phase in phases:
        if phase.end < phase.start:
            yield f"its {phase.name} phase ends at {phase.end:.6g} s, before its start at {phase.start:.6g} s"


def shape(flight: Flight) -> Iterator[Claim]:
    """Claim continuity of value, rate and acceleration, home and rest at both ends, and endurance."""
    curve, drone = flight.track.curve, flight.drone
    for order, name in enumerate(ORDERS):
        worst = largest_jump(curve, order)
        yield claim(flight, Limit(f"jump of {name}", TOLERANCE, "of its scale", drone.path), worst)
    ends = np.array([curve.start, curve.end])
    away = np.linalg.norm(curve(ends)[:, :3] - np.array(drone.home), axis=1)
    k = int(np.argmax(away))
    home = Limit("distance from home", AT_HOME, "m", (*drone.path, "home"))
    yield claim(flight, home, Worst(float(away[k]), float(ends[k]), "exact"))
    still = np.max([np.abs(curve.derivative(n)(ends)).max(axis=1) for n in (1, 2)], axis=0)
    k = int(np.argmax(still))
    rest = Limit("rate at start and end", AT_REST, "m/s", drone.path)
    yield claim(flight, rest, Worst(float(still[k]), float(ends[k]), "exact"))
    endurance = Limit("endurance", drone.endurance, "s", (*drone.path, "endurance"))
    yield claim(flight, endurance, Worst(curve.end - lift_off(curve), curve.end, "exact"))


def largest_jump(curve: Piecewise, order: int) -> Worst:
    """Return the largest jump of a derivative at a break, relative to its scale.

    The scale of a channel is its largest control value, at least one unit. What rounding of the control
    points explains is taken off: the n-th difference of values of size c over h carries 2^n c eps / h^n.
    """
    derived = curve.derivative(order).ctrl
    if len(derived) == 1:
        return Worst(0.0, None, "exact")
    scale = np.maximum(1.0, np.abs(derived).max(axis=(0, 1)))
    jump = np.abs(derived[1:, 0] - derived[:-1, -1])
    excess = np.maximum(jump - _rounding(curve, order), 0.0) / scale
    k = int(np.argmax(excess.max(axis=1)))
    return Worst(float(excess[k].max()), float(curve.breaks[k + 1]), "exact")


def _rounding(curve: Piecewise, order: int) -> Array:
    width = np.diff(curve.breaks)
    shortest = np.minimum(width[1:], width[:-1])
    degree = curve.degree
    factor = factorial(degree) / factorial(max(degree - order, 0)) * 2**order
    size = np.abs(curve.ctrl).max(axis=(0, 1))
    return np.asarray(ROUNDING * factor * size / shortest[:, None] ** order)

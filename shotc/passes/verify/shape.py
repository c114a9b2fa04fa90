"""Check that a trajectory is one flight: finite, with phases without gaps, smooth joints, and rest at home.

Phases meet exactly. The differences of the polynomials at joints are summed over the whole flight and
compared with an absolute amount, so that many small steps count as much as a large one.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice, pairwise
from math import isfinite

import numpy as np

from shotc.diag.model import Diagnostic
from shotc.geom.bernstein import Array, Piecewise, lift_off
from shotc.ir.path import CHANNELS, Z
from shotc.ir.phases import Phase
from shotc.ir.tolerances import REST_TOLERANCE
from shotc.ir.trajectory import Claim, DroneTrajectory, TrajectoryIR
from shotc.passes.verify.claims import LIMIT_TOLERANCE, JudgedFlight, Limit, WorstValue, claim

AT_HOME_M = 1e-3
"""Distance from home within which a flight begins and ends, metres."""

LARGEST_M = 1e6
"""Largest value of a flight, metres or radians; up to it doubles resolve a nanometre."""

LONGEST_S = 1e5
"""Longest mission time, seconds, more than a day: flights are sampled at the output rate."""

SHORTEST_S = 1e-5
"""Shortest piece, seconds; below it rounding dominates third derivatives."""


AT_ENDS_S = 1.0
"""Seconds before and after a flight up to which other checks report its times."""

MOST_REPORTED = 5
"""Most faults of one flight's form that are reported separately."""


@dataclass(frozen=True, slots=True)
class Joints:
    """How much a derivative of a channel may step in total over all joints of a flight.

    most : metres or radians, per second to the power of ``order``
    unit : suffix of "m" or "rad"
    """

    order: int
    name: str
    most: float
    unit: str


JOINTS = (
    Joints(0, "value", 1e-6, ""),
    Joints(1, "rate", 1e-6, "/s"),
    Joints(2, "acceleration", 1e-4, "/s^2"),
)
"""Doubles resolve about 1e-9 /s and 1e-6 /s^2 over a thousand joints, a kilometre from the origin."""


def structure(ir: TrajectoryIR) -> Iterator[Diagnostic]:
    """Yield the faults that make a trajectory unreadable as a flight."""
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
            for fault in first_few(_faults(track, shots)):
                yield Diagnostic(
                    "V014",
                    f"the flight of `{track.drone}` is not whole: {fault}",
                    labels=(label,),
                    help="plan the mission again",
                )


def first_few(faults: Iterator[str]) -> Iterator[str]:
    """Yield the first faults of a flight, and a note if there are more; a damaged plan may have any
    number.
    """
    yield from islice(faults, MOST_REPORTED)
    if next(faults, None) is not None:
        yield f"more than {MOST_REPORTED} faults of its form: the others are not listed"


def _faults(track: DroneTrajectory, shots: set[str]) -> Iterator[str]:
    curve, phases = track.curve, track.phases
    unusable = _unusable(curve)
    if unusable:
        yield unusable
        return
    seen = [k.time for k in track.keyframes] + [t for f in track.framing for t in (f.start, f.end)]
    if not all(map(isfinite, [t for p in phases for t in (p.start, p.end)] + seen)):
        yield "a time is not a finite number"
        return
    # No sample is taken beyond a flight, however far a time is.
    outside = [t for t in seen if not curve.start - AT_ENDS_S <= t <= curve.end + AT_ENDS_S]
    if outside:
        yield f"a keyframe or a picture of it is at {outside[0]:.6g} s, outside of the flight"
        return
    if curve.start != 0.0:
        yield f"it begins at {curve.start:.6g} s, not at 0 s"
    yield from gaps(phases, curve.start, curve.end)
    unknown = {p.shot for p in phases if p.shot is not None} - shots
    unknown |= {f.shot for f in track.framing} - shots
    if unknown:
        yield f"it names shots that the mission does not have: {', '.join(sorted(unknown))}"
    if any((p.name == "shot") != (p.shot is not None) for p in phases):
        yield "a phase is a shot without a name, or has one without being a shot"
    references = (f.reference for f in track.framing if f.reference is not None)
    if any(joint_steps(reference, 0).sum(axis=0).max() > LIMIT_TOLERANCE for reference in references):
        yield "what is wanted of a target on screen jumps"


def _unusable(curve: Piecewise) -> str:
    """Return why a curve is that of no flight; empty where it may be."""
    if curve.ctrl.shape[2] != len(CHANNELS):
        return f"its curve has {curve.ctrl.shape[2]} channels, not {len(CHANNELS)}"
    if np.abs(curve.ctrl).max() > LARGEST_M:
        return f"its curve reaches {np.abs(curve.ctrl).max():.3g}, beyond any flight"
    if curve.end > LONGEST_S:
        return f"it lasts until {curve.end:.6g} s, longer than {LONGEST_S:g} s"
    shortest = np.diff(curve.breaks).min()
    return f"a piece of its curve lasts only {shortest:.3g} s" if shortest < SHORTEST_S else ""


def gaps(phases: tuple[Phase, ...], start: float, end: float) -> Iterator[str]:
    """Yield where phases do not follow one another from a start to an end, seconds.

    They have to meet exactly, because a time between two of them would be checked by none.
    """
    if not phases:
        yield "it has no phases"
        return
    joints = [(start, phases[0].start), (phases[-1].end, end)]
    joints += [(a.end, b.start) for a, b in pairwise(phases)]
    for before, after in joints:
        if before < after:
            yield f"its phases leave {before:.9g} s to {after:.9g} s open"
        elif before > after:
            yield f"two of its phases hold the time from {after:.9g} s to {before:.9g} s"
    for phase in phases:
        if phase.end <= phase.start:
            yield f"its {phase.name} phase ends at {phase.end:.6g} s, and begins at {phase.start:.6g} s"


def shape(flight: JudgedFlight) -> Iterator[Claim]:
    """Yield claims on continuity of value, rate and acceleration, home and rest at both ends, and
    endurance.
    """
    curve, drone = flight.track.curve, flight.drone
    yield from _joints(flight)
    ends = np.array([curve.start, curve.end])
    off_home = np.linalg.norm(curve(ends)[:, :3] - np.array(drone.home), axis=1)
    k = int(np.argmax(off_home))
    home = Limit("distance from home", AT_HOME_M, "m", (*drone.path, "home"))
    yield claim(flight, home, WorstValue(float(off_home[k]), float(ends[k]), "exact"))
    still = np.max([np.abs(curve.derivative(n)(ends)).max(axis=1) for n in (1, 2)], axis=0)
    k = int(np.argmax(still))
    rest = Limit("rate at start and end", REST_TOLERANCE, "m/s", drone.path)
    yield claim(flight, rest, WorstValue(float(still[k]), float(ends[k]), "exact"))
    endurance = Limit("endurance", drone.endurance, "s", (*drone.path, "endurance"))
    yield claim(flight, endurance, WorstValue(curve.end - lift_off(curve), curve.end, "exact"))


def _joints(flight: JudgedFlight) -> Iterator[Claim]:
    curve = flight.track.curve
    for joints in JOINTS:
        steps = joint_steps(curve, joints.order)
        total = steps.sum(axis=0)
        channel = int(np.argmax(total))
        when = float(curve.breaks[1 + np.argmax(steps[:, channel])]) if total[channel] else None
        unit = ("m" if channel <= Z else "rad") + joints.unit
        limit = Limit(f"jump of {joints.name}", joints.most, unit, flight.drone.path)
        yield claim(flight, limit, WorstValue(float(total[channel]), when, "exact"))


def joint_steps(curve: Piecewise, order: int) -> Array:
    """Return the steps of a derivative at every inner break of a curve, shape (P - 1, D)."""
    derived = curve.derivative(order).ctrl
    return np.asarray(np.abs(derived[1:, 0] - derived[:-1, -1]))

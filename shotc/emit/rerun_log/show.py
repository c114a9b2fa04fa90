"""Texts on the current part of a show, and plots of the whole fleet."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from shotc.emit.audience import picture_name, pictures_shown
from shotc.emit.rerun_log.series import Plot, PlotCurve
from shotc.emit.rerun_log.text import SHOWN, certificate_text
from shotc.geom.apart import stretch
from shotc.geom.bernstein import Array
from shotc.geom.fleet_spline import places
from shotc.ir.fleet import FleetTrajectory
from shotc.ir.show import Apart, Fleet
from shotc.ir.trajectory import VerifiedIR
from shotc.planning.on_pads import standing_at
from shotc.planning.take_off import take_off_of

PAIR = 2
WORDS = {**SHOWN, "transit": "Flying to the next display", "shot": "Showing"}


def show_texts(plan: VerifiedIR) -> list[tuple[float, str]]:
    """Return texts with their start times, seconds: what all fleets do, then the summary and the
    certificate.
    """
    body = f"{_summary(plan)}\n\n{certificate_text(plan.certificate)}\n"
    fleets = plan.trajectory.fleets
    doing = {flight.fleet: dict(_heads(plan, flight)) for flight in fleets}
    texts = []
    for time in sorted({time for heads in doing.values() for time in heads}):
        now = [
            (name, heads[max((t for t in heads if t <= time), default=min(heads))])
            for name, heads in doing.items()
        ]
        said = (f"## {head}" if len(fleets) == 1 else f"## `{name}`: {head}" for name, head in now)
        texts.append((time, "\n\n".join([*said, body])))
    return texts


def _heads(plan: VerifiedIR, flight: FleetTrajectory) -> list[tuple[float, str]]:
    """Return what a fleet does, with start times; of several entries for one time the last is valid.

    Each text is a title and a line.
    """
    phases = [
        (phase.start, f"{WORDS[phase.name]}\n{phase.start:.1f} s to {phase.end:.1f} s")
        for phase in flight.phases
    ]
    return phases + _pictures(plan, flight)


def _pictures(plan: VerifiedIR, flight: FleetTrajectory) -> list[tuple[float, str]]:
    """Return a heading for every picture, and one for the move to the next picture."""
    heads = []
    mission = plan.trajectory.keyframes.mission
    for shown in pictures_shown(flight):
        pictures, number = mission.display(shown.display).pictures, shown.picture + 1
        kind = picture_name(pictures[shown.picture])
        title = f"Picture {number} of {len(pictures)} of `{shown.display}`"
        heads.append((shown.start, f"{title}\n{kind}, {shown.start:.1f} s to {shown.end:.1f} s"))
        if number < len(pictures):
            heading = f"On the way to picture {number + 1} of `{shown.display}`"
            heads.append((shown.end, f"{heading}\nfrom {shown.end:.1f} s"))
    return heads


def _summary(plan: VerifiedIR) -> str:
    fleets = plan.trajectory.fleets
    total = max(float(flight.breaks[-1]) for flight in fleets)
    drones = ", ".join(f"{flight.fleet} ({len(flight.coef)} drones)" for flight in fleets)
    return f"- **{plan.trajectory.keyframes.mission.name}**: {total:.1f} s in the air\n- fleets: {drones}"


def fleet_plots(fleet: Fleet, flight: FleetTrajectory, t: Array) -> tuple[Plot, ...]:
    """Return plots of the nearest pair with the separation, and of the largest speeds with the limits.

    t : times, seconds, shape (T,)
    """
    at = np.moveaxis(places(flight.breaks, flight.coef, t), 1, 0)
    rate = places(flight.breaks, flight.coef, t, 1)
    speed = np.hypot(rate[..., 0], rate[..., 1]).max(axis=0)
    climb, descent = rate[..., 2].max(axis=0), rate[..., 2].min(axis=0)
    limits = fleet.limits
    moves = (
        Plot("speed", "Largest horizontal speed (m/s)", (PlotCurve("speed", speed),), (limits.speed,)),
        Plot(
            "climb",
            "Climb and descent, extremes (m/s)",
            (PlotCurve("climb", climb), PlotCurve("descent", descent)),
            (limits.climb, -limits.descent),
        ),
    )
    if len(flight.coef) == 1:
        return moves
    aloft = ~standing_at(fleet, flight, t)
    nearest = np.array([nearest_pair(points[aloft[:, k]], fleet.apart) for k, points in enumerate(at)])
    which = "two drones in the air" if take_off_of(fleet).layered else "two drones"
    title = f"Nearest {which} (m, heights stretched as separation asks)"
    return (Plot("separation", title, (PlotCurve("nearest", nearest),), (fleet.apart.across,)), *moves)


def nearest_pair(points: Array, apart: Apart) -> float:
    """Return the distance of the nearest two of points (n, 3), measured as in ``geom.separation``, metres.

    It is NaN for fewer than two points.
    """
    if len(points) < PAIR:
        return float("nan")
    tall = points * np.array([1.0, 1.0, stretch(apart)])
    tree = cKDTree(tall)
    ball = float(tree.query(tall, k=2)[0][:, 1].min())
    if apart.shape == "ellipsoid":
        return ball
    # The cylinder's measure is at least 1 / sqrt(2) of the Euclidean distance, so this radius contains its
    # nearest pair.
    pairs = tree.query_pairs(ball * np.sqrt(2.0) * (1.0 + 1e-9), output_type="ndarray")
    offsets = np.abs(tall[pairs[:, 0]] - tall[pairs[:, 1]])
    return float(np.maximum(np.hypot(offsets[:, 0], offsets[:, 1]), offsets[:, 2]).min())

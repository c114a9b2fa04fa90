"""The plotted curves of a flight over time: motion and its limits, and clearances."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.solid_arrays.points import signed_distance
from shotc.ir.bodies import moved
from shotc.ir.drone import Drone
from shotc.ir.mission import MissionIR
from shotc.ir.path import BODY_YAW, CAM_PITCH, X, Y, Z
from shotc.ir.phases import UPRIGHT
from shotc.ir.trajectory import DroneTrajectory

RATE_HZ, MOST_SAMPLES = 25.0, 6000
"""Samples a second, and the most samples of a flight: longer flights are sampled more coarsely."""


@dataclass(frozen=True, slots=True, eq=False)
class PlotCurve:
    """One curve of a plot: its name, and its values at the flight's sample times; NaN where it has none."""

    name: str
    values: Array


@dataclass(frozen=True, slots=True, eq=False)
class Plot:
    """Curves with a common axis, and their limits.

    title : the quantity and its unit
    """

    name: str
    title: str
    lines: tuple[PlotCurve, ...]
    limits: tuple[float, ...] = ()


def sample_times(flight: DroneTrajectory) -> Array:
    """Return the sample times of a flight, seconds, shape (n,); the last one is its end."""
    start, end = flight.curve.start, flight.curve.end
    count = int(min(MOST_SAMPLES, np.ceil((end - start) * RATE_HZ))) + 1
    return np.linspace(start, end, max(count, 2))


def motion_plots(flight: DroneTrajectory, drone: Drone, t: Array) -> tuple[Plot, ...]:
    """Return plots of speeds, acceleration, jerk, yaw rate and gimbal pitch with the drone's limits.

    t : mission times, (M,), seconds
    """
    place, limits = flight.curve.channels(X, Y, Z), drone.limits
    velocity = place.derivative()(t)
    acceleration = np.linalg.norm(place.derivative(2)(t), axis=-1)
    jerk = np.linalg.norm(place.derivative(3)(t), axis=-1)
    yaw_rate = np.degrees(flight.curve.channels(BODY_YAW).derivative()(t)[:, 0])
    pitch = np.degrees(flight.curve.channels(CAM_PITCH)(t)[:, 0])
    most_yaw, gimbal = degrees(limits.yaw_rate), tuple(degrees(end) for end in drone.gimbal.pitch)
    windy, (east, north) = any(limits.wind), limits.wind
    speed = PlotCurve(
        "airspeed" if windy else "speed", np.hypot(velocity[:, 0] - east, velocity[:, 1] - north)
    )
    climb = PlotCurve("climb", velocity[:, 2])
    return (
        Plot("speed", f"Horizontal {speed.name} (m/s)", (speed,), (limits.speed,)),
        Plot("climb", "Climb and descent (m/s)", (climb,), (limits.climb, -limits.descent)),
        Plot(
            "acceleration",
            "Acceleration (m/s²)",
            (PlotCurve("acceleration", acceleration),),
            (limits.acceleration,),
        ),
        Plot("jerk", "Jerk (m/s³)", (PlotCurve("jerk", jerk),), (limits.jerk,)),
        Plot("yaw_rate", "Yaw rate (°/s)", (PlotCurve("yaw rate", yaw_rate),), (most_yaw, -most_yaw)),
        Plot("gimbal_pitch", "Gimbal pitch (°)", (PlotCurve("pitch", pitch),), gimbal),
    )


def clearance_plot(flight: DroneTrajectory, drone: Drone, mission: MissionIR, t: Array) -> Plot:
    """Return the plot of the slack over clearances from zones, targets and the ground, metres.

    Distances are measured from the sphere around the body. A negative slack is a violation. The floors of
    keep-in zones and the clearances do not hold during take-off and landing, so the slack is NaN there.

    t : mission times, (M,), seconds
    """
    p = flight.curve.channels(X, Y, Z)(t)
    free = np.ones(len(t), dtype=np.bool_)
    for phase in flight.phases:
        if phase.name in UPRIGHT:
            free &= ~((t >= phase.start) & (t <= phase.end))
    bound = np.where(free, 0.0, np.nan)
    radius, rules = drone.radius, mission.rules
    zones = [
        signed_distance(zone.solid, p) - radius
        if zone.keep == "out"
        else -signed_distance(zone.solid, p) - radius + bound
        for zone in mission.zones
    ]
    subjects = [
        signed_distance(target.kept_clear, p - moved(target, t)) - radius - rules.target_clearance + bound
        for target in mission.targets
    ]
    ground = p[:, 2] - radius - rules.ground_clearance + bound
    groups = (("zones", zones), ("subjects", subjects), ("ground", [ground]))
    lines = tuple(PlotCurve(name, np.fmin.reduce(group)) for name, group in groups if group)
    return Plot("clearance", "Room left (m)", lines)

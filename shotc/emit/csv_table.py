"""trajectory.csv and framing.csv: the plan at the ticks of the output clock, nine significant digits."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from heapq import merge
from math import isnan
from typing import ClassVar

import numpy as np

from shotc.emit.base import Artifact, Emission
from shotc.emit.fleet_rows import fleet_rows
from shotc.emit.table_numbers import DEGREES, NUMBER
from shotc.geom.bernstein import Array, lift_off
from shotc.geom.earth import of_world
from shotc.ir.coverage import coverage
from shotc.ir.mission import MissionIR
from shotc.ir.occlusion import others_of
from shotc.ir.parked import bodies
from shotc.ir.path import BODY_YAW, CAM_PITCH, CAM_YAW, HFOV
from shotc.ir.sampling import clock, phase_index, references, seen, subjects
from shotc.ir.sharpness import sharpness
from shotc.ir.thrust import drawn, lean, thrust_to_weight
from shotc.ir.trajectory import DroneTrajectory, TrajectoryIR, VerifiedIR
from shotc.spec.presets import MANY_DRONES

TRAJECTORY = (
    "t_s,drone,phase,shot,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,ax_m_s2,ay_m_s2,az_m_s2,"
    "body_yaw_rad,cam_yaw_rad,cam_pitch_rad,cam_yaw_rate_rad_s,cam_pitch_rate_rad_s,hfov_rad"
)
GEODETIC = ",lat_deg,lon_deg,alt_m"
LIGHT = ",red,green,blue"
EFFORT = ",tilt_rad,thrust_to_weight,airspeed_m_s,power_w"
FRAMING = "t_s,drone,shot,target,u,v,u_ref,v_ref,size,in_frame,occluded,covered"
SHARPNESS = ",focus_m,near_m,far_m,motion_blur_px,background_blur_px"


@dataclass(frozen=True, slots=True)
class CsvTable:
    """Writes both tables, rows sorted by drone, then time, on the common clock t = k / rate."""

    name: ClassVar[str] = "csv"
    summary: ClassVar[str] = "trajectory.csv and framing.csv"
    api: ClassVar[int] = 1

    def emit(self, plan: VerifiedIR) -> Emission:
        """Return trajectory.csv and framing.csv."""
        mission = plan.trajectory.keyframes.mission
        tracks = sorted(plan.trajectory.drones, key=lambda track: track.drone)
        everyone = bodies(plan.trajectory)
        header = TRAJECTORY + (GEODETIC if mission.origin is not None else "")
        if mission.fleets:
            header += LIGHT
        if mission.drones:
            header += EFFORT
        framing = [
            row.encode()
            for track in tracks
            for row in _framing(plan, track, others_of(everyone, track.drone))
        ]
        title = FRAMING + (SHARPNESS if _exposes(mission) else "")
        rows = partial(_lines, header, plan.trajectory)
        large = sum(len(fleet.coef) for fleet in plan.trajectory.fleets) > MANY_DRONES
        whole = b"" if large else b"".join(rows())
        return Emission(
            (
                Artifact("trajectory.csv", whole, rows if large else None),
                Artifact("framing.csv", b"".join(line + b"\n" for line in (title.encode(), *framing))),
            )
        )


def _lines(header: str, ir: TrajectoryIR) -> Iterator[bytes]:
    """Yield the table drone by drone, sorted by name."""
    mission = ir.keyframes.mission
    filmed = sorted((track.drone, "\n".join(_motion(mission, track))) for track in ir.drones)
    fleets = [fleet_rows(mission, fleet) for fleet in ir.fleets]
    yield header.encode() + b"\n"
    for _, rows in merge(filmed, *fleets, key=lambda block: block[0]):
        yield rows.encode() + b"\n"


def _motion(mission: MissionIR, track: DroneTrajectory) -> Iterator[str]:
    t = clock(mission.rate, track.curve.end)
    curve = track.curve
    pose, rate, acceleration = (curve(t), curve.derivative()(t), curve.derivative(2)(t))
    rate[-1] = acceleration[-1] = 0.0  # at and after the end the drone stands on its pad
    columns = [
        pose[:, :3],
        rate[:, :3],
        acceleration[:, :3],
        pose[:, [BODY_YAW, CAM_YAW, CAM_PITCH]],
        rate[:, [CAM_YAW, CAM_PITCH]],
        pose[:, [HFOV]],
    ]
    if mission.origin is not None:
        columns.append(of_world(pose[:, :3], mission.origin))
    formats = [NUMBER] * sum(c.shape[1] for c in columns)
    if mission.origin is not None:
        formats[-3:-1] = [DEGREES, DEGREES]
    names = [f"{track.drone},{phase.name},{phase.shot or ''}" for phase in track.phases]
    numbers = np.concatenate(columns, axis=1) + 0.0  # no negative zeros
    line = f"{NUMBER},%s,{','.join(formats)}" + ",,," * bool(mission.fleets)
    effort = _effort(mission, track, t, (rate[:, :3], acceleration[:, :3]))
    for time, phase, row, last in zip(
        t.tolist(), phase_index(track.phases, t).tolist(), numbers.tolist(), effort, strict=True
    ):
        yield f"{line % (time, names[phase], *row)},{_cells(last)}"


def _effort(
    mission: MissionIR, track: DroneTrajectory, t: Array, motion: tuple[Array, Array]
) -> list[list[float]]:
    """Return tilt, thrust over weight, airspeed and power at times (M,); NaN where unknown.

    A drone on its pad, before lift-off and after touch-down, draws no power.

    motion : velocity and acceleration, shape (M, 3) each
    """
    drone, (velocity, acceleration) = mission.drone(track.drone), motion
    through = velocity[:, :2] - np.array(drone.limits.wind)
    flying = (t >= lift_off(track.curve)) & (t < track.curve.end)
    unknown = np.full(len(t), np.nan)
    power = unknown if drone.power is None else flying * drawn(drone.power, velocity, acceleration)
    airspeed = unknown if mission.wind_taken else np.hypot(through[:, 0], through[:, 1])
    columns = [lean(acceleration), thrust_to_weight(acceleration), airspeed, power]
    return [list(row) for row in (np.column_stack(columns) + 0.0).tolist()]


def _framing(plan: VerifiedIR, track: DroneTrajectory, others: Sequence[DroneTrajectory]) -> Iterator[str]:
    mission = plan.trajectory.keyframes.mission
    t = clock(mission.rate, track.curve.end)
    index = phase_index(track.phases, t)
    for k, phase in enumerate(track.phases):
        if phase.shot is not None:
            at = t[index == k]
            blocks = [
                _block(plan, track, (phase.shot, target), at, others)
                for target in subjects(mission, track, phase.shot)
            ]
            for rows in zip(*blocks, strict=True):
                yield from rows


def _block(
    plan: VerifiedIR,
    track: DroneTrajectory,
    of: tuple[str, str],
    t: Array,
    others: Sequence[DroneTrajectory],
) -> list[str]:
    (shot, target), mission = of, plan.trajectory.keyframes.mission
    frames = seen(mission, track, target, t, others)
    reference = references(track, shot, target, t)
    numbers = np.column_stack([frames.u, frames.v, reference, frames.size]) + 0.0
    flags = np.column_stack([frames.in_frame, frames.hidden]).astype(int)
    covered = _judged(plan, track.drone, shot, target, t)
    missing = np.isnan(covered)
    if missing.any():
        eyes = track.curve(t[missing])[:, :3]
        covered[missing] = coverage(mission, others, target, eyes, t[missing]).share
    name = f"{track.drone},{shot},{target}"
    sharp = _sharp(mission, track, of, t)
    return [
        f"{NUMBER % time},{name},{_cells(row)},{flag[0]},{flag[1]},{NUMBER % share}{last}"
        for time, row, flag, share, last in zip(
            t.tolist(), numbers.tolist(), flags.tolist(), covered.tolist(), sharp, strict=True
        )
    ]


def _exposes(mission: MissionIR) -> bool:
    """Return whether the mission describes the optics of a camera."""
    return any(drone.optics is not None for drone in mission.drones)


def _sharp(mission: MissionIR, track: DroneTrajectory, of: tuple[str, str], t: Array) -> list[str]:
    """Return the cells of depth of field and motion blur at times (M,), with a comma before each."""
    if not _exposes(mission):
        return [""] * len(t)
    if mission.drone(track.drone).optics is None:
        return [",,,,,"] * len(t)
    sharp = sharpness(mission, track, *of, t)
    columns = [sharp.focus, sharp.near, sharp.far, sharp.motion, sharp.background]
    return [f",{_cells(row)}" for row in np.column_stack(columns).tolist()]


def _judged(plan: VerifiedIR, drone: str, shot: str, target: str, t: Array) -> Array:
    """Return the covered shares that verification found at times (M,); NaN where it has no sample."""
    share = np.full(len(t), np.nan)
    for cover in plan.covered:
        if (cover.drone, cover.shot, cover.target) == (drone, shot, target):
            near = np.minimum(np.searchsorted(cover.times, t), len(cover.times) - 1)
            same = cover.times[near] == t
            share[same] = cover.share[near[same]]
    return share


def _cells(row: list[float]) -> str:
    return ",".join("" if isnan(value) else NUMBER % value for value in row)


EMITTER = CsvTable()

"""One drone of a plan, simulated in many runs at once: sense, estimate, aim, fly."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass

import numpy as np

from shotc.geom.bernstein import Array
from shotc.geom.vec import wrapped
from shotc.ir.rehearsal import VehicleName
from shotc.ir.trajectory import DroneTrajectory
from shotc.plugin_api.replanner import Replanner
from shotc.simulation.aim import Shown, aim_rates, aimed
from shotc.simulation.blind import BlindHold, held_intervals
from shotc.simulation.film import PlanSamples, film_of
from shotc.simulation.gimbal import Attitude, GimbalModel, angles_of, axes_of, turn_rate, turned
from shotc.simulation.guidance import PERIOD_S, Guidance
from shotc.simulation.replanner_process import replanner
from shotc.simulation.replans import Replans
from shotc.simulation.seen import TrackedTarget, watched
from shotc.simulation.sent import Sent
from shotc.simulation.situations import replanned
from shotc.simulation.vehicle import STEP_S, Lagging, Plant, Vehicle, VehicleState, steered
from shotc.simulation.way_back import ReturnLack
from shotc.simulation.world import World

HEADROOM_RATIO = 1.3
"""Factor over the plan's fastest speed, with which a controller may let a drone catch up."""

STEPS_PER_RECORD = 2
"""Steps of the drone for one step of the gimbal and for one record: 50 a second."""


@dataclass(frozen=True, slots=True, eq=False)
class Estimated:
    """A drone's estimate of a target: position (F, R, 3), metres, and its covariance (F, R, 3, 3)."""

    target: str
    place: Array
    covariance: Array


@dataclass(frozen=True, slots=True, eq=False)
class DroneRuns:
    """One drone in R runs at F instants.

    times : (F,), seconds
    position, velocity : (F, R, 3), W, metres, m/s
    yaw, pitch, roll : of the camera, (F, R), rad
    error : of the drone's own position, (F, R, 3), metres
    replans : of every run; () without replanning
    straight : what its straight ways back after outages lack, of every run; () without them
    """

    drone: str
    times: Array
    position: Array
    velocity: Array
    yaw: Array
    pitch: Array
    roll: Array
    error: Array
    estimated: tuple[Estimated, ...]
    replans: tuple[Replans, ...] = ()
    straight: tuple[ReturnLack, ...] = ()


def fly_all(world: World, tracks: Sequence[DroneTrajectory]) -> tuple[DroneRuns, ...]:
    """Return the flights of several drones in all runs of a world, in the order of the tracks.

    With replanning, drones fly one after another: those of higher priority first, whose plans the others
    know.
    """
    with replanner(world.conditions.replanner) if world.conditions.loop == "replan" else nullcontext() as by:
        return _one_after_another(world, tracks, by)


def _one_after_another(
    world: World, tracks: Sequence[DroneTrajectory], by: Replanner | None
) -> tuple[DroneRuns, ...]:
    ranks = {track.drone: (world.mission.drone(track.drone).priority, track.drone) for track in tracks}
    flown: dict[str, DroneRuns] = {}
    sent: tuple[Sent, ...] = ()
    for track in sorted(tracks, key=lambda track: ranks[track.drone]):
        film = film_of(world.mission, track)
        own = Sent(film, PERIOD_S)
        flown[track.drone] = fly(world, film, by, sent, own)
        sent = (*sent, own)
    return tuple(flown[track.drone] for track in tracks)


def fly(
    world: World,
    film: PlanSamples,
    by: Replanner | None = None,
    sent: tuple[Sent, ...] = (),
    own: Sent | None = None,
) -> DroneRuns:
    """Return the flight of one drone in all runs of a world.

    A run does not depend on the other runs of its block, up to rounding. In the same block it is reproduced
    exactly.

    by : the replanner; None without replanning
    sent : plans that drones of higher priority have sent
    own : takes the plans that this drone sends
    """
    conditions, runs = world.conditions, world.runs
    name, count, n = film.drone.name, len(film.times), len(runs)
    gusts = conditions.wind.blown(count, STEP_S, conditions.chances(runs, f"gusts {name}"))
    chances = conditions.chances(runs, f"gps of {name}")
    error = conditions.gps.own_error(film.times[::STEPS_PER_RECORD], chances, conditions.lost(name))
    held = held_intervals(film, conditions.lost(name))
    targets = _watched(world, film)
    guide: Guidance | BlindHold = BlindHold(world, film, held)
    if by is not None:
        shots = replanned(world.mission, film.track)
        guide = Guidance(world, film, shots, by, held, targets, sent, own)
    vehicle, gimbal = (
        Vehicle(speed=HEADROOM_RATIO * film.fastest),
        GimbalModel(film.drone.gimbal.rate),
    )
    state = VehicleState.at_rest(np.tile(film.position[0], (n, 1)))
    plant = plant_of(conditions.vehicle, vehicle, state)
    first = axes_of(np.full(n, film.yaw[0]), np.full(n, film.pitch[0]))
    attitude = Attitude(first, np.zeros((n, 3)))
    into = _Record.of(error, targets)
    for k in range(count):
        off = error[k // STEPS_PER_RECORD]
        if k % STEPS_PER_RECORD == 0:
            into.add(k // STEPS_PER_RECORD, state, attitude, targets)
            believed = state.position + off
            for target in targets:
                target.look(k, film, conditions, (state.position, believed), attitude)
                target.learn(float(film.times[k]))
            attitudes, rate = _demanded(world, film, k, (believed, state.velocity), targets)
            attitude = turned(gimbal, attitude, attitudes, rate, STEPS_PER_RECORD * STEP_S)
        setpoint = guide.setpoint(k, (state.position + off, state.velocity))
        state = plant.carried(state, *steered(vehicle, state, setpoint, off), world.steady + gusts[k])
    return into.done(film, guide)


def plant_of(name: VehicleName, vehicle: Vehicle, first: VehicleState) -> Plant:
    """Return the plant with a name.

    first : state of the drones at the start, hovering
    """
    if name == "lag":
        return Lagging(vehicle)
    from shotc.simulation.rotorpy_plant import RotorPyPlant

    return RotorPyPlant(vehicle, first)


def _watched(world: World, film: PlanSamples) -> tuple[TrackedTarget, ...]:
    """Return the moving targets that a drone's camera follows; none for the loop "replay"."""
    if world.conditions.loop == "replay":
        return ()
    moving = (f for f in film.framed if world.moves(f.target))
    return tuple(watched(world, film, framed) for framed in moving)


def _demanded(
    world: World, film: PlanSamples, k: int, drone: tuple[Array, Array], targets: tuple[TrackedTarget, ...]
) -> tuple[Array, Array]:
    """Return the demanded attitudes of cameras, (R, 3, 3), and their rates, (R, 3).

    For several targets, the mean of their angles is taken.

    drone : estimated positions of the drones and their velocities, (R, 3) each
    """
    yaw, pitch, rates = film.yaw[k], film.pitch[k], np.array([film.yaw_rate[k], film.pitch_rate[k]])
    angles = np.tile([yaw, pitch, *rates], (len(drone[0]), 1))
    framed = () if world.conditions.loop == "replay" else film.framed
    turned = [
        _shared(
            each.share[k : k + STEPS_PER_RECORD + 1],
            _beyond(
                _aim(film, k, each.reference, drone, _known(world, each.target, targets, film.times[k])),
                angles,
            ),
        )
        for each in framed
        if each.share[k] > 0.0
    ]
    if turned:
        angles = angles + np.mean(turned, axis=0)
        low, high = film.drone.gimbal.pitch
        angles[:, 1] = np.clip(angles[:, 1], low, high)
    axes = axes_of(angles[:, 0], angles[:, 1])
    return axes, turn_rate(axes, angles[:, 2], angles[:, 3])


def _beyond(aim: Array, planned: Array) -> Array:
    """Return angles and rates minus those of the plan, (R, 4), with the yaw wrapped."""
    offset = aim - planned
    offset[:, 0] = wrapped(offset[:, 0])
    return offset


def _shared(share: Array, beside: Array) -> Array:
    """Return the part of angles and rates beside the plan, (R, 4), that a camera follows.

    share : the part now and until the next step of the gimbal; its change turns the camera, too
    """
    change = (share[-1] - share[0]) / (STEPS_PER_RECORD * STEP_S)
    part = share[0] * beside
    part[:, 2:] += change * beside[:, :2]
    return np.asarray(part)


def _known(world: World, name: str, targets: tuple[TrackedTarget, ...], time: float) -> tuple[Array, Array]:
    """Return a target's estimated position and velocity; for a standing target the mission's."""
    for target in targets:
        if target.name == name:
            now = target.tracker.now(time)
            return now.position, now.velocity
    return np.array([world.mission.target(name).centre]), np.zeros((1, 3))


def _aim(
    film: PlanSamples, k: int, references: Array, drone: tuple[Array, Array], target: tuple[Array, Array]
) -> Array:
    """Return yaw, pitch and their rates, (R, 4), that keep a target at its reference on screen."""
    offset, velocity = target[0] - drone[0], target[1] - drone[1]
    # After its last frame a target has no place on screen.
    soon = min(k + STEPS_PER_RECORD, len(references) - 1)
    n, next_ = len(offset), soon if np.isfinite(references[soon, 0]) else k
    now, later = (Shown(np.tile(references[i], (n, 1)), np.tile(film.half[i], (n, 1))) for i in (k, next_))
    rates = aim_rates(offset, velocity, now, later, STEPS_PER_RECORD * STEP_S)
    return np.column_stack([*aimed(offset, *now), *rates])


@dataclass(slots=True)
class _Record:
    """The record of a flight under simulation."""

    position: Array
    velocity: Array
    angles: Array
    error: Array
    estimated: tuple[Estimated, ...]

    @staticmethod
    def of(error: Array, targets: tuple[TrackedTarget, ...]) -> _Record:
        f, n, _ = error.shape
        known = tuple(Estimated(t.name, np.empty((f, n, 3)), np.empty((f, n, 3, 3))) for t in targets)
        return _Record(np.empty((f, n, 3)), np.empty((f, n, 3)), np.empty((f, n, 3)), error, known)

    def add(
        self, i: int, state: VehicleState, attitude: Attitude, targets: tuple[TrackedTarget, ...]
    ) -> None:
        self.position[i], self.velocity[i] = state.position, state.velocity
        self.angles[i] = np.stack(angles_of(attitude.axes), axis=-1)
        for target, into in zip(targets, self.estimated, strict=True):
            now = target.tracker.now(i * STEPS_PER_RECORD * STEP_S)
            into.place[i], into.covariance[i] = now.position, now.covariance[:, :3, :3]

    def done(self, film: PlanSamples, guide: Guidance | BlindHold) -> DroneRuns:
        yaw, pitch, roll = np.moveaxis(self.angles, -1, 0)
        times = film.times[::STEPS_PER_RECORD]
        return DroneRuns(
            film.drone.name,
            times,
            self.position,
            self.velocity,
            yaw,
            pitch,
            roll,
            self.error,
            self.estimated,
            tuple(guide.counts) if isinstance(guide, Guidance) else (),
            tuple(guide.lacks) if isinstance(guide, BlindHold) else (),
        )

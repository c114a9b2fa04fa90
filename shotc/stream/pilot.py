"""Leads one drone through a flight: lift-off from its pad by the common clock, the plan, and landing on the
pad.

The methods are called at every tick and never wait. A command is repeated until the vehicle's heartbeat or
position shows its effect.
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import Enum
from math import dist
from typing import NamedTuple

from shotc.diag.model import Diagnostic
from shotc.stream import flight_faults
from shotc.stream.autopilots import Mode
from shotc.stream.clock import PERIOD_S, RATE_HZ
from shotc.stream.messages import ACCEPTED, IN_PROGRESS, REJECTED_FOR_NOW
from shotc.stream.setpoints import Aim, SetpointSeries
from shotc.stream.vehicle import VehicleStatus

AGAIN_TICKS = RATE_HZ // 2
"""Ticks after which a command without effect is sent again."""
FLOWING_TICKS = RATE_HZ * 3 // 2
"""Ticks of setpoints before PX4 is asked to follow them; it needs more than one second of them."""
SPOOL = RATE_HZ
"""Ticks from arming to lift-off, in which the motors spin up."""
SILENT_S = 2.0
"""Time without a heartbeat after which a vehicle counts as vanished; heartbeats come once a second."""
PAD_OFF_M = 2.0
"""How far from its pad a vehicle may be when it arms: 1 m, and 1 m of drift while it waits."""
STRAY_M = 10.0
"""A vehicle farther from its setpoint than this does not fly the plan."""
LIFTED_SHARE = 0.85
"""A vehicle that takes off by itself gets setpoints from this share of the take-off height on."""
LANDING_S = 60.0
SET_MODE, ARM_DISARM, TAKE_OFF, CLAIM = 176, 400, 22, 1001
VIDEO_START, VIDEO_STOP = 2500, 2501


class PilotStage(Enum):
    """The stages of a flight; the value gives their order."""

    PARKED = 0
    MODE = 1
    ARMING = 2
    LIFTING = 3
    FLYING = 4
    LANDING = 5
    LANDED = 6


FOLLOWING = (PilotStage.ARMING, PilotStage.LIFTING, PilotStage.FLYING)
"""Stages in which a vehicle that leaves its mode has been taken over by somebody else."""
AT_REST = (PilotStage.PARKED, PilotStage.LANDING, PilotStage.LANDED)
"""Stages in which nothing has to be stopped: a vehicle that lands on its pad continues."""
DOINGS = {
    PilotStage.MODE: "gets ready",
    PilotStage.ARMING: "arms",
    PilotStage.LIFTING: "takes off",
    PilotStage.FLYING: "follows the plan",
    PilotStage.LANDING: "lands",
    PilotStage.LANDED: "stands on its pad, motors off",
}


class RecordingTick(NamedTuple):
    """A tick at which the camera starts or stops recording a shot."""

    tick: int
    shot: str
    on: bool


def preparing_from(vehicle: VehicleStatus, course: SetpointSeries) -> int:
    """Return the tick from which a drone gets ready for its lift-off."""
    return course.lifts - round(vehicle.autopilot.lead * RATE_HZ)


class Pilot:
    """Sends one drone what its course and its stage require."""

    def __init__(
        self, vehicle: VehicleStatus, course: SetpointSeries, cuts: tuple[RecordingTick, ...]
    ) -> None:
        self.vehicle = vehicle
        self.course = course
        self.cuts = cuts
        self.stage = PilotStage.PARKED
        self.begins = preparing_from(vehicle, course)
        self.farthest = 0.0
        self.sent = 0
        self.taken = False
        self.events: list[str] = []
        self._asked = -(10**9)
        self._armed_since = 0
        self._recording: RecordingTick | None = None
        self._told = 0
        self._landing_since = 0

    @property
    def name(self) -> str:
        """The drone's name in the plan."""
        return self.vehicle.drone

    @property
    def done(self) -> bool:
        """Whether the drone stands on its pad again, motors off."""
        return self.stage is PilotStage.LANDED

    def airborne(self, tick: int) -> bool:
        """Tell whether the drone is off its pad, or may be, and follows the plan or takes off."""
        if self.stage is PilotStage.FLYING:
            return tick > self.course.lifts or self.vehicle.autopilot.lift > 0
        return self.stage is PilotStage.LIFTING

    def send(self, tick: int, aim: Aim) -> None:
        """Send the messages of a tick: the setpoint, if the vehicle accepts setpoints, and the
        gimbal angles.
        """
        follows = PilotStage.MODE if self.vehicle.autopilot.lift == 0 else PilotStage.FLYING
        if self.stage.value >= follows.value and self.stage.value <= PilotStage.FLYING.value:
            boot_ms = max(0, round((tick - self.begins) * PERIOD_S * 1000))
            self.vehicle.link.setpoint(self.course.setpoint(tick), boot_ms)
            self.sent += 1
        if self.stage in (PilotStage.FLYING, PilotStage.LIFTING) and self.vehicle.gimbal is not None:
            link, attitudes = self.vehicle.link, self.vehicle.autopilot.attitudes
            (link.attitude if attitudes else link.aim)(aim, self.vehicle.gimbal, pans=self.course.pans)

    def step(self, tick: int, now: float) -> Iterator[Diagnostic]:
        """Advance to the next stage when this one is complete; yield what is wrong."""
        if self.stage is PilotStage.LANDED or tick < self.begins:
            return
        if self.stage is not PilotStage.PARKED and now - self.vehicle.seen > SILENT_S:
            yield flight_faults.vanished(self.vehicle, now - self.vehicle.seen)
            return
        if self.stage in FOLLOWING and self.vehicle.mode != self.vehicle.autopilot.flown.custom:
            self.taken = True
            yield flight_faults.mode_left(self.vehicle)
            return
        match self.stage:
            case PilotStage.PARKED:
                self._prepare(tick)
            case PilotStage.MODE:
                yield from self._enter_mode(tick)
            case PilotStage.ARMING:
                yield from self._arm(tick)
            case PilotStage.LIFTING:
                yield from self._lift(tick)
            case PilotStage.FLYING:
                yield from self._fly(tick)
            case PilotStage.LANDING:
                yield from self._land(tick)

    def hold(self, tick: int) -> Mode | None:
        """Order a drone in the air to hold and one on the ground to disarm; return the mode requested."""
        if self.stage in AT_REST:
            return None
        if self.airborne(tick):
            self.vehicle.link.set_mode(self.vehicle.autopilot.hold)
            return self.vehicle.autopilot.hold
        if self.vehicle.armed:
            self.vehicle.link.arm(armed=False)
        return None

    def stopped(self, tick: int) -> bool:
        """Tell whether the drone holds, lands on its pad, or stands with its motors off."""
        if self.stage in AT_REST or not self.vehicle.armed:
            return True
        return self.airborne(tick) and self.vehicle.mode == self.vehicle.autopilot.hold.custom

    def _prepare(self, tick: int) -> None:
        self._go(PilotStage.MODE, tick)
        if self.vehicle.autopilot.lift == 0:
            self._asked = tick + FLOWING_TICKS - AGAIN_TICKS

    def _enter_mode(self, tick: int) -> Iterator[Diagnostic]:
        pilot, gimbal = self.vehicle.autopilot, self.vehicle.gimbal
        claimed = gimbal is None or self.vehicle.answers.get(CLAIM) == ACCEPTED
        flows = pilot.lift > 0 or tick >= self.begins + FLOWING_TICKS
        if self.vehicle.mode == pilot.flown.custom and claimed and flows:
            self._go(PilotStage.ARMING, tick)
            return
        yield from self._late_or_refused(tick, SET_MODE, f"the mode {pilot.flown.name}")
        if not claimed:
            yield from self._late_or_refused(tick, CLAIM, "control of its gimbal")
        if self._again(tick):
            if self.vehicle.answers.get(SET_MODE) != ACCEPTED:
                self.vehicle.link.set_mode(pilot.flown)
            if gimbal is not None and not claimed:
                self.vehicle.link.claim(gimbal)

    def _arm(self, tick: int) -> Iterator[Diagnostic]:
        if self.vehicle.armed:
            self._armed_since = self._armed_since or tick
            if tick - self._armed_since >= SPOOL:
                self._go(PilotStage.LIFTING if self.vehicle.autopilot.lift > 0 else PilotStage.FLYING, tick)
            return
        distance = self._away(tick)
        if distance > PAD_OFF_M:
            yield flight_faults.strayed(self.vehicle, distance, PAD_OFF_M)
            return
        yield from self._late_or_refused(tick, ARM_DISARM, "to arm")
        if self._again(tick) and self.vehicle.answers.get(ARM_DISARM) != ACCEPTED:
            self.vehicle.link.arm(armed=True)

    def _lift(self, tick: int) -> Iterator[Diagnostic]:
        if self._height() >= LIFTED_SHARE * self.course.height:
            self._go(PilotStage.FLYING, tick)
            return
        yield from self._late_or_refused(tick, TAKE_OFF, "to take off")
        if self._again(tick) and self.vehicle.answers.get(TAKE_OFF) != ACCEPTED:
            self.vehicle.link.take_off(self.course.height)

    def _fly(self, tick: int) -> Iterator[Diagnostic]:
        distance = self._away(tick)
        self.farthest = max(self.farthest, distance)
        if distance > STRAY_M:
            yield flight_faults.strayed(self.vehicle, distance, STRAY_M)
            return
        yield from self._record(tick)
        if tick >= self.course.last:
            self._landing_since = tick
            self._go(PilotStage.LANDING, tick)

    def _land(self, tick: int) -> Iterator[Diagnostic]:
        if not self.vehicle.armed:
            self._go(PilotStage.LANDED, tick)
            return
        if (tick - self._landing_since) * PERIOD_S > LANDING_S:
            yield flight_faults.not_landed(self.vehicle, LANDING_S)
            self._go(PilotStage.LANDED, tick)
        elif self._again(tick) and self.vehicle.mode != self.vehicle.autopilot.land.custom:
            self.vehicle.link.set_mode(self.vehicle.autopilot.land)

    def _record(self, tick: int) -> Iterator[Diagnostic]:
        """Start and stop recording; if the camera does not answer, yield a warning and fly on."""
        cut = next((c for c in reversed(self.cuts) if c.tick <= tick), None)
        if cut is None:
            return
        command = VIDEO_START if cut.on else VIDEO_STOP
        if cut is not self._recording:
            self._recording, self._told = cut, 0
            self.events.append(f"records shot `{cut.shot}`" if cut.on else f"has recorded shot `{cut.shot}`")
            self.vehicle.answers.pop(command, None)
        if self.vehicle.answers.get(command) in (ACCEPTED, IN_PROGRESS) or self._told > 3:
            return
        if (tick - cut.tick) % AGAIN_TICKS == 0:
            self._told += 1
            if self._told > 3:
                yield flight_faults.not_recorded(self.vehicle, cut.shot, on=cut.on)
            else:
                self.vehicle.link.record(on=cut.on, component=self.vehicle.camera)

    def _late_or_refused(self, tick: int, command: int, what: str) -> Iterator[Diagnostic]:
        result = self.vehicle.answers.get(command)
        if result is not None and result not in (ACCEPTED, REJECTED_FOR_NOW, IN_PROGRESS):
            yield flight_faults.refused(self.vehicle, what, result)
        elif tick >= max(self.course.lifts, self.course.first):
            if result == REJECTED_FOR_NOW:
                yield flight_faults.refused(self.vehicle, what, result)
            else:
                yield flight_faults.late(self.vehicle, what)

    def _again(self, tick: int) -> bool:
        is_time = tick - self._asked >= AGAIN_TICKS
        if is_time:
            self._asked = tick
        return is_time

    def _go(self, stage: PilotStage, tick: int) -> None:
        self.stage, self._asked = stage, tick - AGAIN_TICKS
        self.vehicle.answers.clear()
        self.events.append(DOINGS[stage])

    def _height(self) -> float:
        """Return the vehicle's height above its pad, m."""
        assert self.vehicle.position is not None, "it was read before the flight"
        return float(self.course.position[0, 2] - self.vehicle.position[2])

    def _away(self, tick: int) -> float:
        """Return the distance from the vehicle's planned position, m; before the flight, from its pad."""
        assert self.vehicle.position is not None, "it was read before the flight"
        on_pad = self.stage is not PilotStage.FLYING
        planned = self.course.position[0].tolist() if on_pad else self.course.setpoint(tick).position
        return dist(self.vehicle.position, planned)

"""Flies all drones on one clock: a setpoint at every tick, and one way to stop when anything is wrong."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import ceil

from shotc.diag.model import Diagnostic
from shotc.diag.registry import has_errors
from shotc.stream import flight_faults
from shotc.stream.aim import LiveAim
from shotc.stream.beginning import clock_time
from shotc.stream.clock import PERIOD_S, RATE_HZ, FlightClock
from shotc.stream.feed import Feed
from shotc.stream.pilot import Pilot
from shotc.stream.reading import BEAT_S
from shotc.stream.report import SendTimes, send_times

STALL_S = 0.5
"""After a longer gap the next setpoint would be a jump: half of the time after which PX4 reports
a lost link.
"""
HOLD_S = 5.0
"""How long the hold mode is requested before an error is reported."""
HOLD_AGAIN_S = 0.5
WAIT_S = 0.1
"""How often vehicles are listened to before the first tick, s."""


@dataclass(frozen=True, slots=True)
class PilotedDrone:
    """One drone in flight: its pilot, and where its camera looks."""

    pilot: Pilot
    aim: LiveAim


@dataclass(slots=True)
class FlightResult:
    """The result of a flight.

    landed : whether every drone stands on its pad again
    interrupted : whether the user stopped the flight
    holding : the drones that were ordered to hold, each with its mode
    """

    times: SendTimes
    diagnostics: list[Diagnostic] = field(default_factory=list)
    landed: bool = False
    interrupted: bool = False
    holding: list[tuple[str, str]] = field(default_factory=list)


class StreamedFlight:
    """Sends a plan to vehicles that have passed their checks."""

    def __init__(
        self,
        crew: Sequence[PilotedDrone],
        feeds: Sequence[Feed],
        clock: FlightClock,
        say: Callable[[str], None],
        at: float | None = None,
    ) -> None:
        """Prepare the flight; say : receives what happens, line by line.

        at : the time of day of mission time 0, POSIX seconds; None begins at once
        """
        self._crew = crew
        self._feeds = feeds
        self._clock = clock
        self._say = say
        self._at = at
        self._delays: list[float] = []
        self._skipped = 0
        self._beat = float("-inf")
        self._stale: set[str] = set()
        self._tick = min(member.pilot.begins for member in crew)

    def fly(self) -> FlightResult:
        """Fly; return when all drones have landed, or have been ordered to hold because something
        is wrong.
        """
        diagnostics: list[Diagnostic] = []
        interrupted = False
        try:
            diagnostics = self._run()
        except KeyboardInterrupt:
            interrupted = True
            self._say("interrupted: every drone in the air is asked to hold")
        except BaseException:  # also after a bug in this program, order a hold
            self._hold()
            raise
        landed = all(member.pilot.done for member in self._crew)
        holding: list[tuple[str, str]] = []
        if not landed:
            holding, more = self._hold()
            diagnostics += more
        times = send_times(self._delays, self._skipped)
        return FlightResult(times, diagnostics, landed and not interrupted, interrupted, holding)

    def _run(self) -> list[Diagnostic]:
        diagnostics: list[Diagnostic] = []
        start = self._start()
        while not all(member.pilot.done for member in self._crew):
            tick_time = start + self._tick * PERIOD_S
            self._clock.wait_until(tick_time)
            behind = self._clock.now() - tick_time
            if behind > STALL_S:
                return [*diagnostics, flight_faults.stalled(behind, STALL_S)]
            if self._tick == 0:
                self._say("mission time 0")
            self._send()
            self._delays.append(self._clock.now() - tick_time)
            diagnostics += self._attend()
            if has_errors(diagnostics):
                return diagnostics
            onward = max(self._tick + 1, ceil((self._clock.now() - start) * RATE_HZ - 1e-6))
            self._skipped += onward - self._tick - 1
            self._tick = onward
        return diagnostics

    def _start(self) -> float:
        """Return the time of the clock that is mission time 0; until the first tick of a beginning at a time
        of day, keep up with the vehicles.

        Time of day may be set while this waits, so it is looked at until the first tick, and not later.
        """
        lead = -self._tick * PERIOD_S
        if self._at is None:
            if lead > 0.0:
                self._say(f"mission time 0 is in {lead:.1f} s")
            return self._clock.now() + lead
        left = self._at - self._clock.utc()
        self._say(f"mission time 0 is at {clock_time(self._at)}, in {left:.1f} s")
        while True:
            now, left = self._clock.now(), self._at - self._clock.utc()
            if left <= lead + WAIT_S:
                return now + left
            self._keep_up(now)
            self._clock.wait_until(now + WAIT_S)

    def _send(self) -> None:
        now = self._clock.now()
        for member in self._crew:
            member.pilot.send(self._tick, member.aim.at(self._tick, now))

    def _attend(self) -> list[Diagnostic]:
        """Read all messages and advance every pilot; return what is wrong."""
        now = self._clock.now()
        self._keep_up(now)
        diagnostics = [d for member in self._crew for d in member.pilot.step(self._tick, now)]
        for member in self._crew:
            self._tell(member.pilot)
        return [*diagnostics, *self._silent_targets(now)]

    def _keep_up(self, now: float) -> None:
        if now - self._beat >= BEAT_S:
            self._beat = now
            for member in self._crew:
                member.pilot.vehicle.link.heartbeat()
        for member in self._crew:
            member.pilot.vehicle.listen(now)
        for feed in self._feeds:
            feed.listen(now)

    def _tell(self, pilot: Pilot) -> None:
        for event in pilot.events:
            self._say(f"{self._tick * PERIOD_S:8.1f} s  {pilot.name}: {event}")
        pilot.events.clear()

    def _silent_targets(self, now: float) -> list[Diagnostic]:
        """Return a warning for every target that has just become silent."""
        diagnostics = []
        for feed in self._feeds:
            silent = feed.position(now) is None
            if silent and feed.target not in self._stale:
                diagnostics.append(flight_faults.stale(feed.target, now - (feed.seen or 0.0)))
                self._stale.add(feed.target)
            elif not silent:
                self._stale.discard(feed.target)
        return diagnostics

    def _hold(self) -> tuple[list[tuple[str, str]], list[Diagnostic]]:
        """Order every drone in the air to hold until it does, except drones that somebody else has taken
        over.
        """
        pilots = [member.pilot for member in self._crew if not member.pilot.taken]
        start = again = self._clock.now()
        requests: dict[str, str] = {}
        while True:
            now = self._clock.now()
            self._keep_up(now)
            running = [pilot for pilot in pilots if not pilot.stopped(self._tick)]
            if not running or now - start > HOLD_S:
                return list(requests.items()), [flight_faults.not_holding(p.vehicle, HOLD_S) for p in running]
            if now >= again:
                again = now + HOLD_AGAIN_S
                for pilot in running:
                    requests.update(self._ask_to_hold(pilot, known=pilot.name in requests))
            self._clock.wait_until(now + PERIOD_S)

    def _ask_to_hold(self, pilot: Pilot, *, known: bool) -> dict[str, str]:
        mode = pilot.hold(self._tick)
        if mode is None or known:
            return {}
        self._say(f"{pilot.name}: {mode.name} is asked for")
        return {pilot.name: mode.name}

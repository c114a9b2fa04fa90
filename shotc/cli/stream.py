"""``shotc stream``: send a proved plan to autopilots, in real time."""

from __future__ import annotations

import signal
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime
from importlib.util import find_spec
from types import FrameType
from typing import TYPE_CHECKING, Annotated

import typer

from shotc.cli import console
from shotc.cli.console import known
from shotc.cli.plans import PlanPath, prove
from shotc.diag.registry import has_errors
from shotc.plugins import not_installed
from shotc.rounding import at_least
from shotc.stream.beginning import clock_time, moment
from shotc.stream.clock import WallClock
from shotc.stream.endpoint import Endpoint, endpoint
from shotc.stream.punctual import punctual

if TYPE_CHECKING:  # the base install has no numpy
    from shotc.api import PlanReport
    from shotc.ir.trajectory import TrajectoryIR
    from shotc.stream.flight import FlightResult
    from shotc.stream.pilot import Pilot
    from shotc.stream.session import Aboard, Session

To = Annotated[
    list[str] | None,
    typer.Option(
        "--to",
        metavar="[DRONE=]ADDRESS",
        help="Where a vehicle is: `udp:PORT` or `udp:HOST:PORT` waits for it there, `udpout:HOST:PORT` calls "
        "it. Once for every drone; the name may be left out if the plan has one drone.",
    ),
]
TargetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--target",
        metavar="NAME=udp:PORT",
        help="Let cameras follow where a target really is: positions as JSON or MAVLink come to this port.",
    ),
]
At = Annotated[
    str | None,
    typer.Option(
        metavar="TIME",
        help="The time of day of mission time 0: HH:MM:SS here, or a date and time of ISO 8601 [at once].",
    ),
]
Arm = Annotated[bool, typer.Option("--arm", help="Arm the vehicles and fly. Without it nothing moves.")]
_ENDINGS = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))


def stream(
    plan: PlanPath, to: To = None, target: TargetOption = None, at: At = None, arm: Arm = False
) -> None:
    """Send a proved plan to PX4 or ArduPilot over MAVLink: 50 setpoints a second a drone, on one clock.

    Without --arm it is a dry run: it connects to every vehicle, reads its state, judges it, prints what the
    flight would be, and sends nothing that moves anything. Do this first, on the pads.

    Before anything is armed, every vehicle has to be the autopilot that the plan is for, disarmed and ready,
    with its home within 1 m of its pad in the plan, a gimbal with the reach that the plan needs, and
    parameters by which it holds, returns or lands when the link is lost. Every fault is reported with a
    remedy.

    With --arm, each drone gets ready a few seconds before its lift-off, follows the plan in OFFBOARD (PX4) or
    GUIDED (ArduPilot), records its shots, and lands on its pad. If anything goes wrong, or at Ctrl-C, every
    drone in the air is told to hold (PX4: HOLD, ArduPilot: BRAKE): be ready to take over.

    With --at, mission time 0 is at that time of day. Several machines and a show then begin together. Set
    their clocks by a time server or by satellites. Drones get ready up to 15 s before it.

    With --target, cameras follow the real place of a target, and keep it at its planned place on screen;
    drones keep to the plan. A datagram is `{"x": 3.1, "y": -2, "z": 0.9}` in the mission's frame,
    `{"lat": .., "lon": .., "alt": ..}`, or the GLOBAL_POSITION_INT of another vehicle.

    For example:

        shotc stream out/tower --to udp:14540

        shotc stream out/runner --to near=udp:14540 --to far=udp:14541 --target runner=udp:14600 --arm

        shotc stream out/film --to udp:14540 --at 21:30:00 --arm
    """
    begins = None if at is None else _moment(at)
    given, targets = _addresses(to or [], "--to"), _addresses(target or [], "--target")
    if find_spec("pymavlink") is None:
        console.report([not_installed("P004", "`shotc stream`", ["pymavlink"])], {})
        raise typer.Exit(console.EXIT_REJECTED)
    report = prove(plan)
    if report.plan is None:
        console.report(report.diagnostics, report.sources)
        raise typer.Exit(console.EXIT_REJECTED)
    flown = [track.drone for track in report.plan.trajectory.drones]
    addresses = _of_one(given, flown)
    _all_named(addresses, flown)
    _all_filmed(targets, report.plan.trajectory)
    raise typer.Exit(_stream(report, addresses, targets, at=begins, arm=arm))


def _moment(text: str) -> float:
    """Return a time of day as POSIX seconds."""
    try:
        return moment(text, datetime.fromtimestamp(WallClock().utc(), UTC)).timestamp()
    except ValueError as fault:
        raise typer.BadParameter(str(fault), param_hint="--at") from None


def _stream(
    report: PlanReport,
    addresses: Mapping[str, Endpoint],
    targets: Mapping[str, Endpoint],
    *,
    at: float | None,
    arm: bool,
) -> int:
    from shotc.stream.session import Session
    from shotc.stream.sockets import DOORS

    assert report.plan is not None
    with Session(report.plan, DOORS, WallClock(), console.note) as session:
        diagnostics = session.open(addresses, targets)
        aboard: list[Aboard] = []
        if not has_errors(diagnostics):
            aboard, judged = session.check()
            diagnostics = [*diagnostics, *judged]
        if aboard and at is not None and not has_errors(diagnostics):
            diagnostics = [*diagnostics, *session.too_soon(aboard, at)]
        console.report(diagnostics, report.sources)
        if console.exit_code(diagnostics):
            return console.EXIT_REJECTED
        console.out(_checked(aboard))
        if not arm:
            begins = "" if at is None else f", from {clock_time(at)} on"
            console.out(f"dry run: nothing was armed or moved; with --arm this is flown{begins}")
            return console.EXIT_CLEAN
        return _fly(session, aboard, report, at)


def _fly(session: Session, aboard: Sequence[Aboard], report: PlanReport, at: float | None) -> int:
    from shotc.stream.report import timing_summary

    with _as_interrupts(), punctual() as granted:
        flown, pilots = session.fly(aboard, at)
    console.out(_outcome(flown, pilots))
    console.out(f"{timing_summary(flown.times)}{'; at real-time priority' * granted}")
    console.report(flown.diagnostics, report.sources)
    if flown.interrupted:
        return console.EXIT_INTERRUPTED
    return console.exit_code(flown.diagnostics)


def _checked(aboard: Sequence[Aboard]) -> str:
    from shotc.stream.session import summary

    rows = [
        (f"{who.ready.drone.name}" if index == 0 else "", *row)
        for who in aboard
        for index, row in enumerate(summary(who))
    ]
    return "\n".join(console.table(rows))


def _outcome(flown: FlightResult, pilots: Sequence[Pilot]) -> str:
    rows = [
        (
            pilot.name,
            f"{pilot.sent} setpoints",
            f"at most {at_least(pilot.farthest)} m from the plan",
            _end(flown, pilot),
        )
        for pilot in pilots
    ]
    return "\n".join(console.table(rows))


def _end(flown: FlightResult, pilot: Pilot) -> str:
    from shotc.stream.session import left_alone

    if pilot.done:
        return "landed"
    mode = dict(flown.holding).get(pilot.name)
    if mode is not None:
        return f"in the air, {mode} was requested: take it over{left_alone(pilot.vehicle)}"
    return "taken over" if pilot.taken else "not in the air"


def _addresses(texts: Sequence[str], option: str) -> dict[str, Endpoint]:
    """Return addresses by name; the name is "" for an address without one."""
    endpoints: dict[str, Endpoint] = {}
    for text in texts:
        name, equals, address = text.rpartition("=")
        if option == "--target" and not equals:
            raise typer.BadParameter(f"`{text}` names no target; write `NAME=udp:PORT`", param_hint=option)
        if name in endpoints:
            raise typer.BadParameter(f"`{name or text}` is given twice", param_hint=option)
        try:
            endpoints[name] = endpoint(address)
        except ValueError as fault:
            raise typer.BadParameter(str(fault), param_hint=option) from None
    return endpoints


def _of_one(addresses: Mapping[str, Endpoint], flown: Sequence[str]) -> dict[str, Endpoint]:
    """Return addresses by drone. An address without a name belongs to the plan's only drone."""
    if len(flown) == 1 and list(addresses) == [""]:
        return {flown[0]: addresses[""]}
    return dict(addresses)


def _all_named(addresses: Mapping[str, Endpoint], flown: Sequence[str]) -> None:
    """Refuse names that are not in the plan, and drones without an address: all drones fly on one clock."""
    if "" in addresses:
        names = ", ".join(flown)
        raise typer.BadParameter(
            f"the plan flies {names}; write `--to DRONE=...` for each", param_hint="--to"
        )
    for name in addresses:
        known("--to", name, list(flown))
    lacking = [name for name in flown if name not in addresses]
    if lacking:
        raise typer.BadParameter(f"no address for {', '.join(lacking)}", param_hint="--to")


def _all_filmed(targets: Mapping[str, Endpoint], trajectory: TrajectoryIR) -> None:
    """Refuse targets that are not in the mission, or that no camera films."""
    mission = trajectory.keyframes.mission
    filmed = {span.target for track in trajectory.drones for span in track.framing}
    filmed |= {shot.subject for shot in mission.shots if shot.subject is not None}
    for name in targets:
        known("--target", name, [target.name for target in mission.targets])
        if name not in filmed:
            raise typer.BadParameter(f"no shot films `{name}`", param_hint="--target")


@contextmanager
def _as_interrupts() -> Iterator[None]:
    """Turn SIGTERM and SIGHUP into KeyboardInterrupt, as Ctrl-C does; in the main thread only."""
    before = {ending: signal.signal(ending, _interrupt) for ending in _ENDINGS}
    try:
        yield
    finally:
        for ending, handler in before.items():
            signal.signal(ending, handler)


def _interrupt(number: int, frame: FrameType | None) -> None:
    raise KeyboardInterrupt

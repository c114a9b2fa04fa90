"""`python -m tests.experiments.bench.streaming [DRONES]` prints how punctually setpoints are sent.

The vehicles are simulated autopilots on loopback ports, in a process of their own; the sender is that of
`shotc stream`, by the clock of the machine. Five drones fly for half a minute. Nothing is asserted: how late
a sender is depends on what else the machine does.
"""

from __future__ import annotations

import multiprocessing
import sys
import time
from multiprocessing.synchronize import Event

from shotc.stream.clock import WallClock
from shotc.stream.punctual import punctual
from shotc.stream.report import timing_summary
from shotc.stream.session import Session
from shotc.stream.sockets import DOORS
from tests.support.stream.plans import hop_plan
from tests.support.stream.worlds import World, endpoints_of

DRONES = 5
STEP_S = 0.005


def main(count: int) -> None:
    """Fly, and print the times."""
    names = [f"cam{i + 1}" for i in range(count)]
    plan = hop_plan(*names, pans=True)
    context = multiprocessing.get_context("fork")
    over = context.Event()
    with World(plan) as world:
        vehicles = context.Process(target=_live, args=(world, over))
        vehicles.start()
        try:
            _fly(plan, world)
        finally:
            over.set()
            vehicles.join()


def _fly(plan: object, world: World) -> None:
    with Session(plan, DOORS, WallClock(), print) as session:
        found = session.open(endpoints_of(world.ports), {})
        aboard, more = session.check()
        if found or more:
            raise SystemExit(f"not ready: {found} {more}")
        cpu = time.process_time()
        with punctual() as granted:
            flown, pilots = session.fly(aboard)
        cpu = time.process_time() - cpu
    lasted = flown.times.ticks / 50
    print(f"{len(pilots)} drones, {lasted:.0f} s: {timing_summary(flown.times)}")
    print(f"real-time priority: {'granted' if granted else 'not granted'}")
    print(f"CPU {100 * cpu / lasted:.1f} % of one core; {'landed' if flown.landed else flown.diagnostics}")


def _live(world: World, over: Event) -> None:
    """Run the vehicles until the flight is over."""
    while not over.is_set():
        now = time.monotonic()
        for autopilot in world.autopilots.values():
            autopilot.run(now)
        time.sleep(STEP_S)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else DRONES)

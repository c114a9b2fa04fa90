"""A time limit for solvers that have none of their own.

fatrop adds to the diagonal of its linear system until it can factorise it, without a limit. So there are
problems on which it never ends. It cannot be interrupted, but it can be abandoned.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from queue import Empty, SimpleQueue
from threading import Thread, get_ident
from typing import Any

TIMEOUT_S = 30.0  # seconds of processor time: ten times what the largest problems take
LOOK_S = 0.05  # seconds that are waited at least before the time is looked at again


class TimedOut(Exception):
    """A call did not end in time; its thread keeps running."""


def within(seconds: float, call: Callable[[], Any]) -> Any:
    """Return what ``call`` returns, or raise what it raises.

    The call runs in its own thread, so that Ctrl-C works meanwhile. Its time is processor time, so that the
    result does not depend on the load of the machine.

    Raises TimedOut after ``seconds``.
    """
    answer: SimpleQueue[tuple[Any, BaseException | None]] = SimpleQueue()
    clocks: SimpleQueue[Callable[[], float]] = SimpleQueue()

    def run() -> None:
        clocks.put(_own_clock())
        try:
            answer.put((call(), None))
        except BaseException as raised:  # noqa: BLE001  it is raised again below
            answer.put((None, raised))

    Thread(target=run, daemon=True).start()
    taken, left = clocks.get(), seconds
    while left > 0.0:
        try:
            value, raised = answer.get(timeout=max(left, LOOK_S))  # no thread computes longer than it lasts
        except Empty:
            left = seconds - taken()
            continue
        if raised is not None:
            raise raised
        return value
    raise TimedOut


def _own_clock() -> Callable[[], float]:
    """Return a clock of the calling thread's processor time, or of its process' where threads have none."""
    if sys.platform in {"win32", "darwin"}:
        began = time.process_time()
        return lambda: time.process_time() - began
    clock = time.pthread_getcpuclockid(get_ident())

    def taken() -> float:
        try:
            return time.clock_gettime(clock)
        except OSError:  # it has ended, so its answer is there
            return 0.0

    return taken

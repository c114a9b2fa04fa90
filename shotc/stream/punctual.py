"""What a process does to be woken in time: real-time priority where it is granted, no garbage collection.

On a machine with as much to do as it has cores, a process that sleeps is woken up to a few milliseconds late.
One of 99 levels of real-time priority is asked for; Linux grants it to those whom ``ulimit -r`` allows it.
"""

from __future__ import annotations

import gc
import os
from collections.abc import Iterator
from contextlib import contextmanager

PRIORITY_LEVEL = 10


@contextmanager
def punctual() -> Iterator[bool]:
    """Be woken in time inside of the block; gives whether the priority was granted.

    The flight makes no cycles of objects, and is over before what it does make is of any size.
    """
    collects = gc.isenabled()
    gc.collect()
    gc.disable()
    before = _raised()
    try:
        yield before is not None
    finally:
        if before is not None:
            _restore(before)
        if collects:
            gc.enable()


if hasattr(os, "sched_setscheduler"):

    def _raised() -> tuple[int, int] | None:
        """Take real-time priority; return the policy and the level before, None where that is not allowed."""
        before = os.sched_getscheduler(0), os.sched_getparam(0).sched_priority
        try:
            os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(PRIORITY_LEVEL))
        except OSError:
            return None
        return before

    def _restore(before: tuple[int, int]) -> None:
        os.sched_setscheduler(0, before[0], os.sched_param(before[1]))

else:

    def _raised() -> tuple[int, int] | None:
        """Other systems have no such call."""
        return None

    def _restore(before: tuple[int, int]) -> None:
        """Leave all as it is."""

"""Makes the process wake up on time: real-time priority if the system grants it, and no garbage collection.

On a machine with as many busy processes as cores, a sleeping process wakes up to a few milliseconds late. The
module requests one of the 99 levels of real-time priority; Linux grants it to users whom ``ulimit -r`` allows
it.
"""

from __future__ import annotations

import gc
import os
from collections.abc import Iterator
from contextlib import contextmanager

PRIORITY_LEVEL = 10


@contextmanager
def punctual() -> Iterator[bool]:
    """Wake up on time inside of the block; yields whether the priority was granted.

    Garbage collection is off: a flight makes no cycles of objects, and ends before other objects fill the
    memory.
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
        """Take real-time priority; return the policy and the level before, None if the system refuses."""
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
        """Return None: other systems have no such call."""
        return None

    def _restore(before: tuple[int, int]) -> None:
        """Do nothing."""

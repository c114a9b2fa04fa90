"""A limit on how long a call may take, where the system can interrupt one."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


class CallTimeout(Exception):
    """A call took longer than it may."""


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Raise ``CallTimeout`` in what runs below after so many seconds.

    It needs Unix and the main thread, as the processes of a simulation have; elsewhere nothing is limited.
    What does not come back to the interpreter cannot be interrupted.
    """
    if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGALRM, _interrupt)
    left = signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.signal(signal.SIGALRM, before)
        signal.setitimer(signal.ITIMER_REAL, *left)  # whoever had one goes on with it


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    raise CallTimeout

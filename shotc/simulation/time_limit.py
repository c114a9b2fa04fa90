"""A time limit for a call, on systems that can interrupt one."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


class CallTimeout(Exception):
    """A call exceeded its time limit."""


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Raise ``CallTimeout`` in the body after some seconds.

    It needs Unix and the main thread, which the processes of a simulation have; elsewhere there is no limit.
    Code that does not return to the interpreter cannot be interrupted.
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
        signal.setitimer(signal.ITIMER_REAL, *left)  # restores an earlier timer


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    raise CallTimeout

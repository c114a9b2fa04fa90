"""A limit on how long a solver may take, for one that has none of its own.

fatrop adds to the diagonal of its linear system until that can be factorised, without a bound on how
often, so there are problems on which it never ends. It cannot be interrupted; it can be left behind.
"""

from __future__ import annotations

from collections.abc import Callable
from queue import Empty, SimpleQueue
from threading import Thread
from typing import Any

TIMEOUT_S = 30.0  # seconds: ten times what the largest problems take


class TimedOut(Exception):
    """A call has not ended in time; the thread that it runs in is left to itself."""


def within(seconds: float, call: Callable[[], Any]) -> Any:
    """Return what ``call`` returns, or raise what it raises; TimedOut after so many seconds.

    The call runs in a thread of its own, so that an interrupt from the keyboard is heard meanwhile.
    """
    answer: SimpleQueue[tuple[Any, BaseException | None]] = SimpleQueue()

    def run() -> None:
        try:
            answer.put((call(), None))
        except BaseException as raised:  # noqa: BLE001  it is raised again below
            answer.put((None, raised))

    Thread(target=run, daemon=True).start()
    try:
        value, raised = answer.get(timeout=seconds)
    except Empty:
        raise TimedOut from None
    if raised is not None:
        raise raised
    return value

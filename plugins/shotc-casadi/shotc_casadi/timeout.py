"""A time limit for solvers that have none of their own.

fatrop adds to the diagonal of its linear system until it can factorise it, without a limit. So there are
problems on which it never ends. It cannot be interrupted, but it can be abandoned.
"""

from __future__ import annotations

from collections.abc import Callable
from queue import Empty, SimpleQueue
from threading import Thread
from typing import Any

TIMEOUT_S = 30.0  # seconds: ten times what the largest problems take


class TimedOut(Exception):
    """A call did not end in time; its thread keeps running."""


def within(seconds: float, call: Callable[[], Any]) -> Any:
    """Return what ``call`` returns, or raise what it raises.

    The call runs in its own thread, so that Ctrl-C works meanwhile.

    Raises TimedOut after ``seconds``.
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

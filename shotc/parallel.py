"""Parallel work, by processes of this machine or by a cluster."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from multiprocessing import active_children, get_context, parent_process
from typing import Any, TypeVar

S = TypeVar("S")
T = TypeVar("T")

GONE_S = 5.0
"""Timeout for the end of a killed process, seconds."""

Hands = int | str
"""The largest number of processes of this machine, or the address of a cluster's scheduler."""


class NoCluster(Exception):
    """No scheduler answers at an address."""


class Lost(Exception):
    """A process died before its work was done: killed, or out of memory."""


def nothing() -> None:
    """Do nothing."""


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count() or 1


def as_done(work: Callable[[S], T], items: Sequence[S], hands: Hands) -> Iterator[T]:
    """Yield the results of ``work`` for all items in the order of completion.

    ``work`` and the items are pickled. With one process or one item the work runs in this process.
    Raise ``NoCluster`` if no scheduler answers, ``Lost`` if a process is killed.
    """
    if isinstance(hands, str):
        from shotc.cluster import on_cluster

        yield from on_cluster(hands, work, items)
        return
    workers = min(hands, len(items))
    if workers < 2:
        yield from (work(item) for item in items)
        return
    with pool_of(workers) as pool:
        try:
            with uninterrupted():
                waiting = [pool.submit(work, item) for item in items]
            yield from (each.result() for each in as_completed(waiting))
        except BrokenExecutor:
            raise Lost from None


@contextmanager
def pool_of(
    workers: int, begin: Callable[..., None] = nothing, given: tuple[Any, ...] = ()
) -> Iterator[ProcessPoolExecutor]:
    """Yield a pool of worker processes, which end with the block in any case.

    begin : called first in each worker, with the arguments ``given``
    Workers ignore interrupts, and end if this process is killed. On Linux, where it is safe, they are forked
    at the first task; enter the block before threads start.
    """
    others = set(active_children())
    context = get_context("fork" if sys.platform == "linux" else "spawn")
    pool = ProcessPoolExecutor(workers, context, _begin, (begin, given))
    finished = False
    try:
        yield pool
        finished = True
    finally:
        with uninterrupted():
            mine = set(active_children()) - others
            for worker in mine:
                worker.kill()  # safe, because it writes nothing to the disk
            for worker in mine:
                worker.join(GONE_S)
            # A worker that is killed while it sends a result leaves a part of it in the pipe. The thread that
            # reads results then waits forever, so we do not wait for that thread.
            pool.shutdown(wait=finished)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Block interrupts, so that no worker is lost and none gets an interrupt before it ignores them."""
    if sys.platform == "win32":
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin(begin: Callable[..., None], given: tuple[Any, ...]) -> None:
    """Initialise a worker; it ends if its parent is killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    begin(*given)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        parent.join()
    os._exit(0)

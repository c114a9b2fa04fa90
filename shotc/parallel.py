"""Work that is done side by side: by processes of this machine, or by a cluster."""

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
"""Seconds in which a process that is killed is gone."""

Hands = int | str
"""So many processes of this machine at most, or the cluster whose scheduler is at an address."""


class NoCluster(Exception):
    """No scheduler answers at an address."""


class Lost(Exception):
    """A process is gone before its work was done: killed, or out of memory."""


def nothing() -> None:
    """Do nothing."""


def cores() -> int:
    """Return how many cores this process may use."""
    return len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count() or 1


def as_done(work: Callable[[S], T], items: Sequence[S], hands: Hands) -> Iterator[T]:
    """Yield what ``work`` makes of every item, as it comes.

    ``work`` and the items are pickled; with one process, or one item, it works in this one.
    Raises ``NoCluster`` where no scheduler answers, ``Lost`` where a process is killed.
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
    """Yield processes that work for this one and end with the block, however that ends.

    begin : called in each of them first, with what is given
    They do not hear interrupts, and end when this process is killed. They are forked, at the first task that
    they are given, where that is safe: on Linux; enter the block before threads are started.
    """
    others = set(active_children())
    context = get_context("fork" if sys.platform == "linux" else "spawn")
    pool = ProcessPoolExecutor(workers, context, _begin, (begin, given))
    done = False
    try:
        yield pool
        done = True
    finally:
        with uninterrupted():
            mine = set(active_children()) - others
            for worker in mine:
                worker.kill()  # it writes nothing to the disk
            for worker in mine:
                worker.join(GONE_S)
            # One that is killed in the middle of an answer leaves half of it in the pipe, and the thread that
            # reads answers waits for the rest for good: nobody waits for that thread then.
            pool.shutdown(wait=done)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Hold interrupts back: no worker is to be forgotten, and none is to meet one before it ignores them."""
    if sys.platform == "win32":
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin(begin: Callable[..., None], given: tuple[Any, ...]) -> None:
    """Begin as a worker; one whose parent is killed ends, too."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    begin(*given)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        parent.join()
    os._exit(0)

"""Work on a Dask cluster; its workers must have the same shotc installed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from distributed import Client, KilledWorker, as_completed

from shotc.parallel import Lost, NoCluster

ANSWERS_S = 10
"""Timeout for a scheduler's answer, seconds."""

S = TypeVar("S")
T = TypeVar("T")


def on_cluster(address: str, work: Callable[[S], T], items: Sequence[S]) -> Iterator[T]:
    """Yield the results of ``work`` for all items in the order of completion.

    address : of the scheduler, such as tcp://127.0.0.1:8786
    Raise ``NoCluster`` if no scheduler answers, ``Lost`` if a worker dies.
    """
    try:
        client = Client(address, timeout=ANSWERS_S)
    except (OSError, ValueError) as error:
        raise NoCluster(str(error)) from None
    with client:
        # The data that all items share, such as the plan, is sent once.
        shared = client.scatter(work, broadcast=True)
        waiting = [client.submit(_do, shared, item, pure=False) for item in items]
        try:
            yield from (each.result() for each in as_completed(waiting))
        except KilledWorker:
            raise Lost from None


def _do(work: Callable[[S], T], item: S) -> T:
    return work(item)

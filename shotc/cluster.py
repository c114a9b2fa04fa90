"""Work on a Dask cluster, whose workers have the same shotc installed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from distributed import Client, KilledWorker, as_completed

from shotc.parallel import Lost, NoCluster

ANSWERS_S = 10
"""Seconds in which a scheduler has to answer."""

S = TypeVar("S")
T = TypeVar("T")


def on_cluster(address: str, work: Callable[[S], T], items: Sequence[S]) -> Iterator[T]:
    """Yield what ``work`` makes of every item, as it comes; ``NoCluster`` where no scheduler answers.

    address : of the scheduler, as tcp://127.0.0.1:8786
    """
    try:
        client = Client(address, timeout=ANSWERS_S)
    except (OSError, ValueError) as error:
        raise NoCluster(str(error)) from None
    with client:
        # What all items share, such as the plan that is flown, is sent once.
        shared = client.scatter(work, broadcast=True)
        waiting = [client.submit(_do, shared, item, pure=False) for item in items]
        try:
            yield from (each.result() for each in as_completed(waiting))
        except KilledWorker:
            raise Lost from None


def _do(work: Callable[[S], T], item: S) -> T:
    return work(item)

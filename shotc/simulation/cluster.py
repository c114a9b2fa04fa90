"""Runs on a Dask cluster, whose workers have shotc installed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from distributed import Client, as_completed

from shotc.simulation.hands import NoCluster

ANSWERS_S = 10
"""Seconds in which a scheduler has to answer."""

T = TypeVar("T")


def on_cluster(address: str, work: Callable[[range], T], blocks: Sequence[range]) -> Iterator[T]:
    """Yield what ``work`` makes of every block, as it comes; ``NoCluster`` where no scheduler answers.

    address : of the scheduler, as tcp://127.0.0.1:8786
    """
    try:
        client = Client(address, timeout=ANSWERS_S)
    except (OSError, ValueError) as error:
        raise NoCluster(str(error)) from None
    with client:
        # What is flown is sent once, and not with every block.
        shared = client.scatter(work, broadcast=True)
        waiting = [client.submit(_do, shared, block, pure=False) for block in blocks]
        for each in as_completed(waiting):
            yield each.result()


def _do(work: Callable[[range], T], block: range) -> T:
    return work(block)

"""Parallel emitters: worker processes that load their libraries while the plan is made.

An emitter needs only the plan, and its drawing libraries take about as long to load as a mission takes to
plan. So workers are forked early, while this process has one thread and no solver. They load what their
emitters need while this process solves, then they get the plan. If a worker fails or dies, this process makes
its files, so a failure looks the same with and without workers. Files do not depend on the number of workers.
"""

from __future__ import annotations

import os
import re
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future
from contextlib import contextmanager, suppress
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from typing import TYPE_CHECKING, Any, NamedTuple

from shotc.emit.base import Artifact, Emission, Emitter, Prepares
from shotc.parallel import cores, pool_of, uninterrupted

if TYPE_CHECKING:  # the base install has no numpy
    from shotc.ir.trajectory import VerifiedIR

MOST_PROCESSES = 4
"""Default number of processes; our own emitters have no work for more."""

_PLAIN = re.compile(r"\w(?:[\w .-]{0,126}[\w-])?").fullmatch
"""A file name that is valid on every system and leads into no other folder."""

Load = Callable[[str], Emitter | None]
EmitterResult = Emission | Exception | str
"""The emission of an emitter, its exception, or the fault of its result."""


def usual_jobs() -> int:
    """Return the default number of processes: that of usable cores, at most MOST_PROCESSES."""
    return min(MOST_PROCESSES, cores()) if sys.platform == "linux" else 1


class EmitterPool:
    """The processes that emit: this one, and the workers of the pool that ``emitter_pool`` made.

    plans : the ends of the pipes through which workers get the plan
    """

    def __init__(
        self, pool: Executor | None = None, plans: Sequence[Connection] = (), load: Load | None = None
    ) -> None:
        self._pool = pool
        self._plans = plans
        self._load = load
        self._work: list[_Work] = []

    def prepare(self, names: Sequence[str]) -> None:
        """Let the workers load what these emitters need.

        Emitters without preparation stay in this process.
        """
        if self._pool is None or self._load is None:
            return
        heavy = [name for name in names if isinstance(self._load(name), Prepares)]
        for i, plan in enumerate(self._plans):
            if share := heavy[i :: len(self._plans)]:
                with suppress(BrokenExecutor):
                    self._work.append(_Work(share, plan, self._pool.submit(_emissions, i, share)))

    def emit(self, plan: VerifiedIR, emitters: Sequence[Emitter]) -> list[EmitterResult]:
        """Run emitters and return their results in order."""
        names = {emitter.name for emitter in emitters}
        busy = [work for work in self._work if names.intersection(work.names)]
        for work in busy:
            with suppress(OSError):  # a dead worker is noticed by its missing result
                work.plan.send((plan, names))
        forked = {name for work in busy for name in work.names}
        results: dict[str, EmitterResult] = {
            e.name: _result(e, plan) for e in emitters if e.name not in forked
        }
        for work in busy:
            with suppress(Exception):  # without a worker's result this process makes the files, or fails
                results |= work.made.result()
        return [results[e.name] if e.name in results else _result(e, plan) for e in emitters]


class _Work(NamedTuple):
    """The emitters that one worker prepares, the pipe for its plan, and its future result."""

    names: list[str]
    plan: Connection
    made: Future[dict[str, Emission]]


NO_WORKERS = EmitterPool()


@contextmanager
def emitter_pool(jobs: int, load: Load) -> Iterator[EmitterPool]:
    """Yield this process and ``jobs`` - 1 workers, which end with the block in any case.

    load : returns an emitter by its name, None for an unusable one; also called in the workers
    There are no workers if a fork is not safe: on other systems than Linux, and with several threads.
    """
    if jobs < 2 or sys.platform != "linux" or threading.active_count() > 1:
        yield EmitterPool(load=load)
        return
    pipes = [Pipe(duplex=False) for _ in range(jobs - 1)]
    receivers, plans = [end for end, _ in pipes], [start for _, start in pipes]
    try:
        with pool_of(jobs - 1, _begin, (load, receivers, plans)) as pool:
            with uninterrupted():
                pool.submit(os.getpid)  # the pool forks all its workers at the first task
            for end in receivers:
                end.close()
            yield EmitterPool(pool, plans, load)
    finally:
        for start in plans:
            start.close()


_IN_WORKER: list[Any] = []
"""In a worker: the loader of emitters, and the ends of the pipes for plans."""


def _begin(load: Load, receivers: Sequence[Connection], plans: Sequence[Connection]) -> None:
    """Initialise a worker: keep its own ends of the pipes."""
    for start in plans:
        start.close()
    _IN_WORKER[:] = load, receivers


def _emissions(i: int, names: Sequence[str]) -> dict[str, Emission]:
    """Prepare emitters, wait for a plan in pipe ``i``, and return their emissions without the failed ones."""
    load, receivers = _IN_WORKER
    emitters = [emitter for name in names if (emitter := load(name)) is not None]
    for emitter in emitters:
        with suppress(Exception):
            emitter.prepare()
    plan, requested = receivers[i].recv()
    results = {emitter.name: _result(emitter, plan) for emitter in emitters if emitter.name in requested}
    return {name: emission for name, emission in results.items() if isinstance(emission, Emission)}


def _result(emitter: Emitter, plan: VerifiedIR) -> EmitterResult:
    try:
        emission: Any = emitter.emit(plan)
    except Exception as fault:  # noqa: BLE001  a plugin may raise anything
        return fault
    return _wrong(emission) or emission


def _wrong(result: Any) -> str:
    """Return the fault of an emitter's result, an empty text if there is none."""
    if not isinstance(result, Emission):
        return f"returned a {type(result).__name__}, not an Emission"
    artifacts: Any = result.artifacts
    for artifact in artifacts:
        if not isinstance(artifact, Artifact) or not isinstance(artifact.data, bytes):
            return "returned something else than Artifacts of bytes"
        if not _PLAIN(artifact.name):
            return f"names a file {artifact.name!r}: letters, digits, spaces and . - _ only, in no folder"
    return ""

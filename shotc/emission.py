"""Emitters side by side: processes that stand ready while the plan is still being made.

An emitter needs nothing but the plan, and the libraries that draw take about as long to load as a
mission takes to plan. So workers are forked early, while this process has one thread and no solver;
they load what their emitters need while this process solves, then get the plan. What a worker does
not bring back (it failed, or it is gone) is made here again, so that a failure looks as it does
without workers. Files do not depend on how many there are.
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

MOST = 4
"""Processes that are used where nothing is said; our own emitters have no work for more."""

_PLAIN = re.compile(r"\w(?:[\w .-]{0,126}[\w-])?").fullmatch
"""A file name that every system takes and that leads into no other folder."""

Load = Callable[[str], Emitter | None]
Outcome = Emission | Exception | str
"""What an emitter made, what it raised, or what is wrong with what it returned."""


def usual_jobs() -> int:
    """Return how many processes are used where nothing is said: the cores that we may use, at most MOST."""
    return min(MOST, cores()) if sys.platform == "linux" else 1


class EmitterPool:
    """The processes that emit: this one, and the workers of the pool that ``crew`` made beside it.

    plans : the ends of pipes by which each worker gets its plan
    """

    def __init__(
        self, pool: Executor | None = None, plans: Sequence[Connection] = (), load: Load | None = None
    ) -> None:
        self._pool = pool
        self._plans = plans
        self._load = load
        self._work: list[_Work] = []

    def prepare(self, names: Sequence[str]) -> None:
        """Let the workers load what these emitters need; those that need no preparation stay here."""
        if self._pool is None or self._load is None:
            return
        heavy = [name for name in names if isinstance(self._load(name), Prepares)]
        for i, plan in enumerate(self._plans):
            if share := heavy[i :: len(self._plans)]:
                with suppress(BrokenExecutor):
                    self._work.append(_Work(share, plan, self._pool.submit(_made, i, share)))

    def emit(self, plan: VerifiedIR, emitters: Sequence[Emitter]) -> list[Outcome]:
        """Run emitters and return what came of each, in their order."""
        wanted = {emitter.name for emitter in emitters}
        busy = [work for work in self._work if wanted.intersection(work.names)]
        for work in busy:
            with suppress(OSError):  # a worker that is gone shows when its result is missing
                work.plan.send((plan, wanted))
        away = {name for work in busy for name in work.names}
        made: dict[str, Outcome] = {e.name: _outcome(e, plan) for e in emitters if e.name not in away}
        for work in busy:
            with suppress(Exception):  # what a worker does not bring back is made here, and fails here
                made |= work.made.result()
        return [made[e.name] if e.name in made else _outcome(e, plan) for e in emitters]


class _Work(NamedTuple):
    """The emitters that one worker has prepared, the pipe for its plan, and what it will have made."""

    names: list[str]
    plan: Connection
    made: Future[dict[str, Emission]]


ALONE = EmitterPool()


@contextmanager
def crew(jobs: int, load: Load) -> Iterator[EmitterPool]:
    """Yield this process and ``jobs`` - 1 workers, which end with the block, however that ends.

    load : returns an emitter by its name, None for one that cannot be used; called in the workers, too
    There are no workers where a fork is not safe: off Linux, and in a process with several threads.
    """
    if jobs < 2 or sys.platform != "linux" or threading.active_count() > 1:
        yield EmitterPool(load=load)
        return
    pipes = [Pipe(duplex=False) for _ in range(jobs - 1)]
    orders, plans = [end for end, _ in pipes], [start for _, start in pipes]
    try:
        with pool_of(jobs - 1, _begin, (load, orders, plans)) as pool:
            with uninterrupted():
                pool.submit(os.getpid)  # it forks all its workers at the first task
            for end in orders:
                end.close()
            yield EmitterPool(pool, plans, load)
    finally:
        for start in plans:
            start.close()


_HERE: list[Any] = []
"""In a worker: how emitters load, and the ends of the pipes by which plans come."""


def _begin(load: Load, orders: Sequence[Connection], plans: Sequence[Connection]) -> None:
    """Begin as a worker: keep its own ends of the pipes."""
    for start in plans:
        start.close()
    _HERE[:] = load, orders


def _made(i: int, names: Sequence[str]) -> dict[str, Emission]:
    """Prepare emitters, wait for a plan in pipe ``i``, and return what they make; what fails is left out."""
    load, orders = _HERE
    emitters = [emitter for name in names if (emitter := load(name)) is not None]
    for emitter in emitters:
        with suppress(Exception):
            emitter.prepare()
    plan, wanted = orders[i].recv()
    outcomes = {emitter.name: _outcome(emitter, plan) for emitter in emitters if emitter.name in wanted}
    return {name: made for name, made in outcomes.items() if isinstance(made, Emission)}


def _outcome(emitter: Emitter, plan: VerifiedIR) -> Outcome:
    try:
        made: Any = emitter.emit(plan)
    except Exception as fault:  # noqa: BLE001  a plugin may raise anything
        return fault
    return _wrong(made) or made


def _wrong(made: Any) -> str:
    """Return what is wrong with an emitter's answer, an empty text where nothing is."""
    if not isinstance(made, Emission):
        return f"returned a {type(made).__name__}, not an Emission"
    artifacts: Any = made.artifacts
    for artifact in artifacts:
        if not isinstance(artifact, Artifact) or not isinstance(artifact.data, bytes):
            return "returned something else than Artifacts of bytes"
        if not _PLAIN(artifact.name):
            return f"names a file {artifact.name!r}: letters, digits, spaces and . - _ only, in no folder"
    return ""

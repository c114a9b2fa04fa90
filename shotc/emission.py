"""Emitters side by side: processes that stand ready while the plan is still being made.

An emitter needs nothing but the plan, and the libraries that draw take about as long to load as a
mission takes to plan. So workers are forked early, while this process has one thread and no solver;
they load what their emitters need while this process solves, then get the plan. What a worker does
not bring back (it failed, or it is gone) is made here again, so that a failure looks as it does
without workers. Files do not depend on how many there are.
"""

from __future__ import annotations

import os
import pickle
import re
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, BinaryIO

from shotc.emit.base import Artifact, Emission, Emitter, Prepares

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
    return min(MOST, len(os.sched_getaffinity(0))) if sys.platform == "linux" else 1


@dataclass(slots=True, eq=False)
class _Worker:
    """A process, the pipe to it, the pipe from it, and the names of the emitters that it has prepared."""

    pid: int
    orders: BinaryIO
    results: BinaryIO
    names: list[str] = field(default_factory=list)

    def send(self, order: Any) -> None:
        """Send an order whole or not at all; a worker that is gone shows when its results are missing."""
        data = pickle.dumps(order, pickle.HIGHEST_PROTOCOL)
        with suppress(OSError):
            self.orders.write(data)
            self.orders.flush()

    def receive(self) -> Mapping[str, Emission]:
        try:
            return dict(pickle.load(self.results))
        except (OSError, EOFError, pickle.UnpicklingError):
            return {}

    def end(self) -> None:
        os.kill(self.pid, signal.SIGKILL)  # it writes nothing to the disk
        os.waitpid(self.pid, 0)
        self.results.close()
        with suppress(OSError):
            self.orders.close()


class Crew:
    """The processes that emit: this one, and the workers that ``crew`` made beside it."""

    def __init__(self, workers: Sequence[_Worker] = (), load: Load | None = None) -> None:
        self._workers = workers
        self._load = load

    def prepare(self, names: Sequence[str]) -> None:
        """Let the workers load what these emitters need; those that need no preparation stay here."""
        if not self._workers or self._load is None:
            return
        heavy = [name for name in names if isinstance(self._load(name), Prepares)]
        for i, worker in enumerate(self._workers):
            worker.names = heavy[i :: len(self._workers)]
            if worker.names:
                worker.send(worker.names)

    def emit(self, plan: VerifiedIR, emitters: Sequence[Emitter]) -> list[Outcome]:
        """Run emitters and return what came of each, in their order."""
        wanted = {emitter.name for emitter in emitters}
        busy = [worker for worker in self._workers if wanted.intersection(worker.names)]
        for worker in busy:
            worker.send((plan, [name for name in worker.names if name in wanted]))
        away = {name for worker in busy for name in worker.names}
        made: dict[str, Outcome] = {e.name: _outcome(e, plan) for e in emitters if e.name not in away}
        for worker in busy:
            made |= worker.receive()
        return [made[e.name] if e.name in made else _outcome(e, plan) for e in emitters]


ALONE = Crew()


@contextmanager
def crew(jobs: int, load: Load) -> Iterator[Crew]:
    """Yield this process and ``jobs`` - 1 workers, which end with the block, however that ends.

    load : returns an emitter by its name, None for one that cannot be used; called in the workers, too
    There are no workers where a fork is not safe: off Linux, and in a process with several threads.
    """
    safe = sys.platform == "linux" and threading.active_count() == 1
    workers: list[_Worker] = []
    try:
        with _uninterrupted():
            for _ in range(jobs - 1 if safe else 0):
                workers.append(_hire(load, workers))
        yield Crew(workers, load)
    finally:
        with _uninterrupted():
            for worker in workers:
                worker.end()


@contextmanager
def _uninterrupted() -> Iterator[None]:
    """Hold interrupts back: no worker is to be forgotten, and none is to meet one before it ignores them."""
    if sys.platform == "win32":
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _hire(load: Load, others: Sequence[_Worker]) -> _Worker:
    """Fork a worker; others : those that are there already."""
    inward, orders = _pipe()
    results, outward = _pipe()
    pid = os.fork()
    if pid == 0:
        # A worker sees the end of its orders only if nobody but this process can write any.
        _live(inward, outward, load, [orders, results, *(s for o in others for s in (o.orders, o.results))])
    inward.close()
    outward.close()
    return _Worker(pid, orders, results)


def _pipe() -> tuple[BinaryIO, BinaryIO]:
    end, start = os.pipe()
    return os.fdopen(end, "rb"), os.fdopen(start, "wb")


def _live(inward: BinaryIO, outward: BinaryIO, load: Load, ours: Sequence[BinaryIO]) -> None:
    """Be a worker until the process ends, without a word: what fails is done again where it is reported."""
    try:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        for stream in ours:
            stream.close()
        _work(inward, outward, load)
    finally:
        os._exit(0)


def _work(orders: BinaryIO, results: BinaryIO, load: Load) -> None:
    emitters = [emitter for name in pickle.load(orders) if (emitter := load(name)) is not None]
    for emitter in emitters:
        if isinstance(emitter, Prepares):
            with suppress(Exception):
                emitter.prepare()
    plan, names = pickle.load(orders)
    made: dict[str, Emission] = {}
    for emitter in emitters:
        if emitter.name in names:
            with suppress(Exception):
                emission = emitter.emit(plan)
                if not _wrong(emission):
                    made[emitter.name] = emission
    pickle.dump(made, results, pickle.HIGHEST_PROTOCOL)
    results.flush()


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

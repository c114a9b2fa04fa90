"""A replanner of another package in a process of its own, which is killed if it takes too long.

Neither an endless loop in C nor a crash of its process ends a simulation. One process serves all drones of a
block of runs, one after the other. It starts at the first replan, and again after it was killed. A planner is
a pure function of its problem and the two arguments of ``replan``, so a new process gives the same answers.
"""

from __future__ import annotations

import pickle
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import partial
from importlib.metadata import EntryPoint
from typing import Any, BinaryIO, ClassVar, NamedTuple

from shotc import child_process, plugins
from shotc.plugin_api.replanner import (
    ChaseProblem,
    ChaseSituation,
    FramingProblem,
    FramingSituation,
    Plan,
    Replanner,
)

LIMIT_S = 10.0
"""Seconds after which a replanner counts as hanging; a drone could not be flown with it."""

START_S = 60.0
"""Seconds in which its process has to start and to import the plugin; longer than on a machine under load."""

OUR_PACKAGE = "shotc-casadi"

Problem = ChaseProblem | FramingProblem
Situation = ChaseSituation | FramingSituation


class ReplannerFailed(Exception):
    """A replanner gave no answer; the text is the reason."""


class ReplannerHangs(ReplannerFailed):
    """A replanner took more than its limit."""


class _ReplanRequest(NamedTuple):
    """A replan; the problem is sent once for each planner, None after that."""

    number: int
    problem: Problem | None
    situation: Situation
    last: Plan | None


@contextmanager
def replanner(name: str) -> Iterator[Replanner]:
    """Yield the replanner with a name.

    Ours runs in this process: its steps and the iterations of its solver are bounded, so it cannot hang, and
    the pipe would cost 0.5 ms of CPU time beside the 0.9 ms of a replan. All others run in a process of their
    own, which takes 0.4 s of CPU time to start.
    """
    source = plugins.one("replanners", name)
    if source.package == OUR_PACKAGE:
        yield source.plugin
        return
    process = ReplannerProcess(source.reference, LIMIT_S)
    try:
        yield process
    finally:
        process.close()


class ReplannerProcess:
    """A replanner whose planners run in one process."""

    name: ClassVar[str] = "process"
    summary: ClassVar[str] = "a replanner in a process of its own"
    api: ClassVar[int] = plugins.API_VERSION

    def __init__(self, reference: str, seconds: float) -> None:
        """Prepare a process; reference : module:attribute; seconds : limit of a replan."""
        self._reference, self._seconds = reference, seconds
        self._planners: list[RemotePlanner] = []
        self._process: subprocess.Popen[bytes] | None = None
        self._sent: set[int] = set()

    def chase(self, problem: ChaseProblem) -> RemotePlanner:
        """Return the planner for a shot of one target."""
        return self._planner(problem)

    def framing(self, problem: FramingProblem) -> RemotePlanner:
        """Return the planner for a framing shot."""
        return self._planner(problem)

    def answer(self, number: int, situation: Situation, last: Plan | None) -> Any:
        """Return what a planner answers; raise ReplannerFailed if there is no answer."""
        if self._process is None:
            self._start()
        problem = None if number in self._sent else self._planners[number].problem
        self._sent.add(number)
        answered, fault = self._within(
            self._seconds, pickle.dumps(_ReplanRequest(number, problem, situation, last)), "it took"
        )
        if fault is not None:
            raise ReplannerFailed(fault)
        return answered

    def close(self) -> None:
        """End the process."""
        if self._process is not None:
            child_process.kill(self._process)
            with self._process:
                self._process = None

    def _planner(self, problem: Problem) -> RemotePlanner:
        self._planners.append(RemotePlanner(self, len(self._planners), problem))
        return self._planners[-1]

    def _start(self) -> None:
        self._sent.clear()
        self._process = child_process.started(__name__, serve.__name__)
        data = child_process.module_path() + pickle.dumps((self._reference, self._seconds))
        _, fault = self._within(START_S, data, "its process needs for its start")
        if fault is not None:
            self.close()
            raise ReplannerFailed(fault)

    def _within(self, seconds: float, data: bytes, what: str) -> Any:
        """Send data and return the answer; without one, end the process and raise why."""
        process = self._process
        assert process is not None
        assert process.stdin is not None
        assert process.stdout is not None
        late = threading.Event()

        def stop() -> None:
            late.set()
            child_process.kill(process)

        timer = threading.Timer(seconds, stop)
        timer.start()
        answered: Any = None
        try:
            process.stdin.write(data)
            process.stdin.flush()
            answered = pickle.load(process.stdout)
        except Exception:  # noqa: BLE001  half an answer, or none, may fail in any way
            with suppress(subprocess.TimeoutExpired):
                process.wait(child_process.GRACE_S)  # it ends by itself, and has a status of its own then
        finally:
            timer.cancel()
            timer.join()
        if late.is_set() or answered is None:
            self.close()
        if answered is None:
            if late.is_set():
                raise ReplannerHangs(f"{what} more than {seconds:g} s")
            raise ReplannerFailed(child_process.ended(process.returncode))
        return answered


class RemotePlanner:
    """A planner that runs in the process of its replanner."""

    def __init__(self, owner: ReplannerProcess, number: int, problem: Problem) -> None:
        self._owner, self._number = owner, number
        self.problem = problem

    def replan(self, situation: Situation, last: Plan | None) -> Any:
        """Return the answer of the plugin, which may be anything; raise ReplannerFailed without one."""
        return self._owner.answer(self._number, situation, last)


def serve(orders: BinaryIO) -> None:
    """Run in the process: answer the replans in ``orders`` until there are no more."""
    with child_process.answers() as out:
        reference, seconds = pickle.load(orders)
        plugin = EntryPoint("replanner", reference, "")
        data = child_process.answer_of(partial(_check, plugin))
        planners: dict[int, Any] = {}
        while True:
            out.write(data)
            out.flush()
            try:
                order = pickle.load(orders)
            except EOFError:
                return
            with child_process.ends_itself(seconds):
                data = child_process.answer_of(partial(_replanned, plugin, planners, order))


def _check(plugin: EntryPoint) -> None:
    """Load a plugin, which raises if that is impossible."""
    plugin.load()


def _replanned(plugin: EntryPoint, planners: dict[int, Any], order: _ReplanRequest) -> Any:
    """Return the answer of the planner that an order names; the planner is made if it is new."""
    if order.problem is not None:
        loaded = plugin.load()
        make: Any = loaded.chase if isinstance(order.problem, ChaseProblem) else loaded.framing
        planners[order.number] = make(order.problem)
    return planners[order.number].replan(order.situation, order.last)

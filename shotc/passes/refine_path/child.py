"""A refiner in a process of its own, which can be stopped whatever it is doing.

The process is a fresh interpreter: this one may have threads by now, which a fork would not survive. The
path goes in and the answer comes back by pipe; what the refiner prints goes to standard error.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
from importlib.metadata import EntryPoint
from typing import Any, BinaryIO, NamedTuple

from shotc.diag.plugin_faults import one_line
from shotc.ir.passes import Outcome, PassContext
from shotc.ir.path import Deviation, DronePath, PathIR, TimedPath

_START = (
    "import pickle, sys; sys.path[:] = pickle.load(sys.stdin.buffer); "
    "from shotc.passes.refine_path.child import answer; answer(sys.stdin.buffer)"
)
_GRACE = 1.0
"""Seconds past its time after which a process whose parent is gone ends itself."""


class TooSlow(Exception):
    """The refiner did not answer in time."""


class Failed(Exception):
    """The refiner raised, or its process ended without an answer; the text says which."""


class _Bare(NamedTuple):
    """A PathIR without the mission that it was asked with: what the answer need not carry back."""

    drones: tuple[DronePath, ...]
    deviations: tuple[Deviation, ...]
    stats: tuple[tuple[str, float | str], ...]
    timed: tuple[TimedPath, ...]


class _Order(NamedTuple):
    reference: str
    path: PathIR
    seed: int
    seconds: float


def refined_within(seconds: float, reference: str, path: PathIR, ctx: PassContext) -> Any:
    """Return what a refiner answers in a process of its own, whatever that is.

    seconds : from the start of the process, loading included; reference : module:attribute
    Raises TooSlow or Failed. A process that does not end by itself is ended, with all that it started.
    """
    data = pickle.dumps(sys.path) + pickle.dumps(_Order(reference, path, ctx.seed, seconds))
    with subprocess.Popen([sys.executable, "-P", "-c", _START], **_streams()) as process:
        try:
            answered, _ = process.communicate(data, timeout=seconds)
        except subprocess.TimeoutExpired:
            raise TooSlow from None
        finally:
            _end(process)
    return _read(answered, process.returncode, path)


def answer(orders: BinaryIO) -> None:
    """Be the process: refine what stands in the orders, and write the answer to standard output."""
    # The answer has the pipe for itself.
    with os.fdopen(os.dup(1), "wb") as out:
        os.dup2(2, 1)
        order: _Order = pickle.load(orders)
        if sys.platform != "win32":
            signal.setitimer(signal.ITIMER_REAL, order.seconds + _GRACE)
        data = _answer(order)
        out.write(data)


def _answer(order: _Order) -> bytes:
    try:
        refiner = EntryPoint("refiner", order.reference, "").load()
        outcome = refiner.refine(order.path, PassContext(order.seed))
        return pickle.dumps((_bare(outcome, order.path), None))
    except BaseException as fault:  # noqa: BLE001  a plugin may raise anything, and this process ends anyway
        return pickle.dumps((None, one_line(fault)))


def _bare(outcome: Any, path: PathIR) -> Any:
    value = outcome.value if isinstance(outcome, Outcome) else None
    if not isinstance(value, PathIR) or value.keyframes is not path.keyframes:
        return outcome
    return outcome._replace(value=_Bare(value.drones, value.deviations, value.stats, value.timed))


def _read(answered: bytes, status: int, path: PathIR) -> Any:
    try:
        outcome, fault = pickle.loads(answered)
    except Exception:  # noqa: BLE001  half an answer, or none, may fail in any way
        raise Failed(_ended(status)) from None
    if fault is not None:
        raise Failed(fault)
    if isinstance(outcome, Outcome) and isinstance(outcome.value, _Bare):
        return outcome._replace(value=PathIR(path.keyframes, *outcome.value))
    return outcome


def _ended(status: int) -> str:
    if status < 0:
        return f"its process was ended by a signal: {signal.strsignal(-status)}"
    return f"its process ended with status {status} and no answer"


def _streams() -> dict[str, Any]:
    """Return how the process is started: with pipes, and apart from what an interrupt reaches."""
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    if sys.platform == "win32":
        return pipes | {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}
    return pipes | {"start_new_session": True}


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a process that has not ended, and what it started."""
    if process.returncode is not None:
        return
    if sys.platform == "win32":
        process.kill()
    else:
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()

"""A fresh interpreter as a child process, in which a plugin runs, and which can be killed at any time.

It is not a fork, because this process may have threads, which a fork does not copy. Orders and answers pass
through pipes. ``answers``, ``ends_itself`` and ``answer_of`` are called in the child.
"""

from __future__ import annotations

import faulthandler
import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, BinaryIO

from shotc.diag.plugin_faults import one_line

GRACE_S = 1.0
"""Seconds after its limit at which a child without a parent ends itself, and seconds in which a child that
gives no answer has to end.
"""

_START = (
    "import pickle, sys; sys.path[:] = pickle.load(sys.stdin.buffer); "
    "from {module} import {function}; {function}(sys.stdin.buffer)"
)


def started(module: str, function: str) -> subprocess.Popen[bytes]:
    """Return a new interpreter that calls a function with its standard input.

    The first pickle in its input has to be ``module_path()``. Interrupts do not reach it.
    """
    command = [sys.executable, "-P", "-c", _START.format(module=module, function=function)]
    apart: dict[str, Any] = {"start_new_session": True}
    if sys.platform == "win32":
        apart = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, **apart)


def module_path() -> bytes:
    """Return the search path of modules of this process, pickled."""
    return pickle.dumps(sys.path)


def kill(process: subprocess.Popen[bytes]) -> None:
    """Kill a running process, and its children on systems that can; return when it has ended."""
    if process.returncode is not None:
        return
    if sys.platform == "win32":
        process.kill()
    else:
        with suppress(ProcessLookupError, PermissionError):  # it has ended, and nobody has waited for it yet
            os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def ended(status: int) -> str:
    """Return how a process ended without an answer, in words."""
    if status < 0:
        return f"its process was ended by a signal: {signal.strsignal(-status)}"
    return f"its process ended with status {status} and no answer"


@contextmanager
def answers() -> Iterator[BinaryIO]:
    """Yield the pipe for answers; what the plugin prints goes to standard error."""
    with os.fdopen(os.dup(1), "wb") as out:
        os.dup2(2, 1)
        yield out


@contextmanager
def ends_itself(seconds: float) -> Iterator[None]:
    """End this process with status 1 if the block takes more than ``GRACE_S`` longer than a limit, also if
    it hangs in C code. The parent has killed it before that, unless the parent is gone.
    """
    with Path(os.devnull).open("w") as nowhere:
        faulthandler.dump_traceback_later(seconds + GRACE_S, exit=True, file=nowhere)
        try:
            yield
        finally:
            faulthandler.cancel_dump_traceback_later()


def answer_of(plugin: Callable[[], Any]) -> bytes:
    """Return what a plugin answers and, in one line, what it raises, pickled; one of them is None."""
    try:
        return pickle.dumps((plugin(), None))
    except BaseException as fault:  # noqa: BLE001  a plugin may raise anything
        return pickle.dumps((None, one_line(fault)))

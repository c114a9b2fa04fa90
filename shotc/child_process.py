"""A fresh interpreter as a child process, which can be killed at any time.

It is not a fork, because this process may have threads, which a fork does not copy. Orders and answers pass
through pipes.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
from contextlib import suppress
from typing import Any

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

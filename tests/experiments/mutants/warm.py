"""A pytest plugin that collects once, then runs chosen tests with one fault after another, each in a fork.

Most of the time of a mutant would go into imports and collection. Here a process waits with all tests
collected; a fork of it exchanges the code of the functions that have the fault and runs the tests.
"""

from __future__ import annotations

import os
import resource
from math import ceil
from multiprocessing.connection import Connection
from pathlib import Path
from types import FunctionType
from typing import NamedTuple

import pytest

from tests.experiments.mutants.patched import NotPatchedError, loaded_functions, patch, patch_constants

PIPE = "MUTANTS_PIPE"
"""Environment: the descriptor of the pipe by which tasks come and exit statuses go."""

SURVIVED, KILLED, COLD, UNSURE = 0, 1, 3, 4
"""Exit statuses of a fork; COLD: the module must be imported anew; UNSURE: it survived, but should be."""


class Task(NamedTuple):
    """A fault and its tests.

    old, new : texts of the file, the same for no fault; seconds : of CPU that each test may take
    """

    path: str
    old: str
    new: str
    tests: tuple[str, ...]
    seconds: tuple[float, ...]


@pytest.hookimpl(tryfirst=True)
def pytest_runtestloop(session: pytest.Session) -> bool:
    """Wait for tasks in place of running what was collected; None ends."""
    functions = loaded_functions()
    items = {item.nodeid: item for item in session.items}
    with Connection(int(os.environ[PIPE])) as pipe:
        pipe.send(sorted(items))
        while (task := pipe.recv()) is not None:
            child = os.fork()
            if child == 0:
                os._exit(_try(Task(*task), items, functions))
            pipe.send(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
    return True


def _try(task: Task, items: dict[str, pytest.Item], functions: dict[str, list[FunctionType]]) -> int:
    path = str(Path.cwd() / task.path)
    try:
        sure = task.new == task.old or _patched(functions.get(path, []), path, task)
        ended = _run([items[name] for name in task.tests], task.seconds)
    except NotPatchedError:
        return COLD
    except BaseException:  # noqa: BLE001 - a fault may end the session, too
        return KILLED
    return ended if sure or ended == KILLED else UNSURE


def _patched(functions: list[FunctionType], path: str, task: Task) -> bool:
    """Put a fault into what is loaded; return whether all that depends on it sees it."""
    try:
        patch(functions, path, task.old, task.new)
    except NotPatchedError:
        patch_constants(path, task.old, task.new)
        return False
    return True


def _run(tests: list[pytest.Item], seconds: tuple[float, ...]) -> int:
    for test, following, limit in zip(tests, [*tests[1:], None], seconds, strict=True):
        used = resource.getrusage(resource.RUSAGE_SELF)
        resource.setrlimit(resource.RLIMIT_CPU, (ceil(used.ru_utime + used.ru_stime + limit), -1))
        test.config.hook.pytest_runtest_protocol(item=test, nextitem=following)
        if test.session.testsfailed:
            return KILLED
    return SURVIVED

"""Runs of tests in a copy of the tree: in a fork of a process that has collected them, or in a fresh one."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from collections.abc import Mapping, Sequence
from multiprocessing import Pipe
from pathlib import Path

from tests.experiments.mutants.choice import CHOSEN, FAILED
from tests.experiments.mutants.warm import COLD, KILLED, PIPE, SURVIVED, UNSURE, Task

ENDS = {SURVIVED: "survived", KILLED: "killed", 2: "killed"}
"""What exit statuses of pytest mean; 2 is that a module cannot be imported."""

START_SECONDS = 30.0
"""CPU for the imports and the collection of a fresh process."""

FAILED_FILE = "failed-tests.txt"


class Waiting:
    """A process that has collected some tests of a copy and waits for faults."""

    def __init__(self, tests: Sequence[str], copy: Path) -> None:
        self.pipe, theirs = Pipe()
        with theirs, (copy / "waiting.log").open("wb") as log:
            self.process = subprocess.Popen(
                pytest(tests, "-p", "tests.experiments.mutants.warm", f"--basetemp={copy / 'temporary'}"),
                cwd=copy,
                env=environment(tests, copy) | {PIPE: str(theirs.fileno())},
                pass_fds=[theirs.fileno()],
                stdout=log,
                stderr=log,
            )
        self.tests = set(self.pipe.recv())

    def run(self, path: str, old: str, new: str, tests: Mapping[str, float]) -> str | None:
        """Run tests until one fails, with a file's text exchanged: killed, timeout or survived.

        None is that a fresh process must import the file.

        tests : each with the seconds of CPU that it may take
        """
        names = tuple(test for test in tests if test in self.tests)
        self.pipe.send(Task(path, old, new, names, tuple(tests[name] for name in names)))
        status = self.pipe.recv()
        return None if status in {COLD, UNSURE} else _verdict(status)

    def close(self) -> None:
        """End it."""
        self.pipe.send(None)
        self.process.wait()


def fresh_run(tests: Sequence[str], copy: Path, seconds: float) -> str:
    """Run tests in a copy until one fails, in a process of their own: killed, timeout or survived.

    The limit is one of CPU time, so that a loaded machine kills no mutant; a wall-clock limit, ten times as
    long, ends what waits for ever.
    """
    limit = int(START_SECONDS + seconds) + 1
    try:
        done = subprocess.run(
            pytest(tests, "-x"),
            cwd=copy,
            env=environment(tests, copy),
            capture_output=True,
            check=False,
            timeout=10 * limit,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit)),
        )
    except subprocess.TimeoutExpired:
        return "timeout"
    if done.returncode >= 0 and done.returncode not in ENDS:
        raise RuntimeError(done.stdout.decode() + done.stderr.decode())
    return _verdict(done.returncode)


def _verdict(status: int) -> str:
    return "timeout" if status < 0 else ENDS[status]


def pytest(tests: Sequence[str], *options: str) -> list[str]:
    """Return the command that runs tests, whatever their marks."""
    files = sorted({test.partition("::")[0] for test in tests})
    plain = ("-q", "--tb=no", "-m", "", "-p", "no:cacheprovider", "-p", "tests.experiments.mutants.choice")
    return [sys.executable, "-m", "pytest", *plain, *options, *files]


def environment(tests: Sequence[str], copy: Path) -> dict[str, str]:
    """Write the tests down, and return the environment in which a copy runs them with its own modules."""
    chosen = copy / "chosen-tests.txt"
    chosen.write_text("\n".join(tests), encoding="utf-8")
    paths = [copy, *(p for p in sorted(copy.glob("plugins/*")) if p.is_dir())]
    inherited = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    return inherited | {
        CHOSEN: str(chosen),
        FAILED: str(copy / FAILED_FILE),
        "PYTHONPATH": os.pathsep.join(map(str, paths)),
        "OMP_NUM_THREADS": "1",
    }

"""One mutant against the tests that run its line, in a copy of the tree."""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.experiments.mutants.changes import Mutant
from tests.experiments.mutants.choice import CHOSEN, FAILED
from tests.experiments.mutants.coverage_map import CoverageMap

FIRST_TESTS, FIRST_SECONDS = 40, 5.0
"""A first round of few tests, which kills most mutants and imports little."""

START_SECONDS, LONGER = 30.0, 4.0
"""CPU that a round may take: its imports, and so many times what its tests took without the fault."""


ENDS = {0: "survived", 1: "killed", 2: "killed"}
"""What exit statuses of pytest mean; 2 is that a module cannot be imported."""

FAILED_FILE = "failed-tests.txt"


@dataclass(frozen=True)
class Trial:
    """What became of a mutant: killed, timeout, survived or uncovered; tests : how many were to run it."""

    mutant: Mutant
    verdict: str
    tests: int


def copy_tree(root: Path, to: Path) -> None:
    """Copy what git tracks, or would."""
    listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(listed, cwd=root, check=True, capture_output=True, text=True).stdout
    shutil.rmtree(to, ignore_errors=True)
    for name in filter(None, names.split("\0")):
        if (root / name).is_file():
            (to / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(root / name, to / name)


def tried(mutant: Mutant, covered: CoverageMap, copy: Path, longest: float) -> Trial:
    """Put a fault into the copy, run its tests until one fails, and take the fault out again.

    longest : seconds of CPU that its tests may take without the fault; the broadest are left out beyond
    """
    tests = _within(covered.tests(mutant), covered, longest)
    if not tests:
        return Trial(mutant, "uncovered", 0)
    path = copy / mutant.path
    text = path.read_text(encoding="utf-8")
    _write(path, mutant.applied(text))
    try:
        return Trial(mutant, _verdict(tests, covered, copy), len(tests))
    finally:
        _write(path, text)


def _write(path: Path, text: str) -> None:
    """Write a module, and forget its bytecode: two versions in one second have the same time stamp."""
    path.write_text(text, encoding="utf-8")
    for compiled in path.parent.glob(f"__pycache__/{path.stem}.*.pyc"):
        compiled.unlink()


def _verdict(tests: Sequence[str], covered: CoverageMap, copy: Path) -> str:
    for part in _rounds(tests, covered):
        verdict = run(part, copy, START_SECONDS + LONGER * sum(covered.seconds[t] for t in part))
        if verdict != "survived":
            return verdict
    return "survived"


def _within(tests: Sequence[str], covered: CoverageMap, longest: float) -> list[str]:
    total, found = 0.0, []
    for test in tests:
        total += covered.seconds[test]
        if total > longest and found:
            break
        found.append(test)
    return found


def _rounds(tests: Sequence[str], covered: CoverageMap) -> Iterator[Sequence[str]]:
    first = _within(tests[:FIRST_TESTS], covered, FIRST_SECONDS)
    yield first
    if rest := tests[len(first) :]:
        yield rest


def run(tests: Sequence[str], copy: Path, seconds: float) -> str:
    """Run tests in a copy until one fails: killed, timeout or survived.

    The limit is one of CPU time, so that a loaded machine kills no mutant; a wall-clock limit, ten times as
    long, ends what waits for ever.
    """
    limit = int(seconds) + 1
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
    if done.returncode < 0:
        return "timeout"
    if done.returncode not in ENDS:
        raise RuntimeError(done.stdout.decode() + done.stderr.decode())
    return ENDS[done.returncode]


def failing(tests: Sequence[str], copy: Path, jobs: int) -> set[str]:
    """Return the tests that fail in a copy without any fault: they tell nothing of one."""
    command = pytest(tests, "-n", str(jobs))
    done = subprocess.run(command, cwd=copy, env=environment(tests, copy), capture_output=True, check=False)
    if done.returncode not in (0, 1):
        raise RuntimeError(done.stdout.decode() + done.stderr.decode())
    failed = copy / FAILED_FILE
    return set(failed.read_text(encoding="utf-8").split("\n")) if failed.is_file() else set()


def pytest(tests: Sequence[str], *options: str) -> list[str]:
    """Return the command that runs tests, whatever their marks."""
    files = sorted({test.partition("::")[0] for test in tests})
    plain = ("-q", "-m", "", "-p", "no:cacheprovider", "-p", "tests.experiments.mutants.choice")
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

"""One mutant against the tests that run its line, in a copy of the tree."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.experiments.mutants.changes import Mutant
from tests.experiments.mutants.coverage_map import CoverageMap
from tests.experiments.mutants.memory import Memory
from tests.experiments.mutants.runs import FAILED_FILE, Waiting, fresh_run

START_SECONDS, LONGER = 5.0, 4.0
"""CPU that a test may take: late imports, and so many times what it took without the fault."""


@dataclass(frozen=True)
class Trial:
    """What became of a mutant: killed, timeout, survived or uncovered; tests : how many were to run it."""

    mutant: Mutant
    verdict: str
    tests: int


class Bench:
    """A copy of the tree in which mutants are tried one after another.

    remembered : file of what earlier campaigns found
    longest : seconds of CPU that the tests of a mutant may take without it; the broadest are left out beyond
    """

    def __init__(
        self,
        root: Path,
        copy: Path,
        covered: CoverageMap,
        tests: Sequence[str],
        *,
        remembered: Path,
        longest: float,
    ) -> None:
        _copy_tree(root, copy)
        self.copy, self.covered, self.longest = copy, covered, longest
        self.memory = Memory(remembered, copy)
        self.waiting = Waiting(tests, copy)
        self.sound: set[str] = set()

    def tried(self, mutant: Mutant) -> Trial:
        """Put a fault into the copy, run its tests until one fails, and take the fault out again."""
        while tests := self._tests(mutant):
            if self.memory.survives(mutant, tests):
                return Trial(mutant, "survived", len(tests))
            verdict = self._verdict(mutant, tests)
            failed = self._failed() if verdict == "killed" else ""
            if not failed or self._passes(failed):
                self.memory.note(mutant, verdict, tests, failed)
                return Trial(mutant, verdict, len(tests))
            self.covered.forget({failed})
        return Trial(mutant, "uncovered", 0)

    def close(self) -> None:
        """End the process that waits for mutants."""
        self.waiting.close()

    def _tests(self, mutant: Mutant) -> list[str]:
        """Return the tests of a mutant that there is time for, the one that killed it before first."""
        total, found, made = 0.0, [], set[str]()
        killer = self.memory.killer(mutant)
        for test in sorted(self.covered.tests(mutant), key=lambda test: test != killer):
            total += self.covered.cost(test, made)
            made |= self.covered.needs[test]
            if total > self.longest and found:
                break
            found.append(test)
        return found

    def _verdict(self, mutant: Mutant, tests: Sequence[str]) -> str:
        path = self.copy / mutant.path
        old = path.read_text(encoding="utf-8")
        new = mutant.applied(old)
        limits = self._limits(tests)
        _write(path, new)
        (self.copy / FAILED_FILE).unlink(missing_ok=True)
        try:
            verdict = self.waiting.run(mutant.path, old, new, limits)
            if verdict is None or (verdict == "survived" and self.covered.imports(mutant)):
                return fresh_run(tests, self.copy, sum(limits.values()))
            return verdict
        finally:
            _write(path, old)

    def _limits(self, tests: Sequence[str]) -> dict[str, float]:
        return {test: START_SECONDS + LONGER * self.covered.cost(test) for test in tests}

    def _failed(self) -> str:
        """Return the test that failed; none did where a module could not be imported."""
        failed = self.copy / FAILED_FILE
        return failed.read_text(encoding="utf-8").split("\n")[0] if failed.is_file() else ""

    def _passes(self, test: str) -> bool:
        """Whether a test passes in the copy without a fault: one that does not tells nothing of one."""
        if test not in self.sound:
            if self.waiting.run("", "", "", self._limits([test])) != "survived":
                return False
            self.sound.add(test)
        return True


def _copy_tree(root: Path, to: Path) -> None:
    """Copy what git tracks, or would."""
    listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(listed, cwd=root, check=True, capture_output=True, text=True).stdout
    shutil.rmtree(to, ignore_errors=True)
    for name in filter(None, names.split("\0")):
        if (root / name).is_file():
            (to / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(root / name, to / name)


def _write(path: Path, text: str) -> None:
    """Write a module, and forget its bytecode: two versions in one second have the same time stamp."""
    path.write_text(text, encoding="utf-8")
    for compiled in path.parent.glob(f"__pycache__/{path.stem}.*.pyc"):
        compiled.unlink()

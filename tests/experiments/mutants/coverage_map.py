"""Which tests run a line, and how long each takes: recorded by one run of the suite."""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
import sys
from argparse import Namespace
from collections import defaultdict
from collections.abc import Iterable, Sequence
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from typing import Any

from tests.experiments.mutants.changes import Mutant
from tests.experiments.mutants.recording import FOLDER, IMPORT, PATHS

INSTANT_S = 0.02
"""CPU seconds by which one test is hardly quicker than another."""


class CoverageMap:
    """What the records say.

    tests : of a file and a line; seconds : of CPU of each test; modules : tests of any line of a file
    """

    def __init__(self, records: Iterable[dict[str, Any]]) -> None:
        self.lines: dict[str, dict[int, set[str]]] = defaultdict(lambda: defaultdict(set))
        self.asked: dict[str, set[str]] = defaultdict(set)
        self.seconds: dict[str, float] = {}
        failed: set[str] = set()
        for record in records:
            failed.update(record["failed"])
            self.seconds.update(record["seconds"])
            for name, by in record["asked"].items():
                self.asked[name].update(by)
            for path, lines in record["lines"].items():
                for line, contexts in lines.items():
                    self.lines[path][int(line)].update(contexts)
        self.forget(failed)

    @cached_property
    def breadth(self) -> dict[str, int]:
        """How many lines each context runs: who runs few looks closely."""
        found: dict[str, int] = defaultdict(int)
        for lines in self.lines.values():
            for contexts in lines.values():
                for context in contexts:
                    found[context] += 1
        return found

    def tests(self, mutant: Mutant) -> list[str]:
        """Return the tests that run the statement of a mutant, quick ones that run little else first."""
        contexts = self._contexts(mutant)
        if IMPORT in contexts:
            contexts.update(*self.lines[mutant.path].values())
        return sorted(
            self._asking(contexts), key=lambda t: ((1 + self.breadth[t]) * (self.seconds[t] + INSTANT_S), t)
        )

    def imports(self, mutant: Mutant) -> bool:
        """Whether the statement of a mutant is run when modules are imported."""
        return IMPORT in self._contexts(mutant)

    def _contexts(self, mutant: Mutant) -> set[str]:
        lines = self.lines.get(mutant.path, {})
        return set().union(*(lines.get(n, ()) for n in range(mutant.first, mutant.last + 1)))

    def forget(self, tests: set[str]) -> None:
        """Leave tests out that fail without a fault."""
        for test in tests:
            self.seconds.pop(test, None)

    def _asking(self, contexts: set[str]) -> set[str]:
        """Return the tests among contexts, and those that asked for what is shared among them."""
        seen, waiting = set(contexts), list(contexts)
        while waiting:
            for asker in self.asked.get(waiting.pop(), ()):
                if asker not in seen:
                    seen.add(asker)
                    waiting.append(asker)
        return {context for context in seen if context in self.seconds}


def recorded(folder: Path, paths: Sequence[str], root: Path, options: Namespace) -> CoverageMap:
    """Return the map in a folder; run the suite and record it where there is none of these files.

    options : tests, as pytest's command line names them; record, whatever there is; jobs, how many at once
    """
    digest = folder / "digest.txt"
    now = _digest(root, paths, options.tests)
    if options.record or not digest.is_file() or digest.read_text(encoding="utf-8") != now:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        environment = dict(os.environ) | {FOLDER: str(folder), PATHS: "\n".join(paths)}
        chosen = ["-p", "tests.experiments.mutants.recording", *shlex.split(options.tests)]
        command = [sys.executable, "-m", "pytest", "-n", str(options.jobs), "--dist", "loadgroup", *chosen]
        subprocess.run(command, cwd=root, env=environment, check=False)
        digest.write_text(now, encoding="utf-8")
    return CoverageMap(json.loads(p.read_text(encoding="utf-8")) for p in sorted(folder.glob("*.json")))


def _digest(root: Path, paths: Sequence[str], tests: str) -> str:
    """Return what tells one source, recorded by tests of some names, from another."""
    files = sorted(file for path in paths for file in (root / path).rglob("*.py"))
    tested = [*root.glob("tests/**/test_*.py"), *root.glob("plugins/**/test_*.py")]
    names = sorted(file.relative_to(root).as_posix() for file in tested)
    parts = [tests.encode(), "\n".join(names).encode(), *(file.read_bytes() for file in files)]
    return sha256(b"\0".join(parts)).hexdigest()

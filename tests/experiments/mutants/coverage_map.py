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
from collections.abc import Container, Iterable, Iterator, Sequence
from functools import cached_property
from hashlib import sha256
from pathlib import Path, PurePosixPath
from typing import Any

from tests.experiments.mutants.changes import Mutant
from tests.experiments.mutants.recording import FOLDER, IMPORT, KNOWN, PATHS, text_digest

INSTANT_S = 0.02
"""CPU seconds by which one test is hardly quicker than another."""

ELSEWHERE, BESIDE = 10.0, 3.0
"""How much later tests come whose folder does not mirror the source, or whose file is not named like it."""


class CoverageMap:
    """What the records say.

    lines : contexts by file and line; asked : who asks for what is shared
    seconds : of CPU of each test, without what it shares; shared : of what is shared
    """

    def __init__(self, records: Iterable[dict[str, Any]]) -> None:
        self.lines: dict[str, dict[int, set[str]]] = defaultdict(lambda: defaultdict(set))
        self.asked: dict[str, set[str]] = defaultdict(set)
        self.seconds: dict[str, float] = {}
        self.shared: dict[str, float] = {}
        for record in records:
            self.seconds.update(record["seconds"])
            self.shared.update(record["shared"])
            self.forget(record["failed"])
            for name, by in record["asked"].items():
                self.asked[name].update(by)
            for path, lines in record["lines"].items():
                for line, contexts in lines.items():
                    self.lines[path][int(line)].update(contexts)

    @cached_property
    def breadth(self) -> dict[str, int]:
        """How many lines each test runs, with those of what it shares: who runs few looks closely."""
        lines: dict[str, int] = defaultdict(int)
        for of_file in self.lines.values():
            for contexts in of_file.values():
                for context in contexts:
                    lines[context] += 1
        found: dict[str, int] = defaultdict(int)
        for context, count in lines.items():
            for asker in self._all_asking({context}):
                found[asker] += count
        return found

    @cached_property
    def needs(self) -> dict[str, set[str]]:
        """What is shared that each test asks for, itself or by what it asks for."""
        found: dict[str, set[str]] = defaultdict(set)
        for name in self.asked:
            for asker in self._all_asking({name}):
                found[asker].add(name)
        return found

    def cost(self, test: str, made: Container[str] = ()) -> float:
        """Return the CPU seconds of a test, with those of all it shares that is not made yet."""
        new = (self.shared.get(name, 0.0) for name in self.needs[test] if name not in made)
        return self.seconds[test] + sum(new)

    def tests(self, mutant: Mutant) -> list[str]:
        """Return the tests that run the statement of a mutant, near quick ones that run little else first."""
        contexts = self._contexts(mutant)
        running = self._all_asking(contexts)
        if IMPORT in contexts:
            contexts.update(*self.lines[mutant.path].values())

        def lateness(test: str) -> tuple[float, str]:
            close = (1 + self.breadth[test]) * (self.cost(test) + INSTANT_S)
            return close * _distance(mutant.path, test) * (1.0 if test in running else ELSEWHERE), test

        asking = self._all_asking(contexts)
        return sorted((context for context in asking if context in self.seconds), key=lateness)

    def imports(self, mutant: Mutant) -> bool:
        """Whether the statement of a mutant is run when modules are imported."""
        return IMPORT in self._contexts(mutant)

    def _contexts(self, mutant: Mutant) -> set[str]:
        lines = self.lines.get(mutant.path, {})
        return set().union(*(lines.get(n, ()) for n in range(mutant.first, mutant.last + 1)))

    def forget(self, tests: Iterable[str]) -> None:
        """Leave tests out that fail without a fault."""
        for test in tests:
            self.seconds.pop(test, None)

    def _all_asking(self, contexts: set[str]) -> set[str]:
        """Return contexts, and those that asked for what is shared among them."""
        seen, waiting = set(contexts), list(contexts)
        while waiting:
            for asker in self.asked.get(waiting.pop(), ()):
                if asker not in seen:
                    seen.add(asker)
                    waiting.append(asker)
        return seen


def _distance(path: str, test: str) -> float:
    """Return how far a test is from a source, by its folder and the name of its file."""
    source, place = PurePosixPath(path), PurePosixPath(test.partition("::")[0])
    mirrored = PurePosixPath("tests/unit").joinpath(*source.parts[1:-1])
    if place.parent not in {mirrored, mirrored.parent}:
        return ELSEWHERE
    return 1.0 if source.stem in place.stem else BESIDE


def recorded(folder: Path, paths: Sequence[str], root: Path, options: Namespace) -> CoverageMap:
    """Return the map in a folder, after a run of the tests that it lacks.

    A test whose file has changed is recorded again. Where the source has changed, all tests are.

    options : tests, as pytest's command line names them; record, whatever there is; jobs, how many at once
    """
    source, tests = folder / "source.txt", folder / "tests.txt"
    now, asked = _source_digest(root, paths), _tests_digest(root, options.tests)
    if options.record or _text(source) != now:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        source.write_text(now, encoding="utf-8")
    if _text(tests) != asked:
        _record(folder, paths, root, options)
        tests.write_text(asked, encoding="utf-8")
    return CoverageMap(_records(folder, root))


def _record(folder: Path, paths: Sequence[str], root: Path, options: Namespace) -> None:
    """Run the tests that are not recorded; each process of the run writes a record."""
    run = folder / f"{len(list(folder.glob('*/'))):03}"
    run.mkdir()
    known = folder / "known.txt"
    known.write_text("\n".join(CoverageMap(_records(folder, root)).seconds), encoding="utf-8")
    environment = dict(os.environ) | {FOLDER: str(run), PATHS: "\n".join(paths), KNOWN: str(known)}
    chosen = ["-p", "tests.experiments.mutants.recording", *shlex.split(options.tests)]
    command = [sys.executable, "-m", "pytest", "-n", str(options.jobs), "--dist", "loadgroup", *chosen]
    subprocess.run(command, cwd=root, env=environment, check=False)
    if not any(run.glob("*.json")):
        raise RuntimeError(f"the run of the tests left no record in {run}")


def _records(folder: Path, root: Path) -> Iterator[dict[str, Any]]:
    """Yield the records, the oldest first, without the tests whose files have changed since."""
    for path in sorted(folder.glob("*/*.json")):
        record = json.loads(path.read_text(encoding="utf-8"))
        same = {name for name, digest in record["files"].items() if _is_text(root / name, digest)}
        seconds = {test: s for test, s in record["seconds"].items() if test.partition("::")[0] in same}
        yield {**record, "seconds": seconds, "failed": [test for test in record["failed"] if test in seconds]}


def _is_text(path: Path, digest: str) -> bool:
    return path.is_file() and text_digest(path) == digest


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8") if path.is_file() else ""


def _source_digest(root: Path, paths: Sequence[str]) -> str:
    """Return what tells one source from another."""
    files = sorted(file for path in paths for file in (root / path).rglob("*.py"))
    files.append(root / "tests/experiments/mutants/recording.py")
    return sha256(
        "\n".join(f"{file.relative_to(root)} {text_digest(file)}" for file in files).encode()
    ).hexdigest()


def _tests_digest(root: Path, tests: str) -> str:
    """Return what tells one choice of tests from another, and one text of them."""
    files = sorted([*root.glob("tests/**/test_*.py"), *root.glob("plugins/**/test_*.py")])
    lines = [tests, *(f"{file.relative_to(root)} {text_digest(file)}" for file in files)]
    return sha256("\n".join(lines).encode()).hexdigest()
